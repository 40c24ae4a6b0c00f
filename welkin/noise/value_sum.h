// SPDX-License-Identifier: Apache-2.0
// Octaves of value noise. Private to noise/.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "welkin/noise/noise.h"
#include "welkin/noise/plan.h"

namespace welkin::noise {

// The raw sum at p, finite, in units of the domain.
double valueSum(const std::vector<ValueTerm>& terms, const NoiseParams& params, const glm::dvec3& p);

// The sum of Fractal::kFbm, and its derivative per unit of the domain.
ValueAndSlope valueSlope(const std::vector<ValueTerm>& terms, const NoiseParams& params, const glm::dvec3& p);

// The raw sum over a box of a grid, in parallel: store(at, row) gets each row, from sample `at` of the box
// on, from several threads.
void fillValues(const Plan& plan, const NoiseParams& params, const Grid& grid, const Box& box,
                const std::function<void(std::size_t at, std::span<const float> row)>& store);

}  // namespace welkin::noise
