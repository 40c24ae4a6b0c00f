// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "welkin/core/error.h"

namespace welkin::io {

static_assert(std::endian::native == std::endian::little,
              "the files' numbers are read and written as they are");

namespace {
constexpr std::uint64_t kBufferBytes = 1 << 16;
}

InputFile::InputFile(const std::filesystem::path& path) : path_(path) {
  file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe must not make us wait
  struct stat status{};
  if (file_ < 0 || fstat(file_, &status) != 0) {
    const int error = errno;
    if (file_ >= 0) close(file_);
    fail(std::generic_category().message(error));
  }
  if (!S_ISREG(status.st_mode)) {
    close(file_);
    fail(S_ISDIR(status.st_mode) ? "is a folder" : "is no ordinary file");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() {
  close(file_);
}

void InputFile::fail(const std::string& why) const {
  throw IoError("cannot read " + path_.string() + ": " + why);
}
void InputFile::fail(const std::string& why, std::uint64_t byte) const {
  fail(why + " (byte " + std::to_string(byte) + ")");
}

void InputFile::require(std::uint64_t count) const {
  if (count > left())
    fail("the file is cut short: expected " + std::to_string(count) + " more bytes, found " +
             std::to_string(left()),
         position_);
}

void InputFile::readDirect(std::uint64_t position, void* out, std::uint64_t count) {
  char* to = static_cast<char*>(out);
  while (count > 0) {
    const ssize_t done = pread(file_, to, count, static_cast<off_t>(position));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(std::generic_category().message(errno), position);
    if (done == 0) fail("the file became shorter while it was read", position);
    to += done;
    position += static_cast<std::uint64_t>(done);
    count -= static_cast<std::uint64_t>(done);
  }
}

void InputFile::read(void* out, std::uint64_t count) {
  require(count);
  if (count >= kBufferBytes) {
    readDirect(position_, out, count);
  } else if (count > 0) {
    if (position_ < bufferStart_ || position_ + count > bufferStart_ + buffer_.size()) {
      buffer_.resize(std::min(kBufferBytes, left()));
      bufferStart_ = position_;
      readDirect(position_, buffer_.data(), buffer_.size());
    }
    std::memcpy(out, buffer_.data() + (position_ - bufferStart_), count);
  }
  position_ += count;
}

void InputFile::skip(std::uint64_t count) {
  require(count);
  position_ += count;
}

void InputFile::seek(std::uint64_t position) {
  if (position > size_) fail("the file ends before byte " + std::to_string(position));
  position_ = position;
}

}  // namespace welkin::io
