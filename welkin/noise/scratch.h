// SPDX-License-Identifier: Apache-2.0
// Memory of fills, lent out and taken back. Private to noise/.
#pragma once

#include <cstddef>
#include <vector>

namespace welkin::noise {

// Memory of one thread, or of what threads share, that is kept for the next fill: take() allocates only when
// more is taken than ever before. What was taken is aligned to 64 bytes and stays until reset().
class Scratch {
 public:
  Scratch() = default;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch();

  template <class T>
  T* take(std::size_t count) {
    return static_cast<T*>(takeBytes(count * sizeof(T)));
  }
  void reset();

 private:
  void* takeBytes(std::size_t bytes);
  std::vector<std::byte*> blocks_;  // after reset at most one
  std::size_t capacity_ = 0, used_ = 0, total_ = 0;
};

// Lends a Scratch out of a pool for the whole process.
class ScratchLoan {
 public:
  ScratchLoan();
  ~ScratchLoan();
  ScratchLoan(const ScratchLoan&) = delete;
  ScratchLoan& operator=(const ScratchLoan&) = delete;
  Scratch* operator->() const { return scratch_; }
  Scratch& operator*() const { return *scratch_; }

 private:
  Scratch* scratch_;
};

}  // namespace welkin::noise
