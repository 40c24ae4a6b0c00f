// SPDX-License-Identifier: Apache-2.0
// What paths have brought to a traced picture so far: its mean, how well it is known, and all that it takes
// to go on as if nothing had happened.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "welkin/core/image.h"
#include "welkin/reference/sky_tracer.h"

namespace welkin::reference {

class SkyFilm {
 public:
  SkyFilm(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  std::int64_t samples() const { return samples_; }  // of every pixel
  std::uint64_t events() const { return events_; }   // of all samples

  // So many more paths for every pixel, by parallelFor; the same on any number of threads, and by however
  // many calls. pause: called now and then from several threads; where it throws, the film is as it was.
  // Throws ParameterError for a tracer of another size and for less than one path.
  void addPaths(const SkyTracer& tracer, std::int64_t count, const std::function<void()>& pause = {});

  Image<float> luminance() const;  // RGB, cd/m2
  Image<float> opacity() const;    // 1 channel: of the clouds, seen straight from the eye
  Image<float> error() const;      // 1 channel: standard error of the luminance, cd/m2; 0 below 2 samples
  // Mean over the picture of standard error over luminance, with luminances taken to be at least a hundredth
  // of the picture's mean. Infinite below 2 samples.
  double meanRelativeError() const;

  // As planes of floats by name and texts by key, for a file (docs/file_formats.md): exactly what there is.
  struct State {
    int width = 0, height = 0;
    std::map<std::string, std::vector<float>> planes;
    std::map<std::string, std::string> texts;
  };
  State state() const;
  // Throws ParameterError for what is no such state.
  static SkyFilm fromState(const State& state);

 private:
  enum { kRed, kGreen, kBlue, kSquares, kCloud, kSums };  // kSquares: of the luminance
  double& sum(std::size_t pixel, int which) { return sums_[pixel * kSums + static_cast<std::size_t>(which)]; }
  double sum(std::size_t pixel, int which) const {
    return sums_[pixel * kSums + static_cast<std::size_t>(which)];
  }

  int width_, height_;
  std::int64_t samples_ = 0;
  std::uint64_t events_ = 0;
  std::vector<double> sums_;  // each is kept to what two floats hold
};

}  // namespace welkin::reference
