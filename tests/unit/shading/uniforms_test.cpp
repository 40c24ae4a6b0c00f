// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/uniforms.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <set>
#include <string>
#include <variant>

#include "tests/testing/skies.h"
#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"
#include "welkin/scene/cloud_shapes.h"

namespace welkin::shading {
namespace {

using testing::clearScene;
using testing::cloudyScene;
using weather::Genus;

const scene::SkyState& cloudyState() {
  static const scene::SkyState state =
      scene::buildSky(cloudyScene(40.0, {Genus::kCumulus, Genus::kCirrus}), 0.0);
  return state;
}

template <class T>
T valueOf(const Uniforms& uniforms, const std::string& name) {
  for (const auto& [n, value] : uniforms)
    if (n == name) return std::get<T>(value);
  ADD_FAILURE() << "no uniform " << name;
  return T{};
}

Uniforms all(const scene::SkyState& state) {
  Uniforms u = cloudUniforms(state);
  for (const Uniforms& more : {skyUniforms(state), marchUniforms(marchSettings(state.scene.output.quality)),
                               projectorUniforms(state), lightVolumeUniforms(lightVolumeLayout(state))})
    u.insert(u.end(), more.begin(), more.end());
  return u;
}

struct Finite {
  bool operator()(int) const { return true; }
  bool operator()(float v) const { return std::isfinite(v); }
  template <class V>
  bool operator()(const V& v) const {
    if constexpr (std::is_same_v<V, glm::mat3>) {
      return (*this)(v[0]) && (*this)(v[1]) && (*this)(v[2]);
    } else if constexpr (requires { v.size(); }) {
      for (const auto& x : v)
        if (!(*this)(x)) return false;
      return true;
    } else {
      for (int i = 0; i < v.length(); ++i)
        if (!std::isfinite(v[i])) return false;
      return true;
    }
  }
};

TEST(Uniforms, EachHasOneNameAndAFiniteValue) {
  for (const double sun : {60.0, 0.0, -30.0})
    for (const bool cloudy : {false, true}) {
      scene::Scene s = cloudyState().scene;
      s.time = clearScene(sun).time;
      const scene::SkyState state =
          cloudy ? scene::buildSky(s, 0.0, &cloudyState()) : scene::buildSky(clearScene(sun), 0.0);
      std::set<std::string> names;
      for (const auto& [name, value] : all(state)) {
        EXPECT_TRUE(names.insert(name).second) << name << " twice";
        EXPECT_TRUE(std::visit(Finite{}, value)) << name << ", sun at " << sun;
      }
    }
}

TEST(Uniforms, EveryMemberOfEveryLayerIsSet) {
  const Uniforms u = cloudUniforms(cloudyState());
  const auto layers = cloudyState().clouds->layers();
  ASSERT_EQ(layers.size(), 2u);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::string prefix = "uLayers[" + std::to_string(i) + "].";
    field::forEachMember(layers[i], [&](const char* name, auto value) {
      EXPECT_EQ(valueOf<decltype(value)>(u, prefix + name), value) << prefix << name;
    });
  }
  const auto ice = valueOf<std::vector<float>>(u, "uLayerIce");
  ASSERT_EQ(ice.size(), static_cast<std::size_t>(field::kMaxLayers));
  EXPECT_EQ(ice[0], 0.0f);
  EXPECT_EQ(ice[1], 1.0f);
}

// What a disc sends is its luminance times its solid angle.
TEST(Uniforms, DiscsHoldTheirIlluminance) {
  const Uniforms u = skyUniforms(cloudyState());
  const sky::Ephemeris& e = cloudyState().ephemeris;
  const float radius = valueOf<float>(u, "uSunRadius");
  EXPECT_NEAR(degrees(radius), 0.265, 0.01);
  const glm::vec3 sent = valueOf<glm::vec3>(u, "uSunLuminance") * static_cast<float>(kPi) * radius * radius;
  EXPECT_NEAR(glm::dot(sent, glm::vec3(0.2126f, 0.7152f, 0.0722f)) / e.sunIlluminanceLux, 1.0, 1e-4);
  EXPECT_EQ(valueOf<float>(u, "uDiscs"), 1.0f);
  scene::SkyState without = cloudyState();
  without.scene.output.sunDisc = false;
  EXPECT_EQ(valueOf<float>(skyUniforms(without), "uDiscs"), 0.0f);
}

TEST(Uniforms, CameraFramesAreRightHandedAndUpright) {
  scene::SkyState state = cloudyState();
  for (const scene::Projection projection :
       {scene::Projection::kPerspective, scene::Projection::kFisheye, scene::Projection::kEquirect})
    for (const double heading : {0.0, 75.0, 300.0})
      for (const double pitch : {-90.0, -20.0, 0.0, 50.0, 90.0}) {
        state.scene.camera.projection = projection;
        state.scene.camera.pitchDeg = pitch;
        state.headingDeg = heading;
        const auto m = valueOf<glm::mat3>(projectorUniforms(state), "uProjector.enuFromCamera");
        EXPECT_NEAR(glm::determinant(m), 1.0f, 1e-5f);
        EXPECT_NEAR(m[0].z, 0.0f, 1e-6f);  // the horizon is level
        EXPECT_GE(m[2].z, -1e-6f);         // and up is up
        if (projection != scene::Projection::kPerspective) {
          EXPECT_NEAR(m[2].z, 1.0f, 1e-6f);
        }
      }
}

TEST(Uniforms, LightVolumeLinesAlwaysGoUp) {
  scene::SkyState state = cloudyState();
  for (const double elevation : {-89.0, -10.0, -0.1, 0.0, 0.1, 1.0, 45.0, 90.0}) {
    const double e = radians(elevation);
    state.lights[0].direction = {static_cast<float>(std::cos(e)), 0.0f, static_cast<float>(std::sin(e))};
    const LightVolumeLayout layout = lightVolumeLayout(state);
    EXPECT_NEAR(glm::length(layout.line), 1.0f, 1e-6f) << elevation;
    EXPECT_GT(layout.line.z, 0.03f) << elevation;
    EXPECT_TRUE(layout.towardsSun) << elevation;  // of half a sky of clouds none is lit from below
    EXPECT_GT(glm::dot(layout.line, {state.lights[0].direction.x, 0.0f, 1.0f}), 0.0f) << elevation;
    if (elevation > 3.0) {
      EXPECT_NEAR(glm::dot(layout.line, state.lights[0].direction), 1.0f, 1e-5f) << elevation;
    }
  }
}

// Bands are where there are layers: apart, ascending, and filled with slices from base to top.
TEST(Uniforms, LightVolumeBandsCoverTheLayers) {
  const LightVolumeLayout layout = lightVolumeLayout(cloudyState());
  ASSERT_EQ(layout.bands.size(), 2u);
  int next = 0;
  float top = 0.0f;
  for (const LightVolumeLayout::Band& band : layout.bands) {
    EXPECT_GT(band.baseM, top);
    EXPECT_EQ(band.firstSlice, next);
    EXPECT_GT(band.lastSlice, band.firstSlice);
    EXPECT_EQ(layout.heightsM[static_cast<std::size_t>(band.firstSlice)], band.baseM);
    EXPECT_NEAR(layout.heightsM[static_cast<std::size_t>(band.lastSlice)], band.topM, 1e-3f * band.topM);
    next = band.lastSlice + 1;
    top = band.topM;
  }
  EXPECT_EQ(layout.heightsM.size(), static_cast<std::size_t>(next));

  const scene::SkyState overlapping =
      scene::buildSky(cloudyScene(40.0, {Genus::kCumulus, Genus::kStratocumulus}), 0.0);
  const auto layers = overlapping.clouds->layers();
  const LightVolumeLayout cut = lightVolumeLayout(overlapping);
  // Where two layers overlap, a band ends wherever one of them begins or ends.
  EXPECT_GE(cut.bands.size(), 2u);
  for (const LightVolumeLayout::Band& band : cut.bands)
    for (int i = 0; i < static_cast<int>(layers.size()); ++i) {
      const field::CloudLayer& layer = layers[static_cast<std::size_t>(i)];
      const bool listed = std::ranges::find(band.layers, i) != band.layers.end();
      EXPECT_EQ(listed, layer.baseM <= band.baseM && layer.topM >= band.topM);
    }
  EXPECT_TRUE(lightVolumeLayout(scene::buildSky(clearScene(40.0), 0.0)).heightsM.empty());
}

TEST(Uniforms, RainHasABandBeneathItsCloud) {
  scene::Scene storm = cloudyScene(40.0, {Genus::kCirrus, Genus::kCumulonimbus});
  const auto at = std::ranges::find(storm.layers, Genus::kCumulonimbus, &weather::Layer::genus);
  at->rainMmPerH = 25.0;
  const scene::SkyState state = scene::buildSky(storm, 0.0);
  const LightVolumeLayout layout = lightVolumeLayout(state);
  EXPECT_EQ(layout.bands.front().layers, std::vector<int>{2});
  EXPECT_EQ(layout.bands.front().baseM, 0.0f);
  EXPECT_EQ(layout.bands.front().topM, static_cast<float>(at->baseM));
  const Uniforms uniforms = cloudUniforms(state);
  EXPECT_EQ(valueOf<std::vector<float>>(uniforms, "uLayerIce")[2], 0.0f);
  EXPECT_EQ(valueOf<std::vector<float>>(uniforms, "uLayerCover")[2], static_cast<float>(at->oktas / 8.0));
}

TEST(Uniforms, HalosAreCompiledInForIceAlone) {
  const auto halos = [](const scene::SkyState& state) {
    ShaderDefines defines;
    addPhaseDefines(state, defines);
    return std::ranges::count(defines, "WELKIN_HALOS", &ShaderDefines::value_type::first);
  };
  scene::Scene snow = cloudyScene(40.0, {Genus::kCirrostratus, Genus::kCumulonimbus});
  const auto at = std::ranges::find(snow.layers, Genus::kCumulonimbus, &weather::Layer::genus);
  at->rainMmPerH = 5.0;
  scene::SkyState state = scene::buildSky(snow, 0.0);
  state.weather.precipitation = weather::PrecipitationKind::kSnow;
  EXPECT_EQ(halos(state), 1);
  const Uniforms uniforms = cloudUniforms(state);
  const auto crystals = valueOf<std::vector<float>>(uniforms, "uLayerCrystals");
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(crystals[i], state.weather.layers[i].genus == Genus::kCirrostratus ? 1.0f : 0.0f);
  EXPECT_EQ(crystals[2], 0.0f);  // flakes
  EXPECT_EQ(valueOf<std::vector<float>>(uniforms, "uLayerIce")[2], 1.0f);
  EXPECT_EQ(halos(scene::buildSky(cloudyScene(40.0, {Genus::kCumulonimbus, Genus::kAltostratus}), 0.0)), 0);
  EXPECT_EQ(halos(scene::buildSky(clearScene(40.0), 0.0)), 0);
}

TEST(Uniforms, NarrowViewsTakeFinerSteps) {
  for (const scene::Quality quality : {scene::Quality::kLow, scene::Quality::kUltra}) {
    const MarchSettings any = marchSettings(quality), wide = marchSettings(quality, {0.3f, 0.58f}),
                        narrow = marchSettings(quality, {0.2f, 0.1f}),
                        narrowest = marchSettings(quality, {0.01f, 0.01f});
    EXPECT_EQ(marchUniforms(any), marchUniforms(wide));
    EXPECT_FALSE(wide.cascadesBlended);
    EXPECT_TRUE(narrow.cascadesBlended);
    EXPECT_LT(narrow.stepShare, any.stepShare);
    EXPECT_LT(narrowest.stepShare, narrow.stepShare);
    EXPECT_GT(narrowest.stepShare, 0.05f * any.stepShare);
    EXPECT_GT(narrow.surfaceHalvings, any.surfaceHalvings);
    // As far as before.
    EXPECT_NEAR(narrow.stepShare * static_cast<float>(narrow.maxSteps),
                any.stepShare * static_cast<float>(any.maxSteps), 0.01f);
  }
}

TEST(Uniforms, BetterQualityTakesFinerSteps) {
  const scene::Quality order[] = {scene::Quality::kLow, scene::Quality::kMedium, scene::Quality::kHigh,
                                  scene::Quality::kUltra};
  for (int i = 1; i < 4; ++i) {
    const MarchSettings worse = marchSettings(order[i - 1]), better = marchSettings(order[i]);
    EXPECT_GT(better.subframes, worse.subframes);
    EXPECT_LT(better.stepShare, worse.stepShare);
    EXPECT_LE(better.stepNearM, worse.stepNearM);
    EXPECT_GE(better.maxSteps, worse.maxSteps);
    EXPECT_GE(better.sunSamples, worse.sunSamples);
  }
}

}  // namespace
}  // namespace welkin::shading
