// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and termination: the signal only sets a flag; whoever reports progress turns it into
// welkin::Interrupted, so that everything half-written is cleaned up on the way out.
#pragma once

namespace welkin::app {

// SIGINT and SIGTERM set the flag from now on.
void catchInterrupts();

// Throws Interrupted once the flag is set.
void throwIfInterrupted();

}  // namespace welkin::app
