// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/noise_texture.h"

#include <algorithm>
#include <cassert>
#include <string>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/field/quantile.h"

namespace welkin::field {
namespace {

constexpr std::size_t kValuesAtOnce = std::size_t{1} << 22;  // 16 MiB of floats
constexpr std::size_t kGrain = std::size_t{1} << 16;

noise::NoiseParams thesisNoise(int dimensions, int octaves, double frequency, double amplitude,
                               double persistence) {
  noise::NoiseParams n;
  n.dimensions = dimensions;
  n.octaves = octaves;
  n.frequency = glm::dvec3(frequency);
  n.amplitude = amplitude;
  n.persistence = persistence;
  n.normalisation = noise::Normalisation::kThesis;
  return n;
}

}  // namespace

void describe(TextureParams& p, ParamVisitor& v) {
  describe(p.noise, v);
  v.group({"cloud", "", "noise that condenses to cloud"}, p.cloud);
  v.group({"curve", "", "what happens to the noise before"}, p.curve);
}

// Tarantilis 2004: CloudPlane(octaves, cutoff, frequency, amplitude, persistence, density, size, height) in
// its chapter on cloud planes, CloudDome(octaves, frequency, amplitude, persistence, cutoff, exponent,
// radius, segments) in that on the dome. The dome's texture is the bare noise: the shader cuts it off as it
// draws.
TextureParams thesisParams(ThesisTexture which) {
  TextureParams p;
  switch (which) {
    case ThesisTexture::kOvercast:
      p.noise = thesisNoise(2, 10, 3, 0.5, 0.7);
      p.cloud = {.cutoff = 0.6, .density = 0.95};
      break;
    case ThesisTexture::kBroken:
      p.noise = thesisNoise(2, 10, 6, 1.0, 0.4);
      p.cloud = {.cutoff = 0.7, .density = 0.96};
      break;
    case ThesisTexture::kFew:
      p.noise = thesisNoise(2, 8, 16, 0.8, 0.4);
      p.cloud = {.cutoff = 0.8, .density = 0.96};
      break;
    case ThesisTexture::kDome:
      p.noise = thesisNoise(3, 6, 2, 0.7, 0.5);
      break;
  }
  return p;
}

glm::ivec3 thesisSize(ThesisTexture which) {
  return which == ThesisTexture::kDome ? glm::ivec3(128) : glm::ivec3(1024, 1024, 1);
}

NoiseTexture::NoiseTexture(const TextureParams& params, glm::ivec3 size)
    : params_(params), size_(size), noise_(params.noise), law_(lawOf(params.cloud)) {
  assert(size.x >= 1 && size.y >= 1 && size.z >= 1);
  validate(params.cloud);
  validate(params.curve);
  if (channels() > 1 && !params.isPlain())
    throw ParameterError(
        "noise of several channels does not condense and takes no curve; expected another kind");
  if (params.noise.dimensions == 2 && size.z > 1)
    throw ParameterError("a volume needs noise of 3 dimensions; it has 2");
}

std::size_t NoiseTexture::layerValues() const {
  const std::size_t row = static_cast<std::size_t>(size_.x) * channels();
  return size_.z > 1 ? row * size_.y : row;
}

int NoiseTexture::layersAtOnce() const {
  return static_cast<int>(std::clamp<std::size_t>(kValuesAtOnce / layerValues(), 1, layers()));
}

void NoiseTexture::fillNoise(int first, int count, std::span<float> out) const {
  assert(out.size() == layerValues() * static_cast<std::size_t>(count));
  noise::Box box{glm::ivec3(0), size_};
  const int axis = size_.z > 1 ? 2 : 1;
  box.first[axis] = first;
  box.size[axis] = count;
  noise_.fill(noise::Grid::tile(size_), box, out);
  if (params_.isPlain()) return;
  const noise::Lift lift = noise::liftOf(params_.noise);
  // A cover is met among values beyond 0 and 1, too: cut off, they would be equal.
  const bool cut = !params_.cloud.cover || !(params_.curve == ToneCurve{});
  parallelFor(out.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    const std::span<float> part = out.subspan(begin, end - begin);
    for (float& v : part) v = lift.scale * v + lift.bias;
    if (cut) params_.curve.apply(part);
  });
}

void NoiseTexture::meetCover(double visible, const std::function<void(double)>& progress) {
  if (!params_.cloud.cover) return;
  SampleQuantile quantile(*params_.cloud.cover);
  std::vector<float> some(layerValues() * static_cast<std::size_t>(layersAtOnce()));
  for (int pass = 0; pass < 2; ++pass) {
    for (int done = 0; done < layers(); done += layersAtOnce()) {
      if (progress) progress(0.5 * (pass + static_cast<double>(done) / layers()));
      const int count = std::min(layersAtOnce(), layers() - done);
      const std::span<float> part = std::span(some).first(layerValues() * static_cast<std::size_t>(count));
      fillNoise(done, count, part);
      quantile.add(part);
    }
    if (pass == 0) quantile.nextPass();
  }
  law_ = withCover(law_, quantile.threshold(), visible);
}

void NoiseTexture::fill(int first, int count, std::span<float> out) const {
  fillNoise(first, count, out);
  if (!params_.cloud.condenses()) return;
  parallelFor(out.size(), kGrain,
              [&](std::size_t begin, std::size_t end) { law_.apply(out.subspan(begin, end - begin)); });
}

}  // namespace welkin::field
