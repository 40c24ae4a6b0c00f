// SPDX-License-Identifier: Apache-2.0
// How much of the sky clouds hide, and the threshold that makes them hide as much as was asked for.
//
// Cover is what an observer on the ground calls so: the fraction of the sky hemisphere, by solid angle, in
// whose directions the optical depth exceeds 0.3. It is measured on the field itself, from the place where
// the weather is reported.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"

namespace welkin::field {

inline constexpr auto kCoverOpticalDepth = static_cast<float>(kCoverDepth);

// Where and how finely to look.
struct CoverView {
  double eyeM = 2.0;      // above the ground
  int directions = 1500;  // spread evenly over the hemisphere
};

// Direction i of n, evenly over the upper hemisphere.
glm::vec3 hemisphereDirection(int i, int n);

// Fraction in [0, 1]; `only` picks one layer, -1: all together.
double measureCover(const CloudField& field, const CoverView& view, int only = -1);

// Optical depth of one layer in each direction of the view, followed no further than to kCoverOpticalDepth.
// Where the depths of several layers add up to that, the sky is covered: so layers measured one by one tell
// what they hide together.
std::vector<float> layerOpticalDepths(const CloudField& field, const CoverView& view, int layer);

// Fraction of directions in which the optical depth makes cover.
double coverOf(std::span<const float> opticalDepths);

// Where calibrated() ends for layers that cannot cover what is asked: cloud wherever the layer reaches.
inline constexpr float kLeastThreshold = -4.0f;

// The layer's threshold at which its own measured cover is `fraction`, by bisection (cover falls as the
// threshold rises). Where the layer is too thin to reach it, its extinction is raised. Of a layer
// that hides nothing at its fullest, as one beneath the eye, 0 is that fullest. The other layers do
// not matter.
CloudLayer calibrated(const CloudField& field, int layer, double fraction, const CoverView& view);

// The same in steps, for frame loops. Once it has searched with so many directions in the noise of one sky it
// allocates nothing.
class CoverSearch {
 public:
  static constexpr int kMostSteps = 18;
  void start(const std::shared_ptr<const CloudNoise>& noise, double groundAltitudeM, const CloudLayer& layer,
             double fraction, const CoverView& view);
  // Looks at most once in each direction. Does nothing once the search is done.
  void step();
  bool done() const;
  const CloudLayer& layer() const { return result_; }  // when done
  // Adds the layer's optical depth in each direction of the view, as layerOpticalDepths() has it.
  void addOpticalDepths(std::span<float> sums);

 private:
  bool tooThin() const;
  std::size_t lookAt(std::size_t begin, std::size_t end);

  std::optional<CloudField> single_;  // of the layer alone
  CoverView view_;
  CloudLayer result_{};
  double fraction_ = 0.0, target_ = 0.0;  // directions to be hidden
  float low_ = 0.0f, high_ = 0.0f;        // thresholds
  std::vector<int> directions_;           // that may still change
  std::vector<char> hides_;               // by direction
  std::size_t hiddenAtLow_ = 0, hiddenAtHigh_ = 0;
  int thickenings_ = 0, bisections_ = 0;
  bool looked_ = false;
};

}  // namespace welkin::field
