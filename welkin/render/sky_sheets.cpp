// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_sheets.h"

#include <cstddef>
#include <string>

#include "welkin/field/cloud_field.h"
#include "welkin/render/programs.h"
#include "welkin/shading/sheet_ambient.h"
#include "welkin/shading/sheet_look.h"
#include "welkin/shading/sheet_mesh.h"

namespace welkin::render {

std::vector<shading::SheetInSky> SkySheets::inSky() const {
  std::vector<shading::SheetInSky> sheets;
  sheets.reserve(layers_.size());
  for (const ThinLayer& layer : layers_) sheets.push_back({layer.sheet.heightM, &layer.matter});
  return sheets;
}

void SkySheets::update(const scene::SkyState& state) {
  const double earthRadiusM = state.clouds->earthRadiusM();
  if (!scene_ || *scene_ != state.scene) {
    layers_ = makeThinLayers(state.scene, state.weather, earthRadiusM);
    scene_ = state.scene;
  }
  for (ThinLayer& layer : layers_) {
    layer.matter = shading::matterAt(layer.sheet, layer.described, state.secondsAfter);
    if (!layer.living) continue;
    if (!octaves_) octaves_.emplace();
    octaves_->compose(*layer.living, state.secondsAfter, layer.flat);
  }
  onRay_.clear();
  if (layers_.empty()) return;
  const shading::LightUnderSheets light = shading::lightUnder(state, inSky(), shading::volumesIn(state));
  ambient_ = light.ambient;
  const double eyeM = state.scene.camera.eyeM;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const ThinLayer& layer = layers_[i];
    onRay_.push_back({layer.sheet.surface, layer.sheet.tier,
                      shading::lookOf(layer.sheet, layer.matter, state.secondsAfter, {0.0, 0.0, eyeM},
                                      state.lights[0].direction, 1.0f),
                      shading::shapeOf(layer.sheet, earthRadiusM, eyeM), light.sheets[i],
                      light.sunThrough[i]});
  }
}

shading::ShaderDefines SkySheets::defines(const shading::LightVolumeLayout& layout, double eyeM) const {
  return shading::sheetDefines(layout, onRay_, eyeM);
}

void SkySheets::set(gpu::Program& program, const scene::SkyState& state,
                    const shading::LightVolumeLayout& layout) const {
  std::vector<glm::vec4> bandSky;
  bandSky.reserve(layout.bands.size());
  for (const auto& band : layout.bands)
    bandSky.push_back(
        shading::lightShareUnder(state, inSky(), 0.5 * static_cast<double>(band.baseM + band.topM)));
  setUniforms(program, shading::sheetUniforms(layout, onRay_, bandSky, state.scene.camera.eyeM));
  for (std::size_t i = 0; i < onRay_.size(); ++i)
    setSheet(program, sheetUniformNames("uSheets[" + std::to_string(i) + "]"), onRay_[i].look);
}

void SkySheets::bind(gpu::Program& program) const {
  for (std::size_t i = 0; i < layers_.size(); ++i)
    program.bind("uSheetPattern" + std::to_string(i), layers_[i].pattern());
}

}  // namespace welkin::render
