/// Parallel loops over all threads that the program allows, by oneTBB.
#pragma once

#include <functional>

namespace emscape {

/// Limits the threads of oneTBB in the whole process; 0 removes this limit. It is one tbb::global_control
/// among those of the program: the lowest limit is in force, so that this call never raises a limit of the
/// host program. A host that limits threads itself need not call it: loops also run within the caller's
/// tbb::task_arena. Safe to call from any thread.
void setThreadLimit(int threads);

/// Threads that a loop of the calling thread may use, >= 1.
int threadCount();

/// Runs body(begin, end) over disjoint ranges that cover [0, count), and returns when all are done. A loop of
/// more than `grain` indices (>= 1; less counts as 1) is cut into ranges that are no shorter than about half
/// of it. An exception of the body reaches the caller. Loops may be nested. Nothing may depend on the order
/// in which ranges run: results must not vary with the number of threads.
void parallelFor(int count, int grain, const std::function<void(int begin, int end)>& body);

}  // namespace emscape
