// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/view.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace welkin::shading {
namespace {

// A camera at (10, 20, 30) that looks north and a little up, its picture off the axis.
View someView() {
  View v;
  v.view = glm::lookAt(glm::dvec3(10, 20, 30), glm::dvec3(10, 120, 50), glm::dvec3(0, 0, 1));
  v.projection = glm::frustum(-0.1, 0.3, -0.2, 0.1, 0.2, 1000.0);
  return v;
}

TEST(View, PartsSayWhereTheEyeIs) {
  const ViewParts parts = partsOf(someView(), 600);
  EXPECT_NEAR(glm::distance(parts.eyeM, glm::dvec3(10, 20, 30)), 0.0, 1e-9);
}

TEST(View, RaysMeetWhatIsProjectedThere) {
  const View view = someView();
  const ViewParts parts = partsOf(view, 600);
  for (const glm::dvec3 world : {glm::dvec3(15, 300, 80), glm::dvec3(60, 180, 20), glm::dvec3(-5, 90, 60)}) {
    const glm::dvec4 clip = view.projection * view.view * glm::dvec4(world, 1.0);
    const glm::dvec2 at = glm::dvec2(clip) / clip.w;
    // Down the ray of this point of the picture...
    const glm::vec3 ray(parts.rayScale.x * at.x + parts.rayScale.z,
                        parts.rayScale.y * at.y + parts.rayScale.w, -1);
    const glm::vec3 direction = glm::normalize(parts.enuFromCamera * ray);
    EXPECT_NEAR(glm::distance(direction, glm::vec3(glm::normalize(world - parts.eyeM))), 0.0f, 1e-6f);
    // ... and up again.
    const glm::vec4 same = parts.clipFromEnu * glm::vec4(world - parts.eyeM, 1.0);
    EXPECT_NEAR(same.x / same.w, at.x, 1e-5);
    EXPECT_NEAR(same.y / same.w, at.y, 1e-5);
  }
}

TEST(View, APixelIsAsWideAsTheProjectionSays) {
  View view;
  view.projection = glm::perspective(0.001, 1.0, 1.0, 10.0);  // a milliradian over ten pixels
  EXPECT_NEAR(partsOf(view, 10).pixelRad, 1e-4, 1e-9);
}

}  // namespace
}  // namespace welkin::shading
