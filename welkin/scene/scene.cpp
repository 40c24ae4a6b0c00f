// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "welkin/core/param_range.h"
#include "welkin/core/random.h"

namespace welkin::scene {
namespace {

// Together the two limits keep a picture of floats under 2 GiB.
constexpr double kMaxSide = 16384;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 27;
constexpr std::size_t kMaxSheets = 8, kMaxMetaballs = 256;
constexpr double kYearS = 366.0 * 86400.0;

}  // namespace

void describe(Place& p, ParamVisitor& v) {
  v.value({"latitude_deg", "deg", "geodetic latitude, north positive", -90, 90}, p.latitudeDeg);
  v.value({"longitude_deg", "deg", "longitude, east positive", -180, 180}, p.longitudeDeg);
  v.value({"altitude_m", "m", "height of the ground above mean sea level", -500, 9000}, p.altitudeM);
}

void describe(Camera& c, ParamVisitor& v) {
  v.value({"eye_m", "m", "height of the eye above the ground", 0.1, 20000}, c.eyeM);
  v.value(
      {"heading_deg", "deg",
       "direction of view clockwise from north; absent: 60 deg right of the sun, or of the moon where it is "
       "up and the sun 7 deg below the horizon, as they stand at `time`; north for projections of the "
       "whole sky",
       -360, 360},
      c.headingDeg);
  v.value({"pitch_deg", "deg", "direction of view above the horizon, of a perspective picture", -90, 90},
          c.pitchDeg);
  v.value({"fov_deg", "deg", "field of view across the width of a perspective picture", 0.1, 170}, c.fovDeg);
  v.choice(
      {"projection", "",
       "perspective; fisheye: the whole dome, zenith in the middle, heading at the bottom; equirect: all "
       "directions, 2:1, heading in the middle; cubemap: six faces side by side, +x -x +y -y +z -z in "
       "east-north-up, whatever the heading"},
      c.projection);
}

void describe(Output& o, ParamVisitor& v) {
  v.value({"width", "pixels",
           "width of the picture; width times height is at most 134217728; left out: 1280 in perspective, "
           "else it "
           "follows from the height: as much (fisheye), twice (equirect) or six times (cubemap) that",
           1, kMaxSide},
          o.width);
  v.value({"height", "pixels",
           "height of the picture; left out: 720 in perspective, else it follows from the width; without "
           "either a "
           "fisheye is 1024x1024, an equirect 2048x1024, a cubemap 3072x512",
           1, kMaxSide},
          o.height);
  v.choice({"quality", "", "how finely the clouds are marched"}, o.quality);
  v.value({"exposure_ev", "EV",
           "exposure value at ISO 100 of PNG and video; absent: automatic, from each picture", -16, 24},
          o.exposureEv);
  v.value(
      {"sun_disc", "", "draw the discs of sun and moon; false leaves their light out of an environment map"},
      o.sunDisc);
  v.value({"stars", "",
           "draw stars, planets and Milky Way when the sun is down, Venus by day too, whatever sun_disc "
           "says; none over a sky box"},
          o.stars);
  v.value(
      {"flare", "",
       "share of the sun's light that the lens scatters into a glow and ghosts, 0.005 for a good one; only "
       "with projection perspective; the reference renderer leaves it out",
       0, 1},
      o.flare);
  v.value({"frames", "", "number of pictures in a sequence or video", 1, 1000000}, o.frames);
  v.value({"fps", "1/s", "frames for each second of video", 0.1, 1000}, o.fps);
  v.value({"speed", "", "simulated seconds for each second of video; negative runs backwards", -86400, 86400},
          o.speed);
}

void describe(Ground& g, ParamVisitor& v) {
  v.value({"albedo", "", "reflectance of the ground without snow, linear Rec. 709 red, green, blue", 0, 1},
          g.albedo);
  v.choice({"snow", "", "whether snow lies on the ground; auto: where the weather report has snow and frost"},
           g.snow);
}

void describe(Scene& s, ParamVisitor& v) {
  v.value({"time", "UTC",
           "the moment at which the weather is as described, ISO 8601; left out beside a report: its day and "
           "time, in June 2026"},
          s.time);
  v.value({"at_s", "s", "how long after `time` the (first) picture is taken", -kYearS, kYearS}, s.atS);
  v.value({"seed", "", "chooses one of many skies of the same weather", 0, 9007199254740991.0}, s.seed);
  v.value({"metar", "",
           "the weather as a METAR report; wins over every [[layer]]; absent: the weather is by hand"},
          s.metar);
  v.value({"visibility_m", "m",
           "how far black things stand out at the ground, by a contrast of 2 % (Koschmieder); absent: from "
           "the report, 1.31 times its number as that is by 5 %, else 40 km",
           10, 300000},
          s.visibilityM);
  v.choice({"technique", "",
            "how layers that name no technique of their own are drawn: as volumes (auto, volume) or, in next "
            "to no "
            "time, as thin sheets on planes, on planes bent over the earth (skyplane), on domes, or on bent "
            "planes "
            "with living octaves; metaballs: cumulus, stratocumulus and cumulonimbus as clouds of balls, the "
            "others as volumes"},
           s.technique);
  v.choice({"metaballs_as", "",
            "how clouds of metaballs are drawn: as splats, lit in two passes, or marched as all volumes are, "
            "with the light of droplets"},
           s.metaballsAs);
  v.choice({"droplets", "",
            "how the droplets of marched volumes scatter light the first time: by a smooth fit, or by Mie's "
            "theory, with fogbow and glory"},
           s.droplets);
  v.choice({"tier", "", "how layers drawn as sheets are lit: flat, embossed, or lit by their depth"}, s.tier);
  v.value({"theme", "",
           "what technique, tier, drift and sheets start from: thesis-overcast, thesis-broken, thesis-few, "
           "thesis-combined, thesis-dome, realistic-skies, or a theme's file beside the scene file"},
          s.theme);
  v.group({"place", "", "where on earth the eye stands"}, s.place);
  v.group({"camera", "", "where the eye is and what it sees"}, s.camera);
  v.group({"output", "", "the picture"}, s.output);
  v.group({"ground", "", "the ground below"}, s.ground);
  v.group({"atmosphere", "", "what the clear air is made of"}, s.atmosphere);
  v.group({"octaves", "", "the patterns of layers with technique octaves, which change as clouds do"},
          s.octaves);
  v.group({"drift", "", "wind and cover that wander by themselves"}, s.drift);
  v.group({"sky_box", "", "pictures all around in the place of the clear sky"}, s.skyBox);
  v.group({"slab", "",
           "a layer to prove light transport with, in the place of the whole sky; for the reference renderer "
           "alone"},
          s.slab);
  v.list({"layer", "", "one layer of cloud; what is left out is typical of its genus"}, s.layers);
  v.list({"sheet", "",
          "a thin layer of cloud by hand, drawn beside those of the weather, volumes and sheets alike"},
         s.sheets);
  v.list({"metaballs", "",
          "a cloud of metaballs by hand, among all others by its distance; covers are measured without it"},
         s.metaballs);
  v.list({"slab_column", "", "columns of a slab that is not homogeneous, from the west"}, s.slab.columns);
}

namespace {

void require(bool good, std::vector<std::string> keys, const std::string& problem) {
  if (!good) throw MisfitError(std::move(keys), problem);
}

// Of the first and the last picture, which at_s and speed may lead far from `time`.
void validateTimes(const Scene& s) {
  const double lastS = static_cast<double>(s.output.frames - 1) * s.output.speed / s.output.fps;
  const auto requireYear = [&](double afterS, std::vector<std::string> keys, const std::string& picture) {
    const UtcTime t = addSeconds(s.time, s.atS + afterS);
    require(t.year >= 1900 && t.year <= 2100, std::move(keys),
            picture + " is of " + formatUtcTime(t) + "; expected the years 1900 to 2100");
  };
  requireYear(0.0, {"at_s", "time"}, "the picture");
  requireYear(lastS, {"output.speed", "output.frames", "output.fps", "at_s", "time"}, "the last picture");
}

void validateSize(const Scene& s) {
  const std::int64_t w = s.output.width, h = s.output.height;
  const std::string size = std::to_string(w) + "x" + std::to_string(h);
  const std::vector<std::string> keys = {"output.width", "output.height", "camera.projection"};
  require(w * h <= kMaxPixels, keys,
          "size " + size + " has " + std::to_string(w * h) + " pixels; expected at most " +
              std::to_string(kMaxPixels));
  require(std::max(w, h) <= static_cast<std::int64_t>(kMaxSide), keys,
          "size " + size + " is too large; expected at most " + numberText(kMaxSide) + " pixels a side");
  const auto example = [h](int wide) {
    return std::to_string(wide * h) + "x" + std::to_string(h) + " for instance";
  };
  require(s.camera.projection != Projection::kCubemap || w == 6 * h, keys,
          "size " + size + " does not fit a cubemap; expected six square faces side by side, " + example(6));
  require(
      s.camera.projection != Projection::kEquirect || w == 2 * h, keys,
      "size " + size + " does not fit an equirect; expected a picture twice as wide as high, " + example(2));
}

// Not more than `most` elements in the list `key`, which are called so.
void requireAtMost(std::size_t most, std::size_t count, const std::string& key, const std::string& called) {
  require(count <= most, {key + "[" + std::to_string(most) + "]", key, "theme"},
          "there are " + std::to_string(count) + " " + called + "; expected at most " + std::to_string(most));
}

}  // namespace

void validate(const Scene& s) {
  validateSize(s);
  requireAtMost(weather::kMaxLayers, s.layers.size(), "layer", "layers");
  for (const weather::Layer& layer : s.layers) weather::validate(layer);
  requireAtMost(kMaxSheets, s.sheets.size(), "sheet", "sheets");
  for (const Sheet& sheet : s.sheets) validate(sheet);
  requireAtMost(kMaxMetaballs, s.metaballs.size(), "metaballs", "clouds of metaballs");
  for (std::size_t i = 0; i < s.metaballs.size(); ++i) {
    const MetaballCloud& cloud = s.metaballs[i];
    validate(cloud);
    const std::string key = "metaballs[" + std::to_string(i) + "].";
    const bool asDroplets = cloud.phase == MetaballPhase::kDroplets && cloud.albedo == 1.0;
    require(s.metaballsAs != MetaballRender::kVolume || asDroplets,
            {key + (cloud.phase != MetaballPhase::kDroplets ? "phase" : "albedo"), "metaballs_as"},
            "clouds of metaballs that are marched scatter all light as droplets do; expected phase droplets "
            "and albedo 1, or metaballs_as splats");
  }
  // Those that know more of what is wrong come before.
  if (const std::string problem = rangeProblemIn(s); !problem.empty()) throw ParameterError(problem);
  UtcTime minute = s.time;
  minute.second = 0.0;
  require(s.time.second >= 0.0 && s.time.second < 60.0 && addSeconds(minute, 0.0) == minute, {"time"},
          "time is no moment of the calendar; expected one such as 2026-06-21T18:30:00Z");
  validateTimes(s);
  validate(s.skyBox);
  validate(s.slab);
  require(s.output.flare <= 0.0 || s.camera.projection == Projection::kPerspective, {"output.flare"},
          "output.flare is a lens's; expected projection perspective");
}

bool drawsSheets(Technique technique) {
  return technique == Technique::kPlane || technique == Technique::kSkyPlane ||
         technique == Technique::kDome || technique == Technique::kOctaves;
}

Technique techniqueOf(const Scene& scene, const weather::Layer& layer) {
  if (layer.technique != Technique::kAuto) return layer.technique;
  // Only heaps are made of balls, unless a layer asks for them itself.
  using weather::Genus;
  const bool heaps = layer.genus == Genus::kCumulus || layer.genus == Genus::kStratocumulus ||
                     layer.genus == Genus::kCumulonimbus;
  return scene.technique == Technique::kMetaballs && !heaps ? Technique::kVolume : scene.technique;
}

bool isSheet(const Scene& scene, const weather::Layer& layer) {
  return drawsSheets(techniqueOf(scene, layer));
}

bool isMetaballs(const Scene& scene, const weather::Layer& layer) {
  return techniqueOf(scene, layer) == Technique::kMetaballs;
}

bool isVolume(const Scene& scene, const weather::Layer& layer) {
  return !isSheet(scene, layer) && !isMetaballs(scene, layer);
}

std::vector<Sheet> sheetsOf(const Scene& scene, const weather::Weather& weather) {
  std::vector<Sheet> sheets;
  for (const weather::Layer& layer : weather.layers) {
    const Technique technique = techniqueOf(scene, layer);
    if (!drawsSheets(technique)) continue;
    const SheetSurface surface = technique == Technique::kPlane  ? SheetSurface::kPlane
                                 : technique == Technique::kDome ? SheetSurface::kDome
                                                                 : SheetSurface::kSkyPlane;
    sheets.push_back(sheetOf(layer, surface));
    sheets.back().tier = scene.tier;
    if (technique == Technique::kOctaves) sheets.back() = withLivingOctaves(sheets.back(), scene.octaves);
  }
  sheets.insert(sheets.end(), scene.sheets.begin(), scene.sheets.end());
  if (scene.drift != Drift{})
    for (std::size_t i = 0; i < sheets.size(); ++i)
      sheets[i].drift = {scene.drift, windSeed(scene), hashOf(sheetSeed(scene, i), 0xc0e4)};
  return sheets;
}

std::uint64_t windSeed(const Scene& scene) {
  return hashOf(static_cast<std::uint64_t>(scene.seed), 0x714d);
}

std::uint64_t sheetSeed(const Scene& scene, std::size_t index) {
  return hashOf(static_cast<std::uint64_t>(scene.seed), 0x5ee7, index);
}

PictureSize naturalSize(Projection projection) {
  switch (projection) {
    case Projection::kFisheye:
      return {1024, 1024};
    case Projection::kEquirect:
      return {2048, 1024};
    case Projection::kCubemap:
      return {3072, 512};
    case Projection::kPerspective:
      break;
  }
  return {1280, 720};
}

void setNaturalSize(Scene& s, bool widthGiven, bool heightGiven) {
  const PictureSize natural = naturalSize(s.camera.projection);
  const bool wholeSky = s.camera.projection != Projection::kPerspective;
  const double shape = static_cast<double>(natural.width) / static_cast<double>(natural.height);
  std::int64_t &width = s.output.width, &height = s.output.height;
  if (!widthGiven)
    width = wholeSky && heightGiven ? std::llround(static_cast<double>(height) * shape) : natural.width;
  if (!heightGiven)
    height = wholeSky && widthGiven
                 ? std::max<std::int64_t>(std::llround(static_cast<double>(width) / shape), 1)
                 : natural.height;
}

}  // namespace welkin::scene
