/// Parallel loops by oneTBB.
#pragma once

#include <functional>

namespace emscape {

/// Limits the threads of oneTBB in the whole process; 0 removes this limit. The limit is a
/// tbb::global_control. Of several, the lowest is in force, so this call never raises a limit of the host
/// program. A host that limits threads itself need not call it: loops also run within the caller's
/// tbb::task_arena. Safe to call from any thread.
void setThreadLimit(int threads);

/// Threads that a loop of the calling thread may use, >= 1.
int threadCount();

/// Runs body(begin, end) over disjoint ranges that cover [0, count), and returns when all are done. A loop of
/// more than `grain` indices (>= 1; less counts as 1) is divided into ranges of at least about grain / 2. An
/// exception of the body is rethrown to the caller. Loops may be nested. Results must not depend on the order
/// in which ranges run, nor on the number of threads.
void parallelFor(int count, int grain, const std::function<void(int begin, int end)>& body);

}  // namespace emscape
