// SPDX-License-Identifier: Apache-2.0
// The clouds of a frame as uniforms, and what every pass asks of them.

#include "lib/cloud_layer.glsl"
#include "lib/clouds.glsl"

// Layers that overlap in height make a band. Which layers there are and in which band is compiled in, by WELKIN_EACH_LAYER(CALL): CALL(layer,
// band) for each. Indices are constants then, and a march through one band costs nothing for the others; compilers that run all
// branches of a program for all its pixels (Mesa's software rasteriser above all) would pay for every layer at every step.

WELKIN_FIXED uniform CloudLayer uLayers[kMaxLayers];
WELKIN_FIXED uniform float uLayerIce[kMaxLayers];    // 1: ice crystals, 0: droplets
#ifdef WELKIN_HALOS
WELKIN_FIXED uniform float uLayerCrystals[kMaxLayers];  // 1: ice that makes halos, 0: other matter
#endif
#ifdef WELKIN_RAIN
WELKIN_FIXED uniform float uLayerRain[kMaxLayers];   // 1: drops of rain, 0: other matter
#endif
WELKIN_FIXED uniform float uLayerCover[kMaxLayers];  // of the sky, [0, 1]
uniform sampler2D uPlacement;
uniform sampler3D uShapeNoise;
uniform sampler3D uDetailNoise;

// How far a point is inside each layer's cloud before the 3D noises shape it (cloudSurface).
struct CloudSurfaces {
  float s[kMaxLayers];
};

// What the layers at a point come to.
struct CloudPoint {
  float extinction;  // 1/m
  float ice;         // the part of it that is ice
  float cover;       // it times its layers' cover of the sky
  vec4 place;        // it times cloudSurface, relative height, depth (m) and extinction (1/m) of its layers
  float clearM;      // where there is none: a distance within which it stays so
  float stepM;       // the longest step that resolves the layers here
  bool inside;       // between base and top of any layer
#ifdef WELKIN_HALOS
  float crystals;    // the part of the extinction that makes halos
#endif
#ifdef WELKIN_RAIN
  float rain;        // the part of the extinction that is rain
#endif
};

#ifdef WELKIN_BALLS
#include "lib/ball_volume.glsl"
#endif

// First half of the question: the surfaces from the placement alone. Returns a distance within which there is no cloud, or -1 if the
// 3D noises have to be asked.
float clearanceInBand(int band, vec3 q, out CloudSurfaces surfaces) {
  float clearM = 1e9;
#define WELKIN_CLEARANCE(i, b)                                     \
  if (band == b) {                                                 \
    surfaces.s[i] = cloudSurface(uLayers[i], uPlacement, q);       \
    clearM = min(clearM, cloudClearance(uLayers[i], q, surfaces.s[i])); \
  }
  WELKIN_EACH_LAYER(WELKIN_CLEARANCE)
#ifdef WELKIN_BALLS
  if (WELKIN_BALLS(band)) clearM = min(clearM, ballClearance(q));
#endif
  return clearM;
}

void addLayer(CloudLayer layer, float ice, float cover, vec3 q, float surface, float detail, inout CloudPoint point) {
  if (q.z < layer.baseM || q.z > layer.topM) return;
  float clearM;
  float extinction = cloudExtinctionFrom(layer, uShapeNoise, uDetailNoise, q, surface, detail, clearM);
  point.extinction += extinction;
  point.ice += extinction * ice;
  point.cover += extinction * cover;
  float depthM = layer.topM - layer.baseM;
  point.place += extinction * vec4(surface, (q.z - layer.baseM) / depthM, depthM, layer.extinction);
  point.clearM = min(point.clearM, clearM);
  point.stepM = min(point.stepM, cloudStepM(layer));
  point.inside = true;
}

// Second half: what is there.
CloudPoint cloudsAtSurfaces(int band, vec3 q, float detail, CloudSurfaces surfaces) {
#if defined(WELKIN_HALOS) && defined(WELKIN_RAIN)
  CloudPoint point = CloudPoint(0.0, 0.0, 0.0, vec4(0.0), 1e9, 1e9, false, 0.0, 0.0);
#elif defined(WELKIN_HALOS) || defined(WELKIN_RAIN)
  CloudPoint point = CloudPoint(0.0, 0.0, 0.0, vec4(0.0), 1e9, 1e9, false, 0.0);
#else
  CloudPoint point = CloudPoint(0.0, 0.0, 0.0, vec4(0.0), 1e9, 1e9, false);
#endif
#ifdef WELKIN_HALOS
#define WELKIN_ADD_CRYSTALS(i) point.crystals += uLayerCrystals[i] * (point.extinction - others);
#else
#define WELKIN_ADD_CRYSTALS(i)
#endif
#ifdef WELKIN_RAIN
#define WELKIN_ADD_RAIN(i) point.rain += uLayerRain[i] * (point.extinction - others);
#else
#define WELKIN_ADD_RAIN(i)
#endif
#if defined(WELKIN_HALOS) || defined(WELKIN_RAIN)
#define WELKIN_ADD_LAYER(i, b)                                                               \
  if (band == b) {                                                                           \
    float others = point.extinction;                                                         \
    addLayer(uLayers[i], uLayerIce[i], uLayerCover[i], q, surfaces.s[i], detail, point);     \
    WELKIN_ADD_CRYSTALS(i)                                                                   \
    WELKIN_ADD_RAIN(i)                                                                       \
  }
#else
#define WELKIN_ADD_LAYER(i, b) if (band == b) addLayer(uLayers[i], uLayerIce[i], uLayerCover[i], q, surfaces.s[i], detail, point);
#endif
  WELKIN_EACH_LAYER(WELKIN_ADD_LAYER)
#ifdef WELKIN_BALLS
  if (WELKIN_BALLS(band)) addBalls(q, point);
#endif
  return point;
}

// Extinction in one go.
float cloudExtinctionInBand(int band, vec3 q, float detail) {
  CloudSurfaces surfaces;
  clearanceInBand(band, q, surfaces);
  return cloudsAtSurfaces(band, q, detail, surfaces).extinction;
}
