// SPDX-License-Identifier: Apache-2.0
// Grid fills: what is worked out once for a fill, and the loop over its blocks. Private to noise/.
//
// Gradient noise over a row of samples is a sum, over the four or more rows of lattice points beside it, of
// products of one factor for each axis, because the noise is
//   sum over corners of  w(x) w(y) w(z) (g_x d_x + g_y d_y + g_z d_z)
// with w the fade's weight of a corner on an axis and d the distance to it. For each row of lattice points
// the factors of z are summed over both slices of lattice points once, and these sums are expanded over the
// samples, into
//   A[x] = sum_corner w(x) (sum_z w(z) g_z d_z + d_x sum_z w(z) g_x),   B[x] = sum_corner w(x) sum_z w(z) g_y
// and every row of samples between two rows of lattice points costs four multiplications a sample:
//   w0 A0 + (w0 d0) B0 + w1 A1 + (w1 d1) B1.
// A derivative along an axis puts the derivatives of w and of w d in their places.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>

#include "welkin/noise/noise.h"
#include "welkin/noise/plan.h"
#include "welkin/noise/scratch.h"

namespace welkin::noise {

// Weight of a corner on an axis, and weight times distance to it (or the derivatives of both).
struct Corner {
  float weight, reach;
};

// Floats of more bytes are written past the caches: of what takes long to work out, more than a core's own
// caches hold, which have better to keep; of what memory would be waited for, more than all caches are likely
// to hold.
inline constexpr std::size_t kCoreBytes = std::size_t{4} << 20, kAllBytes = std::size_t{16} << 20;

// Where samples along one axis lie on an octave's lattice.
struct Place {
  Corner low, high;
  std::uint32_t lowIndex, highIndex;
};

// The same of a row, by arrays over x; the hashes are odd. Where samples are less than a cell apart, the
// hashes are those of the points one after the other, and each sample has the number of the one below it;
// where they are more than half a cell apart, each sample has its own (also).
struct RowPlaces {
  double step;  // cells
  const std::uint32_t *lowHash, *highHash;
  const std::uint32_t* pointHash;
  const std::int32_t* cell;
  const float *lowWeight, *lowReach, *highWeight, *highReach;
};

// A strip of samples of a chunk of rows is worked on at a time: octave by octave all lines of lattice points
// that it lies between, then its sums. Long strips and chunks share what each octave costs beside its lines,
// and write memory in its own order; the lines stay in a core's own cache. With many octaves strips are half
// as long, and sums that wait to be put together come in smaller chunks. Of boxes at most kNarrow across,
// whose lines are short, chunks are twice as high. Arrays over x are padded to a multiple of kPad.
inline constexpr int kStrip = 256, kNarrow = 64, kMostChunk = 64, kWideChunk = 32, kSmallChunk = 8, kPad = 64;
constexpr int padded(int n) {
  return (n + kPad - 1) / kPad * kPad;
}

// A line holds A and B of fill.h's formula for a row of lattice points: kPad of A, the same of B, and so on.
// The lines of an octave are kept in a ring that has room for those of a chunk and two from the chunk before;
// the last floats keep lines from beginning in the same sets of the cache.
inline constexpr int kMostLines = 2 * kMostChunk + 2;
constexpr int lineStride(int strip) {
  return 2 * strip + 16;
}
// Where A of sample i is; i and what is used from there on in the same kPad.
constexpr int inLine(int i) {
  return i + (i & -kPad);
}
struct LineRef {
  std::uint32_t index;   // of the row of lattice points
  std::uint32_t offset;  // of the line, in floats
};

// The lines of one octave that a chunk of rows needs: first those that the chunk before has left.
struct ChunkLines {
  const LineRef* line;
  const std::uint32_t* hash;  // their indices' hashes; vectors are read, so that more follow
  std::uint32_t left, count;
};

// Slices side by side share what the planes of lattice points between them give, where they lie between the
// same ones.
inline constexpr int kMostSlices = 2;

// A row of samples between two lines.
struct RowPlace {
  float weights[4];        // low and high line's weight and reach, all scaled
  std::uint32_t lines[2];  // offsets
};

// One octave of gradient noise with its places on every axis of the box.
struct TermTables {
  const GradientLattice* lattice;
  float weight;    // where the fractal bends the octave: its weight afterwards
  RowPlaces x;     // by sample of the row
  const Place* z;  // by slice; in a plane null
  Place time;      // on the axis behind the last of the domain
};

// Sums of such octaves over the box: the octaves of all sums one after the other, sum s from first[s] on.
struct GradientTables {
  int terms = 0, sums = 0;
  TermTables* term = nullptr;
  int* first = nullptr;          // sums + 1
  RowPlace* rows = nullptr;      // [row * terms + term]
  ChunkLines* chunks = nullptr;  // [chunk * terms + term]
  int strip = kStrip;            // samples across
  int chunk = kSmallChunk;       // rows of a chunk
  int lead = 0;                  // of the first chunk before the box's first
  int slices = 1;                // that are worked on together
  int leadSlices = 0;            // of the first of these before the box's first
  int lines = 0;                 // in all octaves' rings
  bool published = false;        // some lattice is
  float bias = 0.0f;             // added to every sum
  Fractal fractal = Fractal::kFbm;

  // Slices from z on that are worked on together.
  int togetherFrom(int z) const { return slices - (z + leadSlices) % slices; }
};

// For each set of a vector's lanes, by bits, these lanes first and in their order.
inline constexpr std::array<std::array<std::int32_t, 8>, 256> kKeepFirst = [] {
  std::array<std::array<std::int32_t, 8>, 256> table{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    std::size_t n = 0;
    for (int lane = 0; lane < 8; ++lane)
      if ((bits >> lane & 1u) != 0) table[bits][n++] = lane;
  }
  return table;
}();

// Where samples along an axis lie among the cells of one octave.
struct CellPlaces {
  const std::int32_t* cell;    // counted from the first sample's
  const std::uint32_t* index;  // the same, wrapped
  const float* inside;
};

// One octave of cells over the box, its edges moved out to whole tiles.
inline constexpr int kTileX = 8, kTileMost = 8, kCellReach = 2;
struct CellTables {
  const CellLattice* lattice;
  float weight;
  CellPlaces axis[3];
  bool cubes;   // tiles of 8 x 8 x 8 samples, cut into cubes: for the nearest point, in cells of 3 to 10
                // samples
  bool dense;   // samples at least an eighth of a cell apart along x
  int tile[3];  // samples of a tile: kTileX and powers of two up to kTileMost
};

// A lattice point and the distance from it.
struct Spot {
  std::uint32_t index;
  float inside;
};

// One octave of distorted noise over the box; its shifts are sums of gradients.
struct DistortTables {
  const GradientLattice* lattice;
  float weight;
  const std::uint32_t* xIndex;
  const float* xInside;
  const Spot *y, *z;
  Spot time;
};

// Where samples along an axis fall among the lattice points of an octave of value noise, which are listed in
// the samples' order, those that smoothing takes beside them too. Padded: samples to a multiple of kPad,
// points by kPad.
struct ValueLine {
  const std::int32_t* first;  // by sample: its first tap's point
  const float* weight[4];     // by tap, for each sample
  int points;
  const std::uint32_t* index;   // of each point
  const std::uint64_t* column;  // ownColumn() of them
};

// One octave of value noise over the box.
struct ValueTables {
  ValueSettings settings;
  int taps;
  float weight;                      // 1 where the fractal bends the octave
  const ValueClock* clock;           // null: no time
  float timeWeight[4][kTimePhases];  // the clock's, of hashes counted in kOwnStep
  ValueLine axis[3];
};

enum class Format { kUint8, kUint16, kHalf, kFloat };

// Samples of the box that are worked on together, by one thread.
struct Block {
  int x, y, z, width, rows, slices;  // from the box's first
};

struct FillJob {
  const Noise* noise;
  const Plan* plan;
  const NoiseParams* params;
  Grid grid;
  Box box;
  Format format;
  void* out;
  int channels;

  // What follows is worked out by fillGrid().
  GradientTables gradients;
  CellTables* cells;
  int cellTerms;
  DistortTables* distorts;
  int distortTerms;
  ValueTables* values;
  int valueTerms;
  int lead[3], tiled[3];  // samples from a tile's first to the box's, and of whole tiles over the box
  float bias;             // of sums that are not gradients'
  float low, high;        // clamp of normalised values
  float quantiseScale, quantiseBias;  // for integer formats, to [0, greatest]
  bool stream;                        // `out` is large: write past the caches

  // Whether the sums of gradients are stored as they are made.
  bool direct() const {
    const bool sums = params->kind == Kind::kPerlin || params->kind == Kind::kCurl;
    const bool bytes = format == Format::kUint8 && std::endian::native == std::endian::little;
    return sums && channels == 1 && (format == Format::kFloat || bytes);
  }

  // The whole tiles of a block, from the first tile's first sample.
  Block tilesOf(const Block& b) const;
};

// Where samples of an axis lie on an octave of value noise; `taken` guards the memory, where threads share
// it.
ValueLine makeValueLine(const ValueSettings& settings, int axis, std::span<const CellPlace> places,
                        Scratch& memory, std::mutex& taking);
// What of a table does not lie on axes; keeps the noise's clock.
void setValue(const Value& noise, float weight, ValueTables& out);
// The tables of job.values.
void makeValueTables(FillJob& job, Scratch& memory);

// Fills job.out. Everything in the job has been checked.
void fillGrid(FillJob& job);

// One block of it by the point function, for processors without vectors and cells much smaller than samples.
void fillPointwise(const FillJob& job, const Block& block);

// On the processor's best instruction set: weights and reaches of corners from places within cells, n of
// them, and the hashes of lattice points.
struct CornerArrays {
  // What is less counts as nothing: samples that lie on lattice points but for an error of rounding would
  // make products too small for normal floats, which many processors multiply a hundred times more slowly.
  static constexpr double kLeast = 0x1p-40;

  float *lowWeight, *lowReach, *highWeight, *highReach;
};
void makeCorners(const double* inside, int n, bool derivative, const CornerArrays& out);
void makeHashes(std::uint32_t key, const std::uint32_t* index, int n, std::uint32_t* out);

// One block of it, on the processor's best instruction set.
void fillBlock(const FillJob& job, const Block& block, Scratch& scratch);

// Adds one octave of value noise to a box, on the same; `size` samples from the lines' first.
void addValues(const ValueTables& octave, const glm::ivec3& size, float* out, Scratch& scratch);

}  // namespace welkin::noise
