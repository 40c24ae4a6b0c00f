// SPDX-License-Identifier: Apache-2.0
// Rays through the clouds of a cloud_medium.h, many at a time: each in a lane of vectors, on from box to box
// of the grid and from collision to collision, whatever the others do. What a lane finds does not depend on
// the others.
//
// Lanes wait for each other at nothing but the density, which is looked up for several of them at once, and
// for the caller, who gives those that have ended their next ray.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "welkin/core/random.h"
#include "welkin/reference/cloud_medium.h"
#include "welkin/reference/ray_pieces.h"
#include "welkin/reference/sphere.h"

namespace welkin::reference {

using LaneBits = std::uint64_t;  // bit i for lane i

// What lanes know: an array of each quantity, for vectors.
struct alignas(64) CloudLanes {
  template <class T>
  struct alignas(64) Each : std::array<T, kCloudLanes> {};
  struct Vectors {
    Each<float> x, y, z;
  };
  // A piece of the ray: a line of cloud positions, from + slope t, and the same in space. inverse: of the
  // slope; 0 where it has none.
  Vectors from, slope, inverse, place, way;
  Each<float> t, end;                            // where the lane is on the piece, and where that ends
  Each<float> tileX, tileY, brickM, bricksPerM;  // of the tile that it is in
  Each<float> tileEnd;
  Each<std::int32_t> tileSide;  // bricks
  Each<const MajorantGrid::Tile*> tile;
  Each<float> depth;               // to the next collision with the majorant
  Each<std::int32_t> collides;     // -1: looks for a collision, 0: for the transmittance
  Each<float> through, control;    // of transmittance: so far; and an optical depth, not yet in it
  Each<float> majorant, minorant;  // 1/m, of the box
  Each<std::int32_t> slice, layers;
  Each<float> chance, free;  // of collisions: a number to decide by, and one for the next free depth

  struct Boxes {  // of a step
    Vectors at, low, high;
    Each<std::int32_t> x, y, z, brick, voxel, code;
    Each<std::uint16_t*> voxels;
  };
  Boxes boxes;
  struct Answers {  // 1/m, in the order of those that asked; and free depths
    Each<float> extinction, ice, snow, rain, free;
  };
  Answers answers;
};

class CloudWalks {
 public:
  static constexpr std::size_t kLanes = kCloudLanes;

  explicit CloudWalks(const CloudMedium& medium);  // outlives this

  // Begin in a lane whose last walk has ended. As CloudMedium::collide() and transmittance(); `random`
  // outlives the walk.
  void collide(std::size_t lane, const Ray& ray, double end, Random& random);
  void transmit(std::size_t lane, const Ray& ray, double end, Random& random);

  // Goes on until at least one walk has ended: those that have; 0 when there is none.
  LaneBits run();

  // What the last walk of a lane has found.
  std::optional<CloudMedium::Collision> collision(std::size_t lane) const { return collisions_[lane]; }
  double transmittance(std::size_t lane) const { return transmittances_[lane]; }

 private:
  struct Ways {  // what is left of a ray within the shell
    Ray ray;
    Random* random = nullptr;
    CloudMedium::Stretches stretches{};
    std::size_t stretch = 0;
    double piece = 0.0, next = 0.0;  // where the piece begins, and the one after it
  };
  void begin(std::size_t lane, const Ray& ray, double end, Random& random);
  void beginRays();
  bool toNextPiece(std::size_t lane);  // into pieces_
  void beginPieces();
  bool nextTile(std::size_t lane);
  void answer();  // those that ask for the density
  void collided(std::size_t lane, CloudMedium::Matter matter);
  bool spent(std::size_t lane);  // a transmittance that need not go on
  void finish(std::size_t lane);

  const CloudMedium& medium_;
  CloudLanes lanes_;
  std::array<Ways, kLanes> ways_;
  std::array<std::optional<CloudMedium::Collision>, kLanes> collisions_;
  std::array<double, kLanes> transmittances_{};
  RayPieces rays_{}, pieces_{};  // that begin
  LaneBits walking_ = 0, asking_ = 0, ended_ = 0;
};

}  // namespace welkin::reference
