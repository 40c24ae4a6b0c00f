// SPDX-License-Identifier: Apache-2.0
// The exceptions that Welkin throws at its edges. Broken contracts inside are asserts, not exceptions.
// The library never prints and never exits; a program turns these into messages.
#pragma once

#include <stdexcept>
#include <string>

namespace welkin {

// Base of all of Welkin's exceptions; what() is a complete sentence for the user.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A text that could not be read. what() is "file:line:column: message"; parts that are unknown are left out.
class ParseError : public Error {
 public:
  ParseError(const std::string& file, int line, int column, const std::string& message)
      : Error(format(file, line, column, message)), line_(line), column_(column) {}
  int line() const { return line_; }      // from 1; 0: not known
  int column() const { return column_; }  // from 1; 0: not known

 private:
  static std::string format(const std::string& file, int line, int column, const std::string& message) {
    std::string s = file;
    if (line > 0) s += (s.empty() ? "line " : ":") + std::to_string(line);
    if (column > 0) s += (s.empty() ? "column " : ":") + std::to_string(column);
    return s.empty() ? message : s + ": " + message;
  }
  int line_;
  int column_;
};

// A value outside its range, or values that contradict one another.
class ParameterError : public Error {
 public:
  using Error::Error;
};

// A file that could not be read or written; what() names the path.
class IoError : public Error {
 public:
  using Error::Error;
};

// The graphics context, a shader or a GPU resource failed.
class GpuError : public Error {
 public:
  using Error::Error;
};

// The user asked to stop (thrown out of progress callbacks and passed through unharmed).
class Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted") {}
};

}  // namespace welkin
