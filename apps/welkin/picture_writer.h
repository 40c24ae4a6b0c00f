// SPDX-License-Identifier: Apache-2.0
// Writes what `welkin render` draws: one picture, numbered pictures or a video. Files appear complete or not
// at all.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "render_settings.h"
#include "welkin/core/image.h"
#include "welkin/io/frame_path.h"
#include "welkin/io/video.h"
#include "welkin/scene/sky_state.h"

namespace welkin::app {

// Throws IoError when a file could not be created at `path`; leaves nothing behind.
void checkWritable(const std::string& path);

class PictureWriter {
 public:
  // Meant to be made before anything is computed. Throws IoError where nothing can be written or ffmpeg is
  // missing, UsageError for a name or a size that the kind of file does not take.
  explicit PictureWriter(const RenderSettings& settings);

  // luminance: cd/m2. Returns the path of the picture, empty for a frame of a video. Throws IoError.
  std::string write(std::int64_t frame, const Image<float>& luminance, double exposureEv,
                    const scene::SkyState& state);

  // Completes a video; without it none appears.
  void finish();

 private:
  const RenderSettings& settings_;
  std::optional<io::FramePattern> pattern_;
  std::optional<io::VideoWriter> video_;
};

}  // namespace welkin::app
