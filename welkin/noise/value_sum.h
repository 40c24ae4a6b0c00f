// SPDX-License-Identifier: Apache-2.0
// Octaves of value noise. Private to noise/.
#pragma once

#include <vector>

#include "welkin/noise/noise.h"
#include "welkin/noise/plan.h"

namespace welkin::noise {

// The raw sum at p, finite, in units of the domain.
double valueSum(const std::vector<ValueTerm>& terms, const NoiseParams& params, const glm::dvec3& p);

// The sum of Fractal::kFbm, and its derivative per unit of the domain.
ValueAndSlope valueSlope(const std::vector<ValueTerm>& terms, const NoiseParams& params, const glm::dvec3& p);

}  // namespace welkin::noise
