// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/live_sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include "welkin/core/error.h"
#include "welkin/gpu/state_guard.h"
#include "welkin/render/air_volume_pass.h"
#include "welkin/render/cloud_textures.h"
#include "welkin/render/cover_ahead.h"
#include "welkin/render/live_splats.h"
#include "welkin/render/live_volumes.h"
#include "welkin/render/octaves_pass.h"
#include "welkin/render/programs.h"
#include "welkin/render/sheet_pass.h"
#include "welkin/render/sky_box_texture.h"
#include "welkin/render/sky_light_probe.h"
#include "welkin/render/sky_textures.h"
#include "welkin/render/thin_layer.h"
#include "welkin/shading/backdrop_tiles.h"
#include "welkin/shading/lens_flare.h"
#include "welkin/shading/sheet_ambient.h"
#include "welkin/shading/sheet_look.h"
#include "welkin/shading/sheet_mesh.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {
namespace {

constexpr std::size_t kMaxShadows = 4;  // of lib/sheet_shadows.glsl
constexpr std::array<const char*, kMaxShadows> kShadowPatterns = {"uShadowPattern0", "uShadowPattern1",
                                                                  "uShadowPattern2", "uShadowPattern3"};

// What else than sheets is in a sky, with its shadow on the ground: of backdrops there is one of each kind.
struct Others {
  bool volumes = false, splats = false;
  std::size_t number() const { return (volumes ? 1u : 0u) + (splats ? 2u : 0u); }
  static constexpr std::size_t kNumbers = 4;
};

struct Behind {
  bool skyBox = false, beyond = false;  // a box; stars, planets or the Milky Way
};

gpu::Program backdropProgram(shading::BackdropKind kind, const Behind& behind, const Others& others) {
  shading::ShaderDefines defines{{"WELKIN_EACH_LAYER(CALL)", ""},
                                 {"WELKIN_BACKDROP", std::to_string(static_cast<int>(kind))}};
  if (behind.skyBox) defines.emplace_back("WELKIN_SKY_BOX", "1");
  if (behind.beyond) defines.emplace_back("WELKIN_BEYOND", "1");
  if (others.volumes) defines.emplace_back("WELKIN_VOLUMES", "1");
  if (others.splats) defines.emplace_back("WELKIN_SPLATS", "1");
  return fullscreenProgram("pass/backdrop.frag", defines);
}

// By kind, and those of the sky once more with what is beyond it, so that no frame at dusk has to wait for
// them.
using Backdrops = std::array<gpu::Program, 5>;
Backdrops backdropPrograms(const Others& others) {
  using shading::BackdropKind;
  return {backdropProgram(BackdropKind::kAll, {}, others), backdropProgram(BackdropKind::kSky, {}, others),
          backdropProgram(BackdropKind::kGround, {}, others),
          backdropProgram(BackdropKind::kAll, {.beyond = true}, others),
          backdropProgram(BackdropKind::kSky, {.beyond = true}, others)};
}
std::size_t backdropIndex(shading::BackdropKind kind, bool beyond) {
  return static_cast<std::size_t>(kind) + (beyond && kind != shading::BackdropKind::kGround ? 3 : 0);
}

}  // namespace

struct LiveSky::Impl {
  SheetPass sheetPass;
  FlarePass flarePass;
  OctavesPass octavesPass;
  // By what else is in the sky, once it is; and once there is a box, in the place of all of them.
  std::array<Backdrops, Others::kNumbers> allBackdrops{backdropPrograms({})};
  std::array<gpu::Program, Others::kNumbers> boxBackdrops;
  gpu::FullscreenTriangle triangle;
  SkyTextures tables;
  CoverAhead coverAhead;
  std::array<SheetUniformNames, kMaxShadows> shadowNames;

  std::optional<scene::SkyState> state;
  std::optional<CloudTextures> clouds;  // whose placement the ground's pattern comes from
  std::optional<SkyBoxTexture> box;     // in the place of the clear sky
  std::vector<ThinLayer> sheets;        // from the ground up
  std::optional<LiveVolumes> volumes;   // once there are any, or an air volume
  std::optional<AirVolumePass> airPass;
  std::optional<SkyLightProbe> probe;
  bool volumesKnow = false;          // the scene,
  bool airKnows = false;             // too
  std::optional<LiveSplats> splats;  // the same
  Others others;                     // what the state has
  std::vector<shading::VolumeInSky> volumesInSky;

  // Kept for their memory.
  std::vector<shading::SheetInSky> inSky;
  shading::LightUnderSheets underSheets;
  shading::Uniforms skyUniforms;

  Backdrops& backdrops() { return allBackdrops[others.number()]; }
  gpu::Program& boxBackdrop() { return boxBackdrops[others.number()]; }
  void requireSky() const {
    if (!state) throw ParameterError("there is no sky yet; expected update() before this");
  }
  // Whether a scene is the state's, but for the camera and what only pictures have.
  bool knows(const scene::Scene& scene) const;
  void change(const scene::SkyState& next);
  void changeScene(const scene::SkyState& next, const Others& there);
  void refresh();
  void updateBox(const scene::SkyBox& wanted, const Others& with);
  void updateAmbient();
  void lookFrom(const shading::ViewParts& view, unsigned number);
  enum class Programs { kSeen, kAll };  // those that the instant and the view ask for, or any may
  void draw(const shading::View& view, const gpu::Target& target, const LiveOptions& options, Programs which);
  void settle(const shading::View& view, const gpu::Target& target, unsigned number);
  void drawBackdrop(const shading::ViewParts& view, const gpu::Target& target, const LiveOptions& options);
  void drawEveryBackdrop(const shading::ViewParts& view, const gpu::Target& target,
                         const LiveOptions& options);
  void setBackdrop(gpu::Program& p, const shading::ViewParts& view, const gpu::Target& target,
                   const LiveOptions& options);
  void drawSheet(const ThinLayer& sheet, const shading::ViewParts& view, const gpu::Target& target,
                 float scale);
  void drawSheets(const shading::View& view, const shading::ViewParts& parts, const gpu::Target& target,
                  const LiveOptions& options);
  void drawSplats(const shading::View& view, const shading::ViewParts& parts, const gpu::Target& target,
                  const LiveOptions& options);
  void drawFlare(const shading::ViewParts& view, const gpu::Target& target, const LiveOptions& options,
                 Programs which);
  shading::SheetLook look(const ThinLayer& sheet, const shading::ViewParts& view) const {
    return shading::lookOf(sheet.sheet, sheet.matter, state->secondsAfter, view.eyeM,
                           state->lights[0].direction, view.pixelRad);
  }
};

LiveSky::LiveSky() {
  const gpu::StateGuard guard;
  impl_ = std::make_unique<Impl>();
  for (std::size_t i = 0; i < kMaxShadows; ++i)
    impl_->shadowNames[i] = sheetUniformNames("uShadowSheets[" + std::to_string(i) + "]");
}

LiveSky::~LiveSky() = default;

const scene::SkyState& LiveSky::state() const {
  impl_->requireSky();
  return *impl_->state;
}

void LiveSky::update(const scene::Scene& scene, double secondsAfter) {
  Impl& m = *impl_;
  const bool known = m.state && m.knows(scene), same = known && m.state->scene == scene;
  if (!known) {
    update(scene::buildSky(scene, secondsAfter));
  } else if (!same || m.state->secondsAfter != secondsAfter) {
    if (!same) {
      scene::validate(scene);
      m.state->scene = scene;
    }
    const gpu::StateGuard guard;
    scene::moveSky(*m.state, secondsAfter);
    m.refresh();
  }
}

void LiveSky::update(const scene::SkyState& state) {
  const gpu::StateGuard guard;
  impl_->change(state);
  impl_->refresh();
}

bool LiveSky::Impl::knows(const scene::Scene& scene) const {
  if (state->scene == scene) return true;
  if (state->scene.output.quality != scene.output.quality) return false;
  scene::Scene other = scene;
  other.camera = state->scene.camera;
  other.output = state->scene.output;
  other.atS = state->scene.atS;
  return other == state->scene;
}

void LiveSky::Impl::change(const scene::SkyState& next) {
  const bool same = state && knows(next.scene);
  Others there;
  there.volumes = std::ranges::any_of(
      next.weather.layers, [&](const weather::Layer& layer) { return scene::isVolume(next.scene, layer); });
  there.splats = LiveSplats::in(next);
  if (same) {
    state = next;
    return;
  }
  updateBox(next.scene.skyBox, there);  // first, as its files may be missing: all is as it was then
  try {
    changeScene(next, there);
  } catch (...) {
    state.reset();  // half of it is another scene's
    throw;
  }
}

void LiveSky::Impl::changeScene(const scene::SkyState& next, const Others& there) {
  state = next;
  others = there;
  coverAhead.reset();
  volumesKnow = airKnows = false;
  volumesInSky = shading::volumesIn(*state);
  sheets.clear();
  sheets = makeThinLayers(state->scene, state->weather, state->clouds->earthRadiusM());
  for (const ThinLayer& sheet : sheets)
    if (sheet.living) octavesPass.prepare(*sheet.living);
  if (!clouds || clouds->noise() != state->clouds->sharedNoise())
    clouds.emplace(state->clouds->sharedNoise());
  if (backdrops()[0].id() == 0) backdrops() = backdropPrograms(others);
  if (others.splats) {
    if (!splats) splats.emplace();
    splats->change(*state);
  }
  if (!others.volumes) return;
  if (!volumes) volumes.emplace();
  volumes->change(*state, sheets);
  volumesKnow = true;
  const shading::Uniforms light = volumes->lightUniforms();
  for (gpu::Program& p : backdrops()) setUniforms(p, light);
  if (box) setUniforms(boxBackdrop(), light);
}

// Everything to the state's instant.
void LiveSky::Impl::refresh() {
  for (ThinLayer& sheet : sheets)
    sheet.matter = shading::matterAt(sheet.sheet, sheet.described, state->secondsAfter);
  for (ThinLayer& sheet : sheets)
    if (sheet.living) octavesPass.compose(*sheet.living, state->secondsAfter, sheet.flat);
  updateAmbient();
  tables.updateLive(*state);
  coverAhead.prepare(*state);
  shading::skyUniforms(*state, skyUniforms);
  sheetPass.setSky(skyUniforms);
  for (gpu::Program& p : backdrops()) setUniforms(p, skyUniforms);
  if (box) setUniforms(boxBackdrop(), skyUniforms);
  if (others.volumes) volumes->update(skyUniforms);
  if (others.splats) splats->update(*state, skyUniforms);
}

void LiveSky::Impl::updateBox(const scene::SkyBox& wanted, const Others& with) {
  gpu::Program& p = boxBackdrops[with.number()];
  if (!wanted.empty() && p.id() == 0)
    p = backdropProgram(shading::BackdropKind::kAll, {.skyBox = true}, with);
  if (box && box->box() == wanted) return;
  std::optional<SkyBoxTexture> next;  // where it cannot be made, the old one stays
  if (!wanted.empty()) next.emplace(wanted);
  box = std::move(next);
}

// The state's ambient light knows of its volumes and metaballs; here are sheets beside them.
void LiveSky::Impl::updateAmbient() {
  if ((others.volumes || others.splats) && sheets.empty()) return;
  inSky.clear();
  for (const ThinLayer& sheet : sheets) inSky.push_back({sheet.sheet.heightM, &sheet.matter});
  shading::lightUnder(*state, inSky, volumesInSky, underSheets);
  state->ambient = underSheets.ambient;
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    sheets[i].light = underSheets.sheets[i];
    sheets[i].sunThrough = underSheets.sunThrough[i];
  }
}

// Before anything of a view is drawn.
void LiveSky::Impl::lookFrom(const shading::ViewParts& view, unsigned number) {
  const double eyeM = view.eyeM.z;
  const scene::EyeAir air =
      sheets.empty() ? scene::airAbout(*state, eyeM) : shading::airUnder(*state, inSky, underSheets, eyeM);
  tables.lookFrom(*state, air, eyeM, number);
}

void LiveSky::Impl::drawBackdrop(const shading::ViewParts& view, const gpu::Target& target,
                                 const LiveOptions& options) {
  if (others.volumes) volumes->shadeAir(options.view, *state, tables, view);
  if (box) {
    setBackdrop(boxBackdrop(), view, target, options);
    box->bind(boxBackdrop());
    triangle.draw(boxBackdrop(), target);
    return;
  }
  const sky::Body &sun = state->ephemeris.sun, &moon = state->ephemeris.moon;
  const shading::BackdropTiles tiles = shading::backdropTiles(
      view, target.area.width, target.area.height, state->clouds->earthRadiusM(),
      {shading::BackdropDisc{glm::vec3(sun.direction), shading::drawnSunRadius(state->ephemeris)},
       shading::BackdropDisc{glm::vec3(moon.direction), static_cast<float>(moon.angularRadiusRad)}},
      state->scene.output.sunDisc && options.discs);
  tables.makeStars(*state, view.pixelRad);
  const bool beyond = SkyTextures::isAnythingBeyond(*state, view.pixelRad, view.eyeM.z);
  using shading::BackdropKind;
  for (const BackdropKind kind : {BackdropKind::kAll, BackdropKind::kSky, BackdropKind::kGround}) {
    gpu::Program& p = backdrops()[backdropIndex(kind, beyond)];
    bool set = false;
    for (int i = 0; i < tiles.count; ++i) {
      const shading::BackdropTile& t = tiles.tiles[static_cast<std::size_t>(i)];
      if (t.kind != kind) continue;
      if (!set) setBackdrop(p, view, target, options);
      set = true;
      triangle.draw(p, target, {.tile = gpu::Tile{t.x, t.y, t.width, t.height}});
    }
  }
}

void LiveSky::Impl::drawEveryBackdrop(const shading::ViewParts& view, const gpu::Target& target,
                                      const LiveOptions& options) {
  drawBackdrop(view, target, options);
  if (box) return;
  for (gpu::Program& p : backdrops()) {
    setBackdrop(p, view, target, options);
    triangle.draw(p, target);
  }
}

void LiveSky::Impl::setBackdrop(gpu::Program& p, const shading::ViewParts& view, const gpu::Target& target,
                                const LiveOptions& options) {
  p.set("uEarthRadiusM", static_cast<float>(state->clouds->earthRadiusM()));
  p.set("uEnuFromCamera", view.enuFromCamera);
  p.set("uRayScale", view.rayScale);
  p.set("uViewportPx", glm::vec4(target.area.x, target.area.y, target.area.width, target.area.height));
  p.set("uPixelRad", view.pixelRad);
  p.set("uScale", options.scale);
  p.set("uDiscs", state->scene.output.sunDisc && options.discs ? 1.0f : 0.0f);
  tables.bind(p);
  tables.bindStars(p, *state, view.pixelRad, view.eyeM.z);
  clouds->bind(p);
  std::size_t shadows = 0;
  float mean = 1.0f;
  for (const ThinLayer& sheet : sheets) {
    if (shadows == kMaxShadows || scene::comesDown(sheet.sheet.surface)) {
      mean *= sheet.sunThrough;
      continue;
    }
    setSheet(p, shadowNames[shadows], look(sheet, view));
    p.bind(kShadowPatterns[shadows], sheet.flat);
    ++shadows;
  }
  if (others.volumes) volumes->setShadows(p, options.view, *state, view);
  if (others.splats) splats->setShadow(p);
  p.set("uShadowMean", mean);
  p.set("uShadowCount", static_cast<int>(shadows));
}

void LiveSky::Impl::drawSheet(const ThinLayer& sheet, const shading::ViewParts& view,
                              const gpu::Target& target, float scale) {
  sheetPass.draw({&sheet.mesh, &sheet.pattern(), sheet.sheet.tier, look(sheet, view), sheet.light}, view,
                 tables, target, scale);
}

void LiveSky::Impl::drawFlare(const shading::ViewParts& view, const gpu::Target& target,
                              const LiveOptions& options, Programs which) {
  const sky::Body& sun = state->ephemeris.sun;
  shading::LensFlare flare =
      shading::lensFlareOf(view, glm::vec3(sun.direction), static_cast<float>(sun.angularRadiusRad),
                           shading::sunlightAt(*state, view.eyeM.z));
  if (which == Programs::kAll) flare.shown = 1.0f;
  FlarePass::Before before;
  before.depth = options.depth;
  std::array<FlareSheet, FlarePass::kMaxFlat + FlarePass::kMaxVolumes> standing;
  if (others.volumes) {
    before.picture = &volumes->picture(options.view);  // with the sheets in it
  } else {
    const std::size_t count = std::min(sheets.size(), standing.size());
    for (std::size_t i = 0; i < count; ++i)
      standing[i] = {&sheets[i].pattern(),
                     shading::shapeOf(sheets[i].sheet, state->clouds->earthRadiusM(), view.eyeM.z),
                     sheets[i].sheet.surface, look(sheets[i], view)};
    before.sheets = std::span(standing).first(count);
  }
  const float strength = options.flare * (others.splats ? splats->lightFrom(glm::vec3(sun.direction)) : 1.0f);
  flarePass.draw(flare, strength, view, state->clouds->earthRadiusM(), before, target, options.scale);
}

void LiveSky::Impl::drawSplats(const shading::View& view, const shading::ViewParts& parts,
                               const gpu::Target& target, const LiveOptions& options) {
  splats->draw(parts, tables, {target, options.scale, false, options.depth, view.projection});
}

// Far to near: down to the eye from above, and up to it from below; metaballs among them by the middle of
// their heights.
void LiveSky::Impl::drawSheets(const shading::View& view, const shading::ViewParts& parts,
                               const gpu::Target& target, const LiveOptions& options) {
  const double eyeM = parts.eyeM.z;
  bool left = others.splats;
  const auto splatsIf = [&](bool now) {
    if (left && now) drawSplats(view, parts, target, options);
    left &= !now;
  };
  const auto nearest =
      std::find_if(sheets.begin(), sheets.end(), [&](const ThinLayer& s) { return s.sheet.heightM > eyeM; });
  for (auto s = sheets.end(); s != nearest;) {
    --s;
    splatsIf(left && splats->heightM() > s->sheet.heightM);
    drawSheet(*s, parts, target, options.scale);
  }
  splatsIf(left && splats->heightM() > eyeM);
  for (auto s = sheets.begin(); s != nearest; ++s) {
    splatsIf(left && splats->heightM() < s->sheet.heightM);
    drawSheet(*s, parts, target, options.scale);
  }
  splatsIf(left);
}

void LiveSky::prepare(const shading::View& view, const gpu::Target& target, const LiveOptions& options) {
  Impl& m = *impl_;
  m.requireSky();
  if (target.area.width < 1 || target.area.height < 1) return;
  const gpu::StateGuard guard;
  // Drawn beside the target all is as in a frame but for its pixels.
  gpu::Tile beside = target.area;
  beside.x = -beside.width;
  m.draw(view, {target.framebuffer, beside}, options, Impl::Programs::kAll);
  gpu::finish();
}

void LiveSky::draw(const shading::View& view, const gpu::Target& target, const LiveOptions& options) {
  impl_->requireSky();
  if (target.area.width < 1 || target.area.height < 1) return;
  const gpu::StateGuard guard;
  impl_->draw(view, target, options, Impl::Programs::kSeen);
}

void LiveSky::Impl::draw(const shading::View& view, const gpu::Target& target, const LiveOptions& options,
                         Programs which) {
  const shading::ViewParts parts = shading::partsOf(view, target.area.height);
  lookFrom(parts, options.view);
  if (others.splats) splats->lookFrom(*state, parts.eyeM);
  if (others.volumes)
    volumes->march(options.view, *state, sheets, *clouds, tables, parts, target.area.width,
                   target.area.height);
  if (options.backdrop && which == Programs::kAll) drawEveryBackdrop(parts, target, options);
  if (options.backdrop && which == Programs::kSeen) drawBackdrop(parts, target, options);
  if (others.volumes) {
    // Whichever is nearer by the middle of its heights comes last.
    const auto away = [&](double heightM) { return std::abs(heightM - parts.eyeM.z); };
    const bool before = others.splats && away(splats->heightM()) > away(volumes->heightM());
    if (before) drawSplats(view, parts, target, options);
    volumes->show(options.view, target, options.scale);
    if (others.splats && !before) drawSplats(view, parts, target, options);
  } else {
    drawSheets(view, parts, target, options);
  }
  if (options.flare > 0.0f) drawFlare(parts, target, options, which);
}

// All pixels of the volumes of a small picture at once, which frames would come to in a round.
void LiveSky::Impl::settle(const shading::View& view, const gpu::Target& target, unsigned number) {
  if (!others.volumes) return;
  const shading::ViewParts parts = shading::partsOf(view, target.area.height);
  lookFrom(parts, number);
  for (int frame = 1; frame < LiveVolumes::kFramesInRound; ++frame)
    volumes->march(number, *state, sheets, *clouds, tables, parts, target.area.width, target.area.height);
}

SkyLight LiveSky::light(const glm::dvec3& eyeM) {
  Impl& m = *impl_;
  m.requireSky();
  const gpu::StateGuard guard;
  // Pixels as large as a few degrees blur the patterns of sheets, which changes their mean; volumes are slow.
  constexpr int kFine = 128, kCoarse = 32;
  const int side = m.others.volumes ? kCoarse : kFine;
  if (!m.probe || m.probe->side() != side) m.probe.emplace(side);
  SkyLight light;
  const auto drawn = [&](const shading::View& view, const gpu::Target& target, LiveOptions options,
                         int picture) {
    options.view = kLightViews + static_cast<unsigned>(picture);
    m.settle(view, target, options.view);
    m.draw(view, target, options, Impl::Programs::kSeen);
  };
  light.luminance =
      m.probe->luminance(eyeM, [&](const shading::View& view, const gpu::Target& target, int picture) {
        drawn(view, target, {.discs = false}, picture);
      });
  const auto clouds = [&](const shading::View& view, const gpu::Target& target, int picture) {
    drawn(view, target, {.backdrop = false}, picture);
  };
  const scene::SkyState& s = *m.state;
  const auto direct = [&](const sky::Light& from, const sky::Body& body, int picture) {
    DirectLight to;
    to.direction = from.direction;
    to.overClouds = from.illuminance * s.atmosphere->transmittanceToSpace(
                                           s.atmosphere->groundAltitudeM() + eyeM.z, from.direction.z);
    if (to.overClouds != glm::vec3(0.0f))
      to.throughClouds = m.probe->through(eyeM, from.direction, static_cast<float>(body.angularRadiusRad),
                                          SkyLightProbe::kFaces + picture, clouds);
    to.illuminance = to.throughClouds * to.overClouds;
    return to;
  };
  light.sun = direct(sky::sunLight(s.ephemeris), s.ephemeris.sun, 0);
  light.moon = direct(sky::moonLight(s.ephemeris), s.ephemeris.moon, 1);
  return light;
}

const AirVolume& LiveSky::airVolume(const shading::View& view, const AirVolumeOptions& options) {
  checkAirVolume(options);
  Impl& m = *impl_;
  m.requireSky();
  const gpu::StateGuard guard;
  if (!m.volumesKnow) {
    if (!m.volumes) m.volumes.emplace();
    m.volumes->change(*m.state, m.sheets);
    m.volumesKnow = true;
  }
  if (!m.airPass) m.airPass.emplace();
  if (!m.airKnows) m.airPass->change(*m.volumes, *m.state);
  m.airKnows = true;
  const shading::ViewParts parts = shading::partsOf(view, options.height);
  m.volumes->needLight(*m.state, *m.clouds, parts);
  m.lookFrom(parts, options.view);
  gpu::Program& p = m.airPass->program(options);
  setUniforms(p, m.skyUniforms);
  m.volumes->setView(p, *m.state, m.sheets, parts);
  m.clouds->bind(p);
  m.tables.bind(p);
  return m.airPass->fill(options);
}

}  // namespace welkin::render
