// SPDX-License-Identifier: Apache-2.0
// Light inside clouds: the exact first scattering, and a closed form for all the others.
//
// Multiple scattering takes the cloud around a point for a slab across the line to the sun, of the optical depths found along that
// line, and uses the Eddington solution of conservative scattering in it, scaled by similarity: E. P. Shettle and J. A. Weinman
// 1970, "The Transfer of Solar Irradiance Through Inhomogeneous Turbid Atmospheres Evaluated by Eddington's Approximation";
// J. H. Joseph, W. J. Wiscombe and J. A. Weinman 1976, "The Delta-Eddington Approximation for Radiative Flux Transfer". Droplets
// scatter forward, so that the diffuse light seen by them leaves mostly the way it goes: the source has the Eddington radiance's
// part along the flux too, without which sunlit faces are less than half as bright as they are. Light scattered only a few times,
// still mostly forward, is a lobe between the first scattering and the diffuse light. The five constants are fitted to
// discrete-ordinates slabs of optical depth 1, 4, 16 and 64 under suns at 90 and 30 degrees: albedo, transmittance and nadir
// radiance agree to 10 % in the median, 30 % at worst (docs/theory.md has the table, tests/unit/render/cloud_light_test.cpp the check).
// Light from the sky above and the ground below uses the same solution for diffuse light; in equal light from both sides the cloud
// vanishes, as it must.

WELKIN_CONST float kSimilarity = 1.0f - kDropletAsymmetry;
WELKIN_CONST float kForwardLobe = 1.62f;               // weight and
WELKIN_CONST float kForwardLobeG = 0.593f;             // mean cosine of the lobe of light scattered a few times
WELKIN_CONST float kRainFew = 1.35f;                   // weight of what rain has in the place of that lobe: its phase function twice
WELKIN_CONST float kDiffuseWeight = 1.06f;             // of the Eddington radiance as a source
WELKIN_CONST float kDiffuseG = 0.594f;                 // share of its part along the flux; up to 2/3 no direction is dark
WELKIN_CONST float kDiffuseOnset = 0.32f;              // per optical depth: how soon a cloud is thick enough for diffuse light

// Optical depths from a point: along the line to the sun and back, up and down.
struct CloudDepths {
  float toSun;
  float fromSun;
  float up;
  float down;
};

// Light that the narrow peak of the phase function has turned more than once, and nothing else has: the sun's aureole. Orders of scattering
// along a line, n of them with the chance of Poisson's law; the lobe of so many has the mean cosine g^n. cosSun as below.
WELKIN_FN float cloudPeakSource(float toSun, float cosSun, PhasePeak peak) {
  float turned = peak.share * toSun;
  float orders = 2.0f + 0.6f * turned;
  return peak.share * phaseHenyeyGreenstein(cosSun, pow(peak.g, orders)) * (exp(turned - toSun) - exp(-toSun));
}

// What others use in the place of cloudSunSource() below, to be compared with it (`welkin bench truth`): the first scattering alone;
// and octaves of it, each with half the extinction, half the light and half the mean cosine of the one before, eight of them as usual:
// M. Wrenninge, C. Kulla and V. Lundqvist 2013, "Oz: The Great and Volumetric".
WELKIN_FN float cloudSunSourceSingle(CloudDepths d, float phase) { return phase * exp(-d.toSun); }
WELKIN_FN float cloudSunSourceOctaves(CloudDepths d, float phase, float cosSun) {
  float source = phase * exp(-d.toSun);
  float share = 1.0f;
  for (int i = 1; i < 8; ++i) {
    share *= 0.5f;
    source += share * phaseHenyeyGreenstein(cosSun, share * kDropletAsymmetry) * exp(-share * d.toSun);
  }
  return source;
}

// The lobe of light scattered a few times.
WELKIN_FN float cloudForwardLobe(float cosSun) { return kForwardLobe * phaseHenyeyGreenstein(cosSun, kForwardLobeG); }

// Scattered radiance per unit extinction and unit sun illuminance, 1/sr. phase: the first scattering's, 1/sr; few: cloudForwardLobe(), or
// what matter other than droplets has in its place; cosSun: of the angle between the direction of view and the sun; viewHeight, sunHeight:
// sines of their elevations.
WELKIN_FN float cloudSunSourceOf(CloudDepths d, float phase, float few, float cosSun, float viewHeight, float sunHeight) {
#if defined(WELKIN_SINGLE_SCATTERING)
  return cloudSunSourceSingle(d, phase);
#elif defined(WELKIN_OCTAVES_OF_SCATTERING)
  return cloudSunSourceOctaves(d, phase, cosSun);
#else
  const float pi = 3.14159265f;
  float direct = exp(-d.toSun);
  // Inclination of the light to the slab: as the layer lies where depths agree with it, facing the sun where they do not.
  float asLayer = clamp(sunHeight, 0.1f, 1.0f);
  float mu = clamp(d.up / max(d.toSun, 1e-3f), asLayer, 1.0f);
  // Cosine between the direction of view and the slab's normal, which turns from the vertical to the sun.
  float facing = mix(viewHeight, cosSun, (mu - asLayer) / max(1.0f - asLayer, 1e-3f));
  float depth = kSimilarity * mu * d.toSun;
  float total = depth + kSimilarity * mu * d.fromSun;
  float beamHere = exp(-depth / mu), beamThrough = exp(-total / mu);
  float transmitted = (2.0f / 3.0f + mu + (2.0f / 3.0f - mu) * beamThrough) / (4.0f / 3.0f + total);
  float fluence = 3.0f * mu * transmitted * (total - depth + 2.0f / 3.0f) - 2.0f * mu * beamThrough +
                  3.0f * mu * mu * (beamThrough - beamHere);
  float flux = mu * (transmitted - beamHere);  // of diffuse light away from the sun
  float diffuse = kDiffuseWeight * max(fluence + 3.0f * kDiffuseG * flux * facing, 0.0f) / (4.0f * pi);
  diffuse *= 1.0f - exp(-kDiffuseOnset * mu * (d.toSun + d.fromSun));
  float forward = few * max(beamHere - direct, 0.0f);
  return phase * direct + forward + diffuse;
#endif
}
WELKIN_FN float cloudSunSource(CloudDepths d, float phase, float cosSun, float viewHeight, float sunHeight) {
  return cloudSunSourceOf(d, phase, cloudForwardLobe(cosSun), cosSun, viewHeight, sunHeight);
}

WELKIN_CONST float kTiltAcross = 0.3f;                 // what a lump has of a slab's difference between its sides
WELKIN_CONST float kTiltForward = 1.1f;                // and of the flux through it as a source

// What light adds that is not the same from opposite sides: mean radiance at a point, for each unit of half the difference between what a
// plane facing the one side and one facing the other would get. towards, away: optical depths to them; cosView: of the angle between the
// direction of view and the side that the depth `towards` is on.
WELKIN_FN float cloudTilt(float towards, float away, float cosView) {
  float ahead = kSimilarity * towards, behind = kSimilarity * away;
  return (kTiltAcross * (behind - ahead) + kTiltForward * cosView) / (4.0f / 3.0f + ahead + behind);
}

// Shares in [0, 1] of uniform radiance from above (x) and from below (y) that arrive at a point as mean radiance.
WELKIN_FN vec2 cloudSkyShares(CloudDepths d) {
  float up = kSimilarity * d.up, down = kSimilarity * d.down;
  return vec2(down + 2.0f / 3.0f, up + 2.0f / 3.0f) / (4.0f / 3.0f + up + down);
}

// How much cloud a view has before it, optical depth: between what lies along the sun's line and along the vertical, by how near the view is to
// them. Across a line neither end of it is ahead: the one takes the other's place over some degrees. keyCounts: by how much the sun's line counts.
WELKIN_FN float cloudDepthAhead(CloudDepths d, float cosSun, float viewHeight, float keyCounts) {
  vec2 along = vec2(keyCounts, 1.0f) * vec2(cosSun * cosSun + 0.02f, sqrt(viewHeight * viewHeight + 0.002f));
  vec2 end = smoothstep(-0.15f, 0.15f, vec2(cosSun, viewHeight));
  vec2 depth = mix(log(max(vec2(d.fromSun, d.down), 0.01f)), log(max(vec2(d.toSun, d.up), 0.01f)), end);
  return exp(dot(along, depth) / (along.x + along.y));
}
