// SPDX-License-Identifier: Apache-2.0
// What remarks say about cloud, group by group, and which reported layer is meant.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "welkin/weather/metar.h"
#include "welkin/weather/weather.h"

namespace welkin::weather {

// Adds what one group of the remarks says about cloud to the report: Canadian `SC4AS2` (amounts in eighths,
// MANOBS 10.2.19), Japanese `1CU030`, American `8/571` (FMH-1 12.7.2). False: it is no such group.
bool readCloudRemark(std::string_view group, Metar& metar);

// A reported layer and what the remarks call it.
struct NamedLayer {
  double baseM = 0.0;  // above the ground
  std::optional<int> baseFt;
  MetarCloudType type = MetarCloudType::kNone;
  std::optional<Genus>
      genus;  // empty where they do not say, or where it cannot be told which layer they mean
};

// Gives layers, which stand from the lowest base up, their genus and, where that is CB or TCU, their type.
// Those that the body of the report calls so keep theirs.
//
// A remark with a base names the layer with that base. Remarks without bases name the layers in their order
// where there are as many of the one as of the other. `8/` names the layers of a level, low below 2 km,
// middle, and high by latitude; a low code of cumulonimbus only where there is one low layer. What does not
// exist at a height names nothing. `steady`: rain or snow falls, no showers.
void nameByRemarks(const Metar& metar, double latitudeDeg, bool steady, std::span<NamedLayer> layers);

}  // namespace welkin::weather
