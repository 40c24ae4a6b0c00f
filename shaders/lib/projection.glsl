// SPDX-License-Identifier: Apache-2.0
// From a point of the picture to the direction it shows. All projections share one sky, so each only names directions.
//
// Picture coordinates: pixels, origin at the top left, y down. Camera frame: x right, y forward, z up; `enuFromCamera` has its
// columns in east-north-up and holds heading and pitch (perspective) or heading alone (the whole-sky projections).

WELKIN_CONST int kPerspective = 0;
WELKIN_CONST int kFisheye = 1;
WELKIN_CONST int kEquirect = 2;
WELKIN_CONST int kCubemap = 3;

struct Projector {
  int kind;
  vec2 sizePx;
  float halfWidthTan;  // perspective: tangent of half the field of view across the width
  mat3 enuFromCamera;
};

// Direction of cube face 0..5 (+X -X +Y -Y +Z -Z) at s, t in [-1, 1], t down: the orientation of OpenGL's cube maps.
WELKIN_FN vec3 cubeDirection(int face, float s, float t) {
  if (face == 0) return vec3(1.0f, -t, -s);
  if (face == 1) return vec3(-1.0f, -t, s);
  if (face == 2) return vec3(s, 1.0f, t);
  if (face == 3) return vec3(s, -1.0f, -t);
  if (face == 4) return vec3(s, -t, 1.0f);
  return vec3(-s, -t, -1.0f);
}

// Unit direction in east-north-up. False outside the picture's image circle (fisheye corners).
// pixelRad: angle that one pixel spans.
WELKIN_FN bool projectorDirection(Projector projector, vec2 px, WELKIN_OUT(vec3) dir, WELKIN_OUT(float) pixelRad) {
  const float pi = 3.14159265f;
  vec2 size = projector.sizePx;
  if (projector.kind == kPerspective) {
    float scale = 2.0f * projector.halfWidthTan / size.x;
    pixelRad = scale;
    dir = projector.enuFromCamera *
          normalize(vec3((px.x - 0.5f * size.x) * scale, 1.0f, (0.5f * size.y - px.y) * scale));
    return true;
  }
  if (projector.kind == kFisheye) {
    // Dome master: equidistant, zenith in the middle, the heading at the bottom, a full hemisphere in the inscribed circle.
    float radius = 0.5f * min(size.x, size.y);
    vec2 c = (px - 0.5f * size) / radius;
    float r = length(c);
    pixelRad = 0.5f * pi / radius;
    float zenithAngle = min(r, 1.0f) * 0.5f * pi;
    vec2 outward = r > 1e-6f ? c / r : vec2(0.0f, 1.0f);
    float s = sin(zenithAngle);
    dir = projector.enuFromCamera * vec3(s * outward.x, s * outward.y, cos(zenithAngle));
    return r <= 1.0f;
  }
  if (projector.kind == kEquirect) {
    // The heading in the middle column, azimuth growing to the right, zenith at the top.
    float azimuth = (px.x / size.x - 0.5f) * 2.0f * pi;
    float elevation = (0.5f - px.y / size.y) * pi;
    pixelRad = pi / size.y;
    float c = cos(elevation);
    dir = projector.enuFromCamera * vec3(c * sin(azimuth), c * cos(azimuth), sin(elevation));
    return true;
  }
  // A strip of six faces in axes east, north, up.
  float face = floor(px.x / size.y);
  float s = 2.0f * (px.x - face * size.y) / size.y - 1.0f;
  float t = 2.0f * px.y / size.y - 1.0f;
  pixelRad = 2.0f / size.y;
  dir = normalize(cubeDirection(int(face), s, t));
  return true;
}
