// SPDX-License-Identifier: Apache-2.0
#include "call_files.h"

#include <sys/stat.h>

#include <filesystem>
#include <initializer_list>
#include <system_error>

#include "usage_error.h"
#include "welkin/io/file_extension.h"
#include "welkin/io/raw.h"

namespace welkin::app {
namespace {

namespace fs = std::filesystem;

// The same text for the same file, however it is spelt; empty for what is no ordinary file.
std::string identityOf(const fs::path& path) {
  struct stat status{};
  if (stat(path.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode)) return {};
    return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
  }
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  const fs::path canonical = fs::weakly_canonical(absolute, error);
  return (error ? absolute : canonical).string();
}

std::vector<fs::path> texelFiles(const fs::path& path) {
  const std::string extension = io::lowerExtension(path);
  if (extension != ".raw" && !(extension == ".json" && io::lowerExtension(path.stem()) == ".raw"))
    return {path};
  return {io::rawTexelPath(path), io::rawSidePath(path)};
}

}  // namespace

void CallFiles::reads(const std::string& path) {
  if (const std::string file = identityOf(path); !file.empty()) known_.push_back({file, {}});
}

void CallFiles::check(const std::string& flag, const std::string& path, const std::string& file) const {
  for (const Known& known : known_)
    if (known.file == file)
      throw UsageError(flag + ": " + path +
                       (known.flag.empty()   ? " is read"
                        : known.flag == flag ? " is written already"
                                             : " is written already, by " + known.flag) +
                       "; expected another name");
}

void CallFiles::writes(const std::string& flag, const std::string& path) {
  const std::string file = identityOf(path);
  if (file.empty()) return;
  check(flag, path, file);
  known_.push_back({file, flag});
}

void CallFiles::writesFrames(const std::string& flag, const io::FramePattern& pattern, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i)
    if (const std::string path = pattern.path(i), file = identityOf(path); !file.empty())
      check(flag, path, file);
}

void CallFiles::readsTexels(const std::string& path) {
  for (const fs::path& file : texelFiles(path)) reads(file.string());
}

void CallFiles::writesTexels(const std::string& flag, const std::string& path) {
  for (const fs::path& file : texelFiles(path)) writes(flag, file.string());
}

}  // namespace welkin::app
