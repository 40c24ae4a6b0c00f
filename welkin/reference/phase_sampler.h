// SPDX-License-Identifier: Apache-2.0
// Scattering angles drawn from a phase function, and the density that they are drawn with. Both are of one
// function exactly, so that estimates which use both have no bias.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace welkin::reference {

class PhaseSampler {
 public:
  // Henyey and Greenstein's function, in closed form. |g| < 1.
  static PhaseSampler henyeyGreenstein(double g);
  // Any function of the cosine, in 1/sr, as its means over narrow steps of the angle. It is normalised.
  static PhaseSampler tabulated(const std::function<double(double)>& phase);
  // What of a tabulated one is above a level, 1/sr, step by step: nowhere more than it, nor less by more than
  // the level.
  PhaseSampler above(double level) const;

  double density(double cosine) const;  // 1/sr
  // Angles by their versine, 1 - cosine, which is exact for small ones. u in (0, 1]; rises with u.
  double sampleVersine(double u) const;
  double sampleCosine(double u) const { return 1.0 - sampleVersine(1.0 - u); }  // [0, 1); rises with u
  double meanCosine() const;
  double integral() const { return integral_; }  // over the sphere, of the function as it was given

  // The density in parts, where several are asked at one angle that are tabulated with the same steps.
  std::size_t stepAt(double versine) const;
  double densityIn(std::size_t step) const { return static_cast<double>(steps_[step].density); }
  bool isTabulated() const { return !steps_.empty(); }

 private:
  // Between this angle and the next; share: of the light within smaller angles.
  struct Step {
    double share = 0.0;
    float versine = 0.0f, density = 0.0f;
  };
  // densities: a step each, whatever their integral.
  static PhaseSampler of(const std::vector<double>& densities);

  double g_ = 0.0, integral_ = 1.0;
  std::vector<Step> steps_;               // and where the last ends; empty: closed form
  std::vector<std::uint16_t> guide_;      // the first step that may hold u = i / size
  std::vector<std::uint16_t> stepGuide_;  // the first that may hold an angle, by a number that it is made to
};

}  // namespace welkin::reference
