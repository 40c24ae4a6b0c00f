// SPDX-License-Identifier: Apache-2.0
// Genera of cloud that remarks name, and the layers that they mean.
#include "welkin/weather/metar_remarks.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "welkin/weather/from_metar.h"

namespace welkin::weather {
namespace {

using enum Genus;

std::vector<Genus> generaOf(const std::string& sky, const std::string& remarks) {
  const MetarResult r = parseMetar("CYOW 210500Z 28010KT 9999 " + sky + " 12/05 Q1012 RMK " + remarks);
  EXPECT_TRUE(r.ok()) << remarks;
  std::vector<Genus> genera;
  for (const Layer& l : weatherFromMetar(r.metar, 45.0, 4, 0.0).layers) genera.push_back(l.genus);
  return genera;
}
using Genera = std::vector<Genus>;

TEST(MetarRemarks, AreReadGroupByGroup) {
  const Metar m = parseMetar(
                      "CYOW 210500Z 28010KT 15SM SCT030 12/M05 A2992 RMK SC4AS2 FG1ACC3 1CU030 "
                      "2TCU035 AO2 SLP134 8/57/ 8/111 T01201050 CU9 CU1X 9SC040 CIG30 SC TR")
                      .metar;
  ASSERT_EQ(m.cloudRemarks.size(), 5u);
  EXPECT_EQ(m.cloudRemarks[0].genus, kStratocumulus);
  EXPECT_EQ(m.cloudRemarks[0].oktas, 4);
  EXPECT_FALSE(m.cloudRemarks[0].baseFt);
  EXPECT_EQ(m.cloudRemarks[1].genus, kAltostratus);
  EXPECT_EQ(m.cloudRemarks[2].genus, kAltocumulus);
  EXPECT_EQ(m.cloudRemarks[3].baseFt, 3000);
  EXPECT_EQ(m.cloudRemarks[4].type, MetarCloudType::kToweringCumulus);
  ASSERT_TRUE(m.cloudCodes);
  EXPECT_EQ(m.cloudCodes->low, 5);
  EXPECT_EQ(m.cloudCodes->middle, 7);
  EXPECT_FALSE(m.cloudCodes->high);
  EXPECT_EQ(m.temperatureC, 12.0);
  EXPECT_EQ(m.dewPointC, -5.0);
}

TEST(MetarRemarks, CanadianOnesNameTheLayersInTheirOrder) {
  EXPECT_EQ(generaOf("SCT030 BKN100", "none"), (Genera{kStratocumulus, kAltocumulus}));
  EXPECT_EQ(generaOf("SCT030 BKN100", "CU4AS2"), (Genera{kCumulus, kAltostratus}));
  EXPECT_EQ(generaOf("SCT030 BKN100", "FG1CU4 AS2"), (Genera{kCumulus, kAltostratus}));
  EXPECT_EQ(generaOf("SCT030 BKN100", "CU4"), (Genera{kStratocumulus, kAltocumulus})) << "which of the two?";
  EXPECT_EQ(generaOf("FEW030 SCT230", "CB1CI2"), (Genera{kCumulonimbus, kCirrus}));
  EXPECT_EQ(generaOf("FEW030CB SCT230", "SC1CC2"), (Genera{kCumulonimbus, kCirrocumulus})) << "the body's CB";
  EXPECT_EQ(generaOf("FEW030 SCT230", "CI1CU2"), (Genera{kStratocumulus, kCirrus})) << "impossible there";
}

TEST(MetarRemarks, JapaneseOnesNameTheLayerAtTheirBase) {
  EXPECT_EQ(generaOf("FEW030 BKN040 BKN200", "1CU030 4SC040 6CS200"),
            (Genera{kCumulus, kStratocumulus, kCirrostratus}));
  EXPECT_EQ(generaOf("FEW030 BKN040", "4ST040 1CU025"), (Genera{kStratocumulus, kStratus}));
  EXPECT_EQ(generaOf("FEW030 SCT030", "1CU030 3ST030"), (Genera{kCumulus, kStratus}));
}

TEST(MetarRemarks, AmericanCodesNameTheLayersOfALevel) {
  EXPECT_EQ(generaOf("SCT030 BKN100 BKN250", "8/271"), (Genera{kCumulus, kAltocumulus, kCirrus}));
  EXPECT_EQ(generaOf("SCT030 BKN100 BKN250", "8/619"), (Genera{kStratus, kAltostratus, kCirrocumulus}));
  EXPECT_EQ(generaOf("SCT030 BKN100", "8/0//"), (Genera{kStratocumulus, kAltocumulus}));
  EXPECT_EQ(generaOf("SCT030 BKN045", "8/8//"), (Genera{kCumulus, kStratocumulus}));
  EXPECT_EQ(generaOf("SCT030", "8/9//"), (Genera{kCumulonimbus}));
  EXPECT_EQ(generaOf("SCT030 BKN045", "8/9//"), (Genera{kStratocumulus, kStratocumulus}))
      << "which of the two?";
  EXPECT_EQ(generaOf("RA BKN090", "8/02/"), (Genera{kNimbostratus}));
  EXPECT_EQ(generaOf("BKN090", "8/02/"), (Genera{kAltostratus}));
}

}  // namespace
}  // namespace welkin::weather
