// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/fluence_layout.h"

#include <algorithm>
#include <cstddef>

namespace welkin::shading {

FluenceLayout fluenceLayout(const LightVolumeLayout& volume) {
  FluenceLayout layout;
  layout.columns = volume.columns / 2;
  const auto& bands = volume.bands;
  const auto touches = [&](std::size_t b) {
    return b + 1 < bands.size() && bands[b].topM == bands[b + 1].baseM;
  };
  int most = FluenceLayout::kMostCells, spans = 0;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    spans += bands[b].lastSlice - bands[b].firstSlice;
    if (b + 1 < bands.size() && !touches(b)) --most;
  }
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
    layout.bands.emplace_back(first, end, b > 0 && touches(b - 1) ? first : first + 0.5f,
                              touches(b) ? end : end - 0.5f);
    if (b + 1 < bands.size() && !touches(b))
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
