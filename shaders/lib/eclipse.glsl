// SPDX-License-Identifier: Apache-2.0
// Eclipses: the moon before the sun, and the earth before the sun as the moon sees it. Plain mathematics.
//
// Shared by C++ and GLSL, see welkin/core/glsl.h. Lengths on the sky are in radii of the sun's disc. Light is a share of that of the whole sun.

// Limb darkening of the sun, (1 - x^2)^(kSunLimb / 2) over the disc: D. Hestroffer and C. Magnan 1998, "Wavelength dependency of the Solar
// limb darkening", at 550 nm.
WELKIN_CONST float kSunLimb = 0.41f;

// Share of the sun's light from farther than x from the middle of its disc.
WELKIN_FN float sunBeyond(float x) { return pow(max((1.0f - x) * (1.0f + x), 0.0f), 1.0f + 0.5f * kSunLimb); }

// Share of the sun's light that passes by a dark disc of a radius whose middle is that far from the sun's: rings of the sun's disc, of which the
// dark one covers arcs. Within 3e-4 of the integral.
WELKIN_FN float sunPast(float middle, float radius) {
  if (middle >= 1.0f + radius) return 1.0f;
  float first = abs(middle - radius), last = min(middle + radius, 1.0f);
  float share = sunBeyond(last);
  if (middle > radius) share += 1.0f - sunBeyond(first);
  if (first >= last) return share;  // nothing but whole rings
  const int kRings = 12;
  float x0 = first, beyond0 = sunBeyond(x0);
  for (int i = 1; i <= kRings; ++i) {
    float x1 = mix(first, last, 0.5f - 0.5f * cos(3.14159265f * float(i) / float(kRings)));
    float beyond1 = i < kRings ? sunBeyond(x1) : sunBeyond(last), x = 0.5f * (x0 + x1);
    float reach = (x * x + middle * middle - radius * radius) / (2.0f * x * middle);
    share += (beyond0 - beyond1) * (1.0f - acos(clamp(reach, -1.0f, 1.0f)) / 3.14159265f);
    x0 = x1;
    beyond0 = beyond1;
  }
  return share;
}

// Luminance of the corona in that of the middle of the sun's disc, r >= 1 radii from it: S. Baumbach 1937, "Strahlung, Ergiebigkeit und
// Elektronendichte der Sonnenkorona", ended smoothly at kCoronaEnd. In the mean of the disc, of which the middle has 1 + kSunLimb / 2.
WELKIN_CONST float kCoronaEnd = 8.0f;
WELKIN_FN float coronaLuminance(float r) {
  float end = max(1.0f - r * r / (kCoronaEnd * kCoronaEnd), 0.0f);
  float law = 0.0532f * pow(r, -2.5f) + 1.425f * pow(r, -7.0f) + 2.565f * pow(r, -17.0f);
  return 1e-6f * (1.0f + 0.5f * kSunLimb) * law * end;
}
// The light of all of it: 2 times the integral of r times the law, without its end.
WELKIN_CONST float kCoronaShare = 1.36e-6f;

// The moon before the sun, seen from a point.
struct MoonShadow {
  vec3 toMoon;       // from the middle of the sun's disc to that of the moon's
  float moonRadius;  // 0: the moon is nowhere near
  float perMetre;    // by so much toMoon falls back for each metre that one goes across the sun's direction
  float share;       // of the sun's light that arrives at the point, the corona's with it
};

// Share of the sun's light at a place, metres from that point.
WELKIN_FN float sunShareAt(MoonShadow shadow, vec3 sunDirection, vec3 fromPointM) {
  vec3 across = fromPointM - sunDirection * dot(fromPointM, sunDirection);
  float past = sunPast(length(shadow.toMoon - across * shadow.perMetre), shadow.moonRadius);
  return past + kCoronaShare * (1.0f - past);
}

// Of the disc's light alone the share that does not arrive, where that much arrives with the corona's.
WELKIN_FN float sunHidden(float share) { return 1.0f - (share - kCoronaShare) / (1.0f - kCoronaShare); }

// Share of the sun's light on the moon, `middle` from the axis of the earth's shadow, where the earth's disc has a radius.
//
// In the umbra it is light that the earth's air has turned aside and reddened. Fitted, within 0.2 of a logarithm to ten, to an image of the sun in a
// spherical atmosphere: a ray at a height h above the limb is turned by 70' exp(-h / 8.4 km) (F. Link 1969, "Eclipse Phenomena in Astronomy"), weakened by molecules
// and ozone with the coefficients of welkin/sky/atmosphere_uniforms.cpp, and by clouds that leave a fifth of it at sea level and all at 12 km.
WELKIN_FN vec3 sunOnMoon(float middle, float radius) {
  float past = sunPast(middle, radius);
  float u = min(middle / (radius - 1.0f), 1.0f);  // in radii of the umbra
  float u2 = u * u;
  vec3 tens = vec3(-3.759f, -4.616f, -6.900f) + u2 * (vec3(0.226f, 1.762f, 6.284f) + u2 * vec3(0.579f, -0.118f, -2.299f));
  return vec3(past) + (1.0f - past) * exp2(3.32192809f * tens);
}
