// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/thin_layer.h"

#include <algorithm>
#include <array>
#include <utility>

#include "welkin/scene/sheet_texture.h"
#include "welkin/shading/sheet_mesh.h"

namespace welkin::render {

namespace {

// Towards the horizon a pixel's footprint on a sheet is long and narrow.
constexpr float kAnisotropy = 8.0f;

}  // namespace

ThinLayer makeThinLayer(const scene::Sheet& sheet, std::uint64_t seed, double earthRadiusM) {
  constexpr gpu::TextureOptions kTiling{.format = gpu::Format::kR16F,
                                        .filter = gpu::Filter::kMipmap,
                                        .wrapX = gpu::Wrap::kRepeat,
                                        .wrapY = gpu::Wrap::kRepeat,
                                        .wrapZ = gpu::Wrap::kRepeat};
  ThinLayer layer;
  layer.sheet = sheet;
  const bool slopes = sheet.tier == scene::SheetTier::kEmbossed;
  gpu::TextureOptions options = kTiling;
  if (slopes) options.format = gpu::Format::kRgba16F;
  scene::PatternTexels pattern;
  if (sheet.pattern == scene::SheetPattern::kOctaves) {
    const int n = static_cast<int>(sheet.texels);
    layer.living.emplace(sheet, seed);
    layer.described = shading::matterOf(sheet, layer.living->pattern().samples(), seed);
    layer.flat = gpu::Texture2D(n, n, options);  // composed at every instant
  } else {
    pattern = scene::patternOf(sheet, seed);
    layer.described = shading::matterOf(sheet, pattern.values(), seed);
  }
  layer.matter = layer.described;
  if (scene::hasVolume(sheet.surface)) {
    layer.sheet.texels = pattern.volume.nx;
    layer.volume = gpu::Texture3D(slopes ? shading::withSlopes(pattern.volume) : pattern.volume, options);
    layer.volume.makeMipmaps();
  } else if (!layer.living) {
    layer.sheet.texels = pattern.flat.width;
    options.anisotropy = gpu::affordableAnisotropy(kAnisotropy);
    layer.flat = gpu::Texture2D(slopes ? shading::withSlopes(pattern.flat) : pattern.flat, options);
    layer.flat.makeMipmaps();
  }
  const shading::SheetMesh mesh = shading::meshOf(sheet, earthRadiusM);
  constexpr std::array<int, 2> kAttributes = {3, 1};
  layer.mesh = gpu::Mesh(mesh.vertices, kAttributes, mesh.indices);
  return layer;
}

std::vector<ThinLayer> makeThinLayers(const scene::Scene& scene, const weather::Weather& weather,
                                      double earthRadiusM) {
  std::vector<ThinLayer> layers;
  const std::vector<scene::Sheet> wanted = scene::sheetsOf(scene, weather);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    ThinLayer made = makeThinLayer(wanted[i], scene::sheetSeed(scene, i), earthRadiusM);
    const auto above = std::find_if(layers.begin(), layers.end(), [&](const ThinLayer& other) {
      return other.sheet.heightM > made.sheet.heightM;
    });
    layers.insert(above, std::move(made));
  }
  return layers;
}

}  // namespace welkin::render
