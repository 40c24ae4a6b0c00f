// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/sky_film.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>

#include "welkin/core/colour.h"
#include "welkin/core/error.h"
#include "welkin/core/parallel.h"

namespace welkin::reference {
namespace {

constexpr std::array kNames = {"red", "green", "blue", "squares", "cloud"};
constexpr const char *kSamplesKey = "welkin_samples", *kEventsKey = "welkin_events";
// Of a thread: it ends with lanes that have nothing left to do, so many are better, but all threads should
// end at about the same time.
constexpr std::size_t kMostAtATime = 2048, kLeastAtATime = 128, kShares = 6;
constexpr double kDarkest = 0.01;  // of the mean of a picture, for relative errors

// The nearest that two floats hold.
double rounded(double x) {
  const auto high = static_cast<float>(x);
  return static_cast<double>(high) + static_cast<double>(static_cast<float>(x - static_cast<double>(high)));
}

std::uint64_t numberOf(const SkyFilm::State& state, const char* key) {
  const auto found = state.texts.find(key);
  std::uint64_t n = 0;
  if (found == state.texts.end() ||
      std::from_chars(found->second.data(), found->second.data() + found->second.size(), n).ec != std::errc())
    throw ParameterError(std::string("it has no number ") + key + "; expected what --resume has written");
  return n;
}

}  // namespace

SkyFilm::SkyFilm(int width, int height)
    : width_(width), height_(height), sums_(static_cast<std::size_t>(width) * height * kSums) {}

void SkyFilm::addPaths(const SkyTracer& tracer, std::int64_t count, const std::function<void()>& pause) {
  if (tracer.width() != width_ || tracer.height() != height_)
    throw ParameterError("the tracer's picture is " + std::to_string(tracer.width()) + "x" +
                         std::to_string(tracer.height()) + "; expected the film's size, " +
                         std::to_string(width_) + "x" + std::to_string(height_));
  if (count < 1) throw ParameterError(std::to_string(count) + " paths a pixel; expected at least 1");
  const std::size_t pixels = static_cast<std::size_t>(width_) * height_, n = static_cast<std::size_t>(count);
  std::vector<SkySample> samples(pixels * n);
  const std::size_t share = pixels * n / (kShares * static_cast<std::size_t>(threadCount()));
  const std::size_t grain = std::max<std::size_t>(std::clamp(share, kLeastAtATime, kMostAtATime) / n, 1);
  parallelFor(pixels, grain, [&](std::size_t begin, std::size_t end) {
    if (pause) pause();
    std::vector<PixelPath> paths;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < n; ++k)
        paths.push_back({static_cast<int>(i % static_cast<std::size_t>(width_)),
                         static_cast<int>(i / static_cast<std::size_t>(width_)),
                         static_cast<std::uint64_t>(samples_) + k});
    tracer.trace(paths, std::span(samples).subspan(begin * n, paths.size()));
  });
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const SkySample& s = samples[i];
    const double luminance = luminanceOf(&s.luminance.x);
    const double add[kSums] = {s.luminance.x, s.luminance.y, s.luminance.z, luminance * luminance,
                               s.cloud ? 1.0 : 0.0};
    for (int k = 0; k < kSums; ++k) sum(i / n, k) = rounded(sum(i / n, k) + add[k]);
    events_ += s.events;
  }
  samples_ += count;
}

Image<float> SkyFilm::luminance() const {
  Image<float> image(width_, height_, 3);
  const double n = std::max<double>(static_cast<double>(samples_), 1.0);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    image.data[i] = static_cast<float>(sum(i / 3, static_cast<int>(i % 3)) / n);
  return image;
}

Image<float> SkyFilm::opacity() const {
  Image<float> image(width_, height_, 1);
  const double n = std::max<double>(static_cast<double>(samples_), 1.0);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(sum(i, kCloud) / n);
  return image;
}

Image<float> SkyFilm::error() const {
  Image<float> image(width_, height_, 1);
  const auto n = static_cast<double>(samples_);
  if (samples_ < 2) return image;
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const std::array<double, 3> sums = {sum(i, kRed), sum(i, kGreen), sum(i, kBlue)};
    const double mean = luminanceOf(sums.data()) / n;
    image.data[i] =
        static_cast<float>(std::sqrt(std::max(sum(i, kSquares) / n - mean * mean, 0.0) / (n - 1.0)));
  }
  return image;
}

double SkyFilm::meanRelativeError() const {
  if (samples_ < 2) return std::numeric_limits<double>::infinity();
  const Image<float> errors = error(), picture = luminance();
  double mean = 0.0, relative = 0.0;
  const auto pixels = static_cast<double>(errors.data.size());
  auto at = [&](std::size_t i) { return static_cast<double>(luminanceOf(&picture.data[3 * i])); };
  for (std::size_t i = 0; i < errors.data.size(); ++i) mean += at(i) / pixels;
  if (mean <= 0.0) return 0.0;
  for (std::size_t i = 0; i < errors.data.size(); ++i)
    relative += static_cast<double>(errors.data[i]) / std::max(at(i), kDarkest * mean) / pixels;
  return relative;
}

SkyFilm::State SkyFilm::state() const {
  State s;
  s.width = width_;
  s.height = height_;
  const std::size_t pixels = static_cast<std::size_t>(width_) * height_;
  for (int k = 0; k < kSums; ++k) {
    const std::string name = kNames[static_cast<std::size_t>(k)];
    auto &high = s.planes["sum." + name], &low = s.planes["rest." + name];
    for (std::size_t i = 0; i < pixels; ++i) {
      const double x = sum(i, k);
      high.push_back(static_cast<float>(x));
      low.push_back(static_cast<float>(x - static_cast<double>(high.back())));
    }
  }
  s.texts[kSamplesKey] = std::to_string(samples_);
  s.texts[kEventsKey] = std::to_string(events_);
  return s;
}

SkyFilm SkyFilm::fromState(const State& s) {
  SkyFilm film(s.width, s.height);
  film.samples_ = static_cast<std::int64_t>(numberOf(s, kSamplesKey));
  film.events_ = numberOf(s, kEventsKey);
  const std::size_t pixels = static_cast<std::size_t>(s.width) * s.height;
  for (int k = 0; k < kSums; ++k) {
    const std::string name = kNames[static_cast<std::size_t>(k)];
    const auto high = s.planes.find("sum." + name), low = s.planes.find("rest." + name);
    if (high == s.planes.end() || low == s.planes.end() || high->second.size() != pixels ||
        low->second.size() != pixels)
      throw ParameterError("it has no channel sum." + name + "; expected what --resume has written");
    for (std::size_t i = 0; i < pixels; ++i)
      film.sum(i, k) = static_cast<double>(high->second[i]) + static_cast<double>(low->second[i]);
  }
  return film;
}

}  // namespace welkin::reference
