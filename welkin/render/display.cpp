// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/display.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "welkin/core/colour.h"
#include "welkin/core/parallel.h"

namespace welkin::render {
namespace {

// Luminance that exposure EV at ISO 100 renders as 1 (ISO 12232, saturation-based: 78 / 65 * 2^EV, S. Lagarde
// and C. de Rousiers 2014, "Moving Frostbite to PBR", 5.1.2).
double whiteLuminance(double ev) {
  return 1.2 * std::exp2(ev);
}
double evOfWhite(double luminance) {
  return std::log2(luminance / 1.2);
}

// Steeper than life about the middle, as films and cameras are, so that the sunlit and the shaded side of a
// cloud, half as bright, stand apart on a screen; then a shoulder that reaches 1 at infinity with continuous
// slope, so that clouds keep their modelling up to the sun.
constexpr float kSaturation = 1.15f;
constexpr float kContrast = 1.3f;
constexpr float kMiddle = 0.27f;  // what stays as bright as it is: a clear sky beside bright clouds
constexpr float kKnee = 0.5f;
float toneCurve(float x) {
  const float steep = kMiddle * std::pow(x / kMiddle, kContrast);
  if (steep <= kKnee) return steep;
  return kKnee + (1.0f - kKnee) * (1.0f - std::exp(-(steep - kKnee) / (1.0f - kKnee)));
}

// What has no place in a picture becomes black (not a number, below 0) or plain white (without bound).
float inRange(float x) {
  return x > 0.0f ? std::min(x, 1e6f) : 0.0f;
}

// IEC 61966-2-1.
float encode(float x) {
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

// What is rendered as white: direct sunlight with the light of the sky at noon, about 5400 K, the daylight
// setting of cameras. The primaries' own white (D65) is bluer, and sunlit clouds would look cream.
const float kWhiteBalance[3] = {1.0f / 1.12f, 1.0f, 1.0f / 0.90f};

// What rods see: scotopic luminance from X, Y and Z (G. W. Larson, H. Rushmeier and C. Piatko 1997, "A
// Visibility Matching Tone Reproduction Operator for High Dynamic Range Scenes"), in the blue-grey of moonlit
// nights that H. W. Jensen et al. 2000, "Night Rendering", measured in paintings (x = y = 0.25). `rgb` is
// linear Rec. 709.
void towardsNightVision(float* rgb, float share) {
  const float x = 0.4124f * rgb[0] + 0.3576f * rgb[1] + 0.1805f * rgb[2];
  const float y = luminanceOf(rgb);
  const float z = 0.0193f * rgb[0] + 0.1192f * rgb[1] + 0.9505f * rgb[2];
  const float scotopic = std::max(0.4f * y * (1.33f * (1.0f + (y + z) / std::max(x, 1e-12f)) - 1.68f), 0.0f);
  constexpr float kBlueGrey[3] = {0.77f, 0.97f, 1.76f};  // of luminance 1 at x = y = 0.25
  for (int c = 0; c < 3; ++c) rgb[c] += share * (scotopic * kBlueGrey[c] - rgb[c]);
}

// How much of it: none from 3 cd/m2 up, three quarters below 0.003.
float nightShare(double exposureEv) {
  const double adaptation = 0.1 * whiteLuminance(exposureEv);
  return static_cast<float>(0.75 * std::clamp((std::log10(3.0) - std::log10(adaptation)) / 3.0, 0.0, 1.0));
}

// The least keys of automaticExposureEv().
constexpr double kMoonlitKey = 0.2, kMoonlessKey = 0.14;

}  // namespace

double automaticExposureEv(const Image<float>& luminance) {
  // Percentiles from a sample of at most some ten thousand pixels on a regular grid: the same for any thread
  // count.
  std::vector<float> values;
  const int step = std::max(
      1, static_cast<int>(std::sqrt(static_cast<double>(luminance.width) * luminance.height / 16384.0)));
  for (int y = step / 2; y < luminance.height; y += step)
    for (int x = step / 2; x < luminance.width; x += step) {
      const float l = luminanceOf(&luminance.data[luminance.index(x, y)]);
      if (l > 0.0f && std::isfinite(l)) values.push_back(l);  // 0: outside the image circle
    }
  if (values.empty()) return 15.0;
  // The brighter six tenths: a picture of the sky is exposed for the sky, however much dark ground is in it.
  std::sort(values.begin(), values.end());
  const std::size_t first = values.size() * 4 / 10;
  double logSum = 0.0;
  for (std::size_t i = first; i < values.size(); ++i) logSum += std::log(values[i]);
  const double mean = std::exp(logSum / static_cast<double>(values.size() - first));
  // How bright the mean is to look: G. Krawczyk, K. Myszkowski and H.-P. Seidel 2005, "Perceptual Effects in
  // Real-time Tone Mapping", eq. 11; dim scenes stay dim. By the full moon's light no darker than is still to
  // be read on a screen, and without a moon a little darker than that.
  const double moonless = std::clamp(0.5 * std::log10(0.02 / mean), 0.0, 1.0);
  const double key =
      std::max(1.03 - 2.0 / (2.0 + std::log10(mean + 1.0)), std::lerp(kMoonlitKey, kMoonlessKey, moonless));
  const double evMean = evOfWhite(mean / (0.56 * key));
  // Bright clouds must keep their modelling: the brightest twentieth may not pass twice white.
  const double evBright = evOfWhite(values[values.size() * 95 / 100] / (2.4 * key + 0.1));
  return std::max(evMean, evBright);
}

Image<float> toDisplay(const Image<float>& luminance, double exposureEv) {
  Image<float> out(luminance.width, luminance.height, 3);
  const float scale = static_cast<float>(1.0 / whiteLuminance(exposureEv));
  const float night = nightShare(exposureEv);
  parallelFor(luminance.height, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < luminance.width; ++x) {
        const float* in = &luminance.data[luminance.index(x, static_cast<int>(y))];
        float* o = &out.data[out.index(x, static_cast<int>(y))];
        float rgb[3];
        for (int c = 0; c < 3; ++c) rgb[c] = inRange(in[c] * scale * kWhiteBalance[c]);
        if (night > 0.0f) towardsNightVision(rgb, night);
        // Colour is spread a little about the luminance, as every camera does: three primaries see skies
        // paler than an eye.
        const float grey = luminanceOf(rgb);
        for (float& v : rgb) v = std::max(grey + kSaturation * (v - grey), 0.0f);
        // Half way between a curve on each channel (light things turn white) and one on the brightest (hues
        // stay).
        const float peak = std::max({rgb[0], rgb[1], rgb[2], 1e-9f});
        const float keep = toneCurve(peak) / peak;
        for (int c = 0; c < 3; ++c)
          o[c] = encode(std::clamp(0.5f * (rgb[c] * keep + toneCurve(rgb[c])), 0.0f, 1.0f));
      }
  });
  return out;
}

}  // namespace welkin::render
