#include "emscape/base/parallel.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace emscape {
namespace {

/// How often a loop visits each index.
std::vector<int> visits(int count, int grain) {
  std::vector<int> visited(static_cast<std::size_t>(count));
  parallelFor(count, grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) ++visited[static_cast<std::size_t>(i)];
  });
  return visited;
}

TEST(ParallelFor, VisitsEveryIndexOnce) {
  for (int count : {1, 2, 7, 64, 1001, 100000}) {
    for (int grain : {1, 3, 64, 5000}) {
      EXPECT_EQ(visits(count, grain), std::vector<int>(static_cast<std::size_t>(count), 1));
    }
  }
}

TEST(ParallelFor, DoesNothingForAnEmptyRange) {
  parallelFor(0, 1, [](int, int) { FAIL() << "called for an empty range"; });
  parallelFor(-5, 1, [](int, int) { FAIL() << "called for a negative count"; });
}

TEST(ParallelFor, TakesAGrainBelowOneAsOne) {
  EXPECT_EQ(visits(10, 0), std::vector<int>(10, 1));
  EXPECT_EQ(visits(10, -1), std::vector<int>(10, 1));
}

TEST(ParallelFor, KeepsPiecesNearTheGrain) {
  std::atomic<int> shortest{1 << 30};
  parallelFor(10000, 100, [&](int begin, int end) {
    int known = shortest;
    while (end - begin < known && !shortest.compare_exchange_weak(known, end - begin)) {
    }
  });
  EXPECT_GE(shortest, 50);
}

TEST(ParallelFor, DoesNotCutALoopOfOneGrain) {
  std::atomic<int> pieces{0};
  parallelFor(100, 100, [&](int, int) { ++pieces; });
  EXPECT_EQ(pieces, 1);
}

TEST(ParallelFor, ExceptionOfTheBodyReachesTheCaller) {
  const auto failing = [] {
    parallelFor(1000, 1, [](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        if (i == 617) throw std::runtime_error("index 617");
      }
    });
  };
  EXPECT_THROW(failing(), std::runtime_error);
}

TEST(ParallelFor, MayBeNested) {
  std::atomic<int> sum{0};
  parallelFor(10, 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      parallelFor(10, 1, [&](int inner_begin, int inner_end) { sum += inner_end - inner_begin; });
    }
  });
  EXPECT_EQ(sum, 100);
}

TEST(ThreadLimit, BoundsTheThreadsAndIsLifted) {
  const int all = threadCount();
  EXPECT_GE(all, 1);
  setThreadLimit(1);
  EXPECT_EQ(threadCount(), 1);
  EXPECT_EQ(visits(1000, 1), std::vector<int>(1000, 1));
  setThreadLimit(0);
  EXPECT_EQ(threadCount(), all);
}

TEST(ThreadLimit, DoesNotRaiseALimitOfTheHostProgram) {
  const tbb::global_control host(tbb::global_control::max_allowed_parallelism, 1);
  setThreadLimit(8);
  EXPECT_EQ(threadCount(), 1);
  setThreadLimit(0);
  EXPECT_EQ(threadCount(), 1);
}

TEST(ThreadLimit, CountsTheThreadsOfTheCallersArena) {
  tbb::task_arena arena(1);
  EXPECT_EQ(arena.execute([] { return threadCount(); }), 1);
}

}  // namespace
}  // namespace emscape
