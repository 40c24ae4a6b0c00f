// SPDX-License-Identifier: Apache-2.0
// A file that is read with suspicion: its size is known before anything is believed, and every error names
// the path and the byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

namespace welkin::io {

class InputFile {
 public:
  // Throws IoError for what is not there, may not be read, or is no ordinary file.
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return position_; }
  std::uint64_t left() const { return size_ - position_; }

  // All throw IoError when the file ends before; nothing is then read.
  void read(void* out, std::uint64_t count);
  void skip(std::uint64_t count);
  void seek(std::uint64_t position);

  // A number as it stands in the file, little-endian.
  template <class T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    read(&value, sizeof value);
    return value;
  }

  // "cannot read PATH: WHY", with " (byte N)" at the end if a byte is named.
  [[noreturn]] void fail(const std::string& why) const;
  [[noreturn]] void fail(const std::string& why, std::uint64_t byte) const;

 private:
  void require(std::uint64_t count) const;
  void readDirect(std::uint64_t position, void* out, std::uint64_t count);

  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t size_ = 0, position_ = 0;
  std::uint64_t bufferStart_ = 0;  // what small reads find in memory
  std::vector<char> buffer_;
};

}  // namespace welkin::io
