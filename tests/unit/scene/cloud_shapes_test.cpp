// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/cloud_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "welkin/core/random.h"
#include "welkin/field/cloud_field.h"
#include "welkin/scene/cloud_cover.h"
#include "welkin/scene/sky_state.h"

namespace welkin::scene {
namespace {

using weather::Genus;

weather::Layer layerOf(Genus genus, double depthM, double oktas) {
  weather::Layer layer = weather::typicalLayer(genus, 45.0);
  layer.topM = layer.baseM + depthM;
  layer.oktas = oktas;
  return layer;
}

// Clouds of one layer, its cover measured and set, seen at heights that are shares of its depth. Places move
// with the shear, so that what stands on one another has one place.
class Shape {
 public:
  Shape(Genus genus, double depthM, double oktas)
      : noise_(field::makeCloudNoise(1)), clouds_(made(layerOf(genus, depthM, oktas))) {}

  bool at(int x, int y, double height) const { return at(place(x, y), height); }
  bool at(glm::vec2 placeM, double height) const { return extinction(placeM, height) > 0.0f; }
  // Of places, those that have cloud.
  double share(double height) const {
    int n = 0;
    for (int y = 0; y < kPlaces; ++y)
      for (int x = 0; x < kPlaces; ++x) n += at(x, y, height);
    return n / static_cast<double>(kPlaces * kPlaces);
  }
  // Of places with cloud at one height, those that have cloud at the other.
  double carried(double height, double other) const {
    int n = 0, both = 0;
    for (int y = 0; y < kPlaces; ++y)
      for (int x = 0; x < kPlaces; ++x)
        if (at(x, y, height)) ++n, both += at(x, y, other);
    return both / static_cast<double>(n);
  }

  // Mean length of what lines meet of cloud, m: level ones half way up, and upright ones.
  double levelM() const {
    constexpr int kSteps = 2000;
    constexpr float kStepM = 25.0f;
    int clouds = 0, n = 0;
    for (int y = 0; y < 40; ++y) {
      bool before = false;
      for (int x = 0; x < kSteps; ++x) {
        const bool here = at(
            glm::vec2(kStepM * (static_cast<float>(x) - 0.5f * kSteps), 977.0f * static_cast<float>(y)), 0.5);
        n += here, clouds += here && !before;
        before = here;
      }
    }
    return static_cast<double>(kStepM) * n / clouds;
  }
  double uprightM() const {
    const double depthM = clouds_.layers()[0].topM - clouds_.layers()[0].baseM;
    constexpr int kSteps = 50;
    int clouds = 0, n = 0;
    for (int y = 0; y < kPlaces; ++y)
      for (int x = 0; x < kPlaces; ++x) {
        bool before = false;
        for (int i = 0; i < kSteps; ++i) {
          const bool here = at(x, y, (i + 0.5) / kSteps);
          n += here, clouds += here && !before;
          before = here;
        }
      }
    return depthM / kSteps * n / clouds;
  }

  // Extinction of the densest of places, 1/m.
  double densest(double height) const {
    float most = 0.0f;
    for (int y = 0; y < kPlaces; ++y)
      for (int x = 0; x < kPlaces; ++x) most = std::max(most, extinction(place(x, y), height));
    return static_cast<double>(most);
  }
  // By how much cells are stretched and squeezed where they are pushed about (cloudPlacement() in
  // shaders/lib/clouds.glsl): the root mean square of the change of the push from place to place.
  double strain() const {
    const field::CloudLayer& l = clouds_.layers()[0];
    const Image<float>& map = noise_->placement;
    double sum = 0.0;
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x + 1 < map.width; ++x)
        for (const int c : {0, 1}) {
          const double change = static_cast<double>(map.at(x + 1, y, c) - map.at(x, y, c));
          sum += change * change / (2.0 * (map.width - 1) * map.height);
        }
    return static_cast<double>(l.warpM / l.patchM) * map.width * std::sqrt(sum);
  }
  // Of the tops above places with cloud, how far the lower and the upper tenth are apart: a share of the
  // layer's depth.
  double reliefOfTops() const {
    constexpr int kSteps = 100;
    std::vector<double> tops;
    for (int y = 0; y < kPlaces; ++y)
      for (int x = 0; x < kPlaces; ++x)
        for (int i = kSteps - 1; i > 0; --i)
          if (at(x, y, static_cast<double>(i) / kSteps)) {
            tops.push_back(static_cast<double>(i) / kSteps);
            break;
          }
    std::ranges::sort(tops);
    return tops[tops.size() * 9 / 10] - tops[tops.size() / 10];
  }

 private:
  static constexpr int kPlaces = 150;
  static constexpr float kSpacingM = 600.0f;

  static glm::vec2 place(int x, int y) { return kSpacingM * (glm::vec2(x, y) - 0.5f * kPlaces); }
  float extinction(glm::vec2 placeM, double height) const {
    const field::CloudLayer& l = clouds_.layers()[0];
    const auto h = static_cast<float>(height);
    const glm::vec2 p = placeM + l.shearM * h;
    const float drop = glm::dot(p, p) / static_cast<float>(2.0 * clouds_.earthRadiusM());
    return clouds_.extinction({p.x, p.y, l.baseM + h * (l.topM - l.baseM) - drop});
  }

  field::CloudField made(const weather::Layer& layer) const {
    Scene scene;
    weather::Weather weather;
    weather.layers = {layer};
    return cloudsAt(scene, weather, calibrateClouds(scene, weather, noise_), noise_, 0.0);
  }
  std::shared_ptr<const field::CloudNoise> noise_;
  field::CloudField clouds_;
};

TEST(CloudShapes, ThundercloudsAreBroadBelowAndBroaderAbove) {
  for (const double oktas : {2.0, 6.0}) {
    SCOPED_TRACE(oktas);
    const Shape storm(Genus::kCumulonimbus, 9000.0, oktas);
    const double base = storm.share(0.1), waist = storm.share(0.55), anvil = storm.share(0.9);
    EXPECT_GT(waist, 0.003);
    EXPECT_GT(base, 2.0 * waist);
    EXPECT_GT(anvil, base);
    // A trunk stands on a base and bears an anvil.
    EXPECT_GT(storm.carried(0.55, 0.1), 0.98);
    EXPECT_GT(storm.carried(0.55, 0.9), 0.98);
    // Which is thin for its size.
    EXPECT_GT(storm.densest(0.8), 0.1 * storm.densest(0.5));
    EXPECT_LT(storm.densest(0.8), 0.5 * storm.densest(0.5));
  }
}

TEST(CloudShapes, TowersKeepMoreOfTheirBreadthThanHeaps) {
  const Shape heaps(Genus::kCumulus, 1000.0, 4.0), towers(Genus::kCumulus, 3500.0, 4.0);
  EXPECT_LT(heaps.share(0.55), 0.3 * heaps.share(0.1));
  EXPECT_GT(towers.share(0.55), 0.35 * towers.share(0.1));
  EXPECT_GT(towers.carried(0.55, 0.1), 0.98);
  // Their turrets overhang, as no wall does.
  EXPECT_LT(towers.carried(0.8, 0.55), 0.92);
}

// In one pattern the peaks alone would be left of few: the slenderer and the more pointed, the fewer there
// are.
TEST(CloudShapes, FewHeapsAreAsBroadAsMany) {
  const Shape many(Genus::kCumulus, 600.0, 4.0);
  for (const double oktas : {1.0, 2.0}) {
    SCOPED_TRACE(oktas);
    const Shape few(Genus::kCumulus, 600.0, oktas);
    EXPECT_GT(few.levelM(), 0.85 * many.levelM());
    EXPECT_GT(few.levelM(), 1.15 * few.uprightM());
  }
}

// Strained cells would be bands with plane walls.
TEST(CloudShapes, HeapsAreHardlyStrained) {
  for (const double depthM : {400.0, 1200.0, 4000.0})
    EXPECT_LT(Shape(Genus::kCumulus, depthM, 3.0).strain(), 0.35) << depthM;
  EXPECT_LT(Shape(Genus::kStratocumulus, 500.0, 3.0).strain(), 0.35);
  EXPECT_LT(Shape(Genus::kCumulonimbus, 10000.0, 3.0).strain(), 0.35);
}

// Gaps that close as the sky is covered stay as hollows between tops.
TEST(CloudShapes, CoveredSkiesAreNotPlanesFromAbove) {
  for (const double oktas : {4.0, 6.0, 8.0}) {
    SCOPED_TRACE(oktas);
    EXPECT_GT(Shape(Genus::kStratocumulus, 500.0, oktas).reliefOfTops(), 0.3);
    EXPECT_GT(Shape(Genus::kCumulus, 1200.0, oktas).reliefOfTops(), 0.3);
  }
}

// Broken nimbostratus is patches that taper, not blocks of a deck with lids on; a closed one is as it was.
TEST(CloudShapes, BrokenRainCloudsTaper) {
  const Shape broken(Genus::kNimbostratus, 2500, 3);
  EXPECT_LT(broken.share(0.7), 0.25 * broken.share(0.2));
  EXPECT_GT(Shape(Genus::kNimbostratus, 2500, 8).share(0.7), 0.5);
}

TEST(CloudShapes, CellsOfAltocumulusAreFlat) {
  const Shape cells(Genus::kAltocumulus, 500.0, 4.0);
  EXPECT_GT(cells.levelM(), 2.5 * cells.uprightM());
}

// Heaps turn into towers as they get deeper, and nowhere at once.
TEST(CloudShapes, MoveWithTheDepth) {
  const auto numbers = [](double depthM) {
    std::map<std::string, float> all;
    field::forEachMember(shapeOf(layerOf(Genus::kCumulus, depthM, 4.0), 1, 0.0),
                         [&](const char* name, auto value) {
                           if constexpr (std::is_same_v<decltype(value), float>) all[name] = value;
                         });
    return all;
  };
  for (double depthM = 1000.0; depthM < 4000.0; depthM += 50.0) {
    const auto here = numbers(depthM), there = numbers(depthM + 1.0);
    ASSERT_EQ(here.size(), there.size());
    for (const auto& [name, value] : here)
      EXPECT_NEAR(there.at(name), value, 0.004f * std::abs(value) + 1e-3f)
          << name << " at " << depthM << " m";
  }
  EXPECT_NE(numbers(1300.0).at("dome"), numbers(1500.0).at("dome"));
  EXPECT_EQ(numbers(2400.0).at("dome"), numbers(3000.0).at("dome"));
}

// Places, and the noises that shape clouds there, move on after a year as at first.
TEST(CloudsFarInTime, MoveAsTheyDoAtFirst) {
  weather::Weather weather;
  weather::Layer storm;
  storm.genus = weather::Genus::kCumulonimbus;
  storm.baseM = 1200.0, storm.topM = 9000.0, storm.oktas = 4.0;
  storm.windFromDeg = 250.0, storm.windSpeedMps = 30.0, storm.rainMmPerH = 20.0;
  weather.layers = {storm};
  Scene scene;
  const auto noise = field::makeCloudNoise(1);
  const std::vector<LayerCalibration> calibration{{5, 0.5f, 0.05f}};
  Random random(1);
  for (const double fromS : {0.0, 31536000.0, -31536000.0}) {
    const field::CloudField before = cloudsAt(scene, weather, calibration, noise, fromS),
                            after = cloudsAt(scene, weather, calibration, noise, fromS + 0.25);
    ASSERT_EQ(before.layers().size(), 2u);  // and its rain
    const glm::dvec2 wayM = windDriftM(scene, storm, fromS + 0.25) - windDriftM(scene, storm, fromS);
    EXPECT_NEAR(glm::length(wayM), 7.5, 1e-3);
    double most = 0.0, greatest = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const glm::vec3 p(2e4f * random.uniform(), 2e4f * random.uniform(), 8900.0f * random.uniform());
      const float here = before.extinction(p), there = after.extinction(p + glm::vec3(wayM, 0.0));
      most = std::max(most, static_cast<double>(std::abs(here - there)));
      greatest = std::max(greatest, static_cast<double>(here));
    }
    EXPECT_GT(greatest, 0.02) << fromS;
    EXPECT_LT(most, 0.3 * greatest) << fromS;  // a step of 64 m and no evolution between would be all of it
  }
}

}  // namespace
}  // namespace welkin::scene
