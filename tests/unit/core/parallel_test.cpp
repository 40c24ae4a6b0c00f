// SPDX-License-Identifier: Apache-2.0
#include "welkin/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace welkin {
namespace {

// Restores the thread count that the rest of the process uses.
class Parallel : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { setThreadCount(GetParam()); }
  void TearDown() override { setThreadCount(0); }
};

TEST_P(Parallel, CoversEachIndexOnce) {
  for (std::size_t count : {0u, 1u, 7u, 1000u}) {
    for (std::size_t grain : {1u, 3u, 64u, 5000u}) {
      std::vector<std::atomic<int>> hits(count);
      parallelFor(count, grain, [&](std::size_t begin, std::size_t end) {
        EXPECT_LE(end - begin, grain);
        for (std::size_t i = begin; i < end; ++i) ++hits[i];
      });
      for (const auto& h : hits) EXPECT_EQ(h, 1);
    }
  }
}

TEST_P(Parallel, RethrowsAndStaysUsable) {
  EXPECT_THROW(parallelFor(100, 1,
                           [](std::size_t begin, std::size_t) {
                             if (begin == 40) throw std::runtime_error("forty");
                           }),
               std::runtime_error);
  std::atomic<int> n = 0;
  parallelFor(10, 1, [&](std::size_t, std::size_t) { ++n; });
  EXPECT_EQ(n, 10);
}

TEST_P(Parallel, NestedCallsRun) {
  std::atomic<int> n = 0;
  parallelFor(8, 1, [&](std::size_t, std::size_t) {
    parallelFor(8, 1, [&](std::size_t begin, std::size_t end) { n += static_cast<int>(end - begin); });
  });
  EXPECT_EQ(n, 64);
}

TEST_P(Parallel, CallersAtOnceShareTheThreads) {
  std::atomic<int> n = 0;
  const auto loops = [&] {
    for (int i = 0; i < 200; ++i) parallelFor(16, 1, [&](std::size_t, std::size_t) { ++n; });
  };
  std::thread other(loops);
  loops();
  other.join();
  EXPECT_EQ(n, 2 * 200 * 16);
}

TEST_P(Parallel, UsesNoMoreThreadsThanAreSet) {
  std::atomic<int> now = 0, most = 0;
  parallelFor(200, 1, [&](std::size_t, std::size_t) {
    const int here = ++now;
    for (int seen = most; here > seen && !most.compare_exchange_weak(seen, here);) {
    }
    std::this_thread::yield();
    --now;
  });
  EXPECT_LE(most, GetParam());
}

TEST_P(Parallel, ThreadsBeginApartInTheSamePlacesInEveryLoop) {
  constexpr std::size_t kCount = 60;
  const int threads = GetParam();
  std::set<std::size_t> expected;
  for (int t = 0; t < threads; ++t) expected.insert(t * kCount / threads);
  for (int loop = 0; loop < 3; ++loop) {
    std::mutex mutex;
    std::map<std::thread::id, std::size_t> first;
    std::latch allThere(threads);
    parallelFor(kCount, 1, [&](std::size_t begin, std::size_t) {
      {
        std::lock_guard lock(mutex);
        if (!first.try_emplace(std::this_thread::get_id(), begin).second) return;
      }
      allThere.arrive_and_wait();
    });
    std::set<std::size_t> begun;
    for (const auto& [thread, begin] : first) begun.insert(begin);
    EXPECT_EQ(begun, expected);
    EXPECT_EQ(first[std::this_thread::get_id()], 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, Parallel, testing::Values(1, 2, 5));

TEST(ThreadCount, IsAtLeastOneAndAsSet) {
  setThreadCount(3);
  EXPECT_EQ(threadCount(), 3);
  setThreadCount(0);
  EXPECT_GE(threadCount(), 1);
}

}  // namespace
}  // namespace welkin
