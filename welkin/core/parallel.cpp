// SPDX-License-Identifier: Apache-2.0
#include "welkin/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace welkin {
namespace {

std::atomic<int> gThreads{0};
thread_local bool tInsideLoop = false;

}  // namespace

int threadCount() {
  const int n = gThreads.load();
  return n > 0 ? n : std::max(1u, std::thread::hardware_concurrency());
}

void setThreadCount(int n) {
  gThreads.store(std::max(n, 0));
}

void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  const std::size_t workers = std::min<std::size_t>(threadCount(), chunks);
  if (workers <= 1 || tInsideLoop) {
    for (std::size_t c = 0; c < chunks; ++c) body(c * grain, std::min(count, (c + 1) * grain));
    return;
  }

  std::atomic<std::size_t> nextChunk{0};
  std::exception_ptr failure;
  std::mutex failureMutex;
  auto work = [&] {
    tInsideLoop = true;
    try {
      for (std::size_t c = nextChunk++; c < chunks; c = nextChunk++)
        body(c * grain, std::min(count, (c + 1) * grain));
    } catch (...) {
      nextChunk = chunks;
      std::lock_guard lock(failureMutex);
      if (!failure) failure = std::current_exception();
    }
    tInsideLoop = false;
  };
  {
    // Threads are made for each loop: some 20 us, nothing beside the loops that call for it.
    std::vector<std::thread> threads;
    for (std::size_t i = 1; i < workers; ++i) threads.emplace_back(work);
    work();
    for (std::thread& t : threads) t.join();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace welkin
