// SPDX-License-Identifier: Apache-2.0
// The clear sky: medium, table parametrisations, and the ray-march integrals that fill the tables.
// After S. Hillaire 2020, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique" (tables, multiple scattering) and
// E. Bruneton and F. Neyret 2008, "Precomputed Atmospheric Scattering" (transmittance parametrisation).
// Beyond Hillaire, light scattered more than once remembers where it came from. What coarse haze scatters into its narrow peak goes on as a
// second, wider beam (delta scaling: J. H. Joseph, W. J. Wiscombe and J. A. Weinman 1976, "The Delta-Eddington Approximation for Radiative
// Flux Transfer"); what is left has a mean and two moments along the line to the light.
//
// Needs phase.glsl and eclipse.glsl before it. Shared by C++ and GLSL, see welkin/core/glsl.h.
// Frame: at the eye, z up, x and y horizontal. h: altitude above mean sea level in metres; mu: cosine of the angle from the
// zenith; t: metres along a ray. Altitudes along rays are computed as differences, so that 32 bits hold them to millimetres although
// the earth's radius does not fit. Light in linear Rec. 709 (cd/m2, lux), extinction in 1/m. All tables want linear filtering and
// clamping at the edges.

// Sizes of the tables in texels. The ends of a table's coordinates, 0 and 1, fall on the centres of its first and last texel.
WELKIN_CONST float kTransmittanceWidth = 256.0f;   // by direction
WELKIN_CONST float kTransmittanceHeight = 64.0f;   // by altitude
WELKIN_CONST float kMultipleScatteringSize = 32.0f;  // of each of the moments, one beside another along y
WELKIN_CONST float kMultipleScatteringMoments = 3.0f;
WELKIN_CONST float kSkyViewWidth = 192.0f;         // by azimuth
WELKIN_CONST float kSkyViewHeight = 128.0f;        // by elevation, lower half under the horizon
WELKIN_CONST float kAerialAzimuths = 48.0f;
WELKIN_CONST float kAerialElevations = 48.0f;
WELKIN_CONST float kAerialDistances = 32.0f;
WELKIN_CONST float kAerialNearM = 500.0f;          // distances are spaced evenly up to about here, then by ratio
WELKIN_CONST float kAerialFarM = 500000.0f;

WELKIN_CONST float kAtmospherePi = 3.14159265f;
WELKIN_CONST float kLightRadiusRad = 0.00465f;     // of the discs of sun and moon

struct Atmosphere {
  float seaRadiusM;            // radius of the sphere at altitude 0
  float groundAltitudeM;
  float topAltitudeM;
  vec3 rayleighScattering;     // 1/m at altitude 0
  float rayleighScaleHeightM;
  vec3 aerosolExtinction;      // 1/m at the ground
  vec3 aerosolScattering;      // 1/m at the ground
  float aerosolScaleHeightM;
  float aerosolG;              // mean cosine of phaseHaze()
  vec3 ozoneAbsorption;        // 1/m at the layer's peak
  float ozoneAltitudeM;        // of the peak; the profile is a tent
  float ozoneHalfWidthM;
  vec3 groundAlbedo;
  vec3 airglow;                // zenith luminance outside the lower atmosphere, cd/m2
  float airglowAltitudeM;
};

// ---- Geometry -------------------------------------------------------------------------------------------------------------------

// (radius at h0)^2 - (radius at h1)^2 without cancellation.
WELKIN_FN float atmosphereSquareDifference(Atmosphere a, float h0, float h1) {
  return (h0 - h1) * (2.0f * a.seaRadiusM + h0 + h1);
}

// Altitude at t along a ray from h.
WELKIN_FN float atmosphereAltitudeAlong(Atmosphere a, float h, float mu, float t) {
  float r = a.seaRadiusM + h;
  float k = t * (2.0f * r * mu + t);
  return h + k / (sqrt(max(r * r + k, 0.0f)) + r);
}

// Cosine of the zenith angle of the horizon, 0 or less.
WELKIN_FN float atmosphereHorizonMu(Atmosphere a, float h) {
  return -sqrt(max(atmosphereSquareDifference(a, h, a.groundAltitudeM), 0.0f)) / (a.seaRadiusM + h);
}

// Distance to where a ray from h, at or under altitude top, leaves the sphere of that altitude.
WELKIN_FN float atmosphereDistanceToSphere(Atmosphere a, float h, float mu, float top) {
  float b = (a.seaRadiusM + h) * mu;
  float c = min(atmosphereSquareDifference(a, h, top), 0.0f);
  float s = sqrt(b * b - c);
  return b > 0.0f ? -c / (b + s) : s - b;
}

// Distance to the ground, or -1 where the ray misses it.
WELKIN_FN float atmosphereDistanceToGround(Atmosphere a, float h, float mu) {
  float b = (a.seaRadiusM + h) * mu;
  float c = max(atmosphereSquareDifference(a, h, a.groundAltitudeM), 0.0f);
  float disc = b * b - c;
  if (mu >= 0.0f || disc < 0.0f) return -1.0f;
  return c / (sqrt(disc) - b);
}

// ---- Medium ---------------------------------------------------------------------------------------------------------------------

struct AtmosphereMedium {
  vec3 rayleigh;    // scattering, 1/m
  vec3 aerosol;     // scattering, 1/m
  vec3 extinction;  // 1/m
};

WELKIN_FN float atmosphereOzone(Atmosphere a, float h) {
  return max(1.0f - abs(h - a.ozoneAltitudeM) / a.ozoneHalfWidthM, 0.0f);
}

WELKIN_FN AtmosphereMedium atmosphereMedium(Atmosphere a, float h) {
  float aerosol = exp(-max(h - a.groundAltitudeM, 0.0f) / a.aerosolScaleHeightM);
  AtmosphereMedium m;
  m.rayleigh = a.rayleighScattering * exp(-h / a.rayleighScaleHeightM);
  m.aerosol = a.aerosolScattering * aerosol;
  m.extinction = m.rayleigh + a.aerosolExtinction * aerosol + a.ozoneAbsorption * atmosphereOzone(a, h);
  return m;
}

// Integral of exp(-h / scale) over a step of dt along which h goes from h0 to h1 evenly.
WELKIN_FN float atmosphereExponentialStep(float h0, float h1, float scale, float dt) {
  float x = (h1 - h0) / scale;
  float mean = abs(x) < 0.01f ? 1.0f - 0.5f * x : (1.0f - exp(-x)) / x;
  return dt * exp(-h0 / scale) * mean;
}

// Optical depth from h to space along mu (rgb), and the way through aerosol in metres of that at the ground (a). The ray must miss the
// ground.
WELKIN_FN vec4 atmosphereOpticalDepth(Atmosphere a, float h, float mu) {
  const int kSteps = 16;
  float tEnd = atmosphereDistanceToSphere(a, h, mu, a.topAltitudeM);
  float tLow = clamp(-(a.seaRadiusM + h) * mu, 0.0f, tEnd);  // the lowest point; steps are short around it
  float rayleigh = 0.0f;
  float aerosol = 0.0f;
  float ozone = 0.0f;
  for (int side = 0; side < 2; ++side) {
    float reach = side == 0 ? tEnd - tLow : -tLow;
    if (reach == 0.0f) continue;
    float t0 = tLow;
    float h0 = atmosphereAltitudeAlong(a, h, mu, t0);
    for (int i = 1; i <= kSteps; ++i) {
      float x = float(i) / float(kSteps);
      float t1 = tLow + reach * x * x;
      float h1 = atmosphereAltitudeAlong(a, h, mu, t1);
      float dt = abs(t1 - t0);
      rayleigh += atmosphereExponentialStep(h0, h1, a.rayleighScaleHeightM, dt);
      aerosol += atmosphereExponentialStep(h0 - a.groundAltitudeM, h1 - a.groundAltitudeM, a.aerosolScaleHeightM, dt);
      ozone += dt * 0.25f * (atmosphereOzone(a, h0) + 2.0f * atmosphereOzone(a, 0.5f * (h0 + h1)) + atmosphereOzone(a, h1));
      t0 = t1;
      h0 = h1;
    }
  }
  return vec4(a.rayleighScattering * rayleigh + a.aerosolExtinction * aerosol + a.ozoneAbsorption * ozone, aerosol);
}

// ---- Transmittance table: x by direction from the zenith to the horizon, y by altitude; in alpha the way through aerosol in
// metres of that at the ground, over its scale height ---------------------------------------------------------------------------

WELKIN_FN vec2 atmosphereTransmittanceUv(Atmosphere a, float h, float mu) {
  float full = sqrt(atmosphereSquareDifference(a, a.topAltitudeM, a.groundAltitudeM));
  float rho = sqrt(max(atmosphereSquareDifference(a, h, a.groundAltitudeM), 0.0f));
  float d = atmosphereDistanceToSphere(a, h, mu, a.topAltitudeM);
  float dMin = a.topAltitudeM - h;
  float x = clamp((d - dMin) / max(rho + full - dMin, 1.0f), 0.0f, 1.0f);
  float y = clamp(rho / full, 0.0f, 1.0f);
  return vec2((0.5f + x * (kTransmittanceWidth - 1.0f)) / kTransmittanceWidth,
              (0.5f + y * (kTransmittanceHeight - 1.0f)) / kTransmittanceHeight);
}

// The inverse: altitude and mu at x, y in [0, 1].
WELKIN_FN vec2 atmosphereTransmittanceParameters(Atmosphere a, float x, float y) {
  float full = sqrt(atmosphereSquareDifference(a, a.topAltitudeM, a.groundAltitudeM));
  float rho = full * y;
  float rg = a.seaRadiusM + a.groundAltitudeM;
  float h = a.groundAltitudeM + rho * rho / (sqrt(rho * rho + rg * rg) + rg);
  float dMin = a.topAltitudeM - h;
  float d = dMin + x * (rho + full - dMin);
  float r = a.seaRadiusM + h;
  float mu = d <= 0.0f ? 1.0f : clamp((full * full - rho * rho - d * d) / (2.0f * r * d), -1.0f, 1.0f);
  return vec2(h, mu);
}

// What arrives at h of a light at mu: straight from it, and of what coarse haze has turned by little on the way. Both fade to 0 while the
// light's disc sinks behind the earth.
struct AtmosphereBeams {
  vec3 straight;
  vec3 turned;
};

WELKIN_FN AtmosphereBeams atmosphereBeams(Atmosphere a, sampler2D transmittanceLut, float altitudeM, float mu) {
  float h = clamp(altitudeM, a.groundAltitudeM, a.topAltitudeM);
  float horizon = atmosphereHorizonMu(a, h);
  float width = kLightRadiusRad * sqrt(max(1.0f - horizon * horizon, 0.0f));
  float seen = smoothstep(-width, width, mu - horizon);
  if (seen <= 0.0f) return AtmosphereBeams(vec3(0.0f), vec3(0.0f));
  vec4 table = textureLod(transmittanceLut, atmosphereTransmittanceUv(a, h, max(mu, horizon)), 0.0f);
  // No more than haze alone lets through: between texels of a thick haze the one is not the exponential of the other.
  float wayM = a.aerosolScaleHeightM * table.w;
  vec3 straight = min(vec3(table), exp(-a.aerosolExtinction * wayM)) * seen;
  vec3 peak = kHazePeakWeight * a.aerosolScattering * wayM;
  return AtmosphereBeams(straight, straight * (exp(min(peak, vec3(80.0f))) - vec3(1.0f)));  // finite in fog, too
}

// Transmittance from h to space towards a light at mu.
WELKIN_FN vec3 atmosphereTransmittance(Atmosphere a, sampler2D transmittanceLut, float altitudeM, float mu) {
  return atmosphereBeams(a, transmittanceLut, altitudeM, mu).straight;
}

// ---- Multiple-scattering table: x by the light's mu, y by moment and altitude ---------------------------------------------------
// The luminance around a point, all but the two beams, as sum of moment_l P_l(c), of the cosine c of the angle from the light.

// Denser where the light is near the horizon and where the air is dense. Of the moment 0; for the next ones y + 1 / moments.
WELKIN_FN vec2 atmosphereMultipleScatteringUv(Atmosphere a, float h, float muLight) {
  float x = 0.5f + 0.5f * sign(muLight) * sqrt(abs(muLight));
  float y = sqrt(clamp((h - a.groundAltitudeM) / (a.topAltitudeM - a.groundAltitudeM), 0.0f, 1.0f));
  return vec2((0.5f + x * (kMultipleScatteringSize - 1.0f)) / kMultipleScatteringSize,
              (0.5f + y * (kMultipleScatteringSize - 1.0f)) / (kMultipleScatteringSize * kMultipleScatteringMoments));
}

WELKIN_FN vec2 atmosphereMultipleScatteringParameters(Atmosphere a, float x, float y) {
  float s = 2.0f * x - 1.0f;
  return vec2(a.groundAltitudeM + y * y * (a.topAltitudeM - a.groundAltitudeM), s * abs(s));
}

// Light that reaches a point at h after one scattering along `dir`, per unit of illuminance (first), and the fraction of isotropic
// light of luminance 1 at each point that does (second): Hillaire's L_2nd and f_ms before the mean over directions. Scattering into the
// haze's narrow peak is none here. lightDir in the frame of the point. The ground reflects diffusely.
WELKIN_FN void atmosphereSecondOrder(Atmosphere a, sampler2D transmittanceLut, float h, vec3 dir, vec3 lightDir,
                                     WELKIN_OUT(vec3) single, WELKIN_OUT(vec3) gathered) {
  const int kSteps = 16;
  float r = a.seaRadiusM + h;
  float tGround = atmosphereDistanceToGround(a, h, dir.z);
  float tEnd = tGround >= 0.0f ? tGround : atmosphereDistanceToSphere(a, h, dir.z, a.topAltitudeM);
  float c = dot(dir, lightDir);
  float rayleighPhase = phaseRayleigh(c);
  float aerosolPhase = phaseHenyeyGreenstein(c, hazeFineG(a.aerosolG));
  vec3 through = vec3(1.0f);
  single = vec3(0.0f);
  gathered = vec3(0.0f);
  float t0 = 0.0f;
  for (int i = 1; i <= kSteps; ++i) {
    float x = float(i) / float(kSteps);
    float t1 = tEnd * x * x;
    float t = 0.5f * (t0 + t1);
    float ht = atmosphereAltitudeAlong(a, h, dir.z, t);
    float muLight = (r * lightDir.z + t * c) / (a.seaRadiusM + ht);
    AtmosphereMedium m = atmosphereMedium(a, ht);
    vec3 aerosol = (1.0f - kHazePeakWeight) * m.aerosol;
    vec3 extinction = m.extinction - kHazePeakWeight * m.aerosol;
    vec3 stepThrough = exp(-extinction * (t1 - t0));
    vec3 weight = through * (vec3(1.0f) - stepThrough) / max(extinction, vec3(1e-20f));
    AtmosphereBeams beams = atmosphereBeams(a, transmittanceLut, ht, muLight);
    single += weight * (beams.straight + beams.turned) * (m.rayleigh * rayleighPhase + aerosol * aerosolPhase);
    gathered += weight * (m.rayleigh + aerosol);
    through *= stepThrough;
    t0 = t1;
  }
  if (tGround >= 0.0f) {
    float muLight = (r * lightDir.z + tGround * c) / (a.seaRadiusM + a.groundAltitudeM);
    AtmosphereBeams beams = atmosphereBeams(a, transmittanceLut, a.groundAltitudeM, muLight);
    single += through * a.groundAlbedo * (max(muLight, 0.0f) / kAtmospherePi) * (beams.straight + beams.turned);
  }
}

// ---- In-scattering along a ray -----------------------------------------------------------------------------------------------

// Two lights; the second may have no illuminance. Directions in the frame of the eye.
struct AtmosphereLights {
  vec3 direction0;
  vec3 illuminance0;  // lux at the top of the atmosphere, not eclipsed
  MoonShadow shadow0;
  vec3 direction1;
  vec3 illuminance1;
  MoonShadow shadow1;
};

// Shares of a light at a place, metres from the eye: of its own (x), and of what of it the air about the place has scattered (y). Into the
// moon's umbra comes light that the air outside has scattered (G. E. Shaw 1978, "Sky radiance during a total solar eclipse: a theoretical
// model"): fitted to clear skies of the reference renderer in the totalities of Dallas 2024, the sun 65 degrees up, and Leon 2026, 10 degrees.
WELKIN_CONST float kIntoUmbra = 1.1e-3f;
WELKIN_FN vec2 atmosphereLightShares(MoonShadow shadow, vec3 lightDir, vec3 fromEyeM) {
  if (shadow.moonRadius <= 0.0f) return vec2(1.0f);
  float share = sunShareAt(shadow, lightDir, fromEyeM);
  return vec2(share, share + kIntoUmbra * (1.0f - share));
}

// How the air turns light by the angle between a ray and a light: phase functions, of haze its two lobes, each for both beams; and for light
// from all around what they keep of the moments of the table, P_l and all. Rayleigh's own moments are 1, 0, 1/10; Henyey and Greenstein's g^l.
struct AtmosphereTurn {
  float rayleigh;
  float fine;
  float fineOfTurned;
  float peak;
  float peakOfTurned;
  float rayleighSecond;
  float fineFirst;
  float fineSecond;
};

WELKIN_FN AtmosphereTurn atmosphereTurn(Atmosphere a, float c) {
  float fine = hazeFineG(a.aerosolG);
  float second = 1.5f * c * c - 0.5f;
  return AtmosphereTurn(phaseRayleigh(c), phaseHenyeyGreenstein(c, fine), phaseHenyeyGreenstein(c, fine * kHazePeakG),
                        phaseHenyeyGreenstein(c, kHazePeakG), phaseHenyeyGreenstein(c, kHazePeakG * kHazePeakG), 0.1f * second, fine * c,
                        fine * fine * second);
}

// What a point at h sends towards the eye from one light: all but what coarse haze turns by little, and that.
struct AtmosphereSource {
  vec3 wide;
  vec3 narrow;
};

WELKIN_FN AtmosphereSource atmosphereSource(Atmosphere a, sampler2D transmittanceLut, sampler2D multipleScatteringLut, AtmosphereMedium m,
                                            float h, float muLight, AtmosphereTurn turn, vec2 shares) {
  AtmosphereBeams beams = atmosphereBeams(a, transmittanceLut, h, muLight);
  vec2 uv = atmosphereMultipleScatteringUv(a, h, muLight);
  vec2 next = vec2(0.0f, 1.0f / kMultipleScatteringMoments);
  vec3 mean = shares.y * vec3(textureLod(multipleScatteringLut, uv, 0.0f));
  vec3 first = shares.y * vec3(textureLod(multipleScatteringLut, uv + next, 0.0f));
  vec3 second = shares.y * vec3(textureLod(multipleScatteringLut, uv + 2.0f * next, 0.0f));
  beams.straight *= shares.x;
  beams.turned *= shares.x;
  vec3 fine = (1.0f - kHazePeakWeight) * m.aerosol, peak = kHazePeakWeight * m.aerosol;
  return AtmosphereSource((beams.straight + beams.turned) * (m.rayleigh * turn.rayleigh) +
                              fine * (beams.straight * turn.fine + beams.turned * turn.fineOfTurned) +
                              m.rayleigh * max(mean + turn.rayleighSecond * second, vec3(0.0f)) +
                              fine * max(mean + turn.fineFirst * first + turn.fineSecond * second, vec3(0.0f)),
                          peak * (beams.straight * turn.peak + beams.turned * turn.peakOfTurned));
}

// What a march carries along a ray.
struct AtmosphereRay {
  vec3 inscatter;
  vec3 transmittance;
  vec3 kept;  // transmittance where coarse haze, turning light by little, takes none: of light that comes from wide around
};

// Carries the march over [t0, t1]. Under the ground the air is taken as at the ground, so that tables stay smooth across the horizon.
WELKIN_FN void atmosphereMarch(Atmosphere a, sampler2D transmittanceLut, sampler2D multipleScatteringLut, float eyeAltitudeM, vec3 dir,
                               AtmosphereLights lights, float t0, float t1, WELKIN_INOUT(AtmosphereRay) ray) {
  float r = a.seaRadiusM + eyeAltitudeM;
  float t = 0.5f * (t0 + t1);
  float along = atmosphereAltitudeAlong(a, eyeAltitudeM, dir.z, t);
  float h = max(along, a.groundAltitudeM);
  AtmosphereMedium m = atmosphereMedium(a, h);
  vec3 wide = vec3(0.0f);
  vec3 narrow = vec3(0.0f);
  if (lights.illuminance0.y > 0.0f) {
    float c = dot(dir, lights.direction0);
    float muLight = (r * lights.direction0.z + t * c) / (a.seaRadiusM + along);
    AtmosphereSource s = atmosphereSource(a, transmittanceLut, multipleScatteringLut, m, h, muLight, atmosphereTurn(a, c),
                                          atmosphereLightShares(lights.shadow0, lights.direction0, t * dir));
    wide += lights.illuminance0 * s.wide;
    narrow += lights.illuminance0 * s.narrow;
  }
  if (lights.illuminance1.y > 0.0f) {
    float c = dot(dir, lights.direction1);
    float muLight = (r * lights.direction1.z + t * c) / (a.seaRadiusM + along);
    AtmosphereSource s = atmosphereSource(a, transmittanceLut, multipleScatteringLut, m, h, muLight, atmosphereTurn(a, c),
                                          atmosphereLightShares(lights.shadow1, lights.direction1, t * dir));
    wide += lights.illuminance1 * s.wide;
    narrow += lights.illuminance1 * s.narrow;
  }
  vec3 keptExtinction = m.extinction - kHazePeakWeight * m.aerosol;
  vec3 through = exp(-m.extinction * (t1 - t0));
  vec3 kept = exp(-keptExtinction * (t1 - t0));
  ray.inscatter += ray.kept * wide * (vec3(1.0f) - kept) / max(keptExtinction, vec3(1e-20f)) +
                   ray.transmittance * narrow * (vec3(1.0f) - through) / max(m.extinction, vec3(1e-20f));
  ray.transmittance *= through;
  ray.kept *= kept;
}

// The same in as many steps as thick haze asks for, as long as anything of the ray is left: light changes within a free path there.
WELKIN_FN void atmosphereMarchFinely(Atmosphere a, sampler2D transmittanceLut, sampler2D multipleScatteringLut, float eyeAltitudeM, vec3 dir,
                                     AtmosphereLights lights, float t0, float t1, WELKIN_INOUT(AtmosphereRay) ray) {
  float h = max(atmosphereAltitudeAlong(a, eyeAltitudeM, dir.z, 0.5f * (t0 + t1)), a.groundAltitudeM);
  float nearer = max(atmosphereAltitudeAlong(a, eyeAltitudeM, dir.z, t0), a.groundAltitudeM);
  float depth = max(atmosphereMedium(a, h).extinction.y, atmosphereMedium(a, nearer).extinction.y) * (t1 - t0);
  int n = depth > 1.0f && ray.kept.y > 1e-3f ? int(ceil(min(2.0f * depth, 64.0f))) : 1;
  for (int i = 0; i < n; ++i)
    atmosphereMarch(a, transmittanceLut, multipleScatteringLut, eyeAltitudeM, dir, lights, mix(t0, t1, float(i) / float(n)),
                    mix(t0, t1, float(i + 1) / float(n)), ray);
}

WELKIN_FN AtmosphereRay atmosphereRayAtEye() { return AtmosphereRay(vec3(0.0f), vec3(1.0f), vec3(1.0f)); }

// Airglow comes from a thin shell and so grows towards the horizon: P. J. van Rhijn 1921, "On the brightness of the sky at night and
// the total amount of starlight". What the air takes from the straight ray it partly gives back from the rest of the dome, more so over
// bright ground: between half (black ground) and all (white) of the dome's mean luminance, as from any conservative slab under a uniform sky.
// None is seen from above the shell.
WELKIN_CONST float kAirglowMean = 1.71f;  // of the dome, weighted by the cosine, over the zenith's (van Rhijn at 90 km)
WELKIN_FN vec3 atmosphereAirglow(Atmosphere a, sampler2D transmittanceLut, float h, float mu) {
  if (h >= a.airglowAltitudeM) return vec3(0.0f);
  float q = (a.seaRadiusM + h) / (a.seaRadiusM + a.airglowAltitudeM);
  float vanRhijn = 1.0f / sqrt(max(1.0f - q * q * (1.0f - mu * mu), 1e-4f));
  vec3 through = atmosphereTransmittance(a, transmittanceLut, h, mu);
  vec3 back = 0.5f * kAirglowMean * (vec3(1.0f) + a.groundAlbedo);
  return a.airglow * (vanRhijn * through + back * (vec3(1.0f) - through));
}

// Luminance of the clear sky along dir; down to the ground where the ray meets it, without the ground's own. No discs.
// quality scales the number of steps: 1 is enough for pictures.
WELKIN_FN vec3 atmosphereSkyRay(Atmosphere a, sampler2D transmittanceLut, sampler2D multipleScatteringLut, float eyeAltitudeM, vec3 dir,
                                AtmosphereLights lights, float quality) {
  float h = max(eyeAltitudeM, a.groundAltitudeM);
  float b = (a.seaRadiusM + h) * dir.z;
  float tStart = 0.0f;
  float aboveTop = atmosphereSquareDifference(a, h, a.topAltitudeM);
  if (aboveTop > 0.0f) {  // from outside: begin where the ray enters the air
    float disc = b * b - aboveTop;
    if (b >= 0.0f || disc <= 0.0f) return vec3(0.0f);
    tStart = aboveTop / (sqrt(disc) - b);
  }
  float tGround = atmosphereDistanceToGround(a, h, dir.z);
  float tEnd = tGround >= 0.0f ? tGround : sqrt(max(b * b - aboveTop, 0.0f)) - b;
  float tLow = clamp(-b, tStart, tEnd);  // the lowest point: steps are short around it and around the eye
  AtmosphereRay ray = atmosphereRayAtEye();
  if (tLow > tStart) {
    int n = int(14.0f * quality);
    float t0 = tStart;
    for (int i = 1; i <= n; ++i) {
      float x = float(i) / float(n);
      float t1 = tStart + (tLow - tStart) * x * x * (3.0f - 2.0f * x);
      atmosphereMarchFinely(a, transmittanceLut, multipleScatteringLut, h, dir, lights, t0, t1, ray);
      t0 = t1;
    }
  }
  if (tEnd > tLow) {
    int n = int(26.0f * quality);
    float t0 = tLow;
    for (int i = 1; i <= n; ++i) {
      float x = float(i) / float(n);
      float t1 = tLow + (tEnd - tLow) * x * x * x;
      atmosphereMarchFinely(a, transmittanceLut, multipleScatteringLut, h, dir, lights, t0, t1, ray);
      t0 = t1;
    }
  }
  if (tGround < 0.0f) ray.inscatter += atmosphereAirglow(a, transmittanceLut, h, dir.z);
  return ray.inscatter;
}

// ---- Directions in the sky-view and aerial tables -----------------------------------------------------------------------------

// Azimuth from the first light, in [-pi, pi], counter-clockwise seen from above.
WELKIN_FN float atmosphereAzimuth(vec3 dir, vec3 lightDir0) {
  vec2 l = vec2(lightDir0.x, lightDir0.y);
  if (dot(l, l) < 1e-12f) l = vec2(1.0f, 0.0f);
  float y = l.x * dir.y - l.y * dir.x;
  float x = l.x * dir.x + l.y * dir.y;
  if (abs(x) + abs(y) < 1e-12f) return 0.0f;
  return atan(y, x);
}

// Table coordinate in [0, 1] of an azimuth: a few times denser at the light than opposite.
WELKIN_FN float atmosphereAzimuthToX(float azimuth) {
  float f = min(abs(azimuth) / kAtmospherePi, 1.0f);
  float s = (sqrt(0.09f + 2.8f * f) - 0.3f) / 1.4f;
  return 0.5f + (azimuth < 0.0f ? -0.5f : 0.5f) * s;
}

WELKIN_FN float atmosphereXToAzimuth(float x) {
  float s = 2.0f * x - 1.0f;
  return kAtmospherePi * s * (0.3f + 0.7f * abs(s));
}

// Table coordinate in [-1, 1] of a direction's elevation: 0 at the horizon of the eye, 1 at the zenith, -1 at the nadir, densest at the
// horizon.
WELKIN_FN float atmosphereMuToY(float mu, float horizonMu) {
  float angle = asin(clamp(mu, -1.0f, 1.0f)) - asin(horizonMu);
  float range = angle >= 0.0f ? 0.5f * kAtmospherePi - asin(horizonMu) : 0.5f * kAtmospherePi + asin(horizonMu);
  float s = sqrt(min(abs(angle) / range, 1.0f));
  return angle < 0.0f ? -s : s;
}

WELKIN_FN float atmosphereYToMu(float y, float horizonMu) {
  float range = y >= 0.0f ? 0.5f * kAtmospherePi - asin(horizonMu) : 0.5f * kAtmospherePi + asin(horizonMu);
  return sin(clamp(asin(horizonMu) + y * abs(y) * range, -0.5f * kAtmospherePi, 0.5f * kAtmospherePi));
}

// Direction with zenith cosine mu at an azimuth from the first light.
WELKIN_FN vec3 atmosphereDirection(float mu, float azimuth, vec3 lightDir0) {
  vec2 l = vec2(lightDir0.x, lightDir0.y);
  float n = sqrt(dot(l, l));
  if (n < 1e-6f) {
    l = vec2(1.0f, 0.0f);
  } else {
    l = l / n;
  }
  float s = sqrt(max(1.0f - mu * mu, 0.0f));
  float ca = cos(azimuth);
  float sa = sin(azimuth);
  return vec3(s * (l.x * ca - l.y * sa), s * (l.y * ca + l.x * sa), mu);
}

// ---- Sky-view table: x by azimuth, y by elevation. The halves above and below the horizon do not mix -----------------------------

WELKIN_FN vec3 atmosphereSkyLuminance(Atmosphere a, sampler2D skyViewLut, float eyeAltitudeM, vec3 dir, vec3 lightDir0) {
  float x = atmosphereAzimuthToX(atmosphereAzimuth(dir, lightDir0));
  float y = atmosphereMuToY(dir.z, atmosphereHorizonMu(a, max(eyeAltitudeM, a.groundAltitudeM)));
  float rows = 0.5f * kSkyViewHeight;
  float row = y >= 0.0f ? rows + 0.5f + y * (rows - 1.0f) : rows - 0.5f + y * (rows - 1.0f);
  return vec3(textureLod(skyViewLut, vec2((0.5f + x * (kSkyViewWidth - 1.0f)) / kSkyViewWidth, row / kSkyViewHeight), 0.0f));
}

// Azimuth and mu of the texel in column i and row j.
WELKIN_FN vec2 atmosphereSkyViewParameters(float i, float j, float horizonMu) {
  float rows = 0.5f * kSkyViewHeight;
  float y = j >= rows ? (j - rows) / (rows - 1.0f) : (j - rows + 1.0f) / (rows - 1.0f);
  float mu = atmosphereYToMu(y, horizonMu);
  // The two rows at the horizon itself must fall on their sides of it.
  if (j == rows) mu = horizonMu + 1e-5f;
  if (j == rows - 1.0f) mu = horizonMu - 1e-5f;
  return vec2(atmosphereXToAzimuth(i / (kSkyViewWidth - 1.0f)), mu);
}

// ---- Aerial perspective table: x by azimuth, y by elevation, z by distance -----------------------------------------------------

WELKIN_FN float atmosphereDistanceToZ(float distanceM) {
  return min(log(1.0f + max(distanceM, 0.0f) / kAerialNearM) / log(1.0f + kAerialFarM / kAerialNearM), 1.0f);
}

WELKIN_FN float atmosphereZToDistance(float z) {
  return kAerialNearM * (exp(z * log(1.0f + kAerialFarM / kAerialNearM)) - 1.0f);
}

// Light scattered in between the eye and a distance, and the transmittance over it. The light is that of a cloudless sky.
WELKIN_FN void atmosphereAerial(Atmosphere a, sampler3D inscatterLut, sampler3D transmittanceLut, float eyeAltitudeM, vec3 dir,
                                vec3 lightDir0, float distanceM, WELKIN_OUT(vec3) inscatter, WELKIN_OUT(vec3) transmittance) {
  float x = atmosphereAzimuthToX(atmosphereAzimuth(dir, lightDir0));
  float y = 0.5f + 0.5f * atmosphereMuToY(dir.z, atmosphereHorizonMu(a, max(eyeAltitudeM, a.groundAltitudeM)));
  vec3 uvw = vec3((0.5f + x * (kAerialAzimuths - 1.0f)) / kAerialAzimuths,
                  (0.5f + y * (kAerialElevations - 1.0f)) / kAerialElevations,
                  (0.5f + atmosphereDistanceToZ(distanceM) * (kAerialDistances - 1.0f)) / kAerialDistances);
  inscatter = vec3(textureLod(inscatterLut, uvw, 0.0f));
  transmittance = vec3(textureLod(transmittanceLut, uvw, 0.0f));
}
