// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/metaball_motion.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/random.h"

namespace welkin::field {
namespace {

constexpr double kLifeSpread = 0.3;
constexpr double kLeastVolume = 1e-9;  // of a ball: below it there is none

// Up from 0 to 1 in the first `fade` of a life, down in the last, its mean 1.
double volumeAt(double age, double fade) {
  const double edge = std::min(age, 1.0 - age);
  const double t = fade > 0.0 ? std::clamp(edge / fade, 0.0, 1.0) : 1.0;
  return t * t * (3.0 - 2.0 * t) / (1.0 - fade);
}

}  // namespace

std::vector<Metaball> ballsAt(std::span<const Metaball> balls, const MetaballMotion& motion, double timeS) {
  std::vector<Metaball> moved(balls.begin(), balls.end());
  move(moved, motion, timeS);
  return moved;
}

void move(std::span<Metaball> balls, const MetaballMotion& motion, double timeS) {
  for (std::size_t i = 0; i < balls.size(); ++i) {
    Metaball& b = balls[i];
    const double height = b.centreM.z - motion.referenceM;
    b.centreM += timeS * motion.windMps;
    if (motion.lifeS <= 0.0) continue;
    Random random(hashOf(static_cast<std::uint64_t>(motion.seed), 0x6d657461, i));
    const double life = motion.lifeS * (1.0 + kLifeSpread * (2.0 * random.uniform() - 1.0));
    const double lives = timeS / life + random.uniform();
    const double age = lives - std::floor(lives);
    b.centreM += (age - 0.5) * life * height * motion.shearPerS;
    const double volume = volumeAt(age, motion.fade);
    if (volume < kLeastVolume) b.density = 0.0;
    b.radiusM *= std::cbrt(std::max(volume, kLeastVolume));
  }
}

}  // namespace welkin::field
