// SPDX-License-Identifier: Apache-2.0
// The project's one parallel loop. Results must not depend on the thread count: bodies write to disjoint
// places and share no accumulators.
#pragma once

#include <concepts>
#include <cstddef>
#include <memory>

namespace welkin {

// Threads that parallelFor uses, the caller included. At least 1.
int threadCount();

// Sets the number of threads for the whole process; 0 means one for each hardware thread.
void setThreadCount(int n);

// What a loop does with the chunk [begin, end): a reference to the caller's function, so that a loop
// allocates nothing.
class LoopBody {
 public:
  template <class Body>
    requires std::invocable<const Body&, std::size_t, std::size_t> && (!std::same_as<Body, LoopBody>)
  LoopBody(const Body& body)  // implicit, to be called with a lambda
      : body_(std::addressof(body)), call_([](const void* b, std::size_t begin, std::size_t end) {
          (*static_cast<const Body*>(b))(begin, end);
        }) {}
  void operator()(std::size_t begin, std::size_t end) const { call_(body_, begin, end); }

 private:
  const void* body_;
  void (*call_)(const void*, std::size_t, std::size_t);
};

// Calls body(begin, end) over disjoint chunks that together cover [0, count), from several threads at once.
// Chunks are `grain` long (the last may be shorter). Each thread begins with a share of them, in order and
// the same from loop to loop, and then takes what others have left. Returns when all are done. The first
// exception that a body throws is rethrown here; chunks not yet begun are then skipped. Nested calls run
// serially in the calling thread.
void parallelFor(std::size_t count, std::size_t grain, LoopBody body);

}  // namespace welkin
