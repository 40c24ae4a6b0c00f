// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/uniforms.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <string_view>

#include "welkin/core/glsl.h"
#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"
#include "welkin/optics/phase.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/projector.h"
#include "welkin/scene/rain_shafts.h"
#include "welkin/shading/far_decks.h"

namespace welkin::shading {
namespace {

namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/eclipse.glsl"
}  // namespace shared

// Extent of the table of the clouds' light: up to the highest tops, and some 250 km of the earth's curve.
constexpr float kKeyLightTopM = 18000.0f;
constexpr float kKeyLightReach = 0.04f;

std::string layerMember(std::size_t i, const char* member) {
  return "uLayers[" + std::to_string(i) + "]." + member;
}

// Fills a list anew in the memory of its last filling: names that were there before are not allocated again.
class Refill {
 public:
  explicit Refill(Uniforms& list) : list_(list) {}
  ~Refill() { list_.resize(count_); }
  Refill(const Refill&) = delete;
  Refill& operator=(const Refill&) = delete;

  void put(std::string_view owner, std::string_view member, const UniformValue& value) {
    if (count_ == list_.size()) list_.emplace_back();
    auto& [name, place] = list_[count_++];
    name.assign(owner).append(member);
    place = value;
  }

 private:
  Uniforms& list_;
  std::size_t count_ = 0;
};

constexpr const char* kColours[] = {".red", ".green", ".blue"};

void putMoments(Refill& u, std::string_view owner, const sky::LightMoments& light) {
  for (int c = 0; c < 3; ++c)
    u.put(owner, kColours[c],
          glm::vec4(light.total[c], light.along[0][c], light.along[1][c], light.along[2][c]) /
              static_cast<float>(2.0 * kPi));
}

void putAirLight(Refill& u, std::string_view owner, const scene::AirLight& light) {
  for (int c = 0; c < 3; ++c)
    u.put(owner, kColours[c],
          glm::vec4(light.mean[c], light.along[0][c], light.along[1][c], light.along[2][c]));
}

void putEye(Refill& u, const scene::EyeAir& air, double eyeM) {
  u.put("", "uEyeM", static_cast<float>(eyeM));
  u.put("", "uClearAir", air.clearAir);
  u.put("", "uAirUnderSheets", air.airUnderSheets);
  putAirLight(u, "uHaze", air.haze);
  putAirLight(u, "uCloudGlow", air.cloudGlow);
  u.put("", "uOverClouds", glm::vec4(air.overClouds, air.overCloudsM));
}

}  // namespace

Uniforms cloudUniforms(const scene::SkyState& state) {
  Uniforms u;
  const auto layers = state.clouds->layers();
  std::vector<float> ice(field::kMaxLayers, 0.0f), crystals = ice, rain = ice, cover = ice;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    field::forEachMember(layers[i],
                         [&](const char* name, auto value) { u.emplace_back(layerMember(i, name), value); });
    const std::size_t of = scene::layerOfField(state.scene, state.weather, i).of;
    const scene::CloudMatter matter = scene::matterInField(state.scene, state.weather, i);
    crystals[i] = matter == scene::CloudMatter::kIce ? 1.0f : 0.0f;
    ice[i] = scene::isFrozen(matter) ? 1.0f : 0.0f;
    rain[i] = matter == scene::CloudMatter::kRain ? 1.0f : 0.0f;
    cover[i] = static_cast<float>(state.weather.layers[of].oktas / kOktas);
  }
  u.emplace_back("uLayerIce", ice);
  u.emplace_back("uLayerCrystals", crystals);
  u.emplace_back("uLayerRain", rain);
  u.emplace_back("uLayerCover", cover);
  return u;
}

void cloudLayerUniforms(const scene::SkyState& state, glm::dvec2 eyeM, Uniforms& uniforms) {
  static constexpr const char* kOwners[] = {"uLayers[0].", "uLayers[1].", "uLayers[2].", "uLayers[3].",
                                            "uLayers[4].", "uLayers[5].", "uLayers[6].", "uLayers[7].",
                                            "uLayers[8].", "uLayers[9]."};
  static_assert(std::size(kOwners) == field::kMaxLayers);
  Refill u(uniforms);
  const auto layers = state.clouds->layers();
  for (std::size_t i = 0; i < layers.size(); ++i) {
    field::CloudLayer layer = layers[i];
    field::moveLayer(layer, -eyeM);
    field::forEachMember(layer, [&](const char* name, auto value) { u.put(kOwners[i], name, value); });
  }
}

float drawnSunRadius(const sky::Ephemeris& ephemeris) {
  const double radii =
      ephemeris.solarEclipse.obscuration > 0.0 ? static_cast<double>(shared::kCoronaEnd) : 1.0;
  return static_cast<float>(radii * ephemeris.sun.angularRadiusRad);
}

Uniforms skyUniforms(const scene::SkyState& state) {
  Uniforms u;
  skyUniforms(state, u);
  return u;
}

void skyUniforms(const scene::SkyState& state, Uniforms& uniforms) {
  Refill u(uniforms);
  const scene::Scene& s = state.scene;
  sky::visitFields(state.atmosphere->uniforms(),
                   [&](const char* name, auto value) { u.put("uAtmosphere.", name, value); });
  u.put("", "uEarthRadiusM", static_cast<float>(state.clouds->earthRadiusM()));
  u.put("", "uGroundAltitudeM", static_cast<float>(s.place.altitudeM));
  u.put("", "uKeyDirection", state.lights[0].direction);
  u.put("", "uKeyCounts", state.keyCounts);
  u.put("", "uKeyShown", state.keyShown);
  u.put("", "uKeyLightTopM", kKeyLightTopM);
  u.put("", "uKeyLightReach", kKeyLightReach);
  u.put("", "uSkyOnGround", state.ambient.skyOnGround);
  u.put("", "uGroundLight", state.ambient.ground);
  putMoments(u, "uAboveLight[0]", state.ambient.above);
  putMoments(u, "uAboveLight[1]", state.ambient.aboveLow);
  putMoments(u, "uAboveLight[2]", state.ambient.aboveHigh);
  putMoments(u, "uBelowLight[0]", state.ambient.below);
  putMoments(u, "uBelowLight[1]", state.ambient.belowHigh);
  putEye(u, state.ambient.air, s.camera.eyeM);
  u.put("", "uGroundAlbedo", glm::vec3(scene::groundAlbedo(s, state.weather)));

  const optics::DropletPhase droplets =
      optics::dropletPhase(static_cast<float>(scene::dropletDiameterUm(state.weather)));
  u.put("", "uDroplets.gHg", droplets.gHg);
  u.put("", "uDroplets.gDraine", droplets.gDraine);
  u.put("", "uDroplets.alpha", droplets.alpha);
  u.put("", "uDroplets.wDraine", droplets.wDraine);

  // Discs: illuminance spread over the disc's solid angle. The moon's is that which the drawn phase dims to
  // the mean.
  const sky::Ephemeris& e = state.ephemeris;
  const sky::Light sun = sky::sunLight(e), moon = sky::moonLight(e);
  auto discLuminance = [](const glm::vec3& illuminance, double radius, double share) {
    return illuminance / static_cast<float>(kPi * radius * radius * share);
  };
  u.put("", "uDiscs", s.output.sunDisc ? 1.0f : 0.0f);
  u.put("", "uCelestialFromEnu", glm::mat3(glm::transpose(e.enuFromCelestial)));
  u.put("", "uSunDirection", sun.direction);
  u.put("", "uSunRadius", static_cast<float>(e.sun.angularRadiusRad));
  u.put("", "uSunLuminance", discLuminance(sun.fullIlluminance(), e.sun.angularRadiusRad, 1.0));
  u.put("", "uMoonDirection", moon.direction);
  u.put("", "uMoonRadius", static_cast<float>(e.moon.angularRadiusRad));
  u.put(
      "", "uMoonLuminance",
      discLuminance(sky::fullMoonlight(e), e.moon.angularRadiusRad, sky::moonDiscMean(e.moonPhaseAngleRad)));
  u.put("", "uSunHidden", shared::sunHidden(e.solarEclipse.shadow.share));
  u.put("", "uEarthShadow", glm::vec4(e.lunarEclipse.at, e.lunarEclipse.moonRadius));
  u.put("", "uEarthOverSun", e.lunarEclipse.earthRadius);
  u.put("", "uMoonShare", e.lunarEclipse.share);
}

void eyeUniforms(const scene::EyeAir& air, double eyeM, Uniforms& uniforms) {
  Refill u(uniforms);
  putEye(u, air, eyeM);
}

void lightTable(const scene::SkyState& state, const sky::Light& light, Image<float>& table) {
  constexpr int kHeights = 64, kSines = 16;
  if (table.data.empty()) table = Image<float>(kHeights, kSines, 3);
  const FarDecks decks(state);
  const bool towards = decks.lineTowards(light.direction.z);
  for (int y = 0; y < kSines; ++y)
    for (int x = 0; x < kHeights; ++x) {
      const double height = kKeyLightTopM * (x + 0.5) / kHeights;
      const double sine = light.direction.z + kKeyLightReach * (2.0 * (y + 0.5) / kSines - 1.0);
      glm::vec3 arriving = light.illuminance *
                           state.atmosphere->transmittanceToSpace(state.scene.place.altitudeM + height, sine);
      if (decks.any()) arriving *= static_cast<float>(decks.through(height, sine, towards));
      for (int c = 0; c < 3; ++c) table.at(x, y, c) = arriving[c];
    }
}

MarchSettings marchSettings(scene::Quality quality) {
  switch (quality) {
    case scene::Quality::kLow:
      return {.subframes = 3,
              .tolerance = 0.02f,
              .noise = 0.04f,
              .stepNearM = 55.0f,
              .stepShare = 0.015f,
              .maxSteps = 160,
              .sunSamples = 2};
    case scene::Quality::kMedium:
      return {.subframes = 4,
              .tolerance = 0.02f,
              .noise = 0.04f,
              .stepNearM = 42.0f,
              .stepShare = 0.0115f,
              .maxSteps = 240,
              .sunSamples = 3};
    case scene::Quality::kHigh:
      return {.subframes = 16,
              .tolerance = 0.005f,
              .noise = 0.01f,
              .stepNearM = 30.0f,
              .stepShare = 0.008f,
              .maxSteps = 400,
              .sunSamples = 3};
    case scene::Quality::kUltra:
      break;
  }
  return {.subframes = 64,
          .tolerance = 0.002f,
          .noise = 0.004f,
          .stepNearM = 20.0f,
          .stepShare = 0.005f,
          .maxSteps = 800,
          .sunSamples = 5};
}

MarchSettings marchSettings(scene::Quality quality, glm::vec2 halfTan) {
  constexpr float kWideTan = 0.5774f;  // of 30 degrees
  constexpr float kFinest = 0.1f;
  MarchSettings settings = marchSettings(quality);
  const float share =
      std::clamp(std::max(std::abs(halfTan.x), std::abs(halfTan.y)) / kWideTan, kFinest, 1.0f);
  settings.stepShare *= share;
  settings.stepLong /= share;
  settings.maxSteps = static_cast<int>(static_cast<float>(settings.maxSteps) / share);
  settings.surfaceHalvings += static_cast<int>(std::ceil(-std::log2(share)));
  settings.cascadesBlended = share < 1.0f;
  return settings;
}

Uniforms marchUniforms(const MarchSettings& settings) {
  Uniforms u;
  marchUniforms(settings, u);
  return u;
}

void marchUniforms(const MarchSettings& settings, Uniforms& uniforms) {
  Refill u(uniforms);
  u.put("", "uStepNearM", settings.stepNearM);
  u.put("", "uStepShare", settings.stepShare);
  u.put("", "uStepLong", settings.stepLong);
  u.put("", "uMaxSteps", settings.maxSteps);
  u.put("", "uSunSamples", settings.sunSamples);
  u.put("", "uSurfaceHalvings", settings.surfaceHalvings);
}

Uniforms projectorUniforms(const scene::SkyState& state) {
  const scene::Projector p = scene::projectorOf(state);
  return {{"uProjector.kind", p.kind},
          {"uProjector.sizePx", p.sizePx},
          {"uProjector.halfWidthTan", p.halfWidthTan},
          {"uProjector.enuFromCamera", p.enuFromCamera}};
}

LightVolumeLayout lightVolumeLayout(const scene::SkyState& state, std::optional<glm::vec2> ballsM) {
  constexpr float kSpacingM = 70.0f;
  constexpr int kFewest = 5, kMost = 24;
  constexpr float kThinnestM = 50.0f;
  constexpr std::size_t kMostBands = field::kMaxLayers;  // the length of the uniform array
  LightVolumeLayout layout;
  if (state.scene.output.quality >= scene::Quality::kHigh) layout.columns = LightVolumeLayout::kManyColumns;
  const auto layers = state.clouds->layers();
  // A band is a range of heights with the same layers all through: cut at every base and top, so that the
  // foot of a cumulonimbus costs nothing further up.
  std::vector<float> cuts;
  std::vector<std::size_t> volumes;  // the others are drawn as sheets or metaballs
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (!scene::isVolumeInField(state.scene, state.weather, i)) continue;
    volumes.push_back(i);
    cuts.insert(cuts.end(), {layers[i].baseM, layers[i].topM});
  }
  if (ballsM) cuts.insert(cuts.end(), {ballsM->x, ballsM->y});
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
    LightVolumeLayout::Band band{cuts[c], cuts[c + 1], 0, 0, {}};
    band.balls = ballsM && ballsM->x <= band.baseM && ballsM->y >= band.topM;
    band.shafts = !band.balls;
    for (const std::size_t i : volumes) {
      if (layers[i].baseM > band.baseM || layers[i].topM < band.topM) continue;
      band.layers.push_back(static_cast<int>(i));
      band.shafts &= scene::layerOfField(state.scene, state.weather, i).isShaft;
    }
    if ((band.layers.empty() && !band.balls) || band.topM <= band.baseM) continue;
    // Too thin to be worth a band of its own, or no more of them to be had: to the one beneath.
    const bool touches = !layout.bands.empty() && layout.bands.back().topM == band.baseM;
    if ((touches && band.topM - band.baseM < kThinnestM) || layout.bands.size() == kMostBands) {
      layout.bands.back().topM = band.topM;
      layout.bands.back().balls |= band.balls;
      layout.bands.back().shafts &= band.shafts;
      for (const int i : band.layers)
        if (std::ranges::find(layout.bands.back().layers, i) == layout.bands.back().layers.end())
          layout.bands.back().layers.push_back(i);
    } else {
      layout.bands.push_back(band);
    }
  }
  for (auto& band : layout.bands) {
    const int n = std::clamp(static_cast<int>((band.topM - band.baseM) / kSpacingM), kFewest, kMost);
    band.firstSlice = static_cast<int>(layout.heightsM.size());
    band.lastSlice = band.firstSlice + n - 1;
    for (int k = 0; k < n; ++k)
      layout.heightsM.push_back(band.baseM +
                                (band.topM - band.baseM) * static_cast<float>(k) / static_cast<float>(n - 1));
  }
  aimLightVolume(state, layout);
  return layout;
}

void aimLightVolume(const scene::SkyState& state, LightVolumeLayout& layout) {
  const glm::vec3 d = state.lights[0].direction;
  layout.towardsSun = FarDecks(state).lineTowards(d.z);
  glm::vec3 line = layout.towardsSun ? d : -d;
  line.z = std::max(line.z, static_cast<float>(kLeastElevation));
  layout.line = glm::normalize(line);
  layout.sunOverSky = state.ambient.sunOverSky;
  layout.broken = 1.0f - state.ambient.cover * state.ambient.cover;
  layout.spreadM = std::clamp(0.6f * state.ambient.cloudsM, 800.0f, 5000.0f);
}

Uniforms lightVolumeUniforms(const LightVolumeLayout& layout) {
  Uniforms u;
  u.emplace_back("uBandCount", static_cast<int>(layout.bands.size()));
  u.emplace_back("uSliceCount", static_cast<float>(std::max<std::size_t>(layout.heightsM.size(), 1)));
  u.emplace_back("uLine", layout.line);
  u.emplace_back("uLineTowardsSun", layout.towardsSun ? 1.0f : 0.0f);
  u.emplace_back("uCloudTopM", layout.bands.empty() ? 0.0f : layout.bands.back().topM);
  std::vector<glm::vec4> bands(field::kMaxLayers, glm::vec4(1e9f, 2e9f, 0.0f, 0.0f));
  for (std::size_t i = 0; i < layout.bands.size(); ++i) {
    const auto& b = layout.bands[i];
    bands[i] = {b.baseM, b.topM, static_cast<float>(b.firstSlice), static_cast<float>(b.lastSlice)};
  }
  u.emplace_back("uBands", bands);
  u.emplace_back("uCascadeHalfM", std::vector<float>(layout.kHalfM.begin(), layout.kHalfM.end()));
  return u;
}

// "CALL(0, 0) CALL(1, 0)": layer and band of each layer in the band.
std::string layerCalls(const LightVolumeLayout& layout, int band) {
  std::string calls;
  for (const int layer : layout.bands[static_cast<std::size_t>(band)].layers)
    calls += "CALL(" + std::to_string(layer) + ", " + std::to_string(band) + ") ";
  return calls;
}

void addBandDefines(const LightVolumeLayout& layout, ShaderDefines& defines) {
  const auto add = [&](const char* name, bool LightVolumeLayout::Band::* holds) {
    std::string bands;
    for (std::size_t b = 0; b < layout.bands.size(); ++b)
      if (layout.bands[b].*holds) bands += (bands.empty() ? "band == " : " || band == ") + std::to_string(b);
    if (!bands.empty()) defines.emplace_back(name, "(" + bands + ")");
  };
  add("WELKIN_BALLS(band)", &LightVolumeLayout::Band::balls);
  add("WELKIN_SHAFTS(band)", &LightVolumeLayout::Band::shafts);
}

ShaderDefines marchDefines(const LightVolumeLayout& layout, double eyeM) {
  std::string layers, down, up;
  for (int b = 0; b < static_cast<int>(layout.bands.size()); ++b) {
    const std::string call = "CALL(" + std::to_string(b) + ") ";
    layers += layerCalls(layout, b);
    up += call;
    if (eyeM > layout.bands[static_cast<std::size_t>(b)].baseM) down = call + down;
  }
  ShaderDefines defines{{"WELKIN_EACH_LAYER(CALL)", layers},
                        {"WELKIN_EACH_BAND_DOWN(CALL)", down},
                        {"WELKIN_EACH_BAND_UP(CALL)", up},
                        {"WELKIN_BANDS", std::to_string(layout.bands.size())}};
  addBandDefines(layout, defines);
  return defines;
}

void addPhaseDefines(const scene::SkyState& state, ShaderDefines& defines) {
  if (state.scene.droplets == optics::DropletModel::kMie) defines.emplace_back("WELKIN_MIE", "1");
  if (scene::hasIce(state.scene, state.weather)) defines.emplace_back("WELKIN_HALOS", "1");
  if (scene::hasRain(state.scene, state.weather)) defines.emplace_back("WELKIN_RAIN", "1");
}

ShaderDefines bandDefines(const LightVolumeLayout& layout, int band) {
  ShaderDefines defines{{"WELKIN_BAND", std::to_string(band)},
                        {"WELKIN_EACH_LAYER(CALL)", layerCalls(layout, band)}};
  if (layout.bands[static_cast<std::size_t>(band)].balls) defines.emplace_back("WELKIN_BALLS(band)", "true");
  return defines;
}

}  // namespace welkin::shading
