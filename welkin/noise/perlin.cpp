// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/perlin.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "welkin/core/random.h"

namespace welkin::noise {
namespace {

// The reference permutation of Perlin 2002.
constexpr std::array<std::uint8_t, 256> kPublished = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,
    69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,
    94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136,
    171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122,
    60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161,
    1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196, 135, 130, 116, 188, 159, 86,
    164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126,
    255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213,
    119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,   129, 22,  39,  253,
    19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,  242, 193,
    238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,
    222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

template <class T>
T fade(T t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

template <class T>
T lerp(T w, T a, T b) {
  return a + w * (b - a);
}

// Dot product with one of the twelve edge directions (four repeated), chosen by the low bits of the hash.
template <class T>
constexpr T gradient(int hash, T x, T y, T z) {
  const int h = hash & 15;
  const T u = h < 8 ? x : y;
  const T v = h < 4 ? y : (h == 12 || h == 14 ? x : z);
  return ((h & 1) == 0 ? u : -u) + ((h & 2) == 0 ? v : -v);
}

// Lattice indices of a cell's two corners on one axis.
struct Corners {
  int lo, hi;
};

template <class T>
T blend(const std::array<std::uint8_t, 512>& p, Corners cx, Corners cy, Corners cz, T x, T y, T z) {
  const T u = fade(x), v = fade(y), w = fade(z);
  auto corner = [&](int i, int j, int k, T dx, T dy, T dz) {
    return gradient(p[p[p[i & 255] + (j & 255)] + (k & 255)], dx, dy, dz);
  };
  auto face = [&](int k, T dz) {
    const T a = lerp(u, corner(cx.lo, cy.lo, k, x, y, dz), corner(cx.hi, cy.lo, k, x - 1, y, dz));
    const T b = lerp(u, corner(cx.lo, cy.hi, k, x, y - 1, dz), corner(cx.hi, cy.hi, k, x - 1, y - 1, dz));
    return lerp(v, a, b);
  };
  return lerp(w, face(cz.lo, z), face(cz.hi, z - 1));
}

// The directions that gradient() chooses from.
constexpr std::array<glm::vec3, 16> kGradients = [] {
  std::array<glm::vec3, 16> g{};
  for (int h = 0; h < 16; ++h)
    g[h] = {gradient(h, 1.0f, 0.0f, 0.0f), gradient(h, 0.0f, 1.0f, 0.0f), gradient(h, 0.0f, 0.0f, 1.0f)};
  return g;
}();

Corners wrapped(int i, int period) {
  int lo = i % period;
  if (lo < 0) lo += period;
  return {lo, lo + 1 == period ? 0 : lo + 1};
}

}  // namespace

Perlin::Perlin() {
  for (int i = 0; i < 512; ++i) p_[i] = kPublished[i & 255];
}

Perlin::Perlin(std::uint64_t seed) {
  std::array<std::uint8_t, 256> table;
  std::iota(table.begin(), table.end(), std::uint8_t{0});
  Random random(seed);
  for (std::uint32_t i = 255; i > 0; --i) std::swap(table[i], table[random.below(i + 1)]);
  for (int i = 0; i < 512; ++i) p_[i] = table[i & 255];
}

double Perlin::operator()(double x, double y, double z) const {
  const double fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  // Reduced in double first: the lattice repeats every 256 and positions may be far beyond what an int holds.
  auto corner = [](double f) {
    const int lo = static_cast<int>(f - 256.0 * std::floor(f / 256.0));
    return Corners{lo, lo + 1};
  };
  return blend<double>(p_, corner(fx), corner(fy), corner(fz), x - fx, y - fy, z - fz);
}

float Perlin::periodic(float x, float y, float z, glm::ivec3 period) const {
  const float fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  return blend<float>(p_, wrapped(static_cast<int>(fx), period.x), wrapped(static_cast<int>(fy), period.y),
                      wrapped(static_cast<int>(fz), period.z), x - fx, y - fy, z - fz);
}

void Perlin::addRow(std::span<float> out, float weight, float step, float y, float z,
                    glm::ivec3 period) const {
  const float fy = std::floor(y), fz = std::floor(z);
  const Corners cy = wrapped(static_cast<int>(fy), period.y), cz = wrapped(static_cast<int>(fz), period.z);
  const float dy = y - fy, dz = z - fz;
  const float v = fade(dy), w = fade(dz);

  // What the four lattice points of one x contribute, blended over y and z, is linear in the distance from
  // that x.
  struct Node {
    float value, slope;
  };
  auto node = [&](int i) {
    const int px = p_[i & 255];
    auto edge = [&](int k, float ez) {
      const int lo = p_[px + (cy.lo & 255)] + (k & 255), hi = p_[px + (cy.hi & 255)] + (k & 255);
      const glm::vec3 &a = kGradients[p_[lo] & 15], &b = kGradients[p_[hi] & 15];
      return Node{lerp(v, a.y * dy + a.z * ez, b.y * (dy - 1.0f) + b.z * ez), lerp(v, a.x, b.x)};
    };
    const Node near = edge(cz.lo, dz), far = edge(cz.hi, dz - 1.0f);
    return Node{weight * lerp(w, near.value, far.value), weight * lerp(w, near.slope, far.slope)};
  };

  int cell = -2;  // none yet
  Node left{}, right{};
  for (std::size_t n = 0; n < out.size(); ++n) {
    const float x = (static_cast<float>(n) + 0.5f) * step;
    const int i = static_cast<int>(x);
    if (i != cell) {
      const Corners c = wrapped(i, period.x);
      left = i == cell + 1 ? right : node(c.lo);
      right = node(c.hi);
      cell = i;
    }
    const float dx = x - static_cast<float>(i);
    out[n] += lerp(fade(dx), left.value + left.slope * dx, right.value + right.slope * (dx - 1.0f));
  }
}

}  // namespace welkin::noise
