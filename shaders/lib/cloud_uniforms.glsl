// SPDX-License-Identifier: Apache-2.0
// The clouds of a frame as uniforms, and what every pass asks of them.

#include "lib/cloud_layer.glsl"
#include "lib/clouds.glsl"

// WELKIN_LAYERS, the number of layers, is defined by shader assembly. The layers are gone through by calls with constant indices, since
// some compilers (Mesa's software rasteriser above all) fetch a member of a dynamically indexed uniform for each pixel apart.
#if WELKIN_LAYERS == 0
#define WELKIN_EACH_LAYER(CALL)
#elif WELKIN_LAYERS == 1
#define WELKIN_EACH_LAYER(CALL) CALL(0)
#elif WELKIN_LAYERS == 2
#define WELKIN_EACH_LAYER(CALL) CALL(0) CALL(1)
#elif WELKIN_LAYERS == 3
#define WELKIN_EACH_LAYER(CALL) CALL(0) CALL(1) CALL(2)
#elif WELKIN_LAYERS == 4
#define WELKIN_EACH_LAYER(CALL) CALL(0) CALL(1) CALL(2) CALL(3)
#elif WELKIN_LAYERS == 5
#define WELKIN_EACH_LAYER(CALL) CALL(0) CALL(1) CALL(2) CALL(3) CALL(4)
#elif WELKIN_LAYERS == 6
#define WELKIN_EACH_LAYER(CALL) CALL(0) CALL(1) CALL(2) CALL(3) CALL(4) CALL(5)
#elif WELKIN_LAYERS == 7
#define WELKIN_EACH_LAYER(CALL) CALL(0) CALL(1) CALL(2) CALL(3) CALL(4) CALL(5) CALL(6)
#else
#define WELKIN_EACH_LAYER(CALL) CALL(0) CALL(1) CALL(2) CALL(3) CALL(4) CALL(5) CALL(6) CALL(7)
#endif

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

CloudPoint cloudsAt(vec3 q, float detail) {
  CloudPoint point = CloudPoint(0.0, 0.0, 1e9, 1e9, false);
#define WELKIN_ADD_LAYER(i) addLayer(uLayers[i], uLayerIce[i], q, detail, point);
  WELKIN_EACH_LAYER(WELKIN_ADD_LAYER)
  return point;
}
