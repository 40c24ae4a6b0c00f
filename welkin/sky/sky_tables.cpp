// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "welkin/core/parallel.h"
#include "welkin/sky/atmosphere.h"
#include "welkin/sky/atmosphere_glsl.h"

namespace welkin::sky {
namespace {

using shared::vec2;
using shared::vec3;

void add(float* p, const vec3& v) {
  p[0] += v.x;
  p[1] += v.y;
  p[2] += v.z;
}

void store(float* p, const vec3& v) {
  p[0] = v.x;
  p[1] = v.y;
  p[2] = v.z;
}

// Everything that the tables are made from.
struct Job {
  shared::Atmosphere a;
  shared::sampler2D transmittance, multipleScattering;
  float eyeM;
  float horizonMu;
  vec3 direction0;  // azimuths count from this light
  shared::AtmosphereLights lights;
};

// Columns to compute: all, or the first half where the picture is its own mirror image.
int columnsOf(const Job& job, int width) {
  const bool mirrored = job.lights.illuminance1.y <= 0.0f && job.lights.direction0 == job.direction0;
  return mirrored ? (width + 1) / 2 : width;
}

void addSkyView(const Job& job, Image<float>& table) {
  const int columns = columnsOf(job, table.width);
  parallelFor(static_cast<std::size_t>(table.height), 4, [&](std::size_t begin, std::size_t end) {
    for (int j = static_cast<int>(begin); j < static_cast<int>(end); ++j) {
      for (int i = 0; i < columns; ++i) {
        const vec2 p =
            shared::atmosphereSkyViewParameters(static_cast<float>(i), static_cast<float>(j), job.horizonMu);
        const vec3 dir = shared::atmosphereDirection(p.y, p.x, job.direction0);
        const vec3 luminance = shared::atmosphereSkyRay(job.a, job.transmittance, job.multipleScattering,
                                                        job.eyeM, dir, job.lights, 1.0f);
        add(&table.at(i, j), luminance);
        const int mirror = table.width - 1 - i;
        if (mirror >= columns) add(&table.at(mirror, j), luminance);
      }
    }
  });
}

void addAerial(const Job& job, Volume<float>& inscatterTable, Volume<float>& transmittanceTable) {
  constexpr int kStepsPerSlice = 2;
  const int nx = inscatterTable.nx, ny = inscatterTable.ny, nz = inscatterTable.nz;
  const int columns = columnsOf(job, nx);
  parallelFor(static_cast<std::size_t>(ny), 1, [&](std::size_t begin, std::size_t end) {
    for (int j = static_cast<int>(begin); j < static_cast<int>(end); ++j) {
      const float y = 2.0f * static_cast<float>(j) / static_cast<float>(ny - 1) - 1.0f;
      const float mu = shared::atmosphereYToMu(y, job.horizonMu);
      for (int i = 0; i < columns; ++i) {
        const int mirror = nx - 1 - i;
        const float azimuth =
            shared::atmosphereXToAzimuth(static_cast<float>(i) / static_cast<float>(nx - 1));
        const vec3 dir = shared::atmosphereDirection(mu, azimuth, job.direction0);
        vec3 inscatter(0.0f), through(1.0f);
        float t0 = 0.0f;
        for (int k = 0; k < nz; ++k) {
          for (int s = k == 0 ? kStepsPerSlice : 1; s <= kStepsPerSlice; ++s) {
            const float z = (static_cast<float>(k - 1) + static_cast<float>(s) / kStepsPerSlice) /
                            static_cast<float>(nz - 1);
            const float t1 = shared::atmosphereZToDistance(std::max(z, 0.0f));
            shared::atmosphereMarch(job.a, job.transmittance, job.multipleScattering, job.eyeM, dir,
                                    job.lights, t0, t1, inscatter, through);
            t0 = t1;
          }
          add(&inscatterTable.at(i, j, k), inscatter);
          store(&transmittanceTable.at(i, j, k), through);
          if (mirror >= columns) {
            add(&inscatterTable.at(mirror, j, k), inscatter);
            store(&transmittanceTable.at(mirror, j, k), through);
          }
        }
      }
    }
  });
}

// Lights without those that add less than a ten-thousandth to the sky: the moon by day, the sun at night.
// Judged by the zenith, which is the darkest part of a sky lit by one light.
std::vector<Light> lightsThatShow(const Atmosphere& atmosphere, double eyeAltitudeM,
                                  const std::vector<Light>& lights) {
  constexpr float kNegligible = 1e-4f;
  std::vector<float> zenith;
  float sum = 0.0f;
  for (const Light& light : lights) {
    zenith.push_back(atmosphere.skyLuminance(eyeAltitudeM, vec3(0, 0, 1), {light}).y);
    sum += zenith.back();
  }
  const float airglow = atmosphere.skyLuminance(eyeAltitudeM, vec3(0, 0, 1), {}).y;
  std::vector<Light> kept;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (zenith[i] - airglow > kNegligible * sum) kept.push_back(lights[i]);
  }
  return kept;
}

}  // namespace

SkyTables makeSkyTables(const Atmosphere& atmosphere, double eyeAltitudeM,
                        const std::vector<Light>& allLights) {
  const std::vector<Light> lights = lightsThatShow(atmosphere, eyeAltitudeM, allLights);
  Job job;
  job.a = shared::fromUniforms(atmosphere.uniforms());
  job.transmittance = {&atmosphere.transmittance()};
  job.multipleScattering = {&atmosphere.multipleScattering()};
  job.eyeM = std::max(static_cast<float>(eyeAltitudeM), job.a.groundAltitudeM);
  job.horizonMu = shared::atmosphereHorizonMu(job.a, job.eyeM);
  job.direction0 = allLights.empty() ? vec3(1, 0, 0) : vec3(allLights[0].direction);

  SkyTables tables;
  tables.skyView =
      Image<float>(static_cast<int>(shared::kSkyViewWidth), static_cast<int>(shared::kSkyViewHeight), 3);
  const int nx = static_cast<int>(shared::kAerialAzimuths), ny = static_cast<int>(shared::kAerialElevations),
            nz = static_cast<int>(shared::kAerialDistances);
  tables.aerialInscatter = Volume<float>(nx, ny, nz, 3);
  tables.aerialTransmittance = Volume<float>(nx, ny, nz, 3);
  for (std::size_t i = 0; i == 0 || 2 * i < lights.size(); ++i) {
    job.lights = shared::lightPair(lights, i);
    addSkyView(job, tables.skyView);
    addAerial(job, tables.aerialInscatter, tables.aerialTransmittance);
    job.a.airglow = vec3(0.0f);  // once
  }
  return tables;
}

}  // namespace welkin::sky
