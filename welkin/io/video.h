// SPDX-License-Identifier: Apache-2.0
// Video through the program ffmpeg, which must be on the PATH: MP4 (H.264) and WebM (VP9) from sRGB pictures.
//
// Frames go to ffmpeg as they come, so nothing is kept in memory; the file appears under its name only when
// close() has succeeded. The number of encoder threads is fixed, so the same frames give the same bytes
// whatever the machine's number of cores (for one version of ffmpeg). Colours are converted and tagged as
// BT.709.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "welkin/core/error.h"
#include "welkin/core/image.h"

namespace welkin::io {

enum class VideoFormat { kMp4, kWebm };

// True if the extension is that of a video, in upper or lower case.
bool isVideoPath(const std::filesystem::path& path);
// Throws ParameterError that names the known extensions.
VideoFormat videoFormatOf(const std::filesystem::path& path);

struct VideoSettings {
  int width = 1280, height = 720;  // pixels, even: both formats store colour at half resolution
  double fps = 30.0;               // frames a second, (0, 1000]
};

class VideoWriter {
 public:
  // Starts ffmpeg. Throws ParameterError for odd sizes, impossible rates and unknown extensions; IoError if
  // the file cannot be written or ffmpeg cannot be started.
  VideoWriter(const std::filesystem::path& path, const VideoSettings& settings);
  ~VideoWriter();  // without close(): stops ffmpeg and removes what it wrote
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  // 3 channels, of the size in the settings. Throws IoError with ffmpeg's last words if it has given up.
  void write(const Image<std::uint8_t>& frame);

  // Waits for ffmpeg to finish and puts the file in its place. Throws IoError, also for a video without
  // frames.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace welkin::io
