// SPDX-License-Identifier: Apache-2.0
// A file that appears complete or not at all: written beside its place under a hidden name, renamed at the
// end.
//
// The temporary file lies in the same folder, ".name.<process>-<number>.tmp", so that the rename cannot fail
// half-way. Whatever stood at the path before stays until commit() and is then replaced in one step; a
// symbolic link is followed. A path that is no ordinary file (/dev/null, a pipe) is written to directly, and
// so is a file that is open already (/dev/stdout, /dev/fd/3): from where it stands.
//
// An exception, Interrupted among them, unwinds the destructor, which removes the temporary file. A program
// that wants to end inside a signal handler calls removeUnfinishedFiles() there. POSIX. Not thread-safe;
// different files may be written from different threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace welkin::io {

class AtomicFile {
 public:
  // Throws IoError with the path and the reason if nothing can be written there.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();  // without commit(): removes what was written
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Throw IoError when the disk is full or fails.
  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  std::uint64_t position() const { return position_; }
  void seek(std::uint64_t position);  // from the start; what lies between is zero

  // Flushes, closes and renames. Throws IoError, after which the destructor still cleans up.
  void commit();

  const std::filesystem::path& path() const { return path_; }  // as it was asked for
  // Where the bytes are until commit(), for other programs to write to.
  const std::filesystem::path& temporaryPath() const { return temporary_; }

 private:
  void flush();
  void writeThrough(const char* bytes, std::size_t count);
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_, final_, temporary_;
  bool direct_ = false;  // no ordinary file: nothing to rename or remove
  int file_ = -1;
  int slot_ = -1;                            // in the registry of unfinished files
  std::uint64_t position_ = 0, origin_ = 0;  // origin_: where the file stood, if it was open already
  std::string buffer_;
};

// Writes a whole text in one step.
void writeTextFile(const std::filesystem::path& path, std::string_view text);

// Removes the temporary files of all AtomicFile objects that are alive. Safe in a signal handler; the process
// should end after it.
void removeUnfinishedFiles() noexcept;

}  // namespace welkin::io
