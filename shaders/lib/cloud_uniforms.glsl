// SPDX-License-Identifier: Apache-2.0
// The clouds of a frame as uniforms, and what every pass asks of them.

#include "lib/cloud_layer.glsl"
#include "lib/clouds.glsl"

// Layers that overlap in height make a band. Which layers there are and in which band is compiled in, by WELKIN_EACH_LAYER(CALL): CALL(layer,
// band) for each. Indices are constants then, and a march through one band costs nothing for the others; compilers that run all
// branches of a program for all its pixels (Mesa's software rasteriser above all) would pay for every layer at every step.

uniform CloudLayer uLayers[8];
uniform float uLayerIce[8];       // 1: ice crystals, 0: droplets
uniform float uEarthRadiusM;      // to the ground
uniform sampler2D uPlacement;
uniform sampler3D uShapeNoise;
uniform sampler3D uDetailNoise;

// What the layers at a point come to.
struct CloudPoint {
  float extinction;  // 1/m
  float ice;         // the part of it that is ice
  float clearM;      // where there is none: a distance within which it stays so
  float stepM;       // the longest step that resolves the layers here
  bool inside;       // between base and top of any layer
};

void addLayer(CloudLayer layer, float ice, vec3 q, float detail, inout CloudPoint point) {
  if (q.z < layer.baseM || q.z > layer.topM) return;
  float clearM;
  float extinction = cloudExtinction(layer, uPlacement, uShapeNoise, uDetailNoise, q, detail, clearM);
  point.extinction += extinction;
  point.ice += extinction * ice;
  point.clearM = min(point.clearM, clearM);
  point.stepM = min(point.stepM, cloudStepM(layer));
  point.inside = true;
}

CloudPoint cloudsInBand(int band, vec3 q, float detail) {
  CloudPoint point = CloudPoint(0.0, 0.0, 1e9, 1e9, false);
#define WELKIN_ADD_LAYER(i, b) if (band == b) addLayer(uLayers[i], uLayerIce[i], q, detail, point);
  WELKIN_EACH_LAYER(WELKIN_ADD_LAYER)
  return point;
}
