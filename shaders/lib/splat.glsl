// SPDX-License-Identifier: Apache-2.0
// Balls of cloud seen along a ray: the integral of Wyvill's function (welkin/field/metaballs.h) in closed form. Lengths in radii.
//
// With v = w - t^2, w = 1 - b^2, where b is the ray's distance from the centre and t counts along it from the nearest point,
// f = 5/9 v^2 + 4/9 v^3.

// From the nearest point to t, |t| <= sqrt(w).
WELKIN_FN float splatColumnTo(float w, float t) {
  float s = t * t;
  float square = w * w - s * (2.0f / 3.0f * w - s / 5.0f);
  float cube = w * w * w - s * (w * w - s * (3.0f / 5.0f * w - s / 7.0f));
  return t * (5.0f / 9.0f * square + 4.0f / 9.0f * cube);
}

// Between two places on the ray; b2: square of its distance from the centre.
WELKIN_FN float splatColumn(float b2, float from, float to) {
  float w = 1.0f - b2;
  if (w <= 0.0f) return 0.0f;
  float h = sqrt(w);
  return splatColumnTo(w, clamp(to, -h, h)) - splatColumnTo(w, clamp(from, -h, h));
}
