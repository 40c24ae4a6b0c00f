// SPDX-License-Identifier: Apache-2.0
// Scattering angles drawn from a phase function, and the density that they are drawn with. Both are of one
// function exactly, so that estimates which use both have no bias.
#pragma once

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
  double sampleCosine(double u) const;  // u in [0, 1); rises with u
  double meanCosine() const;
  double integral() const { return integral_; }  // over the sphere, of the function as it was given

 private:
  void normalise();

  double g_ = 0.0, integral_ = 1.0;
  // Steps between cosines that rise; empty: closed form. The share of light up to each edge, the density
  // inside each step.
  std::vector<double> edges_, shares_, densities_;
  std::vector<std::uint16_t> guide_;      // the first step that may hold u = i / size
  std::vector<std::uint16_t> stepGuide_;  // the first that may hold a cosine, by a number that it is made to
};

}  // namespace welkin::reference
