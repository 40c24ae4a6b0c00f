// SPDX-License-Identifier: Apache-2.0
// Portable hashing and random numbers: the same values on every machine, compiler and thread count.
#pragma once

#include <cstdint>

namespace welkin {

// Finaliser of SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators"):
// a bijection of 64 bits with full avalanche.
inline constexpr std::uint64_t kMixFactors[] = {0xbf58476d1ce4e5b9ULL, 0x94d049bb133111ebULL};
constexpr std::uint64_t mixStart(std::uint64_t x) {  // of an xor: the xor of what it makes of both
  return x ^ (x >> 30);
}
constexpr std::uint64_t mixRest(std::uint64_t x) {
  x *= kMixFactors[0];
  x ^= x >> 27;
  x *= kMixFactors[1];
  return x ^ (x >> 31);
}
constexpr std::uint64_t mixBits(std::uint64_t x) {
  return mixRest(mixStart(x));
}

// Hash of any number of integers, sensitive to their order.
inline constexpr std::uint64_t kHashFactor = 0x9e3779b97f4a7c15ULL;
constexpr std::uint64_t hashOf(std::uint64_t a) {
  return mixBits(a + kHashFactor);
}
// Of the first of several integers and the rest, from the hashes of both: hashOf() in steps.
constexpr std::uint64_t joinHashes(std::uint64_t first, std::uint64_t rest) {
  return mixBits(first ^ (rest * kHashFactor));
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
  constexpr std::uint64_t next() { return mixBits(state_ += kHashFactor); }
  constexpr float uniform() { return unitFloat(next()); }  // [0, 1)
  // Uniform integer in [0, n), n >= 1, without bias that matters (n < 2^32).
  constexpr std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(((next() >> 32) * n) >> 32);
  }

 private:
  std::uint64_t state_;
};

}  // namespace welkin
