// SPDX-License-Identifier: Apache-2.0
// A sky inside somebody's frame loop, thin sheets, marched volumes and clouds of metaballs:
//
//   LiveSky sky;                                    // with the engine's context current
//   while loading:  sky.update(scene, seconds);     // or of buildSky(scene, seconds), from another thread
//                   sky.prepare(view, {framebuffer, {0, 0, width, height}});
//   every frame:  sky.update(scene, seconds);
//                 for each view: sky.draw(view, {framebuffer, {0, 0, width, height}});
//
// No global state: several skies, several views a frame, several contexts may live side by side. What is
// drawn depends on the scene, the seconds and the view alone, never on what was drawn before; with volumes,
// it comes to that within some frames (render/live_volumes.h). The engine's OpenGL state is as it was after
// every call. After the first two updates of a scene and a draw, or prepare(), nothing is compiled, no OpenGL
// object is made and no memory is allocated, and while time runs on no update takes much longer than others;
// but a view with many more metaballs in it than any before makes room for them, and one with pixels of twice
// the angle or more may sort the stars anew (sky/star_cells.h), some milliseconds, and where time jumps the
// cover of volumes is calibrated there (scene/cover_calibration.h), some hundredths of a second and some
// memory. Where time or a view jumps, up to four tables of the air are made, some hundredths of a second each
// (render/sky_table_keys.h); for the eye of view 0, which may climb or sink as aircraft do, they are ready
// before it comes to their heights, for other views in time alone.
//
// The air is that about each view's eye, wherever the scene's own is. Of the scene's keys those of the camera
// and of output play no part but for quality, sun_disc and stars: others may change with every update.
//
// Metaballs are splats here (render/splat_pass.h), relit every frame, whatever metaballs_as says; among
// sheets and volumes all of them together have their place by the middle of their heights.
//
// Belongs to the context that was current when it was made; not thread-safe.
#pragma once

#include <memory>
#include <vector>

#include "welkin/gpu/draw.h"
#include "welkin/render/air_volume.h"
#include "welkin/render/flare_pass.h"
#include "welkin/render/sky_light.h"
#include "welkin/scene/sky_state.h"
#include "welkin/shading/view.h"

namespace welkin::render {

struct LiveOptions {
  float scale = 1.0f;  // written for each cd/m2: 1 into float targets, an exposure into others. Linear; into
                       // sRGB targets with GL_FRAMEBUFFER_SRGB, as the engine has it set
  bool backdrop = true;  // clear sky, discs of sun and moon, ground; else only the clouds, over what is there
  bool discs = true;     // of sun and moon, where the scene has them: pictures that light things beside these
                         // two as lights are without
  float flare = 0.0f;    // share of the sun's light that a lens scatters into a glow and ghosts; 0: none
  EngineDepth depth{};   // of what hides the sun from the flare, and metaballs
  unsigned view = 0;     // number of the view, where several are drawn in a frame: volumes remember each
};

class LiveSky {
 public:
  // Needs OpenGL 3.3. Throws GpuError, as update(), draw() and airVolume() do, where no context is current
  // in the calling thread, or one of another kind.
  LiveSky();
  ~LiveSky();
  LiveSky(const LiveSky&) = delete;
  LiveSky& operator=(const LiveSky&) = delete;

  // The sky `secondsAfter` the scene's time. Its layers are drawn as their techniques say (auto: as
  // volumes). Throws as buildSky does, and for files of a sky box: the sky is as it was then. After a
  // GpuError there is none until the next update(), as there is none before the first: draw(), airVolume()
  // and state() throw ParameterError then.
  void update(const scene::Scene& scene, double secondsAfter);
  // The same of a sky that is there already.
  void update(const scene::SkyState& state);

  // Does beforehand what the first draw() of a view in a scene, or of its size, does more than later ones:
  // makes its textures, sweeps the light volume, and has the driver finish every program that draws into such
  // a target, those of dusk and night and of the flare too. Then it waits for the device. The target, of the
  // format and size to come, stays as it is. After update(); for each view, with the options to come. It
  // takes as long as that first draw(); airVolume() is made ready by being called. Metaballs are as in
  // draw(): where none is in view, the first that comes into it may take longer.
  void prepare(const shading::View& view, const gpu::Target& target, const LiveOptions& options = {});

  // Draws all of it over the target, far to near, as linear Rec. 709; nothing where its area is empty, as a
  // minimised window's is. After update().
  void draw(const shading::View& view, const gpu::Target& target, const LiveOptions& options = {});

  // The air and the clouds in front of what the engine draws itself, by distance: for its glass, water and
  // particles (render/air_volume.h). After update(), before or after draw(). Valid until the next call for
  // the same options.view, or with another scene. The first call in a scene compiles; later ones of the same
  // size make no OpenGL objects. Clouds are lit as in the last draw() of view 0, where that was near.
  // Throws ParameterError for sizes, distances or a scale out of range, GpuError.
  const AirVolume& airVolume(const shading::View& view, const AirVolumeOptions& options = {});

  // The light at a place in the world, m, for what the engine draws there (render/sky_light.h): sun and moon
  // through air and clouds, and the rest by its coefficients. As all is drawn: in eight small pictures from
  // there, which are read back. So it waits for the device, takes about as long as a frame, and is for once
  // in a while; the first call in a scene makes what a first draw() does. In a sky with volumes it comes out
  // a little otherwise by what was asked before from nearby. After update(). Views from kLightViews on are
  // its.
  static constexpr unsigned kLightViews = 1000;
  SkyLight light(const glm::dvec3& eyeM);

  const scene::SkyState& state() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace welkin::render
