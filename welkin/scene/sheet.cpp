// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/sheet.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/units.h"
#include "welkin/field/quantile.h"
#include "welkin/noise/noise.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/living_pattern.h"
#include "welkin/scene/param_text.h"
#include "welkin/scene/sheet_texture.h"

namespace welkin::scene {
namespace {

constexpr double kMaxDomeTexels = 256;

noise::NoiseParams noiseOf(const Sheet& sheet, std::uint64_t seed) {
  const bool volume = hasVolume(sheet.surface);
  noise::NoiseParams p;
  p.dimensions = volume ? 3 : 2;
  p.frequency = glm::dvec3(static_cast<double>(sheet.frequency));
  p.octaves = sheet.octaves;
  p.amplitude = sheet.amplitude;
  p.persistence = sheet.persistence;
  p.normalisation = noise::Normalisation::kThesis;
  p.seed = static_cast<std::int64_t>(seed >> 11);  // described seeds have 53 bits
  return p;
}

}  // namespace

void describe(Sheet& s, ParamVisitor& v) {
  v.value({"preset", "",
           "what the keys below start from: thesis-overcast, thesis-broken, thesis-few or thesis-dome"},
          s.preset);
  v.choice({"surface", "",
            "plane: a flat square about the eye; skyplane: bent over the earth, to the horizon; dome: cuts "
            "through a volume of noise; hemisphere: half a sphere, as high as wide, which the pattern is "
            "wrapped over from the zenith"},
           s.surface);
  v.choice({"tier", "",
            "how it is lit: flat, embossed by the pattern's slope, or lit by its depth towards the sun"},
           s.tier);
  v.value({"height_m", "m", "height above the ground; a hemisphere's radius", 10, 25000}, s.heightM);
  v.value({"thickness_m", "m", "depth over which its optical depth is spread", 1, 10000}, s.thicknessM);
  v.value({"texture", "",
           "file of the pattern, beside the scene file: a picture, for a dome a volume; absent: it is "
           "generated from the keys below"},
          s.texture);
  v.value({"tile_m", "m", "after which the pattern repeats", 100, 500000}, s.tileM);
  v.value({"offset", "", "of the pattern, tiles east, north and, in a dome, up", -1000, 1000}, s.offset);
  v.value({"texels", "", "of the pattern, a side; a dome has at most 256, and 128 unless told", 16, 4096},
          s.texels);
  v.value({"frequency", "", "cells of the first octave in a tile", 1, 512}, s.frequency);
  v.value({"octaves", "", "of the pattern", 1, 16}, s.octaves);
  v.value({"amplitude", "", "of the first octave", 0.01, 4}, s.amplitude);
  v.value({"persistence", "", "amplitude of an octave over that of the one before", 0.01, 1}, s.persistence);
  v.value({"cutoff", "", "value of the pattern above which it is cloud", 0, 1}, s.cutoff);
  v.value({"oktas", "okta", "eighths of the sheet that are cloud; wins over cutoff", 0, 8}, s.oktas);
  v.value({"density", "",
           "share of light that each of 255 levels of the pattern above the cutoff lets through; absent: "
           "0.96, unless there is an exponent",
           0.01, 0.9999},
          s.density);
  v.value({"exponent", "",
           "the same of the whole range of the pattern, for density is its 255th root; not beside a density",
           1e-100, 0.9999},
          s.exponent);
  v.value({"bias", "", "the most that the sheet hides", 0, 1}, s.bias);
  v.value({"colour", "", "tint of its cloud, linear Rec. 709 red, green, blue; what it hides stays", 0, 4},
          s.colour);
  v.value({"wind_from_deg", "deg", "direction its wind comes from, clockwise from north", 0, 360},
          s.windFromDeg);
  v.value({"wind_speed_mps", "m/s", "speed of its wind", 0, 150}, s.windSpeedMps);
  v.value({"rise_mps", "m/s", "speed of the pattern up through a dome, which forms and dissolves its clouds",
           -50, 50},
          s.riseMps);
  v.choice(
      {"pattern", "",
       "noise: the same at all times; octaves: living ones, which change; not on a dome, at most 8 of them "
       "with 1024 texels and a frequency of 32"},
      s.pattern);
  describe(s.living, v);
}

namespace {

// What living octaves cannot do.
void validateLiving(const Sheet& s) {
  const auto require = [](bool good, const std::string& problem) {
    if (!good) throw ParameterError("living octaves: " + problem);
  };
  require(!hasVolume(s.surface),
          "a dome needs a volume of noise; expected surface plane, skyplane or hemisphere, or pattern noise");
  require(s.texels <= kMaxLivingTexels,
          "texels is " + std::to_string(s.texels) + "; expected at most " + std::to_string(kMaxLivingTexels));
  require(s.octaves <= kMaxLivingOctaves, "octaves is " + std::to_string(s.octaves) + "; expected at most " +
                                              std::to_string(kMaxLivingOctaves));
  require(s.living.kernel != OctaveKernel::kGradient || s.frequency <= kMaxLivingFrequency,
          "frequency is " + std::to_string(s.frequency) + "; expected at most " +
              std::to_string(kMaxLivingFrequency));
}

}  // namespace

void validate(const Sheet& s) {
  if (s.density && s.exponent)
    throw ParameterError("density and exponent both say how fast a sheet thickens; expected one of them");
  if (hasVolume(s.surface) && s.texels > kMaxDomeTexels)
    throw ParameterError("a dome's pattern of " + std::to_string(s.texels) +
                         " texels a side is too large; expected at most " +
                         std::to_string(static_cast<int>(kMaxDomeTexels)));
  if (s.pattern == SheetPattern::kOctaves) validateLiving(s);
}

Sheet sheetOf(field::ThesisTexture preset) {
  const field::TextureParams texture = field::thesisParams(preset);
  Sheet s;
  s.texels = field::thesisSize(preset).x;
  s.octaves = texture.noise.octaves;
  s.frequency = std::llround(texture.noise.frequency.x);
  s.amplitude = texture.noise.amplitude;
  s.persistence = texture.noise.persistence;
  s.cutoff = texture.cloud.cutoff.value_or(0.7);  // the dome's texture is bare noise
  s.density = texture.cloud.density;
  switch (preset) {
    case field::ThesisTexture::kOvercast:
      s.heightM = 1400.0;
      break;
    case field::ThesisTexture::kBroken:
      s.heightM = 1200.0;
      break;
    case field::ThesisTexture::kFew:
      s.heightM = 900.0;
      break;
    case field::ThesisTexture::kDome:
      s.surface = SheetSurface::kDome;
      s.riseMps = 2.0;
      break;
  }
  return s;
}

field::ThesisTexture sheetPreset(std::string_view name) {
  const auto& names = kEnumNames<field::ThesisTexture>;
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) throw ParameterError(choiceProblem({"preset", "", ""}, names, name));
  return static_cast<field::ThesisTexture>(it - names.begin());
}

Sheet sheetOf(const weather::Layer& layer, SheetSurface surface) {
  const field::CloudLayer shape = shapeOf(layer, 0, 0.0);
  Sheet s;
  s.surface = surface;
  s.heightM = 0.7 * layer.baseM + 0.3 * layer.topM;  // where most of a cloud's body is
  s.thicknessM = layer.topM - layer.baseM;
  // Two periods of the layer's own pattern, each a dozen cells.
  s.tileM = std::clamp(2.0 * static_cast<double>(shape.cellM), 100.0, 500000.0);
  s.frequency = 24;
  s.texels = 1024;
  s.octaves = 6;
  s.amplitude = 0.5;  // never clamped
  if (hasVolume(surface)) {
    // A quarter of that, as a volume of noise has few texels a side.
    s.tileM *= 0.25;
    s.texels = 128;
    s.frequency = 6;
    s.octaves = 5;
  }
  s.oktas = layer.oktas;
  // A cloud's optical depth, on average, where its pattern exceeds the cutoff by a tenth.
  const double depth = 0.4 * layer.extinctionPerM * (layer.topM - layer.baseM);
  s.density = std::clamp(std::exp(-depth / (0.1 * 255.0)), 0.01, 0.9999);
  s.windFromDeg = layer.windFromDeg;
  s.windSpeedMps = layer.windSpeedMps;
  return s;
}

std::int64_t cellsOf(const Sheet& sheet) {
  constexpr std::int64_t kSourceCells = 32;  // of both sources
  const bool own = sheet.pattern != SheetPattern::kOctaves || sheet.living.kernel == OctaveKernel::kGradient;
  return own ? sheet.frequency : kSourceCells;
}

Sheet withLivingOctaves(Sheet sheet, const LayerOctaves& octaves) {
  // Fewer cells in a tile, as its texels are fewer as well.
  constexpr std::int64_t kCells = 16;
  const double cellM = sheet.tileM / static_cast<double>(sheet.frequency);
  sheet.frequency = kCells;
  sheet.pattern = SheetPattern::kOctaves;
  sheet.living = octaves.living;
  sheet.texels = octaves.resolution;
  sheet.octaves = octaves.count;
  sheet.tileM = std::clamp(cellM * static_cast<double>(cellsOf(sheet)), 100.0, 500000.0);
  return sheet;
}

Image<float> flatPattern(const Sheet& sheet, std::uint64_t seed) {
  const int n = static_cast<int>(sheet.texels);
  if (sheet.pattern == SheetPattern::kOctaves) return LivingPattern(sheet, seed).image(0.0, n);
  Image<float> pattern(n, n, 1);
  noise::Noise(noiseOf(sheet, seed)).fill(noise::Grid::tile({n, n, 1}), std::span(pattern.data));
  return pattern;
}

Volume<float> domePattern(const Sheet& sheet, std::uint64_t seed) {
  const int n = static_cast<int>(sheet.texels);
  Volume<float> pattern(n, n, n, 1);
  noise::Noise(noiseOf(sheet, seed)).fill(noise::Grid::tile({n, n, n}), std::span(pattern.data));
  return pattern;
}

namespace {

// What observers call cloud hides at least that.
const double kVisible = -std::expm1(-kCoverDepth);

// The least excess over the threshold that observers call cloud. Whoever asks for a sheet that hides less
// than that gets what it has above the threshold.
double visibleExcess(const field::Condensation& law) {
  return law.bias > kVisible ? law.excessOf(kVisible) : 0.0;
}

// The law but for the threshold of a sheet with oktas.
field::Condensation lawOf(const Sheet& sheet) {
  const double density = sheet.density.value_or(field::CondensationParams::kDensity);
  field::Condensation law = sheet.exponent ? field::thesisShader(sheet.cutoff, *sheet.exponent, 1.0)
                                           : field::thesisTexture(sheet.cutoff, density);
  law.bias = sheet.bias;
  return law;
}

// The share of a pattern that exceeds a value.
double shareAbove(const field::PatternQuantiles& pattern, double value) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (pattern.above(middle) > value ? low : high) = middle;
  }
  return low;
}

}  // namespace

field::Condensation condensationOf(const Sheet& sheet, std::span<const float> pattern) {
  field::Condensation law = lawOf(sheet);
  if (!sheet.oktas) return law;
  if (*sheet.oktas <= 0.0) {
    law.threshold = 1.0;  // many texels may have the greatest value: not even they
    return law;
  }
  law.threshold = field::quantileAbove(pattern, *sheet.oktas / kOktas) - visibleExcess(law);
  return law;
}

field::Condensation lawAt(const Sheet& sheet, const field::Condensation& law,
                          const field::PatternQuantiles& pattern, double secondsAfter) {
  if (sheet.drift.drift.coverOktas == 0.0) return law;
  // By differences of the table's values, so that the law is the described one where the drift is nought.
  const double excess = visibleExcess(law);
  const bool never = sheet.oktas && *sheet.oktas <= 0.0;
  const double described = never ? 0.0 : shareAbove(pattern, law.threshold + excess);
  const double oktas = oktasAt(sheet.drift.drift, sheet.drift.coverSeed, kOktas * described, secondsAfter);
  if (never && oktas <= 0.0) return law;
  field::Condensation now = law;
  now.threshold = pattern.above(oktas / kOktas) - excess;
  if (!never) now.threshold += law.threshold + excess - pattern.above(described);
  return now;
}

glm::dvec2 windPathM(const Sheet& sheet, double secondsAfter) {
  return sheet.windSpeedMps *
         windPath(sheet.drift.drift, sheet.drift.windSeed, sheet.windFromDeg, secondsAfter);
}

bool isOneVeil(const Sheet& sheet) {
  return visibleExcess(lawOf(sheet)) >= 1.0;
}

double deliveredCover(const Sheet& sheet, std::uint64_t seed, double secondsAfter) {
  if (sheet.bias <= kVisible) return 0.0;
  // The law goes by the described pattern; what is counted is the one of the instant.
  std::vector<float> described, shown;
  if (sheet.pattern == SheetPattern::kOctaves) {
    const LivingPattern living(sheet, seed);
    described = living.samples();
    shown = living.image(living.shown(secondsAfter), static_cast<int>(sheet.texels)).data;
  } else {
    const PatternTexels texels = patternOf(sheet, seed);
    shown.assign(texels.values().begin(), texels.values().end());
  }
  const std::span<const float> values = described.empty() ? shown : described;
  field::Condensation law = condensationOf(sheet, values);
  if (sheet.drift.drift.coverOktas != 0.0)
    law = lawAt(sheet, law, field::PatternQuantiles(values), secondsAfter);
  const double excess = visibleExcess(law);
  // Rounded down, as the texel that is just visible counts.
  const double least = law.threshold + (1.0 - 1e-6) * excess;
  const auto count = std::count_if(shown.begin(), shown.end(),
                                   [&](float p) { return excess > 0.0 ? p >= least : p > least; });
  return static_cast<double>(count) / static_cast<double>(shown.size());
}

}  // namespace welkin::scene
