#include "base/worker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <vector>

#include "base/event.h"

namespace emscape {
namespace {

TEST(Worker, JobsRunInOrderAndTheFirstFailureReachesTheCaller) {
  std::vector<int> done;
  {
    Worker worker(2);
    for (int i = 0; i < 20; ++i) worker.push([&done, i] { done.push_back(i); });
    worker.finish();
    EXPECT_EQ(done.size(), 20U);
    EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
    worker.push([] { throw std::runtime_error("full"); });
    EXPECT_THROW(worker.finish(), std::runtime_error);
    EXPECT_THROW(worker.push([] {}), std::runtime_error);
  }
  EXPECT_EQ(done.size(), 20U);
}

TEST(Worker, DestructorFinishesTheRunningJobAndDropsWaitingOnes) {
  Event begun, dropped;
  std::atomic<int> done{0};
  {
    Worker worker;
    worker.push([&] {
      begun.set();
      dropped.wait();
      ++done;
    });
    std::shared_ptr<void> waiting(nullptr, [&](void*) { dropped.set(); });
    worker.push([&done, waiting = std::move(waiting)] { ++done; });
    begun.wait();
  }
  EXPECT_EQ(done, 1);
}

TEST(Worker, JobsShareOneThread) {
  Worker worker;
  std::vector<std::thread::id> threads;
  for (int i = 0; i < 3; ++i) {
    worker.push([&] { threads.push_back(std::this_thread::get_id()); });
    worker.finish();
  }
  EXPECT_EQ(std::count(threads.begin(), threads.end(), threads.front()), 3);
  EXPECT_NE(threads.front(), std::this_thread::get_id());
}

TEST(AsyncTasks, WakeIsCalledAndTheResultTakenOnce) {
  Event event;
  AsyncTasks<int> task([&] { event.set(); });
  EXPECT_FALSE(task.active());
  task.start([] { return 7; });
  EXPECT_TRUE(task.active());
  event.wait();
  EXPECT_TRUE(task.done());
  EXPECT_EQ(task.take(), 7);
  EXPECT_FALSE(task.active());
  EXPECT_FALSE(task.done());
}

TEST(AsyncTasks, ResultsAreTakenInTheOrderOfTheStarts) {
  AsyncTasks<int> tasks;
  for (int i = 0; i < 5; ++i) tasks.start([i] { return i; });
  for (int i = 0; i < 5; ++i) EXPECT_EQ(tasks.take(), i);
}

TEST(AsyncTasks, ExceptionReachesTheOwnerAndTheNextTaskRuns) {
  AsyncTasks<int> task;
  task.start([]() -> int { throw std::runtime_error("broken"); });
  EXPECT_THROW(task.take(), std::runtime_error);
  task.start([] { return 1; });
  EXPECT_EQ(task.take(), 1);
}

TEST(AsyncTasks, DestructorWaitsForAllTasks) {
  std::atomic<int> done{0};
  {
    AsyncTasks<int> tasks;
    for (int i = 0; i < 5; ++i) tasks.start([&] { return ++done; });
  }
  EXPECT_EQ(done, 5);
}

}  // namespace
}  // namespace emscape
