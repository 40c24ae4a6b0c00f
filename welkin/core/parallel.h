// SPDX-License-Identifier: Apache-2.0
// The project's one parallel loop. Results must not depend on the thread count: bodies write to disjoint
// places and share no accumulators.
#pragma once

#include <cstddef>
#include <functional>

namespace welkin {

// Threads that parallelFor uses, the caller included. At least 1.
int threadCount();

// Sets the number of threads for the whole process; 0 means one for each hardware thread.
void setThreadCount(int n);

// Calls body(begin, end) over disjoint chunks that together cover [0, count), from several threads at once.
// Chunks are `grain` long (the last may be shorter) and handed out in order as threads become free.
// Returns when all are done. The first exception that a body throws is rethrown here; chunks not yet begun
// are then skipped. Nested calls run serially in the calling thread.
void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace welkin
