// SPDX-License-Identifier: Apache-2.0
// Thin layers of cloud: a pattern of noise on a surface above the eye, for skies that must be drawn in no
// time. The surfaces are those of G. Tarantilis 2004, "Simulating Clouds with Procedural Texturing Techniques
// Using the GPU" (plane, dome), K. Pallister, "Generating Procedural Clouds Using 3D Hardware" (sky plane)
// and of the course project "Realistic Real-Time Skies" (hemisphere).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "welkin/core/image.h"
#include "welkin/core/params.h"
#include "welkin/field/condensation.h"
#include "welkin/field/noise_texture.h"
#include "welkin/scene/drift.h"
#include "welkin/scene/living_octaves.h"
#include "welkin/weather/weather.h"

namespace welkin::scene {

enum class SheetSurface {
  kPlane,       // a flat square that follows the eye and fades out at its rim
  kSkyPlane,    // the same bent down over the earth: reaches the horizon
  kDome,        // a dome about the eye that cuts through a volume of noise
  kHemisphere,  // half a sphere about the eye that a flat pattern is wrapped over, from the zenith down
};
// Whether its pattern is a volume.
constexpr bool hasVolume(SheetSurface surface) {
  return surface == SheetSurface::kDome;
}
// Whether it ends on the ground, so that no one height is its own; its shadows are a mean.
constexpr bool comesDown(SheetSurface surface) {
  return surface == SheetSurface::kDome || surface == SheetSurface::kHemisphere;
}

// How a sheet is lit, the cheapest first.
enum class SheetTier {
  kFlat,      // one light for all of it
  kEmbossed,  // bright where the pattern falls off towards the sun
  kLit,       // by its optical depth towards the sun
};

// Where the pattern of a sheet comes from.
enum class SheetPattern {
  kNoise,    // a fractal sum of gradient noise, the same at all times
  kOctaves,  // octaves that change over time (scene/living_pattern.h); not on a dome
};

struct Sheet {
  std::optional<std::string> preset;  // in scene files: what the other keys start from; empty once it is read
  SheetSurface surface = SheetSurface::kSkyPlane;
  SheetTier tier = SheetTier::kLit;
  double heightM = 1400.0;     // above the ground
  double thicknessM = 300.0;   // over which its optical depth is spread
  double tileM = 12000.0;      // after which the pattern repeats
  std::int64_t texels = 512;   // of the pattern, a side
  std::int64_t frequency = 6;  // cells of the first octave in a tile
  std::int64_t octaves = 8;
  double amplitude = 0.7;
  double persistence = 0.5;
  double cutoff = 0.6;          // of the pattern in [0, 1]
  std::optional<double> oktas;  // wins over cutoff: the cutoff at which so much of the sky is hidden
  // At most one of the two; neither: a density of CondensationParams::kDensity. A level, or a unit, of the
  // pattern lets this share of the light through that the one below it does.
  std::optional<double> density, exponent;
  double bias = 1.0;                   // the most that the sheet hides
  glm::dvec3 colour{1.0};              // share of light that its cloud scatters, linear Rec. 709
  glm::dvec3 offset{0.0};              // of the pattern, tiles east, north, up
  std::optional<std::string> texture;  // file that the pattern is in (sheet_texture.h)
  double windFromDeg = 270.0;
  double windSpeedMps = 8.0;
  double riseMps = 0.0;  // of the pattern through a dome: how fast its clouds form and go
  SheetPattern pattern = SheetPattern::kNoise;
  LivingOctaves living;  // of the pattern octaves
  SheetDrift drift;      // of the scene that it is in: sheetsOf() sets it

  bool operator==(const Sheet&) const = default;
};
void describe(Sheet& s, ParamVisitor& v);
void validate(const Sheet& s);  // throws ParameterError

// The thesis's layers and its dome, as large and with such noise as its textures have (field::thesisParams).
Sheet sheetOf(field::ThesisTexture preset);
// By its name in scene files. Throws ParameterError that names the nearest.
field::ThesisTexture sheetPreset(std::string_view name);

// A layer of weather as a sheet on this surface: its height, cover, optical depth, wind, and cells as large
// as its genus has them.
Sheet sheetOf(const weather::Layer& layer, SheetSurface surface);

// The same sheet with living octaves for its pattern, its clouds as large as they were.
Sheet withLivingOctaves(Sheet sheet, const LayerOctaves& octaves);

// Cells of the pattern's first octave in a tile: the frequency, but for the sources' kernels of living
// octaves.
std::int64_t cellsOf(const Sheet& sheet);

// The generated pattern, in [0, 1]: texels x texels, or for a dome a volume of texels a side, one channel.
// Tiles. `seed`: one pattern for each. Of living octaves: at the scene's time.
Image<float> flatPattern(const Sheet& sheet, std::uint64_t seed);
Volume<float> domePattern(const Sheet& sheet, std::uint64_t seed);

// The law by which a pattern of these values becomes cloud, its threshold such that `oktas` of it are cloud
// (of an optical depth of 0.3 or more, as observers count) where the sheet asks for that.
field::Condensation condensationOf(const Sheet& sheet, std::span<const float> pattern);

// That law `secondsAfter` the scene's time, as its cover drifts; the law itself where it does not.
field::Condensation lawAt(const Sheet& sheet, const field::Condensation& law,
                          const field::PatternQuantiles& pattern, double secondsAfter);

// Where the air of a sheet has gone to since the scene's time, east and north.
glm::dvec2 windPathM(const Sheet& sheet, double secondsAfter);

// Whether its cloud hides so little for each unit of the pattern that all of the pattern, gaps included,
// hides about as much.
bool isOneVeil(const Sheet& sheet);

// The share of the whole pattern, its file's where it has one, that is cloud to an observer: what it covers
// of the sky, but for chance.
double deliveredCover(const Sheet& sheet, std::uint64_t seed, double secondsAfter = 0.0);

}  // namespace welkin::scene

namespace welkin {
template <>
inline constexpr auto kEnumNames<scene::SheetSurface> =
    std::array<std::string_view, 4>{"plane", "skyplane", "dome", "hemisphere"};
template <>
inline constexpr auto kEnumNames<scene::SheetTier> =
    std::array<std::string_view, 3>{"flat", "embossed", "lit"};
template <>
inline constexpr auto kEnumNames<scene::SheetPattern> = std::array<std::string_view, 2>{"noise", "octaves"};
}  // namespace welkin
