// SPDX-License-Identifier: Apache-2.0
// The formulas of shaders/lib/atmosphere.glsl: geometry, parametrisations, transmittance, energy.
#include "welkin/sky/atmosphere.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "welkin/core/parallel.h"
#include "welkin/core/units.h"
#include "welkin/sky/atmosphere_glsl.h"

namespace welkin::sky {
namespace {

using shared::vec2;
using shared::vec3;

constexpr double kClearVisibilityM = 40e3;

const Atmosphere& clearAir() {
  static const Atmosphere air(AtmosphereParams{}, kClearVisibilityM, 0.0, glm::vec3(0.2f));
  return air;
}
double luminance(const glm::vec3& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

TEST(AtmosphereGeometry, AltitudesAlongRaysKeepMillimetres) {
  const shared::Atmosphere a = shared::fromUniforms(clearAir().uniforms());
  for (double h : {2.0, 1500.0, 20000.0}) {
    for (double mu : {-1.0, -0.01, 0.0, 0.001, 0.3, 1.0}) {
      for (double t : {1.0, 100.0, 10000.0, 300000.0}) {
        const double r = kEarthRadiusM + h;
        const double expected = std::sqrt(r * r + 2 * r * mu * t + t * t) - kEarthRadiusM;
        const float got = shared::atmosphereAltitudeAlong(a, static_cast<float>(h), static_cast<float>(mu),
                                                          static_cast<float>(t));
        EXPECT_NEAR(got, expected, 1e-3 + 2e-7 * (std::abs(expected) + t)) << h << " " << mu << " " << t;
      }
    }
  }
}

TEST(AtmosphereGeometry, RaysMeetSpheresWhereTheySay) {
  const shared::Atmosphere a = shared::fromUniforms(clearAir().uniforms());
  for (float h : {0.0f, 2.0f, 3000.0f, 50000.0f}) {
    for (float mu : {-1.0f, -0.3f, -0.02f, 0.0f, 0.02f, 0.5f, 1.0f}) {
      const float t = shared::atmosphereDistanceToSphere(a, h, mu, a.topAltitudeM);
      EXPECT_NEAR(shared::atmosphereAltitudeAlong(a, h, mu, t), a.topAltitudeM, 2.0f) << h << " " << mu;
      const float g = shared::atmosphereDistanceToGround(a, h, mu);
      if (g >= 0.0f) {
        EXPECT_NEAR(shared::atmosphereAltitudeAlong(a, h, mu, g), 0.0f, 0.1f) << h << " " << mu;
      } else {
        EXPECT_GE(mu, shared::atmosphereHorizonMu(a, h) - 1e-6f);
      }
    }
  }
  // The horizon of an eye at 2 m is 5 km away and 2.7 arc minutes down.
  EXPECT_NEAR(shared::atmosphereHorizonMu(a, 2.0f), -7.924e-4f, 1e-6f);
}

TEST(AtmosphereTables, ParametrisationsAreInverse) {
  const shared::Atmosphere a = shared::fromUniforms(clearAir().uniforms());
  for (float y : {0.0f, 0.1f, 0.5f, 0.97f}) {
    for (float x : {0.0f, 0.03f, 0.4f, 0.9f, 1.0f}) {
      const vec2 p = shared::atmosphereTransmittanceParameters(a, x, y);
      const vec2 uv = shared::atmosphereTransmittanceUv(a, p.x, p.y);
      EXPECT_NEAR((uv.x * 256.0f - 0.5f) / 255.0f, x, 3e-3f);
      EXPECT_NEAR((uv.y * 64.0f - 0.5f) / 63.0f, y, 1e-4f);
      const vec2 m = shared::atmosphereMultipleScatteringParameters(a, x, y);
      const vec2 muv = shared::atmosphereMultipleScatteringUv(a, m.x, m.y);
      EXPECT_NEAR((muv.x * 32.0f - 0.5f) / 31.0f, x, 1e-4f);
      EXPECT_NEAR((3.0f * muv.y * 32.0f - 0.5f) / 31.0f, y, 1e-4f);
      EXPECT_NEAR(shared::atmosphereAzimuthToX(shared::atmosphereXToAzimuth(x)), x, 1e-5f);
      EXPECT_NEAR(shared::atmosphereDistanceToZ(shared::atmosphereZToDistance(x)), x, 1e-5f);
    }
  }
  for (float horizon : {0.0f, -0.06f}) {
    for (float y : {-1.0f, -0.4f, -0.05f, 0.05f, 0.6f, 1.0f}) {
      EXPECT_NEAR(shared::atmosphereMuToY(shared::atmosphereYToMu(y, horizon), horizon), y, 2e-3f) << horizon;
    }
  }
}

TEST(AtmosphereTables, DirectionsAndAzimuthsAreInverse) {
  const vec3 light = glm::normalize(vec3(0.3f, -0.8f, 0.2f));
  for (float azimuth : {-3.0f, -1.0f, 0.0f, 0.5f, 2.5f}) {
    const vec3 d = shared::atmosphereDirection(0.4f, azimuth, light);
    EXPECT_NEAR(glm::length(d), 1.0f, 1e-6f);
    EXPECT_NEAR(shared::atmosphereAzimuth(d, light), azimuth, 1e-5f);
  }
}

// The table against a fine integral in double precision of the same medium.
TEST(Transmittance, MatchesAFineIntegral) {
  const AtmosphereUniforms& u = clearAir().uniforms();
  for (double h : {0.0, 300.0, 5000.0, 12000.0, 40000.0}) {
    const double horizon = -std::sqrt(1.0 - std::pow(kEarthRadiusM / (kEarthRadiusM + h), 2));
    for (double mu : {1.0, 0.5, 0.2, 0.1, 0.03, horizon + 0.012}) {
      const double r = kEarthRadiusM + h, top = kEarthRadiusM + u.topAltitudeM;
      const double length = -r * mu + std::sqrt(r * r * (mu * mu - 1) + top * top);
      glm::dvec3 depth(0);
      constexpr int kSteps = 20000;
      for (int i = 0; i < kSteps; ++i) {
        const double t = length * (i + 0.5) / kSteps;
        const double ht = std::sqrt(r * r + 2 * r * mu * t + t * t) - kEarthRadiusM;
        const double ozone = std::max(1.0 - std::abs(ht - u.ozoneAltitudeM) / u.ozoneHalfWidthM, 0.0);
        depth += (glm::dvec3(u.rayleighScattering) * std::exp(-ht / u.rayleighScaleHeightM) +
                  glm::dvec3(u.aerosolExtinction) * std::exp(-ht / u.aerosolScaleHeightM) +
                  glm::dvec3(u.ozoneAbsorption) * ozone) *
                 (length / kSteps);
      }
      const glm::vec3 got = clearAir().transmittanceToSpace(h, mu);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(got[c], std::exp(-depth[c]), 0.004) << h << " " << mu << " " << c;
    }
  }
}

// ASTM G173-03, direct normal over extraterrestrial at air mass 1.5: 0.6226, 0.7326, 0.8060 at 450, 550, 650
// nm, for an aerosol optical depth of 0.084 at 500 nm. The primaries are wide bands around there.
TEST(Transmittance, AgreesWithAstmG173) {
  AtmosphereParams p;
  AtmosphereUniforms u = atmosphereUniforms(p, kClearVisibilityM, 0.0, glm::vec3(0.2f));
  const double wanted = 0.084 * std::pow(550.0 / 500.0, -1.3);
  u.aerosolExtinction *= static_cast<float>(wanted / (u.aerosolExtinction.y * u.aerosolScaleHeightM));
  const glm::vec3 t = Atmosphere(u).transmittanceToSpace(0.0, 1.0 / 1.5);
  EXPECT_NEAR(t.x, 0.806, 0.035);
  EXPECT_NEAR(t.y, 0.7326, 0.025);
  EXPECT_NEAR(t.z, 0.6226, 0.035);
}

// What hazy air does to white light that is scattered many times: dust takes blue away, ash a little, smoke
// reddens what goes straight.
TEST(AtmosphereUniforms, DustIsOchreAndSmokeReddens) {
  const auto of = [](Aerosol aerosol) {
    AtmosphereParams p;
    p.aerosol = aerosol;
    return atmosphereUniforms(p, 800.0, 0.0, glm::vec3(0.2f));
  };
  const auto albedo = [](const AtmosphereUniforms& u) { return u.aerosolScattering / u.aerosolExtinction; };
  const AtmosphereUniforms haze = of(Aerosol::kHaze), dust = of(Aerosol::kDust), smoke = of(Aerosol::kSmoke),
                           ash = of(Aerosol::kAsh);
  EXPECT_EQ(of(Aerosol::kAuto).aerosolScattering, haze.aerosolScattering);
  EXPECT_NEAR(albedo(dust).x, 0.96f, 1e-4f);
  EXPECT_NEAR(albedo(dust).z, 0.92f, 1e-4f);
  EXPECT_GT(albedo(dust).x - albedo(dust).z, albedo(ash).x - albedo(ash).z);
  EXPECT_GT(smoke.aerosolExtinction.z, 1.6f * smoke.aerosolExtinction.x);
  EXPECT_LT(dust.aerosolExtinction.z, 1.1f * dust.aerosolExtinction.x);
  // Visibility is what it is, of whatever; what the wind has raised is deeper.
  for (const AtmosphereUniforms& u : {dust, smoke, ash})
    EXPECT_NEAR(u.aerosolExtinction.y, haze.aerosolExtinction.y, 0.02f * haze.aerosolExtinction.y);
  EXPECT_GT(dust.aerosolScaleHeightM, 1.5f * haze.aerosolScaleHeightM);
}

// Air mass of pure air by F. Kasten and A. T. Young 1989 at zenith distances 60, 80, 85 (the table's geometry
// is straight rays).
TEST(Transmittance, AirMassFollowsKastenAndYoung) {
  AtmosphereUniforms u = atmosphereUniforms({}, kClearVisibilityM, 0.0, glm::vec3(0.2f));
  u.aerosolExtinction = u.ozoneAbsorption = glm::vec3(0.0f);
  u.rayleighScattering *= 0.2f;  // so that the long paths keep digits
  const Atmosphere air(u);
  const double zenith = std::log(air.transmittanceToSpace(0.0, 1.0).z);
  for (auto [zenithDeg, mass] : {std::pair{60.0, 1.994}, {80.0, 5.59}, {85.0, 10.3}}) {
    EXPECT_NEAR(std::log(air.transmittanceToSpace(0.0, std::cos(radians(zenithDeg))).z) / zenith, mass,
                0.03 * mass);
  }
}

TEST(Transmittance, EarthHidesTheLightSmoothly) {
  const Atmosphere& air = clearAir();
  EXPECT_EQ(air.transmittanceToSpace(0.0, -0.02), glm::vec3(0.0f));
  // From 10 km the horizon is 3.2 degrees down: a sun 2.5 degrees under the horizontal still shines, at 4
  // degrees it is gone.
  const glm::vec3 low = air.transmittanceToSpace(10000.0, std::sin(radians(-1.5)));
  EXPECT_GT(low.x, 0.1f);
  EXPECT_GT(low.x, 5.0f * low.z);
  EXPECT_EQ(air.transmittanceToSpace(10000.0, std::sin(radians(-4.0))), glm::vec3(0.0f));
  // At the top the whole path is outside but for grazing rays.
  EXPECT_GT(air.transmittanceToSpace(100e3, 0.0).z, 0.99f);
  EXPECT_EQ(air.transmittanceToSpace(100e3, -0.3), glm::vec3(0.0f));
  // No jumps on the way down.
  for (double h : {0.0, 2000.0, 12000.0, 60000.0}) {
    float before = air.transmittanceToSpace(h, 0.05).x;
    for (double mu = 0.05; mu > -0.2; mu -= 0.0002) {
      const float now = air.transmittanceToSpace(h, mu).x;
      EXPECT_LE(now, before + 2e-3f) << h << " " << mu;
      EXPECT_GT(now, before - 0.06f) << h << " " << mu;
      before = now;
    }
  }
}

// Where nothing absorbs, what leaves the top and what the ground absorbs add up to what came. The series for
// multiple scattering takes every point's surroundings to be lit like the point itself, which loses up to a
// tenth, and what coarse haze turns of the ground's light is lost, too; no more, and nothing may be made.
TEST(Energy, NothingIsLostInAConservativeAtmosphere) {
  for (float groundAlbedo : {0.0f, 1.0f}) {
    AtmosphereUniforms u = atmosphereUniforms({}, 60e3, 0.0, glm::vec3(groundAlbedo));
    u.aerosolScattering = u.aerosolExtinction;
    u.ozoneAbsorption = u.airglow = glm::vec3(0.0f);
    const Atmosphere air(u);
    for (double elevationDeg : {60.0, 30.0}) {
      const float mu0 = static_cast<float>(std::sin(radians(elevationDeg)));
      const std::vector<Light> lights = {{{std::sqrt(1 - mu0 * mu0), 0, mu0}, glm::vec3(1000.0f)}};
      const glm::vec3 direct = air.transmittanceToSpace(0.0, mu0) * (1000.0f * mu0);
      const glm::vec3 ground = direct + air.skyIlluminance(0.0, lights);
      // Up through the plane at 40 km: the air's own light and the ground's through the air.
      glm::vec3 up(0.0f);
      constexpr int kMus = 24, kAzimuths = 24;
      for (int i = 0; i < kMus; ++i) {
        const float mu = (static_cast<float>(i) + 0.5f) / kMus;
        for (int k = 0; k < kAzimuths; ++k) {
          const float azimuth = (static_cast<float>(k) + 0.5f) * static_cast<float>(2 * kPi) / kAzimuths;
          const vec3 d = shared::atmosphereDirection(-mu, azimuth, vec3(1, 0, 0));
          glm::vec3 seen = air.skyLuminance(40e3, d, lights);
          const shared::Atmosphere a = shared::fromUniforms(u);
          if (shared::atmosphereDistanceToGround(a, 40e3f, -mu) >= 0.0f) {
            seen += air.transmittanceToSpace(0.0, mu) * ground * groundAlbedo / static_cast<float>(kPi);
          }
          up += seen * mu * static_cast<float>(2 * kPi) / static_cast<float>(kMus * kAzimuths);
        }
      }
      const double leaves = luminance(up), absorbed = luminance(ground) * (1 - groundAlbedo);
      const double kept = (leaves + absorbed) / (1000.0 * mu0);
      EXPECT_GT(kept, 0.86) << groundAlbedo << " " << elevationDeg;
      EXPECT_LT(kept, 1.03) << groundAlbedo << " " << elevationDeg;
    }
  }
}

// What a white ground adds to the light of the sky on itself, by the tables, is a series of what the air
// sends back.
TEST(Energy, TheAirSendsBackWhatAWhiteGroundAdds) {
  constexpr float kAlbedo = 0.5f;
  const Atmosphere black(AtmosphereParams{}, 300e3, 0.0, glm::vec3(0.0f));
  const Atmosphere white(AtmosphereParams{}, 300e3, 0.0, glm::vec3(kAlbedo));
  const std::array lights{Light{{0.6f, 0.0f, 0.8f}, glm::vec3(1e5f)}};
  const glm::vec3 before = black.skyIlluminance(0.0, lights), after = white.skyIlluminance(0.0, lights),
                  direct = lights[0].illuminance * black.transmittanceToSpace(0.0, 0.8) * 0.8f;
  const glm::vec3 told = black.sphericalAlbedo(0.0), found = (after - before) / (kAlbedo * (after + direct));
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(told[c] / found[c], c < 2 ? 1.0f : 1.15f, 0.15f) << c << " " << found[c];
  EXPECT_GT(told.z, 2.0f * told.x);
  EXPECT_LT(black.sphericalAlbedo(8000.0).z, 0.5f * told.z);
}

// From the densest fog on there is light in every direction, within a factor of two of what it was when last
// looked at. Haze absorbs: at 10 m of visibility its 41 optical depths leave almost nothing.
TEST(Haze, FogIsNeitherBlackNorInfinite) {
  const std::vector<Light> sun = {{glm::normalize(glm::vec3(1.0f, 0.0f, 0.3f)), glm::vec3(100e3f)}};
  struct Fog {
    double visibilityM, towardsSun, zenith, horizon;  // cd/m2
  };
  for (const Fog& fog : {Fog{10.0, 5.5, 7.1, 3.8},
                         {50.0, 1200.0, 1700.0, 570.0},
                         {200.0, 2000.0, 2100.0, 640.0},
                         {1000.0, 10700.0, 2100.0, 700.0}}) {
    const Atmosphere air({}, fog.visibilityM, 0.0, glm::vec3(0.2f));
    const auto expectNear = [&](glm::vec3 way, double expected) {
      const double seen = luminance(air.skyLuminance(2.0, way, sun));
      EXPECT_GT(seen, 0.5 * expected) << fog.visibilityM;
      EXPECT_LT(seen, 2.0 * expected) << fog.visibilityM;
    };
    expectNear(sun[0].direction, fog.towardsSun);
    expectNear({0, 0, 1}, fog.zenith);
    expectNear({-1, 0, 0}, fog.horizon);
  }
}

TEST(Haze, FollowsKoschmieder) {
  for (double visibility : {500.0, 5e3, 40e3}) {
    const AtmosphereUniforms u = atmosphereUniforms({}, visibility, 400.0, glm::vec3(0.2f));
    // Green's effective wavelength is 546 nm: within 2 % of the 550 nm that visibility speaks of.
    const double total =
        u.aerosolExtinction.y + u.rayleighScattering.y * std::exp(-400.0 / u.rayleighScaleHeightM);
    EXPECT_NEAR(total, 3.912 / visibility, 0.02 * 3.912 / visibility);
  }
  const AtmosphereUniforms fog = atmosphereUniforms({}, 200.0, 0.0, glm::vec3(0.2f));
  EXPECT_NEAR(fog.aerosolExtinction.x, fog.aerosolExtinction.z, 1e-6f);  // grey
  const AtmosphereUniforms clear = atmosphereUniforms({}, 40e3, 0.0, glm::vec3(0.2f));
  // Bluish: by the 1.8th power of the wavelength.
  EXPECT_NEAR(clear.aerosolExtinction.z / clear.aerosolExtinction.x, std::pow(640.4 / 441.6, 1.8), 0.01);
  EXPECT_EQ(atmosphereUniforms({}, 1e6, 0.0, glm::vec3(0.2f)).aerosolExtinction, glm::vec3(0.0f));
}

TEST(AtmosphereTables, SameWithAnyNumberOfThreads) {
  std::vector<float> tables[2];
  for (int threads : {1, 3}) {
    setThreadCount(threads);
    const Atmosphere air({}, 30e3, 100.0, glm::vec3(0.2f));
    const std::vector<Light> lights = {{{0.6f, 0.0f, 0.8f}, glm::vec3(1e5f)},
                                       {{0.0f, 0.8f, 0.6f}, glm::vec3(5e4f)}};
    const SkyTables sky = makeSkyTables(air, 500.0, lights);
    std::vector<float>& all = tables[threads == 1 ? 0 : 1];
    for (const auto* data : {&air.transmittance().data, &air.multipleScattering().data, &sky.skyView.data,
                             &sky.aerialInscatter.data, &sky.aerialTransmittance.data}) {
      all.insert(all.end(), data->begin(), data->end());
    }
  }
  setThreadCount(0);
  EXPECT_EQ(tables[0], tables[1]);
}

}  // namespace
}  // namespace welkin::sky
