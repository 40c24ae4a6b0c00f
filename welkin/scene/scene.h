// SPDX-License-Identifier: Apache-2.0
// The whole description of a picture: place, time, weather, eye, picture. What a scene file says and the
// command line overrides.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/params.h"
#include "welkin/optics/phase.h"
#include "welkin/scene/drift.h"
#include "welkin/scene/metaballs.h"
#include "welkin/scene/sheet.h"
#include "welkin/scene/sky_box.h"
#include "welkin/scene/slab.h"
#include "welkin/sky/atmosphere_params.h"
#include "welkin/weather/weather.h"

namespace welkin::scene {

struct Place {
  double latitudeDeg = 47.46;  // north positive
  double longitudeDeg = 8.55;  // east positive
  double altitudeM = 0.0;      // of the ground above mean sea level
  bool operator==(const Place&) const = default;
};
void describe(Place& p, ParamVisitor& v);

enum class Projection { kPerspective, kFisheye, kEquirect, kCubemap };

// Where the eye is and what it sees. The eye stands over the place.
struct Camera {
  double eyeM = 2.0;                 // above the ground
  std::optional<double> headingDeg;  // clockwise from north; absent: 60 degrees right of the brighter of sun
                                     // and moon at the scene's time
  double pitchDeg = 12.0;            // above the horizon
  double fovDeg = 70.0;              // across the width of a perspective picture
  Projection projection = Projection::kPerspective;
  bool operator==(const Camera&) const = default;
};
void describe(Camera& c, ParamVisitor& v);

enum class Quality { kLow, kMedium, kHigh, kUltra };

struct Output {
  std::int64_t width = 1280;  // pixels
  std::int64_t height = 720;
  Quality quality = Quality::kMedium;
  std::optional<double> exposureEv;  // EV at ISO 100; absent: automatic
  bool sunDisc = true;  // draw the discs of sun and moon; false leaves their light out of an environment map
  bool stars = true;    // draw stars, planets and Milky Way, where they are out
  double flare = 0.0;   // share of the sun's light that the lens scatters into a glow and ghosts
  std::int64_t frames = 1;
  double fps = 24.0;    // frames a second of video
  double speed = 60.0;  // simulated seconds for each second of video
  bool operator==(const Output&) const = default;
};
void describe(Output& o, ParamVisitor& v);

enum class Snow { kAuto, kNone, kLying };  // kAuto: as the weather says

struct Ground {
  glm::dvec3 albedo{0.13, 0.14, 0.09};  // linear Rec. 709, without snow
  Snow snow = Snow::kAuto;
  bool operator==(const Ground&) const = default;
};
void describe(Ground& g, ParamVisitor& v);

using weather::Technique;

struct Scene {
  Place place;
  UtcTime time;      // the moment at which the weather is as described
  double atS = 0.0;  // seconds after `time` at which the (first) picture is taken
  std::int64_t seed = 1;
  std::optional<std::string> metar;        // the weather as a report; wins over `layers`
  std::optional<double> visibilityM;       // absent: from the report, else 40 km
  std::vector<weather::Layer> layers;      // the weather by hand
  Technique technique = Technique::kAuto;  // of layers that name none
  SheetTier tier = SheetTier::kLit;        // of layers that are drawn as sheets
  std::optional<std::string> theme;      // in scene files: what technique, tier, drift and sheets start from;
                                         // empty once it is read (theme.h)
  LayerOctaves octaves;                  // of layers with the technique octaves
  std::vector<Sheet> sheets;             // thin layers by hand, beside the weather's
  std::vector<MetaballCloud> metaballs;  // single clouds by hand, beside the weather's
  MetaballRender metaballsAs = MetaballRender::kSplats;        // those and the layers made of them
  optics::DropletModel droplets = optics::DropletModel::kFit;  // of marched volumes
  Drift drift;                                                 // of wind and cover
  SkyBox skyBox;                                               // in the place of the clear sky
  Slab slab;                                                   // in the place of everything
  sky::AtmosphereParams atmosphere;
  Ground ground;
  Camera camera;
  Output output;
  bool operator==(const Scene&) const = default;
};
void describe(Scene& s, ParamVisitor& v);

// Values that do not fit together, with the keys that they may stand under, the likeliest first:
// "output.width", "layer[8]".
class MisfitError : public ParameterError {
 public:
  MisfitError(std::vector<std::string> keys, const std::string& message)
      : ParameterError(message), keys_(std::move(keys)) {}
  const std::vector<std::string>& keys() const { return keys_; }

 private:
  std::vector<std::string> keys_;
};

// What no single range can say: the number of pixels, a cubemap's 6:1 and an equirect's 2:1, tops above
// bases, the years of all pictures. Throws MisfitError, and ParameterError for what is wrong in one layer,
// sheet or cloud, in the sky box or the slab.
void validate(const Scene& s);

// The technique that draws a layer of the scene's weather: its own, or the scene's.
Technique techniqueOf(const Scene& scene, const weather::Layer& layer);
bool drawsSheets(Technique technique);
bool isSheet(const Scene& scene, const weather::Layer& layer);  // drawn as one
bool isMetaballs(const Scene& scene,
                 const weather::Layer& layer);  // drawn as them: neither sheet nor marched volume
bool isVolume(const Scene& scene, const weather::Layer& layer);  // marched
// The sheets of a scene: the layers of the weather that are drawn so, then those by hand. Each with
// its share of the scene's drift.
std::vector<Sheet> sheetsOf(const Scene& scene, const weather::Weather& weather);
// How the wind of all layers turns.
std::uint64_t windSeed(const Scene& scene);
// Of the pattern of the sheet with this index among them.
std::uint64_t sheetSeed(const Scene& scene, std::size_t index);

// The size of a picture in this projection when nobody asked for one.
struct PictureSize {
  std::int64_t width = 0, height = 0;  // pixels
};
PictureSize naturalSize(Projection projection);
// Gives the scene's picture that size, or, where one side was asked for, the other: in a projection of the
// whole sky it follows from that.
void setNaturalSize(Scene& s, bool widthGiven, bool heightGiven);

}  // namespace welkin::scene

namespace welkin {
template <>
inline constexpr auto kEnumNames<scene::Projection> =
    std::array<std::string_view, 4>{"perspective", "fisheye", "equirect", "cubemap"};
template <>
inline constexpr auto kEnumNames<scene::Snow> = std::to_array<std::string_view>({"auto", "none", "lying"});
template <>
inline constexpr auto kEnumNames<scene::Quality> =
    std::array<std::string_view, 4>{"low", "medium", "high", "ultra"};
}  // namespace welkin
