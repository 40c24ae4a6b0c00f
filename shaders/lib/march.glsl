// SPDX-License-Identifier: Apache-2.0
// The march: from the eye through the shells of all layers in one go, band by band in the order in which the ray meets them, over
// the curved earth. The order is compiled in: WELKIN_EACH_BAND_DOWN(CALL) for rays that come down from above (empty for an eye
// beneath all cloud), then WELKIN_EACH_BAND_UP(CALL).
//
// With thin layers among them (WELKIN_SHEETS) bands are cut at the sheets' heights, and the order is that of WELKIN_EACH_DOWN(BAND, SHEET),
// then WELKIN_EACH_UP(BAND, SHEET): BAND(piece, band) and SHEET(hit). WELKIN_EACH_HIT(CALL) has the hits: CALL(hit, whether it is the farther
// of two, ...) and what WELKIN_EACH_SHEET says of the sheet. A sheet's place in it is that of its
// height overhead: exact for sky planes; a plane rises off the curved earth and a dome comes down to the ground, but they keep
// their place.
// Clouds of metaballs (WELKIN_SPLATS) are one more surface, at their mean distance along the ray.
// Needs lib/sky_uniforms.glsl, lib/light_around.glsl and lib/ground_light.glsl before it, with sheets lib/sheet_ray.glsl and lib/sheet_shadows.glsl, with splats lib/splat_layer.glsl.

#if defined(WELKIN_SHEETS) || defined(WELKIN_SPLATS)
#define WELKIN_SURFACES
#endif

uniform sampler3D uLightVolume;
uniform DropletPhase uDroplets;
#ifdef WELKIN_MIE
uniform sampler2D uMieDroplets;   // red, green, blue by the scattering angle, from 0 to pi (welkin/optics/mie_droplets.h)
#endif
#ifdef WELKIN_HALOS
uniform sampler2D uIcePhase;      // the same of the crystals of ice clouds (welkin/optics/ice_phase.h)
#endif
#ifdef WELKIN_RAIN
uniform sampler2D uRainPhase;     // the same of rain (welkin/optics/rain_phase.h)
#endif
uniform float uStepNearM;         // smallest step
uniform float uStepShare;         // step as a share of the distance
uniform float uStepLong;          // the longest step through clear air, in those of the above
uniform int uMaxSteps;
uniform int uSunSamples;          // density samples towards the sun before the light volume takes over (a loop of none costs as much as of one)
uniform int uSurfaceHalvings;     // of the step in which a surface was met
#ifdef WELKIN_SHEETS
WELKIN_FIXED uniform vec4 uPieces[WELKIN_PIECES];  // base and top of bands cut at sheets, m
uniform int uHits;                // WELKIN_HITS
WELKIN_FIXED uniform vec4 uBandSky[kMaxLayers];  // for each band: of the light of the sky, and (w) of the key light on average, what sheets over it let through
#endif

// A march of segments of a ray, one behind the other (WELKIN_SEGMENTS): none steps beyond its end, and cloud at its beginning is cloud from
// there on.
#ifdef WELKIN_SEGMENTS
#define WELKIN_WITHIN(step) min(step, stretch.y - stretch.x)
#else
// Two steps at least through a stretch, or a short one would be met by some pixels and not by others.
#define WELKIN_WITHIN(step) min(step, 0.5 * (stretch.y - stretch.x))
#endif

// Bands of rain or snow alone, which has neither a sharp edge nor forms that the light volume misses: its surface is not sought, nor are shadows in it.
#ifndef WELKIN_SHAFTS
#define WELKIN_SHAFTS(band) false
#endif

// What is left when a march may end: less where sun or moon shine through, which are many times as bright as clouds.
#ifdef WELKIN_SEGMENTS
float opaqueTowards(vec3 dir) { return 0.01; }
#else
const float kAboutDisc = 0.99985; // cosine, 1 degree
float opaqueTowards(vec3 dir) { return max(dot(dir, uSunDirection), dot(dir, uMoonDirection)) > kAboutDisc ? 0.0005 : 0.05; }
#endif

// The phase functions of the first scattering along a ray, 1/sr.
struct FirstPhases {
  float droplets;       // by the fit
  float ice;            // by two lobes
#ifdef WELKIN_MIE
  vec3 beyondFit;       // what Mie's theory has for droplets, less the fit
#endif
#ifdef WELKIN_HALOS
  vec3 beyondLobes;     // what crystals have, less the two lobes
#endif
#ifdef WELKIN_RAIN
  vec4 rain;            // the first scattering's by colour, and (w) of light scattered twice
#endif
};

struct CloudRay {
  vec3 luminance;       // scattered towards the eye by volumes, cd/m2
  float transmittance;
  float depthM;         // mean distance of the volumes that are seen
#ifdef WELKIN_SURFACES
  float hidden;         // the share of what is behind that volumes hide
  vec3 sheets;          // luminance of surfaces as it arrives, air and all
#endif
};

// The stretch of a ray inside a band on its way up (behind the lowest point) or down; x >= y: none. A ray whose lowest point is in the
// band has one stretch, which counts as down.
vec2 bandStretch(vec2 band, bool up, float dirZ) {
  vec2 outer = sphereCrossings(band.y, dirZ);
  vec2 inner = sphereCrossings(band.x, dirZ);
  bool outerHit = outer.x <= outer.y, innerHit = inner.x <= inner.y;
  if (!outerHit || outer.y <= 0.0) return vec2(0.0);
  if (up) return innerHit ? vec2(max(inner.y, 0.0), outer.y) : vec2(0.0);
  return vec2(max(outer.x, 0.0), innerHit ? inner.x : outer.y);
}

#ifdef WELKIN_RAIN
// Depths of droplets that would scatter light as often as these do, where a share is rain; it is so for no more of them than the rain from
// the place to top and base can come to. place: as CloudPoint's, for each extinction.
CloudDepths depthsAsOfDroplets(CloudDepths d, float rain, vec4 place) {
  float more = rain * ((1.0 - kRainAsymmetry) / kSimilarity - 1.0);
  float above = (1.0 - place.y) * place.z * place.w, below = place.y * place.z * place.w;
  float slant = 1.0 / max(abs(uKeyDirection.z), 0.05);
  vec2 alongSun = slant * (uLineTowardsSun > 0.5 ? vec2(above, below) : vec2(below, above));
  return CloudDepths(d.toSun + more * min(d.toSun, alongSun.x), d.fromSun + more * min(d.fromSun, alongSun.y),
                     d.up + more * min(d.up, above), d.down + more * min(d.down, below));
}
#endif

// Source function at q: scattered radiance per unit extinction, cd/m2.
vec3 cloudSource(int band, vec3 p, vec3 q, CloudPoint point, float detail, FirstPhases phases, CloudView view, vec3 dir, float dither) {
  // Towards the sun: first through the point's own density, then through samples at distances that grow
  // cubically, fine where shadows are sharp, the nearest with the small noise; then as the light volume says. It knows nothing of
  // forms smaller than its cells, and a surface that faces the sun would lie in its own shadow: there is a sample for every cell of the
  // way, as far as there is cloud.
  int sunSamples = WELKIN_SHAFTS(band) ? 0 : uSunSamples;
  float edge = (uKeyDirection.z >= 0.0 ? uBands[band].y : uBands[band].x) - q.z;
  float reachM = min(float(sunSamples) * lightVolumeCellM(uLightVolume, q), max(edge / uKeyDirection.z, 1.0));
  float done = reachM / pow(float(sunSamples) + 1.0, 3.0);
  float near = point.extinction * done;
  for (int i = 1; i <= sunSamples; ++i) {
    float x = (float(i) + 1.0) / (float(sunSamples) + 1.0);
    float end = reachM * x * x * x;
    float at = mix(done, end, 0.3 + 0.4 * fract(dither + 0.382 * float(i)));
    near += (end - done) * cloudExtinctionInBand(band, q + uKeyDirection * at, i == 1 ? detail : 0.0);
    done = end;
  }
  CloudDepths depths = cloudDepthsAt(uLightVolume, q);
  depths.toSun = near + cloudDepthsAt(uLightVolume, q + uKeyDirection * done).toSun;
  float ice = point.ice / point.extinction;
  PhasePeak droplets = dropletPeak(uDroplets);
  CloudPhase phase = CloudPhase(mix(phases.droplets, phases.ice, ice),
                                PhasePeak(mix(droplets.share, kIcePeakShare, ice), mix(droplets.g, kIcePeakG, ice)));
  vec4 place = point.place / point.extinction;
  float cover = point.cover / point.extinction;
#ifdef WELKIN_RAIN
  // The first scattering by rain is its table's, and there is no peak. For the others there are the closed forms: it is no cloud, and the
  // network has not seen it.
  float rain = point.rain / point.extinction;
  phase.first -= rain * phases.droplets;
  phase.peak.share *= 1.0 - rain;
  CloudScattering scattered;
  if (WELKIN_SHAFTS(band) || rain > 0.5) {
    CloudDepths alike = depthsAsOfDroplets(depths, rain, place);
    scattered = CloudScattering(cloudSunSourceOf(alike, 0.0, kRainFew * phases.rain.w, view.cosSun, dir.z, uKeyDirection.z),
                                cloudSkyShares(alike));
    scattered.sun += phase.first * exp(-depths.toSun);
  } else {
    scattered = cloudScattering(depths, view, CloudPlace(ice, cover, place.x, place.y, place.z, place.w), phase, uKeyDirection.z);
  }
#else
  const float rain = 0.0;
  CloudScattering scattered = cloudScattering(depths, view, CloudPlace(ice, cover, place.x, place.y, place.z, place.w), phase, uKeyDirection.z);
#endif
  scattered.shares = mix(cloudSkyShares(depths), scattered.shares, uKeyCounts);
  // Light from above comes into a deck through its top, and into a cloud among others through its sides.
  float enteredM = mix(q.z, q.z + (1.0 - place.y) * place.z, cover * cover * cover * cover);
  LightWeights weights = lightWeights(depths, view.cosSun, view.height);
  vec3 sun = vec3(scattered.sun);
#ifdef WELKIN_MIE
  sun += (1.0 - ice - rain) * exp(-depths.toSun) * phases.beyondFit;
#endif
#ifdef WELKIN_HALOS
  sun += point.crystals / point.extinction * exp(-depths.toSun) * phases.beyondLobes;
#endif
#ifdef WELKIN_RAIN
  sun += rain * exp(-depths.toSun) * vec3(phases.rain);
#endif
  vec3 above = lightFromAbove(weights, dir, enteredM);
#ifdef WELKIN_SHEETS
  // Sheets cast shadows where light comes straight; deeper inside it has come from all around.
  sun *= mix(uBandSky[band].w, sheetsSunlight(q), exp(-kDiffuseOnset * depths.toSun));
  above *= vec3(uBandSky[band]);
#endif
  return uKeyShown * keyLightAt(q.z, p) * sun + above * scattered.shares.x +
         lightFromBelow(weights, dir, q.z) * (groundSharesFrom(q).y * scattered.shares.y);
}

// What a march carries along a ray.
struct MarchState {
  vec3 luminance;
  float transmittance;
  float weightedDepth;
  float weight;
  int steps;
#ifdef WELKIN_SURFACES
  vec3 sheets;
#endif
#ifdef WELKIN_SPLATS
  SplatSeen splats;     // no light: behind the ray
#endif
};

#ifdef WELKIN_SPLATS
// Those that are met before a distance.
void meetSplats(float distanceM, inout MarchState state) {
  if (state.splats.distanceM >= distanceM || state.splats.light.w <= 0.0) return;
  state.sheets += state.transmittance * vec3(state.splats.light);
  state.transmittance *= max(1.0 - state.splats.light.w, 0.0);
  state.splats.light = vec4(0.0);
}
#endif

// Two loops, one in the other: the inner one finds the next sample in cloud, the outer one lights it. Pixels that are drawn together
// then light together, however far apart their clouds are. Behind a surface, which is sought by halving, steps grow from half a mean
// free path on: most of what is seen lies there, and the light changes fastest.
void marchBand(int band, vec2 stretch, vec3 dir, float pixelRad, FirstPhases phases, float cosSun, vec2 dither,
               inout MarchState state) {
  float t = stretch.x;
  t += WELKIN_WITHIN(max(uStepNearM, uStepShare * t)) * (0.02 + dither.x);
  float lastClear = stretch.x;  // a place in front of the surface
  int fine = 0;                 // short steps to go before stepping far again
  bool entering = true;         // the next sample in cloud is the first behind a surface
  bool fromStart = false;       // there has been cloud since the stretch began: from there on steps are laid end to end
  float skinStep = 1e9;         // steps grow from the surface on, where most of what is seen lies
  float opaque = opaqueTowards(dir);
  while (state.steps < uMaxSteps && t < stretch.y && state.transmittance > 0.0) {
    vec3 p, q;
    CloudPoint point;
    float shortStep, detail;
    bool hit = false;
    while (state.steps < uMaxSteps && t < stretch.y) {
      CloudSurfaces surfaces;
      float clearM = -1.0;
      while (state.steps < uMaxSteps && t < stretch.y) {
        ++state.steps;
        p = vec3(0.0, 0.0, uEyeM) + dir * t;
        q = cloudPosition(p, uEarthRadiusM);
        detail = cloudDetailSeen(t, pixelRad);
        shortStep = WELKIN_WITHIN(max(uStepNearM, uStepShare * t));
        clearM = clearanceInBand(band, q, surfaces);
        if (clearM < 0.0) break;
        lastClear = t;
        t += fine > 0 ? shortStep : clamp(clearM, shortStep, uStepLong * shortStep);
        --fine;
      }
      if (clearM >= 0.0) break;
      point = cloudsAtSurfaces(band, q, detail, surfaces);
      if (point.inside) shortStep = WELKIN_WITHIN(max(shortStep, point.stepM));
      if (point.extinction <= 0.0) {
        lastClear = t;
        t += fine > 0 ? shortStep : clamp(point.clearM, shortStep, uStepLong * shortStep);
        --fine;
      } else if (fine <= 0) {
        // Out of clear air into a cloud: back, and on with short steps from a place of chance. (Bounded steps end at the same depth
        // under the surface whatever place they began at, and would draw lines of equal depth on it.) The places are those that short
        // steps all the way would come to, so that sub-frames whose dithers lie evenly sample the cloud evenly. That way begins with the
        // stretch: counted from the eye, phases would drift across a layer's even base and draw rings with the noise of pixels.
        fine = 2 + int((t - lastClear) / shortStep);
        bool evenSteps = shortStep > 1.001 * uStepShare * t;  // or they grow with the distance
        float steps = evenSteps ? (lastClear - stretch.x) / shortStep : log(max(lastClear, 1.0) / max(stretch.x, 1.0)) / log(1.0 + uStepShare);
        t = lastClear + shortStep * fract(dither.x - steps);
        entering = true;
      } else {
        hit = true;
        break;
      }
    }
    if (!hit) break;
    fine = max(fine, 2);
    if (entering) {
      skinStep = 0.5 / point.extinction;
      fromStart = lastClear == stretch.x;
      // The surface of dense cloud lies in the last step. Thin cloud is left where it was met: a place of chance in it, which stands for a step
      // of it. From one to the other more and more of the step is searched, or there would be a line between them.
      if (!WELKIN_SHAFTS(band) && skinStep < shortStep) {
        float clear = mix(t, lastClear, smoothstep(1.0, 2.0, shortStep / skinStep));
        for (int i = 0; i < uSurfaceHalvings; ++i) {
          float middle = 0.5 * (clear + t);
          CloudSurfaces surfaces;
          vec3 pm = vec3(0.0, 0.0, uEyeM) + dir * middle;
          vec3 qm = cloudPosition(pm, uEarthRadiusM);
          clearanceInBand(band, qm, surfaces);
          CloudPoint there = cloudsAtSurfaces(band, qm, detail, surfaces);
          if (there.extinction > 0.0) {
            t = middle;
            p = pm;
            q = qm;
            point = there;
          } else {
            clear = middle;
            fromStart = false;
          }
        }
      }
      if (fromStart) t = stretch.x;
      entering = false;
    }
#ifdef WELKIN_SPLATS
    meetSplats(t, state);
#endif
    float stepM = min(shortStep, skinStep);
#ifdef WELKIN_SEGMENTS
    stepM = min(stepM, stretch.y - t);
#else
    if (fromStart) stepM = min(stepM, stretch.y - t);
#endif
    skinStep *= 2.0;
    float through = exp(-point.extinction * stepM);
    float share = state.transmittance * (1.0 - through);
    state.luminance += share * cloudSource(band, p, q, point, detail, phases,
                                           CloudView(cosSun, dir.z, -log(state.transmittance), t,
                                                     cloudDepthsAt(uLightVolume, q + kBehindM * dir),
                                                     CloudFluence(fluenceAt(q), fluenceAt(q + kAheadM * dir))),
                                           dir, dither.y);
    state.weightedDepth += share * t;
    state.weight += share;
    state.transmittance *= through;
    if (state.transmittance < opaque) {
      // What is left would look like what was seen.
      state.luminance /= 1.0 - state.transmittance;
#ifdef WELKIN_SURFACES
      state.sheets /= 1.0 - state.transmittance;
      state.weightedDepth /= 1.0 - state.transmittance;
      state.weight /= 1.0 - state.transmittance;
#endif
      state.transmittance = 0.0;
    }
    t += stepM;
  }
}

#ifdef WELKIN_SHEETS
// What a ray sees of a sheet: where, which, how much of it, and of its pattern what the light asks for.
struct SheetSeen {
  SheetHit hit;
  int sheet;
  float alpha;
  vec4 texel;
  vec3 way;
};

// Its luminance there.
vec3 ownLightOfSheet(SheetSeen seen, vec3 dir, FirstPhases phases, float cosSun) {
  float sun = exp(-cloudDepthToSun(uLightVolume, cloudPosition(seen.hit.p, uEarthRadiusM)));
  return sheetLuminance(seen.sheet, WELKIN_SHEET_TIER(seen.sheet), seen.hit, seen.texel, seen.way, sun, phases.droplets, cosSun, dir.z);
}

// As it arrives, air and all.
vec3 lightOfSheet(SheetSeen seen, vec3 dir, FirstPhases phases, float cosSun) {
  vec3 inscatter, through;
  aerial(dir, seen.hit.distanceM, inscatter, through);
  return ownLightOfSheet(seen, dir, phases, cosSun) * through + inscatter;
}
#endif

#ifdef WELKIN_SPLATS
#define WELKIN_MARCH_BEGIN MarchState(vec3(0.0), 1.0, 0.0, 0.0, 0, vec3(0.0), splatsAlong(dir))
#elif defined(WELKIN_SHEETS)
#define WELKIN_MARCH_BEGIN MarchState(vec3(0.0), 1.0, 0.0, 0.0, 0, vec3(0.0))
#else
#define WELKIN_MARCH_BEGIN MarchState(vec3(0.0), 1.0, 0.0, 0.0, 0)
#endif

#if defined(WELKIN_MIE) || defined(WELKIN_HALOS) || defined(WELKIN_RAIN)
// By the angle's tangent, as cosines know little of those near the glory; ends are middles of texels.
vec4 phaseOfTable(sampler2D table, vec3 dir, float cosSun) {
  float angle = atan(length(cross(dir, uKeyDirection)), cosSun) / 3.14159265;
  float texels = float(textureSize(table, 0).x);
  return textureLod(table, vec2((angle * (texels - 1.0) + 0.5) / texels, 0.5), 0.0);
}
#endif

// Of droplets, of ice and of rain.
FirstPhases cloudPhases(vec3 dir, float cosSun) {
  FirstPhases phases;
  phases.droplets = phaseDroplet(cosSun, uDroplets);
  phases.ice = phaseIce(cosSun);
#ifdef WELKIN_MIE
  phases.beyondFit = vec3(phaseOfTable(uMieDroplets, dir, cosSun)) - phases.droplets;
#endif
#ifdef WELKIN_HALOS
  phases.beyondLobes = vec3(phaseOfTable(uIcePhase, dir, cosSun)) - phases.ice;
#endif
#ifdef WELKIN_RAIN
  phases.rain = phaseOfTable(uRainPhase, dir, cosSun);
#endif
  return phases;
}

// Rays that were not marched to their ends have nothing left; those that were just not ended have as much as opaqueTowards() says. Between
// them and rays of which much is left it fades, and there is no line.
void fadeToOpaque(vec3 dir, inout MarchState state) {
  const float kFadeFrom = 4.0;  // in what is left when a march ends
  float opaque = opaqueTowards(dir);
  if (state.steps == 0 || state.transmittance <= 0.0 || state.transmittance >= kFadeFrom * opaque) return;
  float left = max(state.transmittance - opaque, 0.0) * (kFadeFrom / (kFadeFrom - 1.0));
  float more = (1.0 - left) / (1.0 - state.transmittance);
  state.luminance *= more;
#ifdef WELKIN_SURFACES
  state.sheets *= more;
#endif
  state.weightedDepth *= more;
  state.weight *= more;
  state.transmittance = left;
}

CloudRay marchClouds(vec3 dir, float endM, float pixelRad, vec2 dither) {
  float cosSun = dot(dir, uKeyDirection);
  FirstPhases phases = cloudPhases(dir, cosSun);
#ifdef WELKIN_SHEETS
  MarchState state = WELKIN_MARCH_BEGIN;
  vec2 stretch;
  // All sheets first, as the order of light does not matter: where, and their patterns, one by one, since samplers are; then their
  // light in a loop, which compilers are not to unroll (uHits): the shader grows little with each sheet.
  SheetSeen seen[WELKIN_HITS];
  vec3 sheetLight[WELKIN_HITS];
#define WELKIN_PATTERN(VECTOR, pattern, i, share, level) \
  textureLod(pattern, VECTOR(hit.coordinate + share * vec3(uSheetSunStep[i])), level).x
#define WELKIN_SEE(k, far, i, kind, tier, VECTOR, SAMPLER, pattern)                                                 \
  {                                                                                                                 \
    SheetHit hit = meetSheet(i, kind, far, dir, endM, pixelRad);                                                    \
    vec4 texel = textureGrad(pattern, VECTOR(hit.coordinate), VECTOR(hit.across), VECTOR(hit.along));               \
    vec3 way = vec3(0.0);                                                                                           \
    if (tier == 2) {                                                                                                \
      float level = floor(sheetWayLevel(uSheetRay[i].y * pixelRad, max(hit.distanceM, 1.0)));                       \
      way = vec3(WELKIN_PATTERN(VECTOR, pattern, i, kSheetWay.x, level),                                            \
                 WELKIN_PATTERN(VECTOR, pattern, i, kSheetWay.y, level),                                            \
                 WELKIN_PATTERN(VECTOR, pattern, i, kSheetWay.z, level));                                           \
    }                                                                                                               \
    seen[k] = SheetSeen(hit, i, hit.most - hit.most * exp(-sheetDepth(uSheets[i], texel.x)), texel, way);           \
  }
  WELKIN_EACH_HIT(WELKIN_SEE)
  for (int k = 0; k < uHits; ++k)
    if (seen[k].alpha > 0.0) sheetLight[k] = lightOfSheet(seen[k], dir, phases, cosSun);
#define WELKIN_MARCH(p, band, up)                            \
  stretch = bandStretch(vec2(uPieces[p]), up, dir.z);        \
  stretch.y = min(stretch.y, endM);                          \
  marchBand(band, stretch, dir, pixelRad, phases, cosSun, dither, state);
#define WELKIN_MARCH_DOWN(p, band) WELKIN_MARCH(p, band, false)
#define WELKIN_MARCH_UP(p, band) WELKIN_MARCH(p, band, true)
#ifdef WELKIN_SPLATS
#define WELKIN_MEET_SPLATS(distanceM) meetSplats(distanceM, state);
#else
#define WELKIN_MEET_SPLATS(distanceM)
#endif
#define WELKIN_ADD_SHEET(k)                                                              \
  if (seen[k].alpha > 0.0) {                                                             \
    WELKIN_MEET_SPLATS(seen[k].hit.distanceM)                                            \
    state.sheets += state.transmittance * seen[k].alpha * sheetLight[k];                 \
    state.transmittance *= 1.0 - seen[k].alpha;                                          \
  }
  WELKIN_EACH_DOWN(WELKIN_MARCH_DOWN, WELKIN_ADD_SHEET)
  WELKIN_EACH_UP(WELKIN_MARCH_UP, WELKIN_ADD_SHEET)
  WELKIN_MEET_SPLATS(endM)
  fadeToOpaque(dir, state);
  return CloudRay(state.luminance, state.transmittance, state.weight > 0.0 ? state.weightedDepth / state.weight : 0.0, state.weight,
                  state.sheets);
#else
  MarchState state = WELKIN_MARCH_BEGIN;
  vec2 stretch;
#define WELKIN_MARCH_DOWN(i)                                \
  stretch = bandStretch(vec2(uBands[i]), false, dir.z);     \
  stretch.y = min(stretch.y, endM);                         \
  marchBand(i, stretch, dir, pixelRad, phases, cosSun, dither, state);
#define WELKIN_MARCH_UP(i)                                  \
  stretch = bandStretch(vec2(uBands[i]), true, dir.z);      \
  stretch.y = min(stretch.y, endM);                         \
  marchBand(i, stretch, dir, pixelRad, phases, cosSun, dither, state);
  WELKIN_EACH_BAND_DOWN(WELKIN_MARCH_DOWN)
  WELKIN_EACH_BAND_UP(WELKIN_MARCH_UP)
#ifdef WELKIN_SPLATS
  meetSplats(endM, state);
#endif
  fadeToOpaque(dir, state);
#ifdef WELKIN_SPLATS
  return CloudRay(state.luminance, state.transmittance, state.weight > 0.0 ? state.weightedDepth / state.weight : 0.0, state.weight,
                  state.sheets);
#else
  return CloudRay(state.luminance, state.transmittance, state.weight > 0.0 ? state.weightedDepth / state.weight : 0.0);
#endif
#endif
}
