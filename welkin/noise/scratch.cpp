// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/scratch.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <new>

namespace welkin::noise {
namespace {

constexpr std::size_t kAlignment = 64;

std::byte* allocate(std::size_t bytes) {
  return static_cast<std::byte*>(::operator new(bytes, std::align_val_t{kAlignment}));
}
void release(std::byte* p) {
  ::operator delete(p, std::align_val_t{kAlignment});
}

struct Pool {
  std::mutex mutex;
  std::vector<std::unique_ptr<Scratch>> idle;
};
Pool& pool() {
  static Pool p;
  return p;
}

}  // namespace

Scratch::~Scratch() {
  for (std::byte* b : blocks_) release(b);
}

void Scratch::reset() {
  const std::size_t all = total_;
  used_ = total_ = 0;
  if (blocks_.size() <= 1) return;
  // One block that holds all that was taken. Where there is no memory for it, none is left.
  for (std::byte* b : blocks_) release(b);
  blocks_.clear();
  capacity_ = 0;
  blocks_.push_back(allocate(all));
  capacity_ = all;
}

void* Scratch::takeBytes(std::size_t bytes) {
  bytes = (bytes + kAlignment - 1) / kAlignment * kAlignment;
  if (blocks_.empty() || used_ + bytes > capacity_) {
    // What fails here leaves all as it was.
    const std::size_t capacity = std::max(bytes, std::size_t{1} << 16);
    blocks_.reserve(blocks_.size() + 1);
    blocks_.push_back(allocate(capacity));
    capacity_ = capacity;
    used_ = 0;
  }
  void* p = blocks_.back() + used_;
  used_ += bytes;
  total_ += bytes;
  return p;
}

ScratchLoan::ScratchLoan() {
  Pool& p = pool();
  const std::lock_guard lock(p.mutex);
  if (p.idle.empty()) {
    scratch_ = new Scratch;
    // Room for all to come back, so that giving back does not allocate.
    p.idle.reserve(p.idle.capacity() + 1);
  } else {
    scratch_ = p.idle.back().release();
    p.idle.pop_back();
  }
}

ScratchLoan::~ScratchLoan() {
  Pool& p = pool();
  const std::lock_guard lock(p.mutex);
  p.idle.emplace_back(scratch_);
}

}  // namespace welkin::noise
