// SPDX-License-Identifier: Apache-2.0
// Writes what `welkin render` draws: one picture, numbered pictures or a video. Files appear complete or not
// at all.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "render_settings.h"
#include "welkin/core/image.h"
#include "welkin/scene/sky_state.h"

namespace welkin::app {

// Throws IoError, before anything is computed, when a file could not be created at `path`.
void checkWritable(const std::string& path);

// Writes the text of a report. Throws IoError.
void writeReport(const std::string& path, const std::string& json);

class PictureWriter {
 public:
  // Throws IoError for a video where ffmpeg is missing, UsageError for a pattern without a place for one
  // number.
  explicit PictureWriter(const RenderSettings& settings);
  ~PictureWriter();  // a video that was not finished is removed
  PictureWriter(const PictureWriter&) = delete;
  PictureWriter& operator=(const PictureWriter&) = delete;

  // luminance: cd/m2. Returns the path of the picture, empty for a frame of a video. Throws IoError.
  std::string write(std::int64_t frame, const Image<float>& luminance, double exposureEv,
                    const scene::SkyState& state);

  // Completes a video.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace welkin::app
