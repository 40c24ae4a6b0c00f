// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/flare_pass.h"

#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "welkin/shading/shader_library.h"

namespace welkin::render {
namespace {

gpu::Mesh quads() {
  constexpr float kRoom = 1.1f;  // for fringes beyond the unit disc
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t s = 0; s < shading::LensFlare::kSprites; ++s) {
    for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)})
      vertices.insert(vertices.end(), {kRoom * corner.x, kRoom * corner.y, static_cast<float>(s)});
    for (const std::uint32_t k : {0u, 1u, 2u, 2u, 3u, 0u}) indices.push_back(4 * s + k);
  }
  constexpr std::array<int, 1> kAttributes = {3};
  return gpu::Mesh(vertices, kAttributes, indices);
}

}  // namespace

FlarePass::Slots FlarePass::slotsOf(const std::string& name) {
  Slots slots{name + "Count", name + "Surface", name + "Rim", {}, {}};
  for (std::size_t i = 0; i < kMaxFlat; ++i) {
    slots.sheets[i] = sheetUniformNames(name + "[" + std::to_string(i) + "]");
    slots.patterns[i] = name + "Pattern" + std::to_string(i);
  }
  return slots;
}

FlarePass::FlarePass()
    : program_(
          gpu::Program::graphics(shading::assembleShader("pass/flare.vert", shading::ShaderDialect::kGl330),
                                 shading::assembleShader("pass/flare.frag", shading::ShaderDialect::kGl330))),
      quads_(quads()) {}

void FlarePass::setSheets(const Slots& slots, bool volumes, std::size_t most,
                          std::span<const FlareSheet> sheets) {
  std::array<glm::vec4, kMaxFlat> surfaces{}, rims{};
  std::size_t n = 0;
  for (const FlareSheet& sheet : sheets) {
    if ((sheet.pattern->depth() > 1) != volumes || n == most) continue;
    setSheet(program_, slots.sheets[n], sheet.look);
    program_.bind(slots.patterns[n], *sheet.pattern);
    surfaces[n] = sheet.shape.shape;
    rims[n] = {sheet.shape.innerM, static_cast<float>(sheet.surface), 0.0f, 0.0f};
    ++n;
  }
  program_.set(slots.count, static_cast<int>(n));
  program_.set(slots.surfaces, std::span<const glm::vec4>(surfaces).first(most));
  program_.set(slots.rims, std::span<const glm::vec4>(rims).first(most));
}

void FlarePass::draw(const shading::LensFlare& flare, float strength, const shading::ViewParts& view,
                     double earthRadiusM, const Before& before, const gpu::Target& target, float scale) {
  if (flare.shown <= 0.0f || strength <= 0.0f) return;
  std::array<glm::vec4, shading::LensFlare::kSprites> places, lights;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const shading::FlareSprite& s = flare.sprites[i];
    places[i] = {s.centre.x, s.centre.y, s.halfSize.x, s.halfSize.y};
    lights[i] = glm::vec4(s.light * strength, s.hollow);
  }
  gpu::Program& p = program_;
  p.set("uSprites", std::span<const glm::vec4>(places));
  p.set("uSpriteLight", std::span<const glm::vec4>(lights));
  p.set("uSunAt", flare.sunAt);
  p.set("uSunHalfSize", flare.sunHalfSize);
  p.set("uEnuFromCamera", view.enuFromCamera);
  p.set("uRayScale", view.rayScale);
  p.set("uEyeM", static_cast<float>(view.eyeM.z));
  p.set("uEarthRadiusM", static_cast<float>(earthRadiusM));
  p.set("uScale", scale);
  setSheets(flat_, false, kMaxFlat, before.sheets);
  setSheets(volumes_, true, kMaxVolumes, before.sheets);
  p.set("uHasInFront", before.picture ? 1.0f : 0.0f);
  if (before.picture) p.bind("uInFront", *before.picture);
  p.set("uHasDepth", before.depth.texture ? 1.0f : 0.0f);
  p.set("uFarDepth", before.depth.reversed ? 0.0f : 1.0f);
  const gpu::TexelReader::Binding binding(depthReader_, p, "uDepth", before.depth.texture);
  quads_.draw(p, target, {.blend = gpu::Blend::kAdd});
}

}  // namespace welkin::render
