// SPDX-License-Identifier: Apache-2.0
// What decks of volumes far from a place take from the light of a sun near its horizon, on average.
//
// The light volume has depths along a straight line that is never nearer to level than kLeastElevation. On
// its way from a lower sun light goes along a deck for a hundred kilometres, and from one just below the
// horizon through it twice, down out of the clouds and, beyond the lowest point, up again: over the curved
// earth, h(s) = h + s sin(elevation) + s^2 / (2 R). What those ways are longer than the line counts here, by
// the clouds that there are in the mean.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "welkin/field/cloud_field.h"
#include "welkin/scene/sky_state.h"

namespace welkin::shading {

// The sine of two degrees: nearer to level a line would leave the volume before it has crossed a layer.
inline constexpr double kLeastElevation = 0.035;

class FarDecks {
 public:
  explicit FarDecks(const scene::SkyState& state);

  bool any() const { return count_ > 0; }
  // The share of light that is left, [0, 1]. heightM: above the ground; sine: of the light's elevation there;
  // towardsLight: as below, of the light that clouds are lit by.
  double through(double heightM, double sine, bool towardsLight) const;
  // The line points to a light of that elevation, sine, and not away from it. It points to one below the
  // horizon where decks keep that from shining on clouds from below: what light there is comes out of the sky
  // above it.
  bool lineTowards(double sine) const { return sine >= kFromBelow || !openBelow_; }

 private:
  struct Deck {
    double baseM, topM;
    double perM;  // what it takes along a long level way, 1/m
  };
  static constexpr double kFromBelow = -0.015;
  std::span<const Deck> decks() const { return std::span(decks_).first(count_); }

  std::array<Deck, field::kMaxLayers> decks_{};
  std::size_t count_ = 0;
  double radiusM_;
  bool openBelow_ = true;
};

}  // namespace welkin::shading
