/// Parallel loops over all threads that the program allows (oneTBB behind them).
#pragma once

#include <functional>

namespace emscape {

/// Limits the threads of oneTBB in the whole process; 0 lifts this limit. It is one tbb::global_control among
/// those of the program: the lowest limit holds, so that it never raises a limit that a host program has set.
/// A host that limits threads by itself need not call it: loops also run within the caller's tbb::task_arena.
/// Safe to call from any thread.
void setThreadLimit(int threads);

/// Threads that a loop of the calling thread may use, >= 1.
int threadCount();

/// Runs body(begin, end) over disjoint pieces that cover [0, count), and returns when all are done. A loop of
/// more than `grain` indices (>= 1; less counts as 1) is cut into pieces that are no shorter than about half
/// of it. An exception of the body reaches the caller. Loops may be nested. Nothing may depend on which piece
/// runs when: results must not vary with the number of threads.
void parallelFor(int count, int grain, const std::function<void(int begin, int end)>& body);

}  // namespace emscape
