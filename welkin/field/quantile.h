// SPDX-License-Identifier: Apache-2.0
// Thresholds that leave a wanted fraction of samples above them, exact to one sample, for more samples than
// fit into memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace welkin::field {

// Sees every sample twice, in any order and in pieces: add() all, nextPass(), add() all again. Memory: 1.5
// MB. Not thread-safe; to count from several threads give each its own and merge() them before each
// nextPass().
class SampleQuantile {
 public:
  // fraction: of the samples that are to lie above the threshold, in [0, 1].
  explicit SampleQuantile(double fraction);

  void add(std::span<const float> samples);  // finite
  // Adds the counts of another one in the same pass, which counts on from none.
  void merge(SampleQuantile& other);
  // At least one sample must have been added. The second pass has counters of its own.
  void nextPass();

  // After the second pass: the nearest possible number of samples to fraction * count are strictly above it
  // (equal samples can only be above or below together). A float, midway between its neighbours among the
  // samples.
  double threshold() const;

 private:
  double fraction_;
  bool secondPass_ = false;
  std::uint64_t count_ = 0, above_ = 0;         // samples; those that are wanted above
  std::uint64_t belowLow_ = 0, belowHigh_ = 0;  // samples beneath the two bins
  std::uint32_t lowBin_ = 0, highBin_ = 0;      // upper 16 bits of the keys on either side of the threshold
  std::vector<std::uint64_t> upper_;            // first pass: by the upper 16 bits of a sample's key
  std::vector<std::uint64_t> low_, high_;       // second pass: by the lower 16 bits, in those bins
};

// The same of samples in memory; at least one.
double quantileAbove(std::span<const float> samples, double fraction);

}  // namespace welkin::field
