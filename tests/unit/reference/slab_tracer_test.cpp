// SPDX-License-Identifier: Apache-2.0
// Against converged discrete ordinates, against closed forms, and against what must hold whatever the slab.
#include "welkin/reference/slab_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/core/units.h"

namespace welkin::reference {
namespace {

using scene::Slab;
using scene::SlabLight;

Slab slabOf(double depth, double g = 0.85) {
  Slab s;
  s.opticalDepth = depth;
  s.asymmetry = g;
  return s;
}

Slab litFrom(Slab s, double mu0) {
  s.sunZenithDeg = std::acos(mu0) * 180.0 / kPi;
  return s;
}

SlabResult trace(const Slab& s, std::uint64_t paths) {
  return traceSlab(s, {.seed = 1, .maxPaths = paths, .noise = 0.0});
}

// Within 3 standard errors, which must be small themselves, and within 0.3 %.
void expectNear(const Estimate& e, double truth, const std::string& what, double largestError = 0.003) {
  EXPECT_NEAR(e.value, truth, 3.0 * e.error + 1e-7) << what;
  EXPECT_NEAR(e.value, truth, 0.003 * truth) << what << ", error " << e.error / truth;
  EXPECT_LT(e.error, largestError * truth) << what;
}

// R and pi I / (mu0 F) towards the zenith of conservative slabs over a black ground, Henyey and Greenstein's
// function with g = 0.85, by converged discrete ordinates.
struct Row {
  double depth, overhead, slanting, diffuse, nadirOverhead, nadirSlanting;
  std::uint64_t paths;
};
constexpr Row kRows[] = {{1, 0.0423162, 0.1648776, 0.1343749, 0.0176279, 0.0548350, 400000},
                         {4, 0.1909149, 0.4160225, 0.3404020, 0.1316950, 0.2300100, 300000},
                         {16, 0.5572094, 0.6974049, 0.6516871, 0.5654561, 0.5599460, 250000},
                         {64, 0.8462810, 0.8949697, 0.8790956, 0.9329113, 0.8110817, 130000}};

// The radiance is noisier than the fluxes; what is asked of its error here is what a short test can reach.
void expectNadir(const Estimate& e, double truth, const std::string& what) {
  EXPECT_NEAR(e.value, truth, 3.0 * e.error) << what;
  EXPECT_LT(e.error, 0.006 * truth) << what;
}

void expectConservative(const SlabResult& r, const std::string& what) {
  const double all = r.total.reflectance.value + r.total.transmittance.value;
  EXPECT_NEAR(all, 1.0, 0.002) << what;  // but for roulette, exactly
  EXPECT_EQ(r.total.absorptance.value, 0.0) << what;
}

TEST(SlabTracer, WhatCannotBeTracedIsSaid) {
  EXPECT_THROW(traceSlab(scene::Slab{}, {}), ParameterError);
  scene::Slab slab;
  slab.opticalDepth = 1.0;
  EXPECT_THROW(traceSlab(slab, {.maxPaths = 0, .noise = 0.0}), ParameterError);
}

TEST(SlabTracer, ConservativeSlabsInTheSun) {
  for (const Row& row : kRows) {
    const std::string name = "depth " + std::to_string(row.depth);
    const SlabResult overhead = trace(slabOf(row.depth), row.paths);
    expectNear(overhead.total.reflectance, row.overhead, name + ", overhead");
    expectNadir(overhead.total.nadirRadiance, row.nadirOverhead, name + ", overhead");
    expectConservative(overhead, name);
    EXPECT_NEAR(overhead.total.directTransmittance.value, std::exp(-row.depth), 1e-12);
    const SlabResult slanting = trace(litFrom(slabOf(row.depth), 0.5), row.paths);
    expectNear(slanting.total.reflectance, row.slanting, name + ", slanting");
    expectNadir(slanting.total.nadirRadiance, row.nadirSlanting, name + ", slanting");
    EXPECT_NEAR(slanting.total.directTransmittance.value, std::exp(-2.0 * row.depth), 1e-12);
  }
}

TEST(SlabTracer, ConservativeSlabsInDiffuseLight) {
  for (const Row& row : kRows) {
    Slab s = slabOf(row.depth);
    s.light = SlabLight::kDiffuse;
    const SlabResult r = trace(s, row.paths);
    expectNear(r.total.reflectance, row.diffuse, "depth " + std::to_string(row.depth));
  }
}

TEST(SlabTracer, OtherMeanCosines) {
  constexpr double kDepths[] = {1, 4, 16, 64};
  constexpr double kIsotropic[] = {0.3413288, 0.6909262, 0.9036315, 0.9743381};
  constexpr double kForward[] = {0.0787398, 0.3116391, 0.6880459, 0.9028564};
  constexpr std::uint64_t kPaths[] = {250000, 100000, 50000, 15000};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string name = "depth " + std::to_string(kDepths[i]);
    expectNear(trace(slabOf(kDepths[i], 0.0), kPaths[i]).total.reflectance, kIsotropic[i], name + ", g 0");
    expectNear(trace(slabOf(kDepths[i], 0.75), kPaths[i]).total.reflectance, kForward[i], name + ", g 0.75");
  }
}

TEST(SlabTracer, AbsorbingSlabs) {
  struct {
    double depth, reflectance, transmittance;
    std::uint64_t paths;
  } constexpr kAbsorbing[] = {{4, 0.1728356, 0.7661701, 260000}, {16, 0.4177221, 0.3061035, 400000}};
  for (const auto& row : kAbsorbing) {
    Slab s = slabOf(row.depth);
    s.albedo = 0.99;
    const SlabLightFlow f = trace(s, row.paths).total;
    const std::string name = "depth " + std::to_string(row.depth);
    expectNear(f.reflectance, row.reflectance, name + ", R");
    expectNear(f.transmittance, row.transmittance, name + ", T");
    expectNear(f.absorptance, 1.0 - row.reflectance - row.transmittance, name + ", A");
  }
}

// In uniform light from everywhere, which over a white ground is diffuse light from above, a white slab
// cannot be seen.
TEST(SlabTracer, WhiteFurnace) {
  for (const double depth : {0.3, 5.0}) {
    Slab s = slabOf(depth, 0.7);
    s.light = SlabLight::kDiffuse;
    s.groundAlbedo = 1.0;
    const SlabLightFlow f = trace(s, 1000000).total;
    expectNear(f.reflectance, 1.0, "R", 1e-4);
    expectNear(f.transmittance, 1.0, "light on the ground");
    expectNear(f.nadirRadiance, 1.0, "radiance", 0.004);
  }
}

// The ground's light goes up and down between slab and ground: T = t / (1 - a r), R = r + a t^2 / (1 - a r)
// where light from below is diffuse, so that with diffuse light all of r and t are known from a black ground.
TEST(SlabTracer, AGreyGroundAddsAGeometricSeries) {
  Slab s = slabOf(4.0, 0.0);
  s.light = SlabLight::kDiffuse;
  const SlabLightFlow black = trace(s, 260000).total;
  s.groundAlbedo = 0.6;
  const SlabLightFlow grey = trace(s, 260000).total;
  // Light that comes through is not diffuse to the last, but what the ground sends up is.
  const double r = black.reflectance.value, t = black.transmittance.value, a = 0.6;
  expectNear(grey.transmittance, t / (1.0 - a * r), "T");
  expectNear(grey.reflectance, r + a * t * t / (1.0 - a * r), "R");
}

// A Lambert ground without any slab, and a slab that only absorbs: closed forms.
TEST(SlabTracer, ClosedForms) {
  Slab s = slabOf(0.0);
  s.groundAlbedo = 0.3;
  const SlabLightFlow bare = trace(s, 100000).total;
  EXPECT_NEAR(bare.reflectance.value, 0.3, 1e-2);
  EXPECT_NEAR(bare.reflectance.value, 0.3, 3.0 * bare.reflectance.error + 1e-9);
  EXPECT_NEAR(bare.nadirRadiance.value, 0.3, 1e-9);
  s = litFrom(slabOf(2.0), 0.5);
  s.albedo = 0.0;
  const SlabLightFlow ink = trace(s, 100000).total;
  EXPECT_EQ(ink.reflectance.value, 0.0);
  EXPECT_NEAR(ink.absorptance.value, 1.0 - std::exp(-4.0), 1e-9);
  EXPECT_NEAR(ink.transmittance.value, std::exp(-4.0), 1e-9);
}

Slab columnsOf(double a, double b) {
  Slab s;
  s.columns = {{a, 16}, {b, 16}};
  return s;
}

TEST(SlabTracer, EqualColumnsAreAHomogeneousSlab) {
  Slab s = litFrom(columnsOf(4.0, 4.0), 0.5);
  s.sunAzimuthDeg = 70.0;
  const SlabResult r = trace(s, 260000);
  ASSERT_EQ(r.columns.size(), 32u);
  expectNear(r.total.reflectance, 0.4160225, "R");
  expectNadir(r.total.nadirRadiance, 0.2300100, "nadir");
  for (const SlabLightFlow& c : r.columns) {
    EXPECT_NEAR(c.reflectance.value, 0.4160225, 4.5 * c.reflectance.error);
    EXPECT_NEAR(c.directTransmittance.value, std::exp(-8.0), 1e-6);
  }
}

TEST(SlabTracer, WideColumnsAreSlabsOfTheirOwn) {
  Slab s = columnsOf(1.0, 16.0);
  s.periodM = 1e6;
  s.thicknessM = 100.0;
  const SlabResult r = trace(s, 600000);
  expectNear(r.total.reflectance, 0.5 * (0.0423162 + 0.5572094), "R");
}

TEST(SlabTracer, ColumnsAddUpAndMirror) {
  Slab s = litFrom(columnsOf(2.0, 18.0), 0.5);
  s.albedo = 0.99;
  const SlabResult east = trace(s, 130000);
  double up = 0.0, all = 0.0;
  for (const SlabLightFlow& c : east.columns) {
    up += c.reflectance.value / 32.0;
    all += (c.reflectance.value + c.transmittance.value + c.absorptance.value) / 32.0;
  }
  EXPECT_NEAR(up, east.total.reflectance.value, 1e-9);
  EXPECT_NEAR(all, 1.0, 0.003);
  // From the west all is the other way round: the thick half, and so its lit edge, lies to the east.
  s.sunAzimuthDeg = -90.0;
  s.columns = {{18.0, 16}, {2.0, 16}};
  const SlabResult west = trace(s, 130000);
  for (std::size_t i = 0; i < 32; ++i) {
    const Estimate& a = east.columns[i].reflectance;
    const Estimate& b = west.columns[31 - i].reflectance;
    EXPECT_NEAR(a.value, b.value, 4.5 * std::hypot(a.error, b.error)) << "column " << i;
  }
}

TEST(SlabTracer, ThreadsChangeNothingAndSeedsDo) {
  const Slab s = columnsOf(2.0, 18.0);
  const int before = threadCount();
  setThreadCount(1);
  const SlabResult one = trace(s, 1);
  setThreadCount(3);
  const SlabResult three = trace(s, 1);
  setThreadCount(before);
  EXPECT_EQ(one.events, three.events);
  EXPECT_EQ(one.total.nadirRadiance.value, three.total.nadirRadiance.value);
  for (std::size_t i = 0; i < 32; ++i)
    EXPECT_EQ(one.columns[i].reflectance.value, three.columns[i].reflectance.value);
  const SlabResult other = traceSlab(s, {.seed = 2, .maxPaths = 1, .noise = 0.0});
  EXPECT_NE(one.total.reflectance.value, other.total.reflectance.value);
}

TEST(SlabTracer, StopsAtTheNoise) {
  const SlabResult r = traceSlab(slabOf(4.0, 0.0), {.seed = 1, .maxPaths = 0, .noise = 0.002});
  EXPECT_TRUE(r.reachedNoise);
  EXPECT_LE(r.total.nadirRadiance.error, 0.002 * r.total.nadirRadiance.value);
  EXPECT_LE(r.total.reflectance.error, 0.002 * r.total.reflectance.value);
}

// Errors are true: among many seeds the results scatter as much as they say.
TEST(SlabTracer, ErrorsAreThoseAmongSeeds) {
  constexpr int kSeeds = 60;
  double squares = 0.0, expected = 0.0;
  for (int i = 0; i < kSeeds; ++i) {
    const Estimate e =
        traceSlab(slabOf(1.0), {.seed = 100 + static_cast<std::uint64_t>(i), .maxPaths = 1, .noise = 0.0})
            .total.reflectance;
    squares += (e.value - 0.0423162) * (e.value - 0.0423162) / kSeeds;
    expected += e.error * e.error / kSeeds;
  }
  EXPECT_GT(squares, 0.4 * expected);
  EXPECT_LT(squares, 2.0 * expected);
}

}  // namespace
}  // namespace welkin::reference
