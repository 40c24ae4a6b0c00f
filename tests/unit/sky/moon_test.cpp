// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "welkin/core/glsl.h"
#include "welkin/core/units.h"
#include "welkin/sky/light.h"

namespace welkin::sky {
namespace {

namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/moon.glsl"
}  // namespace shared

glm::vec2 phaseOf(double angleDeg) {
  return shared::moonPhase(static_cast<float>(std::cos(radians(angleDeg))));
}

// Luminance at a place of the disc as Lommel and Seeliger have it, from the cosines themselves.
double luminanceAt(double x, double y, double angleDeg) {
  const double mu2 = 1.0 - x * x - y * y;
  if (mu2 <= 0.0) return 0.0;
  const double mu = std::sqrt(mu2), a = radians(angleDeg);
  const double mu0 = std::max(x * std::sin(a) + mu * std::cos(a), 0.0);
  return 2.0 * mu0 / (mu0 + mu);
}

TEST(Moon, FullHalfAndNewDisc) {
  EXPECT_NEAR(moonDiscMean(0.0), 1.0, 2e-4);
  EXPECT_NEAR(moonDiscMean(radians(90.0)), 0.3768, 2e-4);
  EXPECT_NEAR(moonDiscMean(radians(180.0)), 1e-4, 2e-5);
}

// The closed form of the integral over the disc: e.g. J. W. Chamberlain and D. M. Hunten 1987, "Theory of
// Planetary Atmospheres".
TEST(Moon, MeanOverTheDiscIsThePhaseFunctionsClosedForm) {
  for (double angle = 0.5; angle < 176.0; angle += 2.5) {
    const double half = radians(0.5 * angle);
    const double closed = 1.0 - std::sin(half) * std::tan(half) * std::log(1.0 / std::tan(0.5 * half));
    EXPECT_NEAR(moonDiscMean(radians(angle)) / (closed + 1e-4), 1.0, 2e-3) << angle;
  }
}

TEST(Moon, SquaresAreMeansOfTheLuminance) {
  constexpr int kSamples = 400;
  constexpr double kWidth = 0.2;
  for (const double angle : {1.0, 60.0, 90.0, 140.0})
    for (const glm::dvec2 at :
         {glm::dvec2(0.0, 0.0), {0.5, 0.3}, {-0.6, -0.2}, {0.93, 0.0}, {0.6, -0.75}, {1.05, 0.1}}) {
      double sum = 0.0;
      for (int i = 0; i < kSamples; ++i)
        for (int j = 0; j < kSamples; ++j)
          sum += luminanceAt(at.x + kWidth * ((i + 0.5) / kSamples - 0.5),
                             at.y + kWidth * ((j + 0.5) / kSamples - 0.5), angle);
      const float drawn = shared::moonSquare(glm::vec2(at), static_cast<float>(kWidth), phaseOf(angle));
      EXPECT_NEAR(drawn, sum / kSamples / kSamples, 0.015) << angle << ": " << at.x << ", " << at.y;
    }
}

// A picture's pixels together have the disc's light in the mean of their places, thin crescents too.
TEST(Moon, PixelsHoldTheLightOfAnyPhase) {
  constexpr int kPlaces = 4;
  for (const double angle : {1.0, 45.0, 90.0, 135.0, 165.0})
    for (const double pixels : {2.0, 3.7, 9.0})
      for (const double turn : {0.0, 20.0, 45.0}) {
        const double c = std::cos(radians(turn)), s = std::sin(radians(turn)), width = 1.0 / pixels;
        double sum = 0.0;
        for (int i = -12 * kPlaces; i <= 12 * kPlaces; ++i)
          for (int j = -12 * kPlaces; j <= 12 * kPlaces; ++j) {
            const double x = (i + 0.3) * width / kPlaces, y = (j + 0.1) * width / kPlaces;
            sum += static_cast<double>(shared::moonSquare(glm::vec2(glm::dvec2(c * x + s * y, c * y - s * x)),
                                                          static_cast<float>(width), phaseOf(angle)));
          }
        const double mean = sum * width * width / (kPlaces * kPlaces) / kPi;
        EXPECT_NEAR(mean / moonDiscMean(radians(angle)), 1.0, 0.02)
            << angle << ", " << pixels << ", " << turn;
      }
}

}  // namespace
}  // namespace welkin::sky
