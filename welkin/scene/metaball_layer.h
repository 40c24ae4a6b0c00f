// SPDX-License-Identifier: Apache-2.0
// A layer of the weather as metaballs: clouds of a small library (cumulus_library.h), each turned, sized and
// placed by hashes of its cell in an endless lattice that drifts with the layer's wind.
//
// Clouds of a few cells each stand together in groups, most of the large ones in some of them.
//
// Every cell has a rank in [0, 1] and the cells whose rank is below a threshold have a cloud, the larger and
// denser the further below. The threshold is where the sky's measured cover is what was asked for; where all
// cells have a cloud by then, clouds are larger, reach farther out and stand closer, as far as it takes. In
// time ranks wander evenly up and down, so that clouds grow and decay while as many stay: a pure function of
// time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "welkin/field/metaballs.h"
#include "welkin/scene/cumulus_library.h"
#include "welkin/weather/weather.h"

namespace welkin::scene {

class MetaballLayer {
 public:
  // Finds how much there must be, by bisection, from the ground at the place. Some seconds, the first time.
  MetaballLayer(const weather::Layer& layer, std::uint64_t seed, double earthRadiusM);

  struct Cloud {
    glm::dvec3 baseM{0.0};  // the middle of its base: along the ground from the place, and above it
    double widthM = 1.0, turnRad = 0.0, extinctionPerM = 0.0;
    std::size_t shape = 0;
  };
  // Those within reach of an eye, when the lattice has drifted so far.
  void cloudsAt(double secondsAfter, const glm::dvec2& driftedM, const glm::dvec2& eyeM,
                std::vector<Cloud>& out) const;
  // What it is made of, and all that its clouds are made of.
  const LibraryCloud& shape(const Cloud& cloud) const { return library()[cloud.shape]; }
  const std::vector<LibraryCloud>& library() const;

  // Optical depths in directions spread evenly over the hemisphere, from the ground at the place.
  std::vector<float> opticalDepths(double secondsAfter, const glm::dvec2& driftedM, int directions) const;

  // Where that is clearly less than was asked for: the most that could be covered.
  std::optional<double> mostOktas() const { return mostOktas_; }
  const weather::Layer& layer() const { return layer_; }
  bool isFlat() const { return flat_; }  // its clouds are the library's flat ones, not towers

 private:
  void fill(double much);

  weather::Layer layer_;
  std::uint64_t seed_;
  double earthRadiusM_;
  bool flat_;
  std::optional<double> mostOktas_;
  double threshold_ = 0.0, leastSize_ = 1.0, cellM_ = 1.0, reachM_ = 0.0, pull_ = 0.0;
};

// From distances along the ground about the eye and height over it to the tangent plane.
glm::dvec3 overEarth(const glm::dvec3& p, const glm::dvec3& eyeM, double earthRadiusM);

// A cloud's ball in the sky.
field::Metaball placed(const field::Metaball& ball, const MetaballLayer::Cloud& cloud);

}  // namespace welkin::scene
