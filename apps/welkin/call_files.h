// SPDX-License-Identifier: Apache-2.0
// Which files one call of the program reads and writes, so that none is written over another.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "welkin/io/frame_path.h"

namespace welkin::app {

// Files are compared, not spellings: "a.png" and "./a.png" are one. What is no ordinary file, such as
// /dev/null, takes anything. Tell what is read first.
class CallFiles {
 public:
  void reads(const std::string& path);
  // `flag` stands in messages. Throws UsageError where the file is read, or written already.
  void writes(const std::string& flag, const std::string& path);
  // The same of numbered pictures, from 0 on. They come last.
  void writesFrames(const std::string& flag, const io::FramePattern& pattern, std::int64_t count);

  // The same of texels: a RAW file has two (io/raw.h).
  void readsTexels(const std::string& path);
  void writesTexels(const std::string& flag, const std::string& path);

 private:
  struct Known {
    std::string file, flag;  // no flag: it is read
  };
  void check(const std::string& flag, const std::string& path, const std::string& file) const;

  std::vector<Known> known_;
};

}  // namespace welkin::app
