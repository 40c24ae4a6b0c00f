// SPDX-License-Identifier: Apache-2.0
// What a fill works out once, its memory, and the loop over its blocks.
#include <hwy/cache_control.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <mutex>

#include "welkin/core/parallel.h"
#include "welkin/noise/fill.h"

namespace welkin::noise {
namespace {

// Makes the tables of a fill in `memory`.
class Tables {
 public:
  Tables(FillJob& job, Scratch& memory)
      : job_(job), memory_(memory), dimensions_(static_cast<int>(job.params->dimensions)) {}

  // Sums of gradient noise. `scale` multiplies every weight.
  template <class TermOf>
  void addSums(int sums, const int* counts, const TermOf& termOf, double scale, double bias,
               Fractal fractal) {
    GradientTables& g = job_.gradients;
    g.sums = sums;
    g.bias = static_cast<float>(bias);
    g.fractal = fractal;
    g.first = take<int>(static_cast<std::size_t>(sums) + 1);
    g.first[0] = 0;
    for (int s = 0; s < sums; ++s) g.first[s + 1] = g.first[s] + counts[s];
    g.terms = g.first[sums];
    const bool narrow = job_.cellTerms > 0 || g.terms > kManyTerms || job_.box.size.x <= kStrip / 2;
    g.strip = narrow ? kStrip / 2 : kStrip;
    g.chunk = !job_.direct() ? kSmallChunk : job_.box.size.x <= kNarrow ? kMostChunk : kWideChunk;
    g.lead = job_.cellTerms > 0 ? job_.lead[1] % g.chunk : 0;  // blocks of cells begin at tiles
    g.lines = 0;
    g.term = take<TermTables>(static_cast<std::size_t>(g.terms));
    const int rows = job_.box.size.y, chunks = chunkCount(g);
    g.rows = take<RowPlace>(static_cast<std::size_t>(g.terms) * rows);
    g.chunks = take<ChunkLines>(static_cast<std::size_t>(g.terms) * chunks);
    auto* octaves = take<Octave>(static_cast<std::size_t>(g.terms));
    for (int s = 0; s < sums; ++s)
      for (int i = 0; i < counts[s]; ++i) {
        Octave& octave = octaves[g.first[s] + i];
        octave = octaveOf(g, termOf(s, i));
        g.lines += static_cast<int>(octave.lines);
        g.published = g.published || octave.term->lattice.published();
      }
    // What other threads would sleep through is a twentieth of a fill in the plane.
    parallelFor(static_cast<std::size_t>(g.terms), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) addTerm(g, static_cast<int>(t), octaves[t], scale);
    });
    if (job_.direct() && job_.box.size.z > 1) pairSlices(g);
  }

  void addCells(const CellTerm& term, CellTables& out, double scale) {
    out.lattice = &term.lattice;
    out.weight = static_cast<float>(term.weight * scale);
    out.dense = term.lattice.axis(0).frequency() * job_.grid.spacing.x > 0.126;
    double most = 0.0;
    for (int a = 0; a < term.lattice.axes(); ++a)
      most = std::max(most, term.lattice.axis(a).frequency() * job_.grid.spacing[a]);
    out.cubes = term.lattice.axes() == 3 && most > kTileStep && most < kCubeStep &&
                (job_.params->kind == Kind::kPerlinWorley || job_.params->feature == Feature::kF1);
    for (int a = 0; a < 3; ++a) {
      out.tile[a] = a == 0 || out.cubes ? kTileX : 1;
      if (a >= term.lattice.axes()) continue;
      const Axis& axis = term.lattice.axis(a);
      const double step = axis.frequency() * job_.grid.spacing[a];
      if (a > 0 && !out.cubes)
        while (out.tile[a] < kTileMost && 2 * out.tile[a] * step <= kTileCells) out.tile[a] *= 2;
      const int first = job_.box.first[a] - job_.lead[a], n = job_.tiled[a];
      auto* cell = take<std::int32_t>(static_cast<std::size_t>(n));
      auto* index = take<std::uint32_t>(static_cast<std::size_t>(n));
      auto* inside = take<float>(static_cast<std::size_t>(n));
      double before = 0.0;
      for (int i = 0; i < n; ++i) {
        const Span span = axis.at(position(a, first + i));
        cell[i] = i == 0 ? 0 : cell[i - 1] + static_cast<int>(std::lround(step - (span.inside - before)));
        index[i] = span.low;
        inside[i] = static_cast<float>(span.inside);
        before = span.inside;
      }
      out.axis[a] = {cell, index, inside};
    }
  }

  void addDistort(const DistortedTerm& term, DistortTables& out, double scale) {
    out.lattice = &term.main;
    out.weight = static_cast<float>(term.weight * scale);
    const int width = padded(job_.box.size.x);
    auto* index = take<std::uint32_t>(static_cast<std::size_t>(width));
    auto* inside = take<float>(static_cast<std::size_t>(width));
    for (int i = 0; i < width; ++i) {
      const Spot s = spotOf(term.main.axis(0), position(0, job_.box.first.x + i));
      index[i] = s.index;
      inside[i] = s.inside;
    }
    out.xIndex = index;
    out.xInside = inside;
    out.y = spots(term.main.axis(1), 1);
    out.z = dimensions_ == 3 ? spots(term.main.axis(2), 2) : nullptr;
    if (term.main.axes() > dimensions_)
      out.time = spotOf(term.main.axis(dimensions_), job_.params->time.value_or(0.0));
  }

 private:
  // Cells between samples, from which and up to which tiles are cut into cubes: measured.
  static constexpr double kTileStep = 0.1, kCubeStep = 0.3;
  static constexpr int kManyTerms = 8;  // octaves from which on strips are half as long: measured
  static constexpr double kPairPoints =
      0.1;                                   // of lattices' planes by sample, from which on slices are paired
  static constexpr double kTileCells = 0.5;  // of a cell's edge that a tile spans in y and z

  // Octaves are worked out by several threads.
  template <class T>
  T* take(std::size_t count) {
    const std::lock_guard lock(taking_);
    return memory_.take<T>(count);
  }

  double position(int axis, int sample) const { return (sample + 0.5) * job_.grid.spacing[axis]; }

  int chunkCount(const GradientTables& g) const { return (g.lead + job_.box.size.y + g.chunk - 1) / g.chunk; }

  static Spot spotOf(const Axis& axis, double p) {
    const Span span = axis.at(p);
    return {span.low, static_cast<float>(span.inside)};
  }
  const Spot* spots(const Axis& axis, int a) {
    auto* out = take<Spot>(static_cast<std::size_t>(job_.box.size[a]));
    for (int i = 0; i < job_.box.size[a]; ++i) out[i] = spotOf(axis, position(a, job_.box.first[a] + i));
    return out;
  }

  // An octave, and its lines among those of all.
  struct Octave {
    const GradientTerm* term;
    std::uint32_t firstLine, lines;
  };

  void addTerm(const GradientTables& g, int t, const Octave& octave, double scale) {
    const GradientTerm& term = *octave.term;
    const GradientLattice& lattice = term.lattice;
    TermTables& out = g.term[t];
    out.lattice = &lattice;
    const bool folded = g.fractal == Fractal::kFbm;
    out.weight = static_cast<float>(term.weight * scale);
    const double unit = 1.0 / gradientBytesScale(lattice.axes());
    const auto yScale = static_cast<float>(folded ? term.weight * scale * unit : unit);

    const Line x = lineOf(lattice.axis(0), 0, term.derivative == 0);
    const double step = lattice.axis(0).frequency() * job_.grid.spacing.x;
    out.x = {step,
             nullptr,
             nullptr,
             nullptr,
             nullptr,
             x.corner.lowWeight,
             x.corner.lowReach,
             x.corner.highWeight,
             x.corner.highReach};
    if (lattice.published()) {
      out.x.lowHash = x.low;
      out.x.highHash = x.high;
    } else {
      if (step < 1.0 && lattice.axes() > 2) addPoints(lattice.axis(0), x, out.x);
      if (step > 0.5 || out.x.pointHash == nullptr) {
        out.x.lowHash = oddHashes(lattice.axis(0), x.low, x.count);
        out.x.highHash = oddHashes(lattice.axis(0), x.high, x.count);
      }
    }

    addRows(g, t, lineOf(lattice.axis(1), 1, term.derivative == 1), octave, yScale);
    out.z = nullptr;
    if (dimensions_ == 3) {
      const Line z = lineOf(lattice.axis(2), 2, term.derivative == 2);
      auto* places = take<Place>(static_cast<std::size_t>(z.count));
      for (int k = 0; k < z.count; ++k) places[k] = z.place(k);
      out.z = places;
    }
    if (lattice.axes() > dimensions_) {
      Line time = takeLine(1);
      set(time, 0, lattice.axis(dimensions_).at(job_.params->time.value_or(0.0)));
      makeCorners(time.inside, 1, false, time.corner);
      out.time = time.place(0);
    }
  }

  // Slices by two, from the first or the second on: as share more planes of lattice points. Where there are
  // few points, it is better to write memory in its own order.
  void pairSlices(GradientTables& g) const {
    double shared[2] = {}, all = 0.0;
    for (int t = 0; t < g.terms; ++t) {
      const GradientLattice& lattice = *g.term[t].lattice;
      const double points = lattice.axis(0).frequency() * lattice.axis(1).frequency();
      all += points * job_.grid.spacing.x * job_.grid.spacing.y;
      for (int z = 0; z + 1 < job_.box.size.z; ++z) {
        const Place &first = g.term[t].z[z], &second = g.term[t].z[z + 1];
        const int planes =
            second.lowIndex == first.lowIndex ? 2 : (second.lowIndex == first.highIndex ? 1 : 0);
        shared[z % 2] += points * planes;
      }
    }
    if (all < kPairPoints) return;
    g.slices = kMostSlices;
    g.leadSlices = shared[1] > shared[0] ? 1 : 0;
  }

  // Samples along an axis, padded.
  struct Line {
    int count;
    double* inside;
    std::uint32_t *low, *high;  // indices
    CornerArrays corner;

    Place place(int i) const {
      return {{corner.lowWeight[i], corner.lowReach[i]},
              {corner.highWeight[i], corner.highReach[i]},
              low[i],
              high[i]};
    }
  };
  Line takeLine(int samples) {
    const int count = padded(samples);
    const auto n = static_cast<std::size_t>(count);
    const auto floats = [&] { return take<float>(n); };
    Line line{count, take<double>(n), take<std::uint32_t>(n), take<std::uint32_t>(n), {}};
    line.corner = {floats(), floats(), floats(), floats()};
    return line;
  }
  static void set(Line& line, int i, const Span& span) {
    line.inside[i] = span.inside;
    line.low[i] = span.low;
    line.high[i] = span.high;
  }

  const std::uint32_t* oddHashes(const Axis& axis, const std::uint32_t* index, int count) {
    auto* hashed = take<std::uint32_t>(static_cast<std::size_t>(padded(count)) + kPad);
    makeHashes(axis.key(), index, count, hashed);
    for (int i = 0; i < count; ++i) hashed[i] |= 1u;
    return hashed;
  }

  // The points of a row one after the other, where no sample lies more than a cell after the one before, or
  // before it by an error of rounding.
  void addPoints(const Axis& axis, const Line& x, RowPlaces& out) {
    auto* cell = take<std::int32_t>(static_cast<std::size_t>(x.count));
    cell[0] = 0;
    for (int i = 1; i < x.count; ++i) {
      const bool next = x.low[i] != x.low[i - 1];
      if (next && x.low[i] != x.high[i - 1]) return;
      cell[i] = cell[i - 1] + (next ? 1 : 0);
    }
    const int points = cell[x.count - 1] + 2;
    auto* index = take<std::uint32_t>(static_cast<std::size_t>(padded(points)));
    index[0] = x.low[0];
    for (int i = 1; i < points; ++i) index[i] = index[i - 1] + 1 == axis.period() ? 0 : index[i - 1] + 1;
    out.cell = cell;
    out.pointHash = oddHashes(axis, index, points);
  }

  Line lineOf(const Axis& axis, int a, bool derivative) {
    Line line = takeLine(job_.box.size[a]);
    // Exact at multiples of kExactly samples of the whole grid, stepped from there: the same in every box,
    // and off by no more than some roundings of a double.
    constexpr int kExactly = 64;
    const double step = axis.frequency() * job_.grid.spacing[a];
    const std::uint32_t period = axis.period();
    const bool steps = step * kExactly < 1e9 && (period == 0 || step < period);
    const int first = job_.box.first[a];
    for (int i = 0; i < line.count;) {
      const int begin = (first + i) / kExactly * kExactly,
                end = std::min(begin + kExactly - first, line.count);
      const Span span = axis.at(position(a, begin));
      if (!steps) {
        set(line, i, axis.at(position(a, first + i)));
        ++i;
        continue;
      }
      for (; i < end; ++i) {
        const double t = span.inside + (first + i - begin) * step;
        const auto cells = static_cast<std::uint32_t>(t);
        line.inside[i] = t - cells;
        std::uint32_t low = span.low + cells;
        if (period != 0 && (low >= period || low < cells)) low = (span.low + std::uint64_t{cells}) % period;
        line.low[i] = low;
        line.high[i] = low + 1 == period ? 0 : low + 1;
      }
    }
    makeCorners(line.inside, line.count, derivative, line.corner);
    return line;
  }

  static int mostLines(const GradientTables& g) { return 2 * g.chunk + 2; }
  Octave octaveOf(const GradientTables& g, const GradientTerm& term) const {
    // Rows less than a cell apart share lines: those over so many cells lie between three more, two are from
    // the chunk before, and roundings may make some twice.
    const int most = mostLines(g);
    const double cells = term.lattice.axis(1).frequency() * job_.grid.spacing.y * g.chunk;
    return {&term, static_cast<std::uint32_t>(g.lines),
            static_cast<std::uint32_t>(cells < g.chunk ? std::min(static_cast<int>(cells) + 7, most) : most)};
  }

  // Which lines of lattice points the rows lie between, chunk by chunk.
  void addRows(const GradientTables& g, int t, const Line& y, const Octave& octave, float scale) {
    const int rows = job_.box.size.y, chunks = chunkCount(g);
    const Axis& axis = g.term[t].lattice->axis(1);
    const int most = mostLines(g);
    const auto stride = static_cast<std::uint32_t>(lineStride(g.strip));
    LineRef* next = take<LineRef>(static_cast<std::size_t>(chunks) * most);
    auto* hash = take<std::uint32_t>(static_cast<std::size_t>(chunks) * most + kPad);
    std::uint32_t slot = 0;
    const LineRef* last[2] = {};  // of the row before
    for (int c = 0; c < chunks; ++c) {
      ChunkLines& chunk = g.chunks[static_cast<std::size_t>(c) * g.terms + t];
      chunk = {next, hash, 0, 0};
      for (const LineRef*& l : last)
        if (l != nullptr && (l == last[0] || l->index != last[0]->index)) {
          next[chunk.count] = *l;
          l = next + chunk.count++;
        }
      chunk.left = chunk.count;
      for (int row = std::max(c * g.chunk - g.lead, 0); row < std::min((c + 1) * g.chunk - g.lead, rows);
           ++row) {
        const auto find = [&](std::uint32_t index) {
          for (const LineRef* l : {last[1], last[0]})
            if (l != nullptr && l->index == index) return l;
          LineRef& made = next[chunk.count++];
          made = {index, (octave.firstLine + slot++ % octave.lines) * stride};
          return static_cast<const LineRef*>(&made);
        };
        const LineRef* low = find(y.low[row]);
        const LineRef* high = y.high[row] == y.low[row] ? low : find(y.high[row]);
        last[0] = low;
        last[1] = high;
        const CornerArrays& w = y.corner;
        g.rows[static_cast<std::size_t>(row) * g.terms + t] = {
            {scale * w.lowWeight[row], scale * w.lowReach[row], scale * w.highWeight[row],
             scale * w.highReach[row]},
            {low->offset, high->offset}};
      }
      for (std::uint32_t i = 0; i < chunk.count; ++i) hash[i] = axis.hash(next[i].index);
      next += chunk.count;
      hash += chunk.count;
    }
  }

  FillJob& job_;
  Scratch& memory_;
  std::mutex taking_;
  int dimensions_;
};

void makeTables(FillJob& job, Scratch& memory) {
  const Plan& plan = *job.plan;
  const NoiseParams& p = *job.params;
  const double scale = plan.normalise.scale, bias = plan.normalise.bias;
  job.cellTerms = static_cast<int>(plan.cells.size());
  Tables tables(job, memory);
  int counts[3 * 24] = {};
  const auto inSum = [&](int s, int i) -> const GradientTerm& { return plan.gradients[s][i]; };
  for (std::size_t s = 0; s < plan.gradients.size(); ++s)
    counts[s] = static_cast<int>(plan.gradients[s].size());
  switch (p.kind) {
    case Kind::kPerlin:
    case Kind::kCurl:
      tables.addSums(static_cast<int>(plan.gradients.size()), counts, inSum, scale, bias, p.fractal);
      break;
    case Kind::kPerlinWorley:
      tables.addSums(1, counts, inSum, 0.5, 0.5, Fractal::kFbm);
      break;
    case Kind::kDistorted: {
      const int fields = static_cast<int>(p.dimensions), octaves = static_cast<int>(plan.distorted.size());
      std::fill_n(counts, fields * octaves, 1);
      tables.addSums(
          fields * octaves, counts,
          [&](int s, int) -> const GradientTerm& { return plan.distorted[s / fields].fields[s % fields]; },
          p.distortion, 0.0, Fractal::kFbm);
      job.distortTerms = octaves;
      job.distorts = memory.take<DistortTables>(static_cast<std::size_t>(octaves));
      for (int o = 0; o < octaves; ++o) tables.addDistort(plan.distorted[o], job.distorts[o], scale);
      break;
    }
    case Kind::kValue:
      makeValueTables(job, memory);
      break;
    case Kind::kCellular:
      break;
  }
  job.bias = static_cast<float>(p.kind == Kind::kPerlinWorley ? 0.0 : bias);
  job.cells = memory.take<CellTables>(plan.cells.size());
  for (int t = 0; t < job.cellTerms; ++t) tables.addCells(plan.cells[t], job.cells[t], scale);
}

}  // namespace

Block FillJob::tilesOf(const Block& b) const {
  Block t = b;
  const auto widen = [](int& first, int& count, int before, int tile) {
    const int begin = (first + before) / tile * tile;
    const int end = (first + before + count + tile - 1) / tile * tile;
    first = begin;
    count = end - begin;
  };
  widen(t.x, t.width, lead[0], kTileX);
  widen(t.y, t.rows, lead[1], kTileMost);
  if (params->dimensions == 3) widen(t.z, t.slices, lead[2], kTileMost);
  return t;
}

namespace {

// Cells that the finest octave has for a sample. It decides by the whole grid, so that boxes agree.
double cellsOfSample(const FillJob& job) {
  double most = 0.0;
  for (const CellTerm& term : job.plan->cells) {
    double cells = 1.0;
    for (int a = 0; a < term.lattice.axes(); ++a) {
      const double step = term.lattice.axis(a).frequency() * job.grid.spacing[a];
      if (step * job.grid.size[a] > 1e9) return HUGE_VAL;  // more than tables count
      cells *= std::max(step, 1.0);
    }
    most = std::max(most, cells);
  }
  return most;
}

// Tiles know all points of their block: of so many cells a sample, blocks are small; of so many, the point
// function, which looks at some samples' own alone, is as fast and takes no memory.
constexpr double kCrowded = 8.0, kPointwise = 512.0;

// Whether threads work samples out faster than memory takes them: measured with one thread and with two.
bool waitsForMemory(const FillJob& job) {
  return job.params->kind == Kind::kPerlin && job.gradients.terms < 2 * threadCount();
}

// Samples of gradient noise that are enough for a block.
constexpr int kBlock = 1 << 15;

// Rows of a block of value noise: fewer where so many lattice points lie under each that they take much
// memory.
int valueRows(const FillJob& job) {
  double most = 0.0;
  for (const ValueTerm& term : job.plan->values)
    for (int a = 0; a < 2; ++a) most = std::max(most, term.axes[a].frequency() * job.grid.spacing[a]);
  return most > 2.0 ? kSmallChunk : 4 * kSmallChunk;
}

}  // namespace

void fillGrid(FillJob& job) {
  const NoiseParams& p = *job.params;
  const glm::ivec3 size = job.box.size;
  const bool cells = p.kind == Kind::kCellular || p.kind == Kind::kPerlinWorley;
  for (int a = 0; a < 3; ++a) {
    const int tile = a < p.dimensions ? kTileMost : 1;
    job.lead[a] = job.box.first[a] % tile;
    job.tiled[a] = (job.lead[a] + size[a] + tile - 1) / tile * tile;
  }
  const Affine &n = job.plan->normalise, &q = job.plan->quantise;
  const double most = job.format == Format::kUint8 ? 255.0 : 65535.0;
  job.low = static_cast<float>(n.low);
  job.high = static_cast<float>(n.high);
  job.quantiseScale = static_cast<float>(q.scale * most);
  job.quantiseBias = static_cast<float>(q.bias * most);
  const ScratchLoan memory;
  memory->reset();
  const double crowd = cellsOfSample(job);
  const bool pointwise = crowd > kPointwise;
  if (!pointwise) makeTables(job, *memory);
  const std::size_t bytes = job.format == Format::kFloat ? 4 : 0;
  job.stream = bytes * size.x * size.y * size.z > (waitsForMemory(job) ? kAllBytes : kCoreBytes);

  // Blocks: of gradients as tall as leaves every thread several, so that rows share what lies between rows of
  // lattice points; of cells small enough for a core's own cache.
  const int strip = cells ? 128 : job.gradients.strip;
  int rows = size.y, slices = job.gradients.slices;
  if (cells) {
    rows = p.dimensions == 3 ? 16 : 64;
    slices = p.kind == Kind::kCellular ? 16 : 8;
    if (crowd > kCrowded) rows = slices = kTileMost;
  } else if (p.kind == Kind::kValue) {
    rows = valueRows(job);
    // Slices share planes of the lattice: all of them where that leaves threads enough to do.
    const int across = (size.x + strip - 1) / strip, down = (size.y + rows - 1) / rows;
    const int parts = std::max(4 * threadCount() / (across * down), 1);
    slices = std::max((size.z + parts - 1) / parts, std::min(size.z, 8));
  } else if (size.z < 4 * slices * threadCount()) {
    rows = std::max(64, size.y / (4 * threadCount()) / kMostChunk * kMostChunk);
  } else {
    // To begin a block costs as much as some hundreds of samples.
    const std::int64_t slice = static_cast<std::int64_t>(rows) * std::min(size.x, strip);
    while (2 * slices * slice <= kBlock && size.z >= 8 * slices * threadCount()) slices *= 2;
  }
  const auto parts = [](int count, int part, int lead) { return (count + lead + part - 1) / part; };
  const int leadX = cells ? job.lead[0] : 0, leadY = cells ? job.lead[1] : 0,
            leadZ = cells ? job.lead[2] : job.gradients.leadSlices;
  const int across = parts(size.x, strip, leadX), down = parts(size.y, rows, leadY),
            deep = parts(size.z, slices, leadZ);
  const auto body = [&](std::size_t begin, std::size_t end) {
    const ScratchLoan scratch;
    for (std::size_t i = begin; i < end; ++i) {
      const int x = static_cast<int>(i % across), y = static_cast<int>(i / across % down),
                z = static_cast<int>(i / across / down);
      // Whole blocks are counted from the lead before the box.
      const auto clip = [](int part, int length, int lead, int whole, int& first, int& count) {
        first = std::max(part * length - lead, 0);
        count = std::min((part + 1) * length - lead, whole) - first;
      };
      Block b{};
      clip(x, strip, leadX, size.x, b.x, b.width);
      clip(y, rows, leadY, size.y, b.y, b.rows);
      clip(z, slices, leadZ, size.z, b.z, b.slices);
      if (pointwise)
        fillPointwise(job, b);
      else
        fillBlock(job, b, *scratch);
    }
    if (job.stream) hwy::FlushStream();
  };
  const std::size_t blocks = static_cast<std::size_t>(across) * down * deep;
  // A thread that has written past the caches waits for its last stores: not after every block.
  const std::size_t grain = job.stream ? blocks / (8 * static_cast<std::size_t>(threadCount())) : 1;
  parallelFor(blocks, grain, std::ref(body));
}

}  // namespace welkin::noise
