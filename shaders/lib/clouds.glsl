// SPDX-License-Identifier: Apache-2.0
// The density of cloud as a function of position: the one definition that CPU and GPU share.
//
// Position q: metres east and north along the curved ground, and height above it. Density is extinction in 1/m.
// Textures: `placement` has three independent standard-normal maps (round cells, fractal noise, patches); `shapeNoise` and
// `detailNoise` are zero-mean, unit-variance 3D noises. All tile.
// The approach, a placement map giving form to 3D noise that erodes its edges, is that of A. Schneider 2015, "The Real-Time
// Volumetric Cloudscapes of Horizon: Zero Dawn"; here it is written as a level set in units of the placement noise, so that a
// threshold is a cover and the distance to the surface can be bounded.
//
// Needs lib/cloud_layer.glsl before it.

// Earth-centred geometry without loss of precision: p is relative to the ground point below the eye, z up.
WELKIN_FN float heightAboveGround(vec3 p, float earthRadiusM) {
  float c = 2.0f * earthRadiusM + p.z;
  float horizontal2 = p.x * p.x + p.y * p.y;
  float excess = p.z * c + horizontal2;  // |centre p|^2 - R^2
  return excess / (sqrt(earthRadiusM * earthRadiusM + excess) + earthRadiusM);
}

// Distance along the ground: azimuthal equidistant about the eye's foot (series of atan, exact to 1e-6 within 600 km).
WELKIN_FN vec3 cloudPosition(vec3 p, float earthRadiusM) {
  float up = earthRadiusM + p.z;
  float t2 = (p.x * p.x + p.y * p.y) / (up * up);
  float k = earthRadiusM / up * (1.0f - t2 * (1.0f / 3.0f - t2 * 0.2f));
  return vec3(p.x * k, p.y * k, heightAboveGround(p, earthRadiusM));
}

// Position in the frame of a layer's pattern: across and along its streaks, moved with wind and shear.
WELKIN_FN vec2 cloudPatternPosition(CloudLayer layer, vec3 q, float h) {
  vec2 p = vec2(q.x, q.y) - layer.driftM - layer.shearM * h;
  return vec2(dot(p, layer.along), p.y * layer.along.x - p.x * layer.along.y);
}

// Patches are turned against cells by this angle.
WELKIN_CONST float kPatchCosine = 0.8f;
WELKIN_CONST float kPatchSine = 0.6f;

// Placement noise, standard normal.
WELKIN_FN float cloudPlacement(CloudLayer layer, sampler2D placement, vec2 p) {
  vec2 a = vec2(p.x / layer.stretch, p.y);
  vec2 turned = vec2(kPatchCosine * a.x - kPatchSine * a.y, kPatchSine * a.x + kPatchCosine * a.y) / layer.patchM - layer.patchShift;
  vec4 patches = textureLod(placement, turned, 0.0f);
  vec2 b = (a + layer.warpM * vec2(patches.y, patches.x)) / layer.cellM;
  vec4 cells = textureLod(placement, b, 0.0f);
  return layer.cellWeight * cells.x + layer.fractalWeight * cells.y + layer.patchWeight * patches.z;
}

// An anvil is ice: smooth, with soft edges, thin for its size. Against the cloud below it:
WELKIN_CONST float kAnvilShape = 0.55f;      // strength of the large 3D noise
WELKIN_CONST float kAnvilEdge = 8.0f;        // depth of the edge
WELKIN_CONST float kAnvilExtinction = 0.3f;
// Relative heights between which a cloud becomes its anvil.
WELKIN_CONST float kAnvilFrom = 0.62f;
WELKIN_CONST float kAnvilTo = 0.88f;

// How much of an anvil there is at relative height h, [0, 1].
WELKIN_FN float cloudAnvil(CloudLayer layer, float h) { return layer.anvil > 0.0f ? smoothstep(kAnvilFrom, kAnvilTo, h) : 0.0f; }

// How much the surface is drawn in at relative height h in [0, 1], sd.
WELKIN_FN float cloudProfile(CloudLayer layer, float h) {
  float towardsBase = 1.0f - h;
  return layer.dome * pow(h, layer.domePower) + layer.belly * towardsBase * towardsBase - layer.anvil * cloudAnvil(layer, h);
}

// Depth below the surface at which density is full, sd.
WELKIN_FN float cloudEdge(CloudLayer layer, float h) { return layer.edge * mix(1.0f, kAnvilEdge, cloudAnvil(layer, h)); }

// How far q is inside the cloud before the 3D noises shape it, sd; -1e3 above the layer's top and below its base.
WELKIN_FN float cloudSurface(CloudLayer layer, sampler2D placement, vec3 q) {
  float h = (q.z - layer.baseM) / (layer.topM - layer.baseM);
  if (h <= 0.0f || h >= 1.0f) return -1e3f;
  return cloudPlacement(layer, placement, cloudPatternPosition(layer, q, h)) - layer.threshold - cloudProfile(layer, h);
}

// Strength of the large noise where the surface is s away. Noise shapes the surface but makes no cloud of its own: it fades out
// outwards.
WELKIN_FN float cloudShapeAmount(CloudLayer layer, float s, float h) {
  float amount = layer.shapeAmount * mix(layer.shapeAtBase, 1.0f, smoothstep(0.0f, 0.35f, h)) *
                 mix(1.0f, kAnvilShape, cloudAnvil(layer, h));
  return amount * smoothstep(-1.8f * layer.shapeAmount, -0.2f * layer.shapeAmount, s);
}

// Where the noises cannot make cloud, s being cloudSurface there: a distance, metres, within which it stays so (an estimate with a
// margin, 0 or more). Elsewhere -1.
WELKIN_FN float cloudClearance(CloudLayer layer, vec3 q, float s) {
  if (s <= -1e3f) return 0.0f;  // beyond base and top nothing is known
  float h = (q.z - layer.baseM) / (layer.topM - layer.baseM);
  // The noises seldom exceed two and a half deviations.
  if (s + 2.5f * cloudShapeAmount(layer, s, h) + 2.0f * layer.detailAmount > 0.0f) return -1.0f;
  // Nearer the surface the noise comes back and meets the ray half way.
  return max(-s - 0.9f * layer.shapeAmount, 0.0f) * layer.reachM;
}

// Extinction at relative height h in [0, 1] where the cloud is full.
WELKIN_FN float cloudBodyExtinction(CloudLayer layer, float h) {
  float vertical = smoothstep(0.0f, layer.bottomSoft, h) * smoothstep(0.0f, layer.topSoft, 1.0f - h);
  return layer.extinction * vertical * mix(1.0f, 0.4f + 0.9f * sqrt(h), layer.lift) *
         mix(1.0f, kAnvilExtinction, cloudAnvil(layer, h));
}

// How much of the small noise is seen at a distance, [0, 1]: bumps of some 40 m fade out when they are a few pixels wide.
WELKIN_FN float cloudDetailSeen(float distanceM, float pixelRad) { return clamp(2.0f - 4.0f * distanceM * pixelRad / 40.0f, 0.0f, 1.0f); }

// By how much a surface without the small noise lies farther out, as of bumps along a ray those that stand out are met; the less the softer
// the edge is that they are on. amount: the noise's deviation.
WELKIN_FN float cloudHiddenBumps(float amount, float edge) {
  float squared = amount * amount;
  return 0.95f * amount * squared / (squared + 0.6f * edge * edge);
}

// Extinction at q, s being cloudSurface there. `detail` in [0, 1] fades the small noise out where it would be smaller than a pixel or
// a step: clouds are seen no smaller for that. clearM: where the density is 0, a distance within which it stays so; else 0.
WELKIN_FN float cloudExtinctionFrom(CloudLayer layer, sampler3D shapeNoise, sampler3D detailNoise, vec3 q, float s, float detail,
                                    WELKIN_OUT(float) clearM) {
  clearM = cloudClearance(layer, q, s);
  if (clearM >= 0.0f) return 0.0f;
  clearM = 0.0f;
  float h = (q.z - layer.baseM) / (layer.topM - layer.baseM);
  vec2 p = cloudPatternPosition(layer, q, h);
  vec3 p3 = vec3(p.x / layer.shapeStretch, p.y, q.z / layer.shapeTall);
  s += cloudShapeAmount(layer, s, h) * textureLod(shapeNoise, (p3 - layer.shapeShiftM) / layer.shapeM, 0.0f).x;
  float bound = s + 2.0f * layer.detailAmount;
  if (bound <= 0.0f) {
    clearM = -bound * layer.reachM * 0.5f;
    return 0.0f;
  }
  float edge = cloudEdge(layer, h);
  if (layer.detailAmount > 0.0f && s < edge + 2.0f * layer.detailAmount) {
    float amount = layer.detailAmount * mix(layer.shapeAtBase, 1.0f, smoothstep(0.0f, 0.2f, h));
    s += (1.0f - detail) * cloudHiddenBumps(amount, edge);
    if (detail > 0.0f) s += detail * amount * textureLod(detailNoise, (p3 - layer.detailShiftM) / layer.detailM, 0.0f).x;
  }
  if (s <= 0.0f) return 0.0f;
  return cloudBodyExtinction(layer, h) * clamp(s / edge, 0.0f, 1.0f);
}

// The same in one go and with all noises.
WELKIN_FN float cloudExtinction(CloudLayer layer, sampler2D placement, sampler3D shapeNoise, sampler3D detailNoise, vec3 q,
                                WELKIN_OUT(float) clearM) {
  return cloudExtinctionFrom(layer, shapeNoise, detailNoise, q, cloudSurface(layer, placement, q), 1.0f, clearM);
}

// The longest step that resolves a layer: a share of its depth and of its mean free path; and of deep layers, whose forms are large, a
// small share of the depth whatever the path. Light changes slowly in what is drawn out upwards.
WELKIN_FN float cloudStepM(CloudLayer layer) {
  float depth = layer.topM - layer.baseM;
  return sqrt(layer.shapeTall) * max(min(0.25f / layer.extinction, 0.07f * depth), 0.006f * depth);
}
