// SPDX-License-Identifier: Apache-2.0
// Textures and volumes of noise, or of cloud condensed from it: what the thesis's NoiseGenerator and its tool
// "Make Some Noise" made (G. Tarantilis 2004), from any of the noises of noise/noise.h.
//
// A texel is made in three steps, each of which may be absent: noise, lifted to [0, 1]; a tone curve; the law
// of condensation, whose cover is met exactly by looking at all of this texture's noise. Without the last two
// the texel is the noise's own value.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string_view>

#include "welkin/core/params.h"
#include "welkin/field/condensation.h"
#include "welkin/noise/noise.h"

namespace welkin::field {

struct TextureParams {
  noise::NoiseParams noise = {};
  ToneCurve curve = {};
  CondensationParams cloud = {};

  bool isPlain() const { return curve == ToneCurve{} && !cloud.condenses(); }
};
void describe(TextureParams& p, ParamVisitor& v);

// The thesis's own clouds: three layers of its demonstration, 1024 x 1024, and the volume of its dome,
// 128 x 128 x 128, which is noise for a shader to condense: its cutoff and exponent are the shader's.
enum class ThesisTexture { kOvercast, kBroken, kFew, kDome };
TextureParams thesisParams(ThesisTexture which);
glm::ivec3 thesisSize(ThesisTexture which);

class NoiseTexture {
 public:
  // size: texels; z is 1 for two dimensions. Throws ParameterError.
  NoiseTexture(const TextureParams& params, glm::ivec3 size);

  // 1; more for Perlin-Worley (4) and curl (as many as dimensions), which do not condense.
  int channels() const { return noise_.channels(); }

  // Where a cover is asked for: looks at all of the noise, twice, and sets the threshold that makes the
  // wanted fraction of texels at least `visible` opaque (see withCover). Without a cover does nothing.
  // progress: as cloudMap()'s.
  void meetCover(double visible, const std::function<void(double)>& progress = {});

  // The law in use; a cover has its threshold after meetCover().
  const Condensation& law() const { return law_; }

  // The next rows or slices, whichever the outermost axis is: `count` of them from `first` on, channels
  // interleaved, x fastest. The same for any number of threads and any way of cutting.
  void fill(int first, int count, std::span<float> out) const;
  int layers() const { return size_.z > 1 ? size_.z : size_.y; }  // rows or slices
  std::size_t layerValues() const;                                // floats of one of them

  // How many layers fit well into one call of fill() that should not take much memory.
  int layersAtOnce() const;

 private:
  void fillNoise(int first, int count, std::span<float> out) const;

  TextureParams params_;
  glm::ivec3 size_;
  noise::Noise noise_;
  Condensation law_;
};

}  // namespace welkin::field

namespace welkin {
template <>
inline constexpr auto kEnumNames<field::ThesisTexture> =
    std::to_array<std::string_view>({"thesis-overcast", "thesis-broken", "thesis-few", "thesis-dome"});
}  // namespace welkin
