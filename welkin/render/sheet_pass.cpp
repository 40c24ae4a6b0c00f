// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sheet_pass.h"

#include "welkin/render/programs.h"
#include "welkin/shading/shader_library.h"

namespace welkin::render {
namespace {

constexpr std::size_t kTiers = 3;

gpu::Program sheetProgram(std::size_t tier, bool volume) {
  const shading::ShaderDefines defines = {{"WELKIN_TIER", std::to_string(tier)},
                                          {"WELKIN_PATTERN_3D", volume ? "1" : "0"}};
  // Not graphicsProgram(), which may have uniforms read at the beginning: where no loop reads them, that
  // costs.
  constexpr auto kDialect = shading::ShaderDialect::kGl330;
  return gpu::Program::graphics(shading::assembleShader("pass/sheet.vert", kDialect, defines),
                                shading::assembleShader("pass/sheet.frag", kDialect, defines));
}

bool hasVolume(const SheetDraw& sheet) {
  return sheet.pattern->depth() > 1;
}

const SheetUniformNames kSheet = sheetUniformNames("uSheet");

}  // namespace

SheetUniformNames sheetUniformNames(const std::string& name) {
  return {name + ".offset",       name + ".perM", name + ".wrap",    name + ".threshold",
          name + ".steepness",    name + ".bias", name + ".heightM", name + ".thicknessM",
          name + ".typicalDepth", name + ".tint"};
}

void setSheet(gpu::Program& program, const SheetUniformNames& names, const shading::SheetLook& look) {
  program.set(names[0], look.offset);
  program.set(names[1], look.perM);
  program.set(names[2], look.wrap);
  program.set(names[3], look.threshold);
  program.set(names[4], look.steepness);
  program.set(names[5], look.bias);
  program.set(names[6], look.heightM);
  program.set(names[7], look.thicknessM);
  program.set(names[8], look.typicalDepth);
  program.set(names[9], look.tint);
}

SheetPass::SheetPass() {
  for (std::size_t i = 0; i < programs_.size(); ++i) programs_[i] = sheetProgram(i % kTiers, i >= kTiers);
}

gpu::Program& SheetPass::program(const SheetDraw& sheet) {
  return programs_[static_cast<std::size_t>(sheet.tier) + (hasVolume(sheet) ? kTiers : 0)];
}

void SheetPass::setSky(const shading::Uniforms& sky) {
  for (gpu::Program& p : programs_) setUniforms(p, sky);
}

void SheetPass::draw(const SheetDraw& sheet, const shading::ViewParts& view, const SkyTextures& tables,
                     const gpu::Target& target, float scale) {
  gpu::Program& p = program(sheet);
  setSheet(p, kSheet, sheet.look);
  p.set("uEyeM", static_cast<float>(view.eyeM.z));
  p.set("uClipFromEnu", view.clipFromEnu);
  p.set("uSunStep", sheet.look.sunStep);
  p.set("uTexelsPerPixel", sheet.look.texelsPerPixel);
  p.set("uSunOnSheet", sheet.light.sun);
  p.set("uSkyOnSheet", sheet.light.sky);
  p.set("uScale", scale);
  tables.bind(p);
  p.bind("uPattern", *sheet.pattern);
  sheet.mesh->draw(p, target, {.blend = gpu::Blend::kOver});
}

}  // namespace welkin::render
