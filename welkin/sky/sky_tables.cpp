// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "welkin/core/parallel.h"
#include "welkin/sky/atmosphere.h"
#include "welkin/sky/atmosphere_glsl.h"

namespace welkin::sky {
namespace {

using shared::store;
using shared::vec2;
using shared::vec3;

void add(float* p, const vec3& v) {
  p[0] += v.x;
  p[1] += v.y;
  p[2] += v.z;
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
  const bool mirrored = job.lights.illuminance1.y <= 0.0f && job.lights.direction0 == job.direction0 &&
                        job.lights.shadow0.moonRadius <= 0.0f;
  return mirrored ? (width + 1) / 2 : width;
}

// Rows [first, last) of the table.
void addSkyView(const Job& job, int first, int last, Image<float>& table) {
  const int columns = columnsOf(job, table.width);
  parallelFor(static_cast<std::size_t>(last - first), 4, [&](std::size_t begin, std::size_t end) {
    for (int j = first + static_cast<int>(begin); j < first + static_cast<int>(end); ++j) {
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

// Elevations [first, last) of the tables.
void addAerial(const Job& job, int first, int last, Volume<float>& inscatterTable,
               Volume<float>& transmittanceTable) {
  constexpr int kStepsPerSlice = 2;
  const int nx = inscatterTable.nx, ny = inscatterTable.ny, nz = inscatterTable.nz;
  const int columns = columnsOf(job, nx);
  parallelFor(static_cast<std::size_t>(last - first), 1, [&](std::size_t begin, std::size_t end) {
    for (int j = first + static_cast<int>(begin); j < first + static_cast<int>(end); ++j) {
      const float y = 2.0f * static_cast<float>(j) / static_cast<float>(ny - 1) - 1.0f;
      const float mu = shared::atmosphereYToMu(y, job.horizonMu);
      for (int i = 0; i < columns; ++i) {
        const int mirror = nx - 1 - i;
        const float azimuth =
            shared::atmosphereXToAzimuth(static_cast<float>(i) / static_cast<float>(nx - 1));
        const vec3 dir = shared::atmosphereDirection(mu, azimuth, job.direction0);
        shared::AtmosphereRay ray = shared::atmosphereRayAtEye();
        float t0 = 0.0f;
        for (int k = 0; k < nz; ++k) {
          for (int s = k == 0 ? kStepsPerSlice : 1; s <= kStepsPerSlice; ++s) {
            const float z = (static_cast<float>(k - 1) + static_cast<float>(s) / kStepsPerSlice) /
                            static_cast<float>(nz - 1);
            const float t1 = shared::atmosphereZToDistance(std::max(z, 0.0f));
            shared::atmosphereMarchFinely(job.a, job.transmittance, job.multipleScattering, job.eyeM, dir,
                                          job.lights, t0, t1, ray);
            t0 = t1;
          }
          add(&inscatterTable.at(i, j, k), ray.inscatter);
          store(&transmittanceTable.at(i, j, k), ray.transmittance);
          if (mirror >= columns) {
            add(&inscatterTable.at(mirror, j, k), ray.inscatter);
            store(&transmittanceTable.at(mirror, j, k), ray.transmittance);
          }
        }
      }
    }
  });
}

// Puts into `kept` the lights without those that add less than a ten-thousandth to the sky: the moon by day,
// the sun at night. Judged by the zenith, which is the darkest part of a sky lit by one light.
void keepThoseThatShow(const Atmosphere& atmosphere, double eyeAltitudeM, std::span<const Light> lights,
                       std::vector<Light>& kept) {
  constexpr float kNegligible = 1e-4f;
  const auto zenith = [&](std::span<const Light> by) {
    return atmosphere.skyLuminance(eyeAltitudeM, vec3(0, 0, 1), by).y;
  };
  float sum = 0.0f;
  for (const Light& light : lights) sum += zenith({&light, 1});
  const float airglow = zenith({});
  kept.clear();
  for (const Light& light : lights)
    if (zenith({&light, 1}) - airglow > kNegligible * sum) kept.push_back(light);
}

constexpr int kSkyViewRows = static_cast<int>(shared::kSkyViewHeight),
              kAerialRows = static_cast<int>(shared::kAerialElevations),
              kRowsPerPair = kSkyViewRows + kAerialRows;

// Noughts, in the memory that is there if there is any.
template <class Table, class Make>
void reset(Table& table, const Make& make) {
  if (table.data.empty())
    table = make();
  else
    std::ranges::fill(table.data, 0.0f);
}

}  // namespace

void SkyTablesInProgress::start(const Atmosphere& atmosphere, double eyeAltitudeM,
                                std::span<const Light> lights) {
  atmosphere_ = &atmosphere;
  eyeAltitudeM_ = eyeAltitudeM;
  zeroAzimuth_ = lights.empty() ? vec3(1, 0, 0) : vec3(lights[0].direction);
  keepThoseThatShow(atmosphere, eyeAltitudeM, lights, lights_);
  done_ = 0;
  const int width = static_cast<int>(shared::kSkyViewWidth);
  const int nx = static_cast<int>(shared::kAerialAzimuths), nz = static_cast<int>(shared::kAerialDistances);
  reset(tables_.skyView, [&] { return Image<float>(width, kSkyViewRows, 3); });
  reset(tables_.aerialInscatter, [&] { return Volume<float>(nx, kAerialRows, nz, 3); });
  reset(tables_.aerialTransmittance, [&] { return Volume<float>(nx, kAerialRows, nz, 3); });
}

int SkyTablesInProgress::rows() const {
  return kRowsPerPair * static_cast<int>(std::max<std::size_t>((lights_.size() + 1) / 2, 1));
}

void SkyTablesInProgress::computeTo(int row) {
  Job job;
  job.transmittance = {&atmosphere_->transmittance()};
  job.multipleScattering = {&atmosphere_->multipleScattering()};
  job.direction0 = zeroAzimuth_;
  while (done_ < std::min(row, rows())) {
    const int pair = done_ / kRowsPerPair, first = done_ % kRowsPerPair,
              last = std::min(row - pair * kRowsPerPair, first < kSkyViewRows ? kSkyViewRows : kRowsPerPair);
    job.a = shared::fromUniforms(atmosphere_->uniforms());
    if (pair > 0) job.a.airglow = vec3(0.0f);  // once
    job.eyeM = std::max(static_cast<float>(eyeAltitudeM_), job.a.groundAltitudeM);
    job.horizonMu = shared::atmosphereHorizonMu(job.a, job.eyeM);
    job.lights = shared::lightPair(lights_, static_cast<std::size_t>(pair));
    if (first < kSkyViewRows)
      addSkyView(job, first, last, tables_.skyView);
    else
      addAerial(job, first - kSkyViewRows, last - kSkyViewRows, tables_.aerialInscatter,
                tables_.aerialTransmittance);
    done_ += last - first;
  }
}

SkyTables makeSkyTables(const Atmosphere& atmosphere, double eyeAltitudeM, std::span<const Light> lights) {
  SkyTablesInProgress making;
  making.start(atmosphere, eyeAltitudeM, lights);
  making.computeTo(making.rows());
  return std::move(making.tables());
}

}  // namespace welkin::sky
