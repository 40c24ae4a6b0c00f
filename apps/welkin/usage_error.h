// SPDX-License-Identifier: Apache-2.0
// A mistake in how the program was called (exit code 2), as against one in what it was given to work on (exit
// code 1).
#pragma once

#include <string>
#include <vector>

#include "welkin/core/error.h"

namespace welkin::app {

class UsageError : public Error {
 public:
  using Error::Error;
};

// What is wrong with the name of a file whose extension says no kind of file that will do.
std::string wrongKind(const std::string& path, const std::string& expected);

// "; did you mean NAME?" with the nearest of the names, "" where none is near.
std::string didYouMean(const std::string& word, const std::vector<std::string>& names);

}  // namespace welkin::app
