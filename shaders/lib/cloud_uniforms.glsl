// SPDX-License-Identifier: Apache-2.0
// The clouds of a frame as uniforms, and what every pass asks of them.

#include "lib/cloud_layer.glsl"
#include "lib/clouds.glsl"

uniform CloudLayer uLayers[8];
uniform int uLayerCount;
uniform float uLayerIce[8];       // 1: ice crystals, 0: droplets
uniform float uEarthRadiusM;      // to the ground
uniform sampler2D uPlacement;
uniform sampler3D uShapeNoise;
uniform sampler3D uDetailNoise;

// Extinction of all layers at q, 1/m.
float cloudsExtinction(vec3 q, float detail) {
  float sum = 0.0;
  for (int i = 0; i < uLayerCount; ++i) {
    if (q.z <= uLayers[i].baseM || q.z >= uLayers[i].topM) continue;
    float clearM;
    sum += cloudExtinction(uLayers[i], uPlacement, uShapeNoise, uDetailNoise, q, detail, clearM);
  }
  return sum;
}
