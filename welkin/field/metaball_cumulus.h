// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs without a map: the bubbles of a tower of cumulus (cumulus_tower.h) become balls.
#pragma once

#include <vector>

#include "welkin/field/cumulus_tower.h"
#include "welkin/field/metaballs.h"

namespace welkin::field {

// A bubble becomes a ball whose density is a fifth of its centre's on the bubble's surface; one that is
// longer than wide a stack of them. Balls stand on the base, none reaching far below it, so that the base is
// flat. Densities are such that where balls overlap their sum is about `density`, not more the more there
// are. The same parameters give the same balls everywhere. Throws ParameterError as cumulusTower() does.
std::vector<Metaball> cumulusMetaballs(const CumulusParams& params, double density);

}  // namespace welkin::field
