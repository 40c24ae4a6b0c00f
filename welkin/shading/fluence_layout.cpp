// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/fluence_layout.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace welkin::shading {
namespace {

using Bands = std::vector<LightVolumeLayout::Band>;

bool touches(const Bands& bands, std::size_t b) {
  return b + 1 < bands.size() && bands[b].topM == bands[b + 1].baseM;
}

// Above which bands there is a cell of air: where the next begins higher up. Of more than there is room for
// beside a cell for each band, the widest have one.
std::vector<bool> cellsOfAir(const Bands& bands) {
  std::vector<std::size_t> gaps;
  for (std::size_t b = 0; b + 1 < bands.size(); ++b)
    if (!touches(bands, b)) gaps.push_back(b);
  const auto wide = [&](std::size_t b) { return bands[b + 1].baseM - bands[b].topM; };
  std::ranges::sort(
      gaps, [&](std::size_t a, std::size_t b) { return wide(a) != wide(b) ? wide(a) > wide(b) : a < b; });
  constexpr std::size_t kMost = FluenceLayout::kMostCells;
  assert(bands.size() <= kMost);
  gaps.resize(std::min(gaps.size(), kMost - bands.size()));
  std::vector<bool> air(bands.size(), false);
  for (const std::size_t b : gaps) air[b] = true;
  return air;
}

}  // namespace

FluenceLayout fluenceLayout(const LightVolumeLayout& volume) {
  FluenceLayout layout;
  layout.columns = volume.columns / 2;
  const Bands& bands = volume.bands;
  const std::vector<bool> air = cellsOfAir(bands);
  int most = FluenceLayout::kMostCells - static_cast<int>(std::ranges::count(air, true)), spans = 0;
  for (const LightVolumeLayout::Band& band : bands) spans += band.lastSlice - band.firstSlice;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const auto& band = bands[b];
    const int own = band.lastSlice - band.firstSlice;
    // As many as it has spaces between slices, or its share of the most; something is left for those above.
    const int left = static_cast<int>(bands.size() - b) - 1;
    const int count = std::clamp(spans > 0 ? own * most / std::max(spans, own) : 1, 1,
                                 std::max(1, std::min(own, most - left)));
    most -= count;
    spans -= own;
    const auto first = static_cast<float>(layout.cells.size());
    const auto slice = [&](int edge) {
      return static_cast<float>(band.firstSlice) + static_cast<float>(own * edge) / static_cast<float>(count);
    };
    for (int i = 0; i < count; ++i)
      layout.cells.emplace_back(slice(i), slice(i + 1), (band.topM - band.baseM) / static_cast<float>(count),
                                0.0f);
    const float end = first + static_cast<float>(count);
    layout.bands.emplace_back(first, end, b > 0 && touches(bands, b - 1) ? first : first + 0.5f,
                              touches(bands, b) ? end : end - 0.5f);
    if (air[b])
      layout.cells.emplace_back(band.lastSlice, bands[b + 1].firstSlice, bands[b + 1].baseM - band.topM,
                                0.0f);
  }
  return layout;
}

Uniforms fluenceUniforms(const FluenceLayout& layout) {
  std::vector<glm::vec4> bands(field::kMaxLayers, glm::vec4(0.0f));
  std::ranges::copy(layout.bands, bands.begin());
  return {{"uFluenceCells", static_cast<float>(std::max<std::size_t>(layout.cells.size(), 1))},
          {"uFluenceBands", bands}};
}

}  // namespace welkin::shading
