// SPDX-License-Identifier: Apache-2.0
// The clear air as a medium that light is traced through: its optical depths by quadrature, its scattering
// at random. The coefficients and profiles are those of sky/atmosphere.h, tables are not used.
//
// Triples are linear Rec. 709 primaries, each with its own coefficients: a primary is traced as one
// wavelength would be.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "welkin/core/random.h"
#include "welkin/reference/sphere.h"
#include "welkin/sky/atmosphere.h"

namespace welkin::reference {

class Air {
 public:
  explicit Air(const sky::AtmosphereUniforms& uniforms);

  struct Medium {
    glm::dvec3 rayleigh, aerosol;  // scattering, 1/m
    glm::dvec3 extinction;
  };
  Medium at(double heightM) const;
  double topM() const { return top_; }  // height above the ground, where the air ends
  bool empty() const { return empty_; }

  // Optical depth of the stretch [0, t] of a ray within the air. Steps of the exact integral of an
  // exponential along the curved way: within 4e-4.
  glm::dvec3 opticalDepth(const Sphere& earth, const Ray& ray, double t) const;
  // The transmittance of that stretch; of one as short as most are, by way of a table over height: within
  // 1e-5.
  glm::dvec3 transmittance(const Sphere& earth, const Ray& ray, double t) const;
  // To space; nothing is known of the ground.
  glm::dvec3 opticalDepthToSpace(const Sphere& earth, const Ray& ray) const;

  // A place where light may be scattered within [0, t], drawn about in proportion to scattering times
  // transmittance, mean over primaries weighted by `weights`; and its density, 1/m.
  struct Place {
    double t, density;
  };
  Place samplePlace(const Sphere& earth, const Ray& ray, double t, const glm::dvec3& weights,
                    Random& random) const;

  double phaseRayleigh(double cosine) const;
  double phaseAerosol(double cosine) const;
  double sampleRayleigh(Random& random) const;
  double sampleAerosol(Random& random) const;

 private:
  using Four = std::array<float, 4>;  // red, green, blue and none
  struct alignas(32) ExtinctionEntry {
    Four at{}, more{};  // 1/m; on to the next entry
  };
  struct PlaceEntry {
    glm::vec3 extinction, scattering;  // 1/m
  };
  double ozoneOver(double h0, double h1) const;  // mean along a step, of its peak

  sky::AtmosphereUniforms u_;
  double ground_, top_;
  double fineG_ = 0.0;  // of the haze's wide lobe
  bool empty_ = false;
  std::vector<ExtinctionEntry> extinctions_;  // by height above the ground
  std::vector<PlaceEntry> places_;            // coarser, to the top
};

// Transmittance to space towards a light's disc from where clouds are, tabulated over height and the cosine
// of the zenith angle as it is within some hundreds of kilometres; elsewhere computed.
class AirToLight {
 public:
  AirToLight(const Air& air, const Sphere& earth, const glm::dvec3& direction);

  // Towards a point of the disc; 0 where the ground is in the way.
  glm::dvec3 transmittance(const glm::dvec3& p, const glm::dvec3& way) const;

 private:
  glm::dvec3 compute(double heightM, double cosine) const;

  const Air* air_;
  const Sphere* earth_;
  double firstCosine_ = 0.0;
  std::vector<glm::dvec3> depths_;  // by height, then by cosine
};

}  // namespace welkin::reference
