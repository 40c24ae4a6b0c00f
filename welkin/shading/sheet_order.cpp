// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/sheet_order.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "welkin/field/cloud_field.h"

namespace welkin::shading {
namespace {

std::string patternName(std::size_t sheet) {
  return "uSheetPattern" + std::to_string(sheet);
}

// What WELKIN_EACH_SHEET says of a sheet.
std::string callOf(std::span<const SheetOnRay> sheets, std::size_t i) {
  const bool volume = scene::hasVolume(sheets[i].surface);
  return "(" + std::to_string(i) + ", " + std::to_string(static_cast<int>(sheets[i].surface)) + ", " +
         std::to_string(static_cast<int>(sheets[i].tier)) +
         (volume ? ", vec3, sampler3D, " : ", vec2, sampler2D, ") + patternName(i) + ") ";
}

// By a ray: from above twice. The farther place of a plane is beyond all that is drawn, but in the order of
// an eye above everything it is where lower eyes meet it.
int timesMet(const SheetOnRay& sheet, double eyeM) {
  return eyeM > sheet.look.heightM ? 2 : 1;
}

}  // namespace

std::vector<SkyPiece> piecesOf(const LightVolumeLayout& layout, std::span<const SheetOnRay> sheets) {
  std::vector<SkyPiece> pieces;
  std::size_t sheet = 0;
  for (std::size_t b = 0; b < layout.bands.size(); ++b) {
    float baseM = layout.bands[b].baseM;
    const float topM = layout.bands[b].topM;
    const auto pieceUpTo = [&](float endM) {
      if (endM > baseM) pieces.push_back({-1, static_cast<int>(b), baseM, endM});
      baseM = std::max(baseM, endM);
    };
    for (; sheet < sheets.size() && sheets[sheet].look.heightM < topM; ++sheet) {
      pieceUpTo(sheets[sheet].look.heightM);
      pieces.push_back({static_cast<int>(sheet), -1, 0.0f, 0.0f});
    }
    pieceUpTo(topM);
  }
  for (; sheet < sheets.size(); ++sheet) pieces.push_back({static_cast<int>(sheet), -1, 0.0f, 0.0f});
  return pieces;
}

ShaderDefines sheetDefines(const LightVolumeLayout& layout, std::span<const SheetOnRay> sheets, double eyeM) {
  std::string layers, each, shadows, hits, up, down;
  int hitCount = 0;
  for (int b = 0; b < static_cast<int>(layout.bands.size()); ++b) layers += layerCalls(layout, b);
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    each += "CALL" + callOf(sheets, i);
    shadows += scene::comesDown(sheets[i].surface)
                   ? "MEAN(" + std::to_string(i) + ") "
                   : "FLAT(" + std::to_string(i) + ", " + patternName(i) + ") ";
  }
  const std::vector<SkyPiece> pieces = piecesOf(layout, sheets);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const SkyPiece& piece = pieces[p];
    if (piece.sheet < 0) {
      const std::string call = "BAND(" + std::to_string(p) + ", " + std::to_string(piece.band) + ") ";
      up += call;
      if (eyeM > piece.baseM) down = call + down;
      continue;
    }
    const auto i = static_cast<std::size_t>(piece.sheet);
    const auto hit = [&](const char* far) {
      hits += "CALL(" + std::to_string(hitCount) + ", " + far + ", " + callOf(sheets, i).substr(1);
      return "SHEET(" + std::to_string(hitCount++) + ") ";
    };
    const bool above = eyeM > sheets[i].look.heightM;
    if (above) down = hit("false") + down;
    if (!above || timesMet(sheets[i], eyeM) == 2) up += hit("true");
  }
  const bool sameTier = std::ranges::all_of(sheets, [&](const auto& s) { return s.tier == sheets[0].tier; });
  ShaderDefines defines{{"WELKIN_EACH_LAYER(CALL)", layers},
                        {"WELKIN_SHEET_TIER(i)", sameTier ? std::to_string(static_cast<int>(sheets[0].tier))
                                                          : "int(uSheetSky[i].w + 0.5)"},
                        {"WELKIN_HITS", std::to_string(hitCount)},
                        {"WELKIN_EACH_HIT(CALL)", hits},
                        {"WELKIN_SHEETS", std::to_string(sheets.size())},
                        {"WELKIN_PIECES", std::to_string(pieces.size())},
                        {"WELKIN_EACH_SHEET(CALL)", each},
                        {"WELKIN_EACH_SHADOW(FLAT, MEAN)", shadows},
                        {"WELKIN_EACH_DOWN(BAND, SHEET)", down},
                        {"WELKIN_EACH_UP(BAND, SHEET)", up},
                        {"WELKIN_BANDS", std::to_string(layout.bands.size())}};
  addBandDefines(layout, defines);
  return defines;
}

Uniforms sheetUniforms(const LightVolumeLayout& layout, std::span<const SheetOnRay> sheets,
                       std::span<const glm::vec4> bandSky, double eyeM) {
  std::vector<glm::vec4> shapes, rays, skies, sunSteps, pieces, bands(field::kMaxLayers, glm::vec4(1.0f));
  for (const SheetOnRay& s : sheets) {
    shapes.push_back(s.shape.shape);
    rays.emplace_back(s.shape.innerM, s.look.texelsPerPixel, s.light.sun, s.sunThrough);
    skies.emplace_back(s.light.sky, static_cast<float>(s.tier));
    sunSteps.emplace_back(s.look.sunStep, 0.0f);
  }
  for (const SkyPiece& p : piecesOf(layout, sheets)) pieces.emplace_back(p.baseM, p.topM, 0.0f, 0.0f);
  for (std::size_t b = 0; b < bandSky.size(); ++b) bands[b] = bandSky[b];
  int hits = 0;
  for (const SheetOnRay& s : sheets) hits += timesMet(s, eyeM);
  return {{"uHits", hits},      {"uSheetShape", shapes},     {"uSheetRay", rays},
          {"uSheetSky", skies}, {"uSheetSunStep", sunSteps}, {"uPieces", pieces},
          {"uBandSky", bands}};
}

}  // namespace welkin::shading
