// SPDX-License-Identifier: Apache-2.0
// The moon's disc, lit by the sun as a dusty sphere is. Plain mathematics.
//
// Luminances are shares of the full moon's, which is as bright all over its disc: 2 mu0 / (mu0 + mu), where mu0 and mu are the cosines of
// the sun's and of the eye's direction above the ground (J. H. Lommel and H. von Seeliger, 1887). Places are in radii of the disc from its middle, x
// towards the sun. phase: cosine and sine of half the phase angle, which is 0 at full moon.

WELKIN_CONST float kEarthshine = 1e-4f;    // of the whole disc, besides
WELKIN_CONST float kThinnestMoon = 1e-3f;  // least cosine, a tenth of a degree before new moon

WELKIN_FN vec2 moonPhase(float cosPhaseAngle) {
  return vec2(max(sqrt(max(0.5f + 0.5f * cosPhaseAngle, 0.0f)), kThinnestMoon), sqrt(max(0.5f - 0.5f * cosPhaseAngle, 0.0f)));
}

// Integral of luminance along the diameter x. The ratio of the cosines is the same along meridians from pole to pole of the light: at t
// from the middle of the lit ones, times the cosine of the longitude, it is (cos t - sin^2 / cos t) / cos with sin and cos of `phase`.
WELKIN_FN float moonAlong(float x, vec2 phase) {
  float sine = clamp(x * phase.x - sqrt(max(1.0f - x * x, 0.0f)) * phase.y, -phase.x, phase.x);
  float t = clamp(sine, -0.9999999f, 0.9999999f);
  return (sine - phase.y * phase.y * 0.5f * log((1.0f + t) / (1.0f - t))) / phase.x;
}

// Mean of sunlit luminance over the disc.
WELKIN_FN float moonMean(vec2 phase) { return 0.5f * (moonAlong(1.0f, phase) - moonAlong(-1.0f, phase)); }

// Mean of it over a square of a width in radii whose sides lie along x and y: a crescent that is thinner than a pixel keeps its light.
// Exact along x, as all rows are alike but for their length.
WELKIN_FN float moonSquare(vec2 at, float width, vec2 phase) {
  float sum = 0.0f;
  for (int row = 0; row < 4; ++row) {
    float y = at.y + width * (0.25f * float(row) - 0.375f), reach = sqrt(max(1.0f - y * y, 1e-12f));
    float x0 = clamp((at.x - 0.5f * width) / reach, -1.0f, 1.0f), x1 = clamp((at.x + 0.5f * width) / reach, -1.0f, 1.0f);
    if (x1 > x0) sum += reach * (moonAlong(x1, phase) - moonAlong(x0, phase));
  }
  return 0.25f * sum / width;
}
