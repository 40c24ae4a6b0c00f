// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/hazy_deck.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

namespace welkin::scene {
namespace {

constexpr int kSlabs = 12;  // of the deck; haze falls off with height

// Shares of diffuse light that goes through a slab and is sent back by it.
struct Slab {
  double through = 1.0, back = 0.0;
};

// scattered: the optical depth, times 1 - g; absorbed: that by which light is lost. W. E. Meador and W. R.
// Weaver 1980, "Two-Stream Approximations to Radiative Transfer in Planetary Atmospheres", equation 25.
Slab slabOf(double scattered, double absorbed) {
  const double depth = scattered + absorbed;
  if (depth <= 0.0) return {};
  const double albedo = scattered / depth;
  const double loss = 0.25 * (7.0 - 4.0 * albedo), gain = 0.25 * (4.0 * albedo - 1.0);
  const double k = std::sqrt(std::max(loss * loss - gain * gain, 1e-12)), e = std::exp(-2.0 * k * depth);
  const double all = k * (1.0 + e) + loss * (1.0 - e);
  return {2.0 * k * std::exp(-k * depth) / all, gain * (1.0 - e) / all};
}

// One on another; `back` is of light that comes from below.
Slab over(const Slab& upper, const Slab& lower) {
  const double again = 1.0 / (1.0 - upper.back * lower.back);
  return {upper.through * lower.through * again,
          lower.back + lower.through * lower.through * upper.back * again};
}

}  // namespace

HazyLight lightThroughHaze(const Deck& deck, const sky::AtmosphereUniforms& air) {
  const double scale = air.aerosolScaleHeightM;
  HazyLight share;
  for (int c = 0; c < 3; ++c) {
    const double extinction = air.aerosolExtinction[c], scattering = air.aerosolScattering[c],
                 ground = air.groundAlbedo[c];
    const auto illuminances = [&](bool hazy) {
      const auto slab = [&](double lowM, double highM, double depth) {
        const double wayM = hazy ? scale * (std::exp(-lowM / scale) - std::exp(-highM / scale)) : 0.0;
        return slabOf(depth + (1.0 - static_cast<double>(air.aerosolG)) * scattering * wayM,
                      (extinction - scattering) * wayM);
      };
      Slab cloud;
      for (int i = kSlabs; i-- > 0;)
        cloud = over(cloud, slab(std::lerp(deck.baseM, deck.topM, static_cast<double>(i) / kSlabs),
                                 std::lerp(deck.baseM, deck.topM, (i + 1.0) / kSlabs), deck.depth / kSlabs));
      const Slab beneath = slab(0.0, deck.baseM, 0.0);
      const double sentUp =
          beneath.back + beneath.through * beneath.through * ground / (1.0 - beneath.back * ground);
      const Slab all = over(cloud, beneath);
      return glm::dvec2(all.through / (1.0 - all.back * ground), cloud.through / (1.0 - cloud.back * sentUp));
    };
    const glm::dvec2 shares = illuminances(true) / illuminances(false);
    share.onGround[c] = static_cast<float>(shares.x);
    share.underDeck[c] = static_cast<float>(shares.y);
  }
  return share;
}

}  // namespace welkin::scene
