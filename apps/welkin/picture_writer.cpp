// SPDX-License-Identifier: Apache-2.0
#include "picture_writer.h"

#include "report.h"
#include "usage_error.h"
#include "welkin/io/atomic_file.h"
#include "welkin/io/quantise.h"
#include "welkin/io/write_image.h"
#include "welkin/render/display.h"

namespace welkin::app {

void checkWritable(const std::string& path) {
  const io::AtomicFile probe(path);
}

PictureWriter::PictureWriter(const RenderSettings& settings) : settings_(settings) {
  const scene::Output& o = settings.scene.output;
  try {
    if (settings.video) {
      video_.emplace(settings.out,
                     io::VideoSettings{static_cast<int>(o.width), static_cast<int>(o.height), o.fps});
      return;
    }
    if (settings.numbered) pattern_.emplace(settings.out);
  } catch (const ParameterError& e) {
    throw UsageError(e.what());
  }
  checkWritable(pattern_ ? pattern_->path(0) : settings.out);
}

std::string PictureWriter::write(std::int64_t frame, const Image<float>& luminance, double exposureEv,
                                 const scene::SkyState& state) {
  if (video_) {
    video_->write(io::quantise8(render::toDisplay(luminance, exposureEv)));
    return {};
  }
  const std::string path = pattern_ ? pattern_->path(frame) : settings_.out;
  const io::WriteOptions options{settings_.pngBits, pictureMetadata(state, exposureEv, settings_.format)};
  if (io::holdsLuminance(settings_.format))
    io::writeImage(path, luminance, options);
  else
    io::writeImage(path, render::toDisplay(luminance, exposureEv), options);
  return path;
}

void PictureWriter::finish() {
  if (video_) video_->close();
}

}  // namespace welkin::app
