// SPDX-License-Identifier: Apache-2.0
#include "welkin/core/parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace welkin {
namespace {

std::atomic<int> gThreads{0};
thread_local bool tInsideLoop = false;

// One call of parallelFor, on its caller's stack. Chunks lie in shares, of which each thread begins at its
// own and goes on with what the others have left: what it wrote in the loop before is still in its own caches
// when the next one comes by.
struct Loop {
  static constexpr std::size_t kMostShares = 64;  // more threads begin together
  struct alignas(64) Share {
    std::atomic<std::size_t> next{0};
    std::size_t end = 0;
  };

  LoopBody body;
  std::size_t count, grain, mostHelpers, shares;
  std::array<Share, kMostShares> share;

  // Written under the crew's mutex:
  std::atomic<std::size_t> helpers = 0;
  std::exception_ptr failure{};
  Loop* next = nullptr;  // that waits for helpers

  Loop(LoopBody of, std::size_t n, std::size_t a, std::size_t chunks, std::size_t threads)
      : body(of), count(n), grain(a), mostHelpers(threads - 1), shares(std::min(threads, kMostShares)) {
    for (std::size_t s = 0; s < shares; ++s) {
      share[s].next = s * chunks / shares;
      share[s].end = (s + 1) * chunks / shares;
    }
  }

  bool wantsHelp() const {
    bool left = false;
    for (std::size_t s = 0; s < shares; ++s) left = left || share[s].next.load() < share[s].end;
    return left && helpers < mostHelpers;
  }
  void work(std::size_t first) {
    for (std::size_t i = 0; i < shares; ++i) {
      Share& s = share[(first + i) % shares];
      for (std::size_t c = s.next++; c < s.end; c = s.next++)
        body(c * grain, std::min(count, (c + 1) * grain));
    }
  }
  void skipTheRest() {
    for (std::size_t s = 0; s < shares; ++s) share[s].next = share[s].end;
  }
};

// Until good() or for as long as it takes to wake a thread that sleeps: where loops follow each other, nobody
// sleeps between them.
template <class Good>
void waitAwake(const Good& good) {
  using std::chrono::steady_clock;
  const auto end = steady_clock::now() + std::chrono::microseconds(50);
  while (!good() && steady_clock::now() < end) std::this_thread::yield();
}

// Threads that wait for loops and help with them, kept from loop to loop: to make a thread takes as long as
// many a loop does. Nothing is allocated once they are there.
class Crew {
 public:
  ~Crew() {
    {
      std::lock_guard lock(mutex_);
      ending_ = true;
    }
    work_.notify_all();
    for (std::thread& t : threads_) t.join();
  }

  void run(Loop& loop) {
    {
      std::lock_guard lock(mutex_);
      while (threads_.size() < loop.mostHelpers)
        threads_.emplace_back([this, which = threads_.size()] { helpForEver(which); });
      loop.next = loops_;
      loops_ = &loop;
      ++begun_;
    }
    if (loop.mostHelpers == 1)
      work_.notify_one();
    else
      work_.notify_all();
    workOn(loop, 0);
    waitAwake([&] { return loop.helpers == 0; });
    std::unique_lock lock(mutex_);
    Loop** place = &loops_;
    while (*place != &loop) place = &(*place)->next;
    *place = loop.next;
    done_.wait(lock, [&] { return loop.helpers == 0; });
  }

 private:
  void helpForEver(std::size_t which) {
    std::unique_lock lock(mutex_);
    for (;;) {
      Loop* loop = nullptr;
      work_.wait(lock, [&] {
        for (loop = loops_; loop && !loop->wantsHelp();) loop = loop->next;
        return loop || ending_;
      });
      if (!loop) return;
      ++loop->helpers;
      lock.unlock();
      workOn(*loop, 1 + which % loop->mostHelpers);
      lock.lock();
      if (--loop->helpers == 0) done_.notify_all();
      const std::uint64_t begun = begun_;
      lock.unlock();
      waitAwake([&] { return begun != begun_; });
      lock.lock();
    }
  }

  void workOn(Loop& loop, std::size_t which) {
    tInsideLoop = true;
    try {
      loop.work(which);
    } catch (...) {
      loop.skipTheRest();
      std::lock_guard lock(mutex_);
      if (!loop.failure) loop.failure = std::current_exception();
    }
    tInsideLoop = false;
  }

  std::mutex mutex_;
  std::condition_variable work_, done_;
  Loop* loops_ = nullptr;
  std::atomic<std::uint64_t> begun_ = 0;  // loops so far
  std::vector<std::thread> threads_;
  bool ending_ = false;
};

}  // namespace

int threadCount() {
  const int n = gThreads.load();
  return n > 0 ? n : std::max(1u, std::thread::hardware_concurrency());
}

void setThreadCount(int n) {
  gThreads.store(std::max(n, 0));
}

void parallelFor(std::size_t count, std::size_t grain, LoopBody body) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  const std::size_t workers = std::min<std::size_t>(threadCount(), chunks);
  if (workers <= 1 || tInsideLoop) {
    for (std::size_t c = 0; c < chunks; ++c) body(c * grain, std::min(count, (c + 1) * grain));
    return;
  }
  static Crew crew;
  Loop loop(body, count, grain, chunks, workers);
  crew.run(loop);
  if (loop.failure) std::rethrow_exception(loop.failure);
}

}  // namespace welkin
