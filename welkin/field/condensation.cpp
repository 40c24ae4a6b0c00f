// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/condensation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "welkin/core/error.h"

namespace welkin::field {
namespace {

constexpr double kLevels = 255.0;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// So thin that 1 - exp(-k x) is k x to a part in 10^9.
constexpr double kThin = 1e-9;

}  // namespace

double Condensation::opacity(double noise) const {
  const double excess = noise - threshold;
  if (!(excess > 0.0)) return 0.0;
  return std::clamp(bias * -std::expm1(-k * excess), 0.0, 1.0);
}

double Condensation::excessOf(double wanted) const {
  if (wanted <= 0.0) return 0.0;
  if (wanted > bias || k == 0.0) return kInfinity;
  if (std::isinf(k)) return 0.0;
  return -std::log1p(-wanted / bias) / k;
}

void Condensation::apply(std::span<float> noise) const {
  const auto rate = static_cast<float>(-k), most = static_cast<float>(bias);
  for (float& n : noise) {
    // Subtracted in double: near the threshold the excess is small beside both.
    const double excess = static_cast<double>(n) - threshold;
    n = excess > 0.0 ? std::min(most * -std::expm1(rate * static_cast<float>(excess)), 1.0f) : 0.0f;
  }
}

Condensation thesisTexture(double cutoff, double density) {
  return {cutoff, -kLevels * std::log(density), 1.0};
}

Condensation thesisShader(double cutoff, double exponent, double bias) {
  return {cutoff, -std::log(exponent), bias};
}

Condensation realisticSkies(double cover, double sharpness) {
  return {1.0 - cover, -kLevels * std::log1p(-sharpness), 1.0};
}

Condensation pallister(double subtract, double scale) {
  return {subtract, kThin, scale / kThin};
}

void describe(CondensationParams& p, ParamVisitor& v) {
  v.value({"cutoff", "", "noise below this is clear air", 0, 1}, p.cutoff);
  v.value({"cover", "",
           "fraction of the samples that become cloud, measured on this noise, in place of a cutoff", 0, 1},
          p.cover);
  v.value(
      {"density", "",
       "clear light left by one 8-bit level above the cutoff: opacity 1 - density^levels (0.96 unless told)",
       0, 1},
      p.density);
  v.value({"exponent", "", "the same by the whole range of noise: opacity 1 - exponent^excess", 0, 1},
          p.exponent);
  v.value({"sharpness", "", "the same as density: 1 - density", 0, 1}, p.sharpness);
  v.value({"scale", "", "opacity proportional to the excess, this much for the whole range", 0, 1e6},
          p.scale);
  v.value({"bias", "", "factor of the opacity", 0, 100}, p.bias);
}

void validate(const CondensationParams& p) {
  if (p.cutoff && p.cover)
    throw ParameterError("cutoff and cover both say where cloud begins; expected one of them");
  const std::pair<const char*, bool> rates[] = {{"density", p.density.has_value()},
                                                {"exponent", p.exponent.has_value()},
                                                {"sharpness", p.sharpness.has_value()},
                                                {"scale", p.scale.has_value()}};
  const char* given = nullptr;
  for (const auto& [name, has] : rates) {
    if (!has) continue;
    if (given != nullptr)
      throw ParameterError(std::string(given) + " and " + name +
                           " both say how fast cloud thickens; expected one of them");
    given = name;
  }
  if (p.condenses()) return;
  if (p.bias != 1.0) given = "bias";
  if (given != nullptr)
    throw ParameterError(std::string(given) +
                         " belongs to noise that condenses; expected a cutoff or a cover");
}

Condensation lawOf(const CondensationParams& p) {
  const double cutoff = p.cutoff.value_or(0.0);
  Condensation law = p.exponent    ? thesisShader(cutoff, *p.exponent, 1.0)
                     : p.sharpness ? realisticSkies(1.0 - cutoff, *p.sharpness)
                     : p.scale     ? pallister(cutoff, *p.scale)
                                   : thesisTexture(cutoff, p.density.value_or(CondensationParams::kDensity));
  law.threshold = cutoff;  // exactly, whichever way it came
  law.bias *= p.bias;
  return law;
}

Condensation withCover(Condensation law, double quantile, double visible) {
  const double excess = law.excessOf(visible);
  if (std::isinf(excess))
    throw ParameterError(
        "cloud never gets as opaque as one step of the file's values; expected a smaller density or "
        "exponent, "
        "or a greater sharpness, scale or bias");
  law.threshold = quantile;
  if (excess == 0.0) return law;
  // Half a float higher: samples that are the quantile are not above it.
  const auto at = static_cast<float>(quantile);
  const double next = std::nextafter(at, std::numeric_limits<float>::infinity());
  law.threshold += 0.5 * (next - static_cast<double>(at)) - excess;
  return law;
}

void describe(ToneCurve& c, ParamVisitor& v) {
  v.value({"in_low", "", "noise that becomes out_low", -100, 100}, c.inLow);
  v.value({"in_high", "", "noise that becomes out_high", -100, 100}, c.inHigh);
  v.value({"gamma", "", "power to which the noise between is raised; above 1 darkens the middle", 0.01, 100},
          c.gamma);
  v.value({"out_low", "", "what the least noise becomes", -100, 100}, c.outLow);
  v.value({"out_high", "", "what the greatest noise becomes", -100, 100}, c.outHigh);
}

void validate(const ToneCurve& c) {
  if (c.inLow == c.inHigh)
    throw ParameterError("in_low and in_high are equal; expected two different values");
}

double ToneCurve::operator()(double noise) const {
  const double t = std::clamp((noise - inLow) / (inHigh - inLow), 0.0, 1.0);
  return outLow + (outHigh - outLow) * (gamma == 1.0 ? t : std::pow(t, gamma));
}

void ToneCurve::apply(std::span<float> noise) const {
  if (*this == ToneCurve{}) {
    for (float& n : noise) n = std::clamp(n, 0.0f, 1.0f);
    return;
  }
  for (float& n : noise) n = static_cast<float>((*this)(n));
}

}  // namespace welkin::field
