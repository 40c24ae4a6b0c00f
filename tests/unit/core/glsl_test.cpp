// SPDX-License-Identifier: Apache-2.0
#include "welkin/core/glsl.h"

#include <gtest/gtest.h>

namespace welkin::glsl {
namespace {

// The 3-channel path and the general one must filter alike, and both as GL does.
TEST(Glsl, FiltersPicturesLikeGl) {
  Image<float> three(4, 3, 3), four(4, 3, 4);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      for (int c = 0; c < 3; ++c)
        three.at(x, y, c) = four.at(x, y, c) = static_cast<float>(x + 10 * y + 100 * c);
      four.at(x, y, 3) = 0.5f;
    }
  }
  for (Wrap wrap : {Wrap::kClamp, Wrap::kRepeat}) {
    for (float v = -0.4f; v < 1.5f; v += 0.07f) {
      for (float u = -0.3f; u < 1.4f; u += 0.05f) {
        const vec4 a = textureLod(sampler2D{&three, wrap, wrap}, vec2(u, v), 0.0f);
        const vec4 b = textureLod(sampler2D{&four, wrap, wrap}, vec2(u, v), 0.0f);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-4f);
        EXPECT_EQ(a.w, 1.0f);
        EXPECT_NEAR(b.w, 0.5f, 1e-6f);
      }
    }
  }
  const sampler2D s{&three, Wrap::kClamp, Wrap::kClamp};
  EXPECT_FLOAT_EQ(textureLod(s, vec2(0.5f, 0.5f), 0.0f).x, 1.5f + 10.0f);     // between centres
  EXPECT_FLOAT_EQ(textureLod(s, vec2(0.125f, 1.0f / 6), 0.0f).x, 0.0f);       // a centre
  EXPECT_FLOAT_EQ(textureLod(s, vec2(-3.0f, 7.0f), 0.0f).y, 100.0f + 20.0f);  // clamped to the corner
  const sampler2D r{&three, Wrap::kRepeat, Wrap::kClamp};
  EXPECT_FLOAT_EQ(textureLod(r, vec2(0.0f, 1.0f / 6), 0.0f).x,
                  1.5f);  // between the last column and the first
}

TEST(Glsl, FiltersVolumesLikeGl) {
  Volume<float> one(3, 4, 5, 1), three(3, 4, 5, 3);
  for (int z = 0; z < 5; ++z) {
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 3; ++x)
        one.at(x, y, z) = three.at(x, y, z, 0) = static_cast<float>(x * x + 7 * y + 31 * z * z);
    }
  }
  for (Wrap wrap : {Wrap::kClamp, Wrap::kRepeat}) {
    for (float t = -1.2f; t < 1.3f; t += 0.093f) {
      const vec3 p(t, 0.7f * t + 0.1f, 0.3f - t);
      EXPECT_NEAR(textureLod(sampler3D{&one, wrap}, p, 0.0f).x,
                  textureLod(sampler3D{&three, wrap}, p, 0.0f).x, 1e-3f);
    }
  }
}

}  // namespace
}  // namespace welkin::glsl
