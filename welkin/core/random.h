// SPDX-License-Identifier: Apache-2.0
// Portable hashing and random numbers: the same values on every machine, compiler and thread count.
#pragma once

#include <cstdint>

namespace welkin {

// Finaliser of SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators"):
// a bijection of 64 bits with full avalanche.
constexpr std::uint64_t mixBits(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// Hash of any number of integers, sensitive to their order.
constexpr std::uint64_t hashOf(std::uint64_t a) {
  return mixBits(a + 0x9e3779b97f4a7c15ULL);
}
// Of the first of several integers and the rest, from the hashes of both: hashOf() in steps.
constexpr std::uint64_t joinHashes(std::uint64_t first, std::uint64_t rest) {
  return mixBits(first ^ (rest * 0x9e3779b97f4a7c15ULL));
}
template <class... Rest>
constexpr std::uint64_t hashOf(std::uint64_t a, Rest... rest) {
  return joinHashes(hashOf(a), hashOf(static_cast<std::uint64_t>(rest)...));
}

// A uniform number in [0, 1) from the top 24 bits of a hash; exact in float.
constexpr float unitFloat(std::uint64_t h) {
  return static_cast<float>(h >> 40) * (1.0f / 16777216.0f);
}

// SplitMix64 sequence. Cheap to make: one for each task, seeded by hashOf(seed, task).
class Random {
 public:
  explicit constexpr Random(std::uint64_t seed) : state_(seed) {}
  constexpr std::uint64_t next() { return mixBits(state_ += 0x9e3779b97f4a7c15ULL); }
  constexpr float uniform() { return unitFloat(next()); }  // [0, 1)
  // Uniform integer in [0, n), n >= 1, without bias that matters (n < 2^32).
  constexpr std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(((next() >> 32) * n) >> 32);
  }

 private:
  std::uint64_t state_;
};

}  // namespace welkin
