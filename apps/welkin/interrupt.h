// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and termination: the signal only sets a flag; whoever reports progress turns it into
// welkin::Interrupted, so that everything half-written is cleaned up on the way out.
#pragma once

namespace welkin::app {

// SIGINT, SIGTERM and SIGHUP set the flag from now on.
void catchInterrupts();

// A file that would grow beyond the process's limit is an error, as on a full disk, and does not end the
// program amid it.
void takeFileLimitsAsErrors();

// Programs that are called, ffmpeg for one, can be told to have failed: who started this one may have had
// that ignored.
void seeHowProgramsEnd();

// Throws Interrupted once the flag is set.
void throwIfInterrupted();

}  // namespace welkin::app
