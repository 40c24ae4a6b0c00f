// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/octaves_pass.h"

#include <glm/vec4.hpp>
#include <span>
#include <string>

#include "welkin/render/programs.h"

namespace welkin::render {
namespace {

constexpr std::array<const char*, scene::kMaxLivingOctaves> kLattices = {
    "uLattice0", "uLattice1", "uLattice2", "uLattice3", "uLattice4", "uLattice5", "uLattice6", "uLattice7"};

constexpr gpu::TextureOptions unfiltered(gpu::Format format) {
  return {.format = format,
          .filter = gpu::Filter::kNearest,
          .wrapX = gpu::Wrap::kRepeat,
          .wrapY = gpu::Wrap::kRepeat};
}

}  // namespace

LivingTexture::LivingTexture(const scene::Sheet& sheet, std::uint64_t seed) : pattern_(sheet, seed) {
  for (int k = 0; k < pattern_.count(); ++k)
    lattices_[static_cast<std::size_t>(k)] =
        gpu::Texture2D(pattern_.side(k), pattern_.side(k), unfiltered(gpu::Format::kRgba32F));
  const int n = static_cast<int>(sheet.texels);
  if (sheet.tier == scene::SheetTier::kEmbossed)
    values_ = gpu::Texture2D(n, n, unfiltered(gpu::Format::kR32F));
}

OctavesPass::OctavesPass() : slopes_(fullscreenProgram("pass/octave_slopes.frag")) {}

gpu::Program& OctavesPass::program(const scene::LivingPattern& pattern) {
  gpu::Program& p = programs_[{pattern.kernel(), pattern.count()}];
  if (p.id() == 0)
    p = fullscreenProgram(
        "pass/octaves.frag",
        shading::ShaderDefines{{"WELKIN_OCTAVES", std::to_string(pattern.count())},
                               {"WELKIN_KERNEL", std::to_string(static_cast<int>(pattern.kernel()))}});
  return p;
}

void OctavesPass::prepare(const LivingTexture& living) {
  program(living.pattern_);
}

void OctavesPass::compose(LivingTexture& living, double secondsAfter, gpu::Texture2D& texture) {
  const double instant = living.pattern_.shown(secondsAfter);
  if (living.shown_ == instant) return;
  living.shown_ = instant;
  living.pattern_.at(instant, living.instant_);

  gpu::Program& p = program(living.pattern_);
  std::array<glm::vec4, scene::kMaxLivingOctaves> octaves{};
  const bool slopes = living.values_.id() != 0;
  for (int i = 0; i < living.instant_.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const scene::OctaveNow& o = living.instant_.octaves[k];
    living.lattices_[k].upload(o.lattice);
    octaves[k] = glm::vec4(o.shift, o.cells / static_cast<float>(texture.width()), o.lattice.width);
  }
  for (int i = 0; i < living.instant_.count; ++i)
    p.bind(kLattices[static_cast<std::size_t>(i)], living.lattices_[static_cast<std::size_t>(i)]);
  p.set("uOctaves", std::span<const glm::vec4>(octaves));
  p.set("uBase", living.instant_.base);
  living.target_.attach(0, slopes ? living.values_ : texture);
  triangle_.draw(p, living.target_);
  if (slopes) {
    slopes_.set("uTexel", glm::vec2(1.0f / static_cast<float>(texture.width())));
    slopes_.bind("uPattern", living.values_);
    living.target_.attach(0, texture);
    triangle_.draw(slopes_, living.target_);
  }
  texture.makeMipmaps();
}

}  // namespace welkin::render
