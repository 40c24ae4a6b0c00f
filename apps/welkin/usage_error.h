// SPDX-License-Identifier: Apache-2.0
// A mistake in how the program was called (exit code 2), as against one in what it was given to work on (exit
// code 1).
#pragma once

#include "welkin/core/error.h"

namespace welkin::app {

class UsageError : public Error {
 public:
  using Error::Error;
};

}  // namespace welkin::app
