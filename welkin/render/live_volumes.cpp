// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/live_volumes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "welkin/field/cloud_field.h"
#include "welkin/render/jitter.h"
#include "welkin/render/programs.h"
#include "welkin/scene/rain_shafts.h"
#include "welkin/shading/sheet_mesh.h"

namespace welkin::render {
namespace {

// Neighbouring frames march pixels far apart in their blocks (B. E. Bayer 1973, "An Optimum Method for
// Two-Level Rendition of Continuous-Tone Pictures").
constexpr std::array<glm::ivec2, LiveVolumes::kFramesInRound> kOrder = {
    glm::ivec2{0, 0}, {2, 2}, {2, 0}, {0, 2}, {1, 1}, {3, 3}, {3, 1}, {1, 3},
    glm::ivec2{1, 0}, {3, 2}, {3, 0}, {1, 2}, {0, 1}, {2, 3}, {2, 1}, {0, 3}};

// The light volume is centred on points of a grid, so that an eye that moves a little needs no other one.
constexpr double kCentreGridM = 500.0;
// Where time or eye leap farther than this, the light volume is swept anew at once.
constexpr double kLeapS = 60.0, kLeapM = 3000.0;

// The share of a new sample while nothing moves, by rounds since: the mean weighs sample r like r^2, and
// after all rounds a thousandth of it is what was there before.
float stillWeight(int round) {
  return 3.0f / static_cast<float>(round + 6);
}

constexpr float kMostCount =
    1.0f;  // samples that a pixel in motion remembers: more would be resampled to a blur
constexpr float kSpread = 2.0f;  // of variance clipping, standard deviations

constexpr gpu::TextureOptions kColour{.format = gpu::Format::kRgba32F},
    kNumber{.format = gpu::Format::kR32F, .filter = gpu::Filter::kNearest};

bool sameView(const shading::ViewParts& a, const shading::ViewParts& b) {
  return a.eyeM == b.eyeM && a.enuFromCamera == b.enuFromCamera && a.clipFromEnu == b.clipFromEnu &&
         a.rayScale == b.rayScale;
}

}  // namespace

LiveVolumes::LiveVolumes()
    : air_(fullscreenProgram("pass/live_air.frag", shading::ShaderDefines{{"WELKIN_EACH_LAYER(CALL)", ""}})),
      spread_(fullscreenProgram("pass/live_spread.frag")),
      resolve_(fullscreenProgram("pass/live_resolve.frag")),
      show_(fullscreenProgram("pass/live_show.frag")) {}

void LiveVolumes::change(const scene::SkyState& state, const std::vector<ThinLayer>& sheets) {
  layout_ = shading::lightVolumeLayout(state);
  light_.reset();
  sweeping_.reset();
  for (auto& memory : memories_) memory.reset();
  const std::size_t count = sheets.size(), bands = layout_.bands.size();
  bandMoves_.assign(bands, glm::vec4(0.0f));
  bandSky_.assign(field::kMaxLayers, glm::vec4(1.0f));
  shapes_.resize(count), rays_.resize(count), skies_.resize(count), sunSteps_.resize(count);
  patternNames_.clear(), sheetNames_.clear(), inSky_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    patternNames_.push_back("uSheetPattern" + std::to_string(i));
    sheetNames_.push_back(sheetUniformNames("uSheets[" + std::to_string(i) + "]"));
    inSky_.push_back({sheets[i].sheet.heightM, &sheets[i].matter});
  }

  // The order of an eye above all clouds has that of every other eye in it: what lies behind the eye is not
  // met.
  constexpr double kAboveAll = 1e6;
  order_.clear();
  if (count == 0) {
    defines_ = shading::marchDefines(layout_, kAboveAll);
  } else {
    std::vector<shading::SheetOnRay> onRay;
    for (const ThinLayer& sheet : sheets) {
      shading::SheetLook look;
      look.heightM = static_cast<float>(sheet.sheet.heightM);
      onRay.push_back({sheet.sheet.surface,
                       sheet.sheet.tier,
                       look,
                       shading::shapeOf(sheet.sheet, state.clouds->earthRadiusM(), 0.0),
                       {},
                       1.0f});
    }
    defines_ = shading::sheetDefines(layout_, onRay, kAboveAll);
    order_ = shading::sheetUniforms(layout_, onRay, {}, kAboveAll);
  }
  shading::addPhaseDefines(state, defines_);
  marching_ = &marches_.with(defines_);
  const shading::MarchSettings settings = shading::marchSettings(state.scene.output.quality);
  reach_ = 1.0f / (3.0f * (layout_.bands.empty() ? 1e-4f : settings.noise));
  setScene(*marching_, state);
  setUniforms(air_, shading::lightVolumeUniforms(layout_));
  setUniforms(resolve_, shading::lightVolumeUniforms(layout_));
}

void LiveVolumes::setScene(gpu::Program& p, const scene::SkyState& state) const {
  setUniforms(p, order_);
  setUniforms(p, shading::cloudUniforms(state));
  setUniforms(p, shading::lightVolumeUniforms(layout_));
  setUniforms(p, shading::fluenceUniforms(shading::fluenceLayout(layout_)));
}

void LiveVolumes::update(const shading::Uniforms& skyUniforms) {
  setUniforms(*marching_, skyUniforms);
  setUniforms(air_, skyUniforms);
}

LiveVolumes::Memory LiveVolumes::makeMemory(int width, int height, std::size_t bands) {
  Memory m;
  const int w = (width + kBlock - 1) / kBlock, h = (height + kBlock - 1) / kBlock;
  m.fresh = gpu::Texture2D(w, h, kColour);
  m.freshDepth = gpu::Texture2D(w, h, kNumber);
  m.mean = gpu::Texture2D(w, h, kColour);
  m.spread = gpu::Texture2D(w, h, kColour);
  m.nearest = gpu::Texture2D(w, h, kNumber);
  m.airShadows = gpu::Texture2D(w, h, kColour);
  m.march.attach(0, m.fresh);
  m.march.attach(1, m.freshDepth);
  m.span.attach(0, m.mean);
  m.span.attach(1, m.spread);
  m.span.attach(2, m.nearest);
  m.air.attach(0, m.airShadows);
  for (std::size_t i = 0; i < 2; ++i) {
    m.history[i] = gpu::Texture2D(width, height, kColour);
    m.count[i] = gpu::Texture2D(width, height, kNumber);
    m.resolved[i].attach(0, m.history[i]);
    m.resolved[i].attach(1, m.count[i]);
  }
  m.driftM.resize(bands);
  return m;
}

glm::dvec2 LiveVolumes::driftOfBand(const scene::SkyState& state, std::size_t band) const {
  if (layout_.bands.empty()) return glm::dvec2(0.0);
  const auto layer = static_cast<std::size_t>(layout_.bands[band].layers.front());
  const std::size_t of = scene::layerOfField(state.scene, state.weather, layer).of;
  return scene::windDriftM(state.scene, state.weather.layers[of], state.secondsAfter);
}

glm::vec2 LiveVolumes::lightShiftM(const scene::SkyState& state, const shading::ViewParts& parts) const {
  return glm::vec2(glm::dvec2(parts.eyeM) - light_->centreM - (driftOfBand(state, 0) - light_->driftM));
}

LiveVolumes::Swept LiveVolumes::wantedLight(const scene::SkyState& state, const shading::ViewParts& parts) {
  shading::aimLightVolume(state, layout_);
  return {state.secondsAfter,    glm::round(glm::dvec2(parts.eyeM) / kCentreGridM) * kCentreGridM,
          driftOfBand(state, 0), state.litBySun,
          layout_.line,          layout_.towardsSun};
}

bool LiveVolumes::isOfAnotherTime(const Swept& wanted) const {
  return !light_ || light_->bySun != wanted.bySun || std::abs(light_->seconds - wanted.seconds) > kLeapS;
}

bool LiveVolumes::leaps(const Swept& wanted, glm::dvec2 eyeM) const {
  return isOfAnotherTime(wanted) || glm::distance(light_->centreM, eyeM) > kLeapM;
}

void LiveVolumes::needLight(const scene::SkyState& state, const CloudTextures& clouds,
                            const shading::ViewParts& parts) {
  if (leaps(wantedLight(state, parts), glm::dvec2(parts.eyeM))) keepLight(state, clouds, parts);
}

void LiveVolumes::keepLight(const scene::SkyState& state, const CloudTextures& clouds,
                            const shading::ViewParts& parts) {
  const Swept wanted = wantedLight(state, parts);
  const bool atOnce = leaps(wanted, glm::dvec2(parts.eyeM));
  if (atOnce) sweeping_.reset();
  if (!sweeping_) {
    if (light_ == wanted) return;
    shading::cloudLayerUniforms(state, wanted.centreM, layers_);
    lightVolume_.begin(layers_, layout_);
    sweeping_ = wanted;
  }
  constexpr int kParts = LightVolumePass::kParts;
  const int frames = kFramesOfSweep * layout_.columns / shading::LightVolumeLayout::kFewColumns;
  if (!lightVolume_.advance(atOnce ? kParts : kParts / frames, clouds) && lightVolume_.inProgress()) return;
  lightVolume_.makeNext();
  light_ = sweeping_;
  sweeping_.reset();
  ++lightNumber_;
}

void LiveVolumes::setLight(gpu::Program& p, const scene::SkyState& state,
                           const shading::ViewParts& parts) const {
  p.set("uLightShiftM", lightShiftM(state, parts));
  p.set("uLine", light_->line);
  p.set("uLineTowardsSun", light_->towardsSun ? 1.0f : 0.0f);
  p.bind("uLightVolume", lightVolume_.volume());
  p.bind("uFluence", lightVolume_.fluence());
  p.bind("uGroundShares", lightVolume_.groundShares());
}

void LiveVolumes::setSheets(gpu::Program& p, const scene::SkyState& state,
                            const std::vector<ThinLayer>& sheets, const shading::ViewParts& parts) {
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const ThinLayer& sheet = sheets[i];
    const shading::SheetLook look = shading::lookOf(sheet.sheet, sheet.matter, state.secondsAfter, parts.eyeM,
                                                    state.lights[0].direction, 1.0f);
    const shading::SheetShape shape =
        shading::shapeOf(sheet.sheet, state.clouds->earthRadiusM(), parts.eyeM.z);
    shapes_[i] = shape.shape;
    rays_[i] = {shape.innerM, look.texelsPerPixel, sheet.light.sun, sheet.sunThrough};
    skies_[i] = glm::vec4(sheet.light.sky, static_cast<float>(sheet.sheet.tier));
    sunSteps_[i] = glm::vec4(look.sunStep, 0.0f);
    setSheet(p, sheetNames_[i], look);
    p.bind(patternNames_[i], sheet.pattern());
  }
  for (std::size_t b = 0; b < layout_.bands.size(); ++b)
    bandSky_[b] = shading::lightShareUnder(
        state, inSky_, 0.5 * static_cast<double>(layout_.bands[b].baseM + layout_.bands[b].topM));
  p.set("uSheetShape", shapes_);
  p.set("uSheetRay", rays_);
  p.set("uSheetSky", skies_);
  p.set("uSheetSunStep", sunSteps_);
  p.set("uBandSky", bandSky_);
}

void LiveVolumes::setView(gpu::Program& p, const scene::SkyState& state, const std::vector<ThinLayer>& sheets,
                          const shading::ViewParts& parts) {
  shading::cloudLayerUniforms(state, glm::dvec2(parts.eyeM), layers_);
  setUniforms(p, layers_);
  setSheets(p, state, sheets, parts);
  setLight(p, state, parts);
  p.set("uEyeM", static_cast<float>(parts.eyeM.z));
  p.set("uEnuFromCamera", parts.enuFromCamera);
  p.set("uRayScale", parts.rayScale);
  p.set("uPixelRad", parts.pixelRad);
  shading::marchUniforms(shading::marchSettings(state.scene.output.quality, glm::vec2(parts.rayScale)),
                         march_);
  setUniforms(p, march_);
}

void LiveVolumes::setMarch(const Memory& m, const scene::SkyState& state,
                           const std::vector<ThinLayer>& sheets, const shading::ViewParts& parts, int width,
                           int height) {
  gpu::Program& p = *marching_;
  setView(p, state, sheets, parts);
  const int round = m.frame / kFramesInRound;
  const glm::ivec2 cell = kOrder[static_cast<std::size_t>(m.frame % kFramesInRound)];
  p.set("uSizePx", glm::vec2(width, height));
  p.set("uBlock", static_cast<float>(kBlock));
  // In motion a pixel is one sample, and half of a block's are of the last round: were each round's elsewhere
  // in the pixel, edges would be dotted.
  p.set("uCellPx", glm::vec2(cell) + 0.5f + (m.still ? jitterPx(round) : glm::vec2(0.0f)));
  p.set("uJitterStep", jitterStep(round));
}

void LiveVolumes::resolve(Memory& m, const scene::SkyState& state, const shading::ViewParts& parts,
                          bool still) {
  if (!still) {
    spread_.set("uDeviations", kSpread);
    spread_.bind("uFresh", m.fresh);
    spread_.bind("uFreshDepth", m.freshDepth);
    triangle_.draw(spread_, m.span);
  }
  gpu::Program& p = resolve_;
  for (std::size_t b = 0; b < bandMoves_.size(); ++b) {
    const glm::dvec2 driftM = driftOfBand(state, b);
    bandMoves_[b] = glm::vec4(glm::vec2(driftM - m.driftM[b]), 0.0f, 0.0f);
    m.driftM[b] = driftM;
  }
  p.set("uBandMoveM", bandMoves_);
  p.set("uBlock", kBlock);
  p.set("uCell", kOrder[static_cast<std::size_t>(m.frame % kFramesInRound)]);
  p.set("uHasHistory", m.any ? 1 : 0);
  p.set("uStill", still ? 1 : 0);
  p.set("uStillWeight", stillWeight(m.frame / kFramesInRound));
  p.set("uMostCount", kMostCount);
  p.set("uEnuFromCamera", parts.enuFromCamera);
  p.set("uRayScale", parts.rayScale);
  p.set("uLastClipFromEnu", m.parts.clipFromEnu);
  p.set("uEyeMoveM", glm::vec3(parts.eyeM - m.parts.eyeM));
  p.set("uEyeM", static_cast<float>(parts.eyeM.z));
  p.set("uEarthRadiusM", static_cast<float>(state.clouds->earthRadiusM()));
  p.bind("uFresh", m.fresh);
  p.bind("uMean", m.mean);
  p.bind("uSpread", m.spread);
  p.bind("uNearest", m.nearest);
  p.bind("uHistory", m.history[m.now]);
  p.bind("uCount", m.count[m.now]);
  m.now = 1 - m.now;
  triangle_.draw(p, m.resolved[m.now]);
}

void LiveVolumes::march(std::size_t view, const scene::SkyState& state, const std::vector<ThinLayer>& sheets,
                        const CloudTextures& clouds, const SkyTextures& tables,
                        const shading::ViewParts& parts, int width, int height) {
  if (view == 0 || isOfAnotherTime(wantedLight(state, parts))) keepLight(state, clouds, parts);
  if (memories_.size() <= view) memories_.resize(view + 1);
  std::unique_ptr<Memory>& place = memories_[view];
  if (!place || place->history[0].width() != width || place->history[0].height() != height)
    place = std::make_unique<Memory>(makeMemory(width, height, layout_.bands.size()));
  Memory& m = *place;
  const bool still =
      m.any && sameView(m.parts, parts) && m.seconds == state.secondsAfter && m.light == lightNumber_;
  // Rounds begin anew, so that what a still view converges to knows no past.
  if (still && !m.still) m.frame = 0;
  m.still = still;
  if (still && m.frame >= kRounds * kFramesInRound) return;
  setMarch(m, state, sheets, parts, width, height);
  clouds.bind(*marching_);
  tables.bind(*marching_);
  triangle_.draw(*marching_, m.march);
  resolve(m, state, parts, still);
  m.any = true;
  ++m.frame;
  m.parts = parts;
  m.seconds = state.secondsAfter;
  m.light = lightNumber_;
}

void LiveVolumes::shadeAir(std::size_t view, const scene::SkyState& state, const SkyTextures& tables,
                           const shading::ViewParts& parts) {
  const Memory& m = *memories_[view];
  gpu::Program& p = air_;
  setLight(p, state, parts);
  p.set("uEyeM", static_cast<float>(parts.eyeM.z));
  p.set("uEarthRadiusM", static_cast<float>(state.clouds->earthRadiusM()));
  p.set("uEnuFromCamera", parts.enuFromCamera);
  p.set("uRayScale", parts.rayScale);
  p.set("uPixelRad", parts.pixelRad);
  p.set("uSizePx", glm::vec2(m.history[0].width(), m.history[0].height()));
  p.set("uBlock", static_cast<float>(kBlock));
  tables.bind(p);
  triangle_.draw(p, m.air);
}

void LiveVolumes::setShadows(gpu::Program& p, std::size_t view, const scene::SkyState& state,
                             const shading::ViewParts& parts) const {
  setLight(p, state, parts);
  p.set("uAirShadowsPx", static_cast<float>(kBlock));
  p.bind("uAirShadows", memories_[view]->airShadows);
}

void LiveVolumes::show(std::size_t view, const gpu::Target& target, float scale) {
  const Memory& m = *memories_[view];
  show_.bind("uHistory", m.history[m.now]);
  show_.set("uOffsetPx", glm::ivec2(target.area.x, target.area.y));
  show_.set("uReach", reach_);
  show_.set("uScale", scale);
  triangle_.draw(show_, target, {.blend = gpu::Blend::kOver});
}

}  // namespace welkin::render
