// SPDX-License-Identifier: Apache-2.0
#include "tests/testing/engine_volume.h"

#include <epoxy/gl.h>

namespace welkin::testing {

Volume<float> readVolume(unsigned name) {
  GLint was = 0, nx = 0, ny = 0, nz = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_3D, &was);
  glBindTexture(GL_TEXTURE_3D, name);
  glGetTexLevelParameteriv(GL_TEXTURE_3D, 0, GL_TEXTURE_WIDTH, &nx);
  glGetTexLevelParameteriv(GL_TEXTURE_3D, 0, GL_TEXTURE_HEIGHT, &ny);
  glGetTexLevelParameteriv(GL_TEXTURE_3D, 0, GL_TEXTURE_DEPTH, &nz);
  Volume<float> volume(nx, ny, nz, 4);
  glGetTexImage(GL_TEXTURE_3D, 0, GL_RGBA, GL_FLOAT, volume.data.data());
  glBindTexture(GL_TEXTURE_3D, static_cast<GLuint>(was));
  return volume;
}

}  // namespace welkin::testing
