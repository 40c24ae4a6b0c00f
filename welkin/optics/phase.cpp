// SPDX-License-Identifier: Apache-2.0
#include "welkin/optics/phase.h"

#include "welkin/core/glsl.h"

namespace welkin::optics {

namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/phase.glsl"
}  // namespace shared

namespace {
shared::DropletPhase toShared(const DropletPhase& p) {
  return {p.gHg, p.gDraine, p.alpha, p.wDraine};
}
}  // namespace

float phaseRayleigh(float c) {
  return shared::phaseRayleigh(c);
}
float phaseHenyeyGreenstein(float c, float g) {
  return shared::phaseHenyeyGreenstein(c, g);
}
float phaseDraine(float c, float g, float alpha) {
  return shared::phaseDraine(c, g, alpha);
}
float phaseHaze(float c, float g) {
  return shared::phaseHaze(c, g);
}
float phaseIce(float c) {
  return shared::phaseIce(c);
}
IcePeak icePeak() {
  return {shared::kIcePeakShare, shared::kIcePeakG};
}
float draineMeanCosine(float g, float alpha) {
  return shared::draineMeanCosine(g, alpha);
}

DropletPhase dropletPhase(float diameterUm) {
  const shared::DropletPhase p = shared::dropletPhase(diameterUm);
  return {p.gHg, p.gDraine, p.alpha, p.wDraine};
}
float phaseDroplet(float c, const DropletPhase& p) {
  return shared::phaseDroplet(c, toShared(p));
}
float dropletMeanCosine(const DropletPhase& p) {
  return shared::dropletMeanCosine(toShared(p));
}
float dropletAsymmetry() {
  return shared::kDropletAsymmetry;
}
float dropletAside() {
  return shared::kDropletAside;
}

}  // namespace welkin::optics
