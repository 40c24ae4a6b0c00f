// SPDX-License-Identifier: Apache-2.0
// The shape of one layer of cloud, as numbers. Compiled as GLSL and, in welkin/field/cloud_layer.h, as C++.
// Lengths in metres. "sd" is a standard deviation of the layer's placement noise, the unit of everything that moves the cloud's
// surface: the cloud is where placement - threshold - profile(height) + shape + detail > 0.

WELKIN_CONST int kMaxLayers = 10;  // eight of cloud, two of rain

struct CloudLayer {
  float baseM;          // height of the base above the ground
  float topM;           // height of the highest tops
  float extinction;     // in the body of the cloud, 1/m
  float threshold;      // of the placement noise, sd; more is less cover

  vec2 driftM;          // displacement of the pattern by wind and seed, less whole periods of cells (moveLayer(), field/cloud_layer.h)
  vec2 shearM;          // displacement of the top relative to the base
  vec2 along;           // unit direction along which the pattern is drawn out
  float stretch;        // how much, >= 1

  float cellM;          // period of the placement pattern (a dozen cells or so)
  float cellWeight;     // weights of round cells, of fractal noise and of large patches; squares sum to 1
  float fractalWeight;
  float patchWeight;
  float patchM;         // period of the patches
  vec2 patchShift;      // their displacement beside that of the pattern, in periods
  float warpM;          // how far patches push cells about

  float dome;           // fall of the surface towards the top, sd
  float domePower;      // 1: a cone, large: a cylinder with a rounded top
  float belly;          // how much the surface is drawn in towards the base, sd (0: flat base; less: broader there)
  float anvil;          // widening below the top, sd
  float bottomSoft;     // share of the depth over which density fades in above the base
  float topSoft;        // the same below the top

  float shapeM;         // period of the large 3D noise
  float shapeAmount;    // its strength, sd
  float shapeAtBase;    // share of that strength left at the base
  float shapeStretch;   // drawing-out of the 3D noises along `along`
  float shapeTall;      // the same upwards
  float detailM;        // period of the small 3D noise
  float detailAmount;   // its strength, sd
  vec3 shapeShiftM;     // displacement of the 3D noises relative to the pattern: evolution
  vec3 detailShiftM;

  float edge;           // depth below the surface at which density is full, sd
  float lift;           // 0: density constant with height, 1: growing from the base as in an adiabatic parcel
  float reachM;         // metres by which the surface moves for one sd: bounds empty-space steps
};
