// SPDX-License-Identifier: Apache-2.0
// Running programs: over all pixels of a target, over a tile of it, or as compute work; and waiting for them.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"

namespace welkin::gpu {

// A rectangle of pixels with the origin at the bottom left, as gl_FragCoord counts.
struct Tile {
  int x = 0, y = 0;
  int width = 0, height = 0;
};

// Where a draw goes: a framebuffer, this folder's or by its GL name, and the part of it that is the picture.
struct Target {
  Target(const Framebuffer& f) : framebuffer(f.id()), area{0, 0, f.width(), f.height()} {}  // NOLINT: is one
  Target(unsigned name, const Tile& viewport) : framebuffer(name), area(viewport) {}
  unsigned framebuffer = 0;
  Tile area;
};

enum class Blend {
  kReplace,
  kAdd,   // onto what is there: accumulation, into a 32-bit float target
  kOver,  // colour premultiplied with alpha, before what is there
};

struct DrawOptions {
  std::optional<Tile> tile{};  // absent: the whole target
  Blend blend = Blend::kReplace;
  std::optional<std::uint8_t> where{};  // the pixels whose number this is, see Framebuffer::setMask()
};

// The state of a draw while it lives. Depth test, culling and all else are as in a fresh context.
class DrawState {
 public:
  DrawState(const Program& program, const Target& target, const DrawOptions& options);
  ~DrawState();
  DrawState(const DrawState&) = delete;
  DrawState& operator=(const DrawState&) = delete;
};

// Draws the triangle of shaders/pass/fullscreen.vert.
class FullscreenTriangle {
 public:
  FullscreenTriangle();
  ~FullscreenTriangle();
  FullscreenTriangle(const FullscreenTriangle&) = delete;
  FullscreenTriangle& operator=(const FullscreenTriangle&) = delete;

  // Binds the target and runs the program over it. Textures are bound already, see Program::bind.
  void draw(const Program& program, const Target& target, const DrawOptions& options = {}) const;

 private:
  unsigned vertexArray_ = 0;  // empty, but core profiles want one
};

// Compute, where Context::hasCompute(), or this of a context that somebody else made.
bool canCompute();
// As Context::isSoftware(), of the current context, whoever made it.
bool isSoftware();
enum class Access { kRead, kWrite, kReadWrite };
// `layout(binding = unit)` of an image uniform; volumes are bound whole.
void bindImage(int unit, const Texture& texture, Access access);
// Runs groups of work items and makes what they write visible to everything after.
void dispatch(const Program& program, int groupsX, int groupsY, int groupsZ = 1);

// Sends all work to the device; it starts even if nobody waits.
void flush();
// Waits until the device has done all work.
void finish();

// Wall-clock time of GPU work. GL's timer queries measure submission, not work, on software rasterisers.
class Stopwatch {
 public:
  Stopwatch();          // waits for work before it, then starts
  double finishedMs();  // waits for the device; milliseconds since the start or the last call

 private:
  std::chrono::steady_clock::time_point start_;
};

}  // namespace welkin::gpu
