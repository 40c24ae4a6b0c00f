// SPDX-License-Identifier: Apache-2.0
// Draws clouds of metaballs in two passes, both of them every frame, after Y. Dobashi et al. 2000, "A Simple,
// Efficient Method for Realistic Animation of Clouds", M. J. Harris and A. Lastra 2001, "Real-Time Cloud
// Rendering", and P. Man 2006, "Generating and Real-Time Rendering of Clouds". Nothing is read back.
//
// Light pass: of each cloud the balls' optical depths add up in slices across a light's direction, whatever
// their order: for sun and moon, as far as they are seen (shading/splat_lights.h), for the zenith and for the
// side that the sky is bright on; finer slices for clouds that are larger in view. From them, the light that
// each ball sends to the eye, along 2 x 2 to 4 x 4 rays through it by its size in view (3 x 3 to 16 x 16 in
// stills). Eye pass: the balls from far to near, each with its exact optical depth along every ray. Light
// scattered more than once is lib/cloud_light.glsl's, as in marched volumes. The phase function is the first
// scattering's; all later ones are those of droplets. Clouds shade one another from sun and moon, not under
// the sky.
//
// Of other things in the sky it knows nothing but the depth that an engine hands over: it draws over what is
// in the target.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "welkin/field/metaballs.h"
#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/instances.h"
#include "welkin/gpu/texel_reader.h"
#include "welkin/render/flare_pass.h"
#include "welkin/render/sky_textures.h"
#include "welkin/render/splat_cloud.h"
#include "welkin/render/splat_pictures.h"
#include "welkin/render/splat_shadow.h"
#include "welkin/shading/far_order.h"
#include "welkin/shading/splat_lights.h"
#include "welkin/shading/uniforms.h"
#include "welkin/shading/view.h"

namespace welkin::render {

struct SplatTarget {
  const gpu::Target& target;
  float scale = 1.0f;     // written value for each cd/m2
  bool distance = false;  // the target's attachment 1 gets the mean distance, km, premultiplied
  // What hides balls, softly: engine's depth of a perspective without skew; reversed depth is taken for that
  // of glClipControl(GL_ZERO_TO_ONE).
  EngineDepth depth{};
  glm::dmat4 projection{1.0};  // with depth: the view's
};

// How finely light is sampled: as frames have time for, or some ten times finer.
enum class SplatDetail { kLive, kStill };

class SplatPass {
 public:
  explicit SplatPass(SplatDetail detail = SplatDetail::kLive);
  ~SplatPass();

  // Makes room for so many clouds and balls around the eye, and ready for pictures of such clouds.
  void reserve(std::size_t clouds, std::size_t balls,
               std::span<const scene::LibraryCloud* const> shapes = {});

  // What all draws under one sky share; before draws and whenever the sky has changed.
  void setSky(const shading::Uniforms& sky, const shading::SplatLights& lights);

  // Over what is in the target. The picture depends on the arguments alone, not on the balls' order unless
  // two are equally far. Allocates nothing once it has drawn as many balls.
  void draw(std::span<const SplatCloud> clouds, const shading::ViewParts& view, const SkyTextures& tables,
            const SplatTarget& to);

  // Their shadow in the key light, at most SplatShadow::kReachM from the eye.
  void drawShadow(std::span<const SplatCloud> clouds, const glm::dvec3& eyeM) {
    shadow_.draw(clouds, eyeM, lights_.toKey, depth_);
  }
  void setShadow(gpu::Program& program) const { shadow_.set(program); }

  // Of the balls and pictures last drawn.
  const shading::FarOrder& order() const { return order_; }

 private:
  struct Block;  // a cloud in view, and where its stacks are
  // Any cloud, in view or not: what it shades it need not be seen with.
  struct Whole {
    glm::dvec3 centreM;  // from the eye
    double radiusM;
  };
  struct Piece {
    glm::vec3 centreM;  // from the eye
    float radiusM, density;
    std::uint32_t block;  // or kPicture and the picture's number
  };
  static constexpr std::uint32_t kPicture = 1u << 31;
  gpu::Program& lightProgram() { return lightPrograms_[lights_.toSecond ? 1 : 0]; }
  void findBlocks(std::span<const SplatCloud> clouds, const shading::ViewParts& view);
  int placeBlocks(double coarser);
  void drawStacks(std::span<const SplatCloud> clouds, const glm::dvec3& eyeM);
  void addStack(const SplatCloud& cloud, const glm::dvec3& eyeM, const glm::dmat3& axes, int beside,
                Block& block);
  struct InStack {
    double x, y, z;         // m, z from the front of the stack
    double seenM, radiusM;  // the radius across, as seen in perspective, and along
    double density;
  };
  void addSlices(const Block& block, int beside, const InStack& ball, double texelM, double sliceM);
  void addShades(std::span<const SplatCloud> clouds, const glm::dvec3& eyeM, const glm::dmat3& axes,
                 int place, const Block& block);
  void sort();
  void addPieces(std::span<const SplatCloud> clouds, const glm::dvec3& eyeM);
  void findTiles(double pixelRad);
  void drawLight(const shading::ViewParts& view, const SkyTextures& tables);
  void drawBalls(const shading::ViewParts& view, const SplatTarget& to);

  SplatDetail detail_;
  gpu::Program depth_;
  std::array<gpu::Program, 2> lightPrograms_;  // with the key light, with both lights
  std::array<gpu::Program, 4> eye_;            // bit 0: with distance, bit 1: with an engine's depth
  gpu::Instances inSlices_{2}, inTiles_{7}, quads_{2};
  gpu::Texture2D depths_, tiles_;
  std::optional<gpu::Framebuffer> toDepths_, toTiles_;
  int stacksHeight_ = 0, tilesHeight_ = 0;  // texels of the textures that are in use
  gpu::TexelReader depthReader_;
  shading::SplatLights lights_;
  std::vector<Block> blocks_;
  std::vector<Block> glows_;   // of the same clouds, for the side that the sky is bright on
  std::vector<Block> shades_;  // of pictures, for what shades them
  SplatPictures pictures_;
  std::vector<Whole> wholes_;  // of each cloud; radius 0: none
  std::vector<Piece> pieces_;
  shading::FarOrder order_;        // of the pieces
  std::vector<float> distances_;   // of each piece
  std::vector<glm::vec3> tileOf_;  // of each piece: texel at its tile's corner, texels on its side
  std::vector<float> values_;
  std::vector<std::uint32_t> bySize_;
  SplatShadow shadow_;
};

}  // namespace welkin::render
