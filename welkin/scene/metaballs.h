// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs (field/metaballs.h) in a sky.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "welkin/core/params.h"
#include "welkin/field/metaballs.h"
#include "welkin/scene/drift.h"
#include "welkin/scene/metaball_file.h"
#include "welkin/scene/metaball_layer.h"
#include "welkin/weather/weather.h"

namespace welkin::scene {

struct Scene;

// Of the first scattering.
enum class MetaballPhase { kDroplets, kRayleigh, kIsotropic };

// How they are drawn: by splats, lit in two passes; or marched, as all volumes are.
enum class MetaballRender { kSplats, kVolume };

// One by hand: [[metaballs]] of a scene file.
struct MetaballCloud {
  std::string file;                           // scene/metaball_file.h
  glm::dvec3 positionM{0.0, 3000.0, 1000.0};  // of the file's origin: east, north, above the ground
  double turnDeg = 0.0;                       // clockwise as seen from above
  double scale = 1.0;
  double extinctionPerM = 0.05;  // where the file's density is 1
  double albedo = 1.0;
  MetaballPhase phase = MetaballPhase::kDroplets;
  double windFromDeg = 270.0;
  double windSpeedMps = 0.0;
  double shearPerS = 0.0;  // m/s of wind more for each metre above its origin
  double lifeS = 0.0;      // of a ball (field/metaball_motion.h)
  bool operator==(const MetaballCloud&) const = default;
};
void describe(MetaballCloud& c, ParamVisitor& v);
void validate(const MetaballCloud& c);  // throws ParameterError: no file

// Of a layer's cloud, so many of its widths away and of that optical depth, what a picture has of its density
// and balls have not. Before its balls, the picture of what is dense then fades in evenly with the distance.
float pictureShare(double widths, double opticalDepth);

// Balls of many clouds at one instant, cloud by cloud, in metres east, north and above the ground about the
// eye; their densities are extinctions, 1/m.
struct CloudBalls {
  // A cloud of the library that is far away, for who draws a picture of it in the place of its balls.
  struct Far {
    const LibraryCloud* shape = nullptr;  // kept for good
    MetaballLayer::Cloud placed;          // the base as the balls are placed
    float share = 0.0f;  // of it that is drawn as a picture: where it is 1, there are no balls
  };
  struct Cloud {
    std::size_t end = 0;  // of its balls; they begin where the one before ends
    MetaballPhase phase = MetaballPhase::kDroplets;
    float albedo = 1.0f;
    // Where two levels of detail fade into one another: the end of the coarser one's balls, which come first,
    // and its share.
    std::size_t coarseEnd = end;
    float coarseShare = 1.0f;
    Far far{};
  };
  std::vector<field::Metaball> balls;
  std::vector<Cloud> clouds;
  std::vector<MetaballLayer::Cloud> filled;  // kept for its memory

  std::span<const field::Metaball> ballsOf(std::size_t cloud) const {
    const std::size_t begin = cloud == 0 ? 0 : clouds[cloud - 1].end;
    return std::span(balls).subspan(begin, clouds[cloud].end - begin);
  }
};

// As an eye sees them: coarser versions of clouds that are far away, fading into one another with the
// distance, and in the end into pictures; the same in balls alone; coarser by far, as their shadows are soft;
// or all of them in full.
enum class MetaballDetail { kAsSeen, kAsBalls, kAsShadow, kFinest };

// All clouds at one instant in full detail, as shapes and where they stand.
struct MetaballInstances {
  // In a frame of its own: x east, y north, z up; densities are not extinctions yet.
  struct Shape {
    std::size_t end = 0;  // of its balls; they begin where the one before ends
    field::Box box;
  };
  struct Instance {
    std::size_t shape = 0;
    glm::dvec3 positionM{0.0};  // of the shape's origin: along the ground from the eye's foot, and above it
    double scale = 1.0;
    double turnRad = 0.0;  // clockwise as seen from above
    double extinctionPerM = 1.0;
  };
  std::vector<field::Metaball> balls;
  std::vector<Shape> shapes;
  std::vector<Instance> instances;

  std::span<const field::Metaball> ballsOf(std::size_t shape) const {
    const std::size_t begin = shape == 0 ? 0 : shapes[shape - 1].end;
    return std::span(balls).subspan(begin, shapes[shape].end - begin);
  }
};

// All of a scene; what does not depend on the instant. Immutable.
class MetaballSky {
 public:
  MetaballSky() = default;
  // Reads the files, and fills the layers that are drawn so. Throws what readMetaballs() throws.
  MetaballSky(const Scene& scene, const weather::Weather& weather, double earthRadiusM);

  bool empty() const { return clouds_.empty() && layers_.empty(); }

  // Layers that cover less than was asked of them, a sentence each.
  std::vector<std::string> warnings() const;

  // Of a layer of the weather, by its number there, that is drawn so: optical depths in directions spread
  // evenly over the hemisphere (field::hemisphereDirection), from the ground at the place.
  std::vector<float> layerOpticalDepths(std::size_t layer, double secondsAfter, int directions) const;

  // All that its layers' clouds are made of.
  std::vector<const LibraryCloud*> shapes() const;

  // At an instant about an eye, over the curved earth. A pure, continuous function of the arguments; it
  // allocates nothing once `out` has held as many.
  void at(double secondsAfter, const glm::dvec3& eyeM, double earthRadiusM, CloudBalls& out,
          MetaballDetail detail = MetaballDetail::kAsSeen) const;

  // The same clouds for who draws them as volumes, about an eye east and north of the place.
  MetaballInstances instancesAt(double secondsAfter, const glm::dvec2& eyeM) const;

 private:
  struct Placed {
    MetaballCloud cloud;
    std::vector<std::vector<field::Metaball>> levels;  // scaled, turned and placed; the finest last
    std::vector<double> radiiM;                        // typical of each level
    glm::dvec3 middleM{0.0};
  };
  struct Filled {
    std::size_t number = 0;  // in the weather
    MetaballLayer layer;
  };
  glm::dvec2 driftOf(const Filled& filled, double secondsAfter) const;
  // Balls of a cloud by hand move, grow and decay; but for its drift as a whole.
  static void live(const MetaballCloud& cloud, double secondsAfter, std::span<field::Metaball> balls);

  std::vector<Placed> clouds_;
  std::vector<Filled> layers_;
  Drift drift_;
  std::uint64_t windSeed_ = 0;
};

}  // namespace welkin::scene

namespace welkin {
template <>
inline constexpr auto kEnumNames<scene::MetaballPhase> =
    std::array<std::string_view, 3>{"droplets", "rayleigh", "isotropic"};
template <>
inline constexpr auto kEnumNames<scene::MetaballRender> = std::array<std::string_view, 2>{"splats", "volume"};
}  // namespace welkin
