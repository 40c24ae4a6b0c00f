// SPDX-License-Identifier: Apache-2.0
#include "tests/testing/gl_counts.h"

#include <epoxy/gl.h>

#include <utility>

namespace welkin::testing {
namespace {

int gPrograms = 0, gTextures = 0;
PFNGLLINKPROGRAMPROC gLinkProgram = nullptr;
PFNGLGENTEXTURESPROC gGenTextures = nullptr;

void linkProgram(GLuint program) {
  ++gPrograms;
  gLinkProgram(program);
}
void genTextures(GLsizei count, GLuint* names) {
  gTextures += count;
  gGenTextures(count, names);
}

}  // namespace

GlCounts::GlCounts() {
  gPrograms = gTextures = 0;
  gLinkProgram = std::exchange(epoxy_glLinkProgram, linkProgram);
  gGenTextures = std::exchange(epoxy_glGenTextures, genTextures);
}

GlCounts::~GlCounts() {
  epoxy_glLinkProgram = gLinkProgram;
  epoxy_glGenTextures = gGenTextures;
}

int GlCounts::programs() const {
  return gPrograms;
}
int GlCounts::textures() const {
  return gTextures;
}

}  // namespace welkin::testing
