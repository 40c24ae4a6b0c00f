// SPDX-License-Identifier: Apache-2.0
// From the sky's state to shader uniforms by name. Pure: no GL calls, no state.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "welkin/core/image.h"
#include "welkin/scene/sky_state.h"
#include "welkin/shading/shader_library.h"

namespace welkin::shading {

// Arrays go whole, by their bare name; structs by member, as in uLayers[2].baseM.
using UniformValue = std::variant<int, float, glm::vec2, glm::vec3, glm::vec4, glm::mat3, std::vector<float>,
                                  std::vector<glm::vec4>>;
using Uniforms = std::vector<std::pair<std::string, UniformValue>>;

// lib/cloud_uniforms.glsl: layers and the earth.
Uniforms cloudUniforms(const scene::SkyState& state);
// Of these the layers alone, as they lie about an eye east and north of the place, into a list that was
// filled before: allocates nothing.
void cloudLayerUniforms(const scene::SkyState& state, glm::dvec2 eyeM, Uniforms& uniforms);

// How far from the sun's middle lib/background.glsl draws it, rad: its disc, and in an eclipse its corona.
float drawnSunRadius(const sky::Ephemeris& ephemeris);

// lib/march.glsl and lib/background.glsl: eye, lights, atmosphere, ground.
Uniforms skyUniforms(const scene::SkyState& state);
// The same into a list that was filled before: allocates nothing.
void skyUniforms(const scene::SkyState& state, Uniforms& uniforms);
// Of these those of the eye alone, for another: its height above the ground, m, and the air about it.
// Allocates nothing where the list was filled before.
void eyeUniforms(const scene::EyeAir& air, double eyeM, Uniforms& uniforms);

// What of a light of the sky reaches clouds through the air: RGB illuminance, lux, by height (columns) and
// the sine of the light's elevation (rows). Allocates only where the table is empty.
void lightTable(const scene::SkyState& state, const sky::Light& light, Image<float>& table);

// How finely to march: marchSettings().
struct MarchSettings {
  int subframes = 0;       // accumulated into a still, at most
  float tolerance = 0.0f;  // relative, up to which a part of the picture has enough of them
  float noise = 0.0f;      // relative, that the sub-frames leave and the resolve takes out
  float stepNearM = 0.0f;  // smallest step, in cloud
  float stepShare = 0.0f;  // step in cloud as a share of the distance
  float stepLong = 30.0f;  // the longest step through clear air, in steps in cloud: the same of every quality
  int maxSteps = 0;
  int sunSamples = 0;            // density samples towards the sun before the light volume takes over
  int surfaceHalvings = 3;       // of the step in which a surface was met
  bool cascadesBlended = false;  // of the light volume; or each pixel has one of two, by its noise
};
MarchSettings marchSettings(scene::Quality quality);
// Of a perspective picture, by the tangents of half its angles across and up: narrow ones see clouds from so
// far that those steps would be many pixels. From 60 degrees on they are the same.
MarchSettings marchSettings(scene::Quality quality, glm::vec2 halfTan);
Uniforms marchUniforms(const MarchSettings& settings);
// The same into a list that was filled before: allocates nothing.
void marchUniforms(const MarchSettings& settings, Uniforms& uniforms);

// lib/projection.glsl.
Uniforms projectorUniforms(const scene::SkyState& state);

// The light volume (lib/light_volume.glsl): where its slices and cascades lie.
struct LightVolumeLayout {
  struct Band {
    float baseM, topM;
    int firstSlice, lastSlice;
    std::vector<int> layers;  // that lie in it, by their indices in the field
    bool balls = false;       // metaballs, too, as volumes
    bool shafts = false;      // what falls, and no cloud

    bool operator==(const Band&) const = default;
  };
  static constexpr int kFewColumns = 160, kManyColumns = 320;
  int columns = kFewColumns;  // a side, of each cascade; many in high quality
  static constexpr std::array<float, 3> kHalfM = {8000.0f, 32000.0f,
                                                  128000.0f};  // half the side of each cascade
  std::vector<Band> bands;      // of the layers that are volumes, from the ground up; they may touch
  std::vector<float> heightsM;  // of the slices
  glm::vec3 line{0, 0, 1};      // along which depths are summed; z > 0
  bool towardsSun = true;       // or away from it
  float sunOverSky = 0.0f;      // illuminance of level ground by sun and moon, in that by the clear sky
  float spreadM = 1000.0f;      // how far light on the ground comes from, about
  float broken = 1.0f;          // 0: closed clouds, under which there is as much everywhere
};
// ballsM: heights between which there are metaballs that are drawn as volumes.
LightVolumeLayout lightVolumeLayout(const scene::SkyState& state, std::optional<glm::vec2> ballsM = {});
// Sets of it what changes with the instant: the line, and how bright sun and moon are.
void aimLightVolume(const scene::SkyState& state, LightVolumeLayout& layout);
Uniforms lightVolumeUniforms(const LightVolumeLayout& layout);

// What is compiled into programs (lib/cloud_uniforms.glsl): the layers of all bands, and the order in which a
// march from an eye at a height meets them; or one band alone.
using ShaderDefines = std::vector<ShaderDefine>;
ShaderDefines marchDefines(const LightVolumeLayout& layout, double eyeM);
ShaderDefines bandDefines(const LightVolumeLayout& layout, int band);
std::string layerCalls(const LightVolumeLayout& layout, int band);             // of the one and of the other
void addBandDefines(const LightVolumeLayout& layout, ShaderDefines& defines);  // what else bands hold
// What lib/march.glsl needs tables for: droplets by Mie's theory, rain.
void addPhaseDefines(const scene::SkyState& state, ShaderDefines& defines);

}  // namespace welkin::shading
