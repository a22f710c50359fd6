#include "apps/view/parts/background_jobs.h"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>
#include <thread>
#include <vector>

namespace emscape::view {
namespace {

TEST(BackgroundJobs, RunInOrderAndFinishOnTheThreadOfTheOwner) {
  std::promise<void> woken;
  int wakes = 0;
  BackgroundJobs jobs([&] {
    if (++wakes == 3) woken.set_value();
  });
  EXPECT_FALSE(jobs.busy());
  std::vector<int> finished;
  const std::thread::id owner = std::this_thread::get_id();
  for (int n = 0; n < 3; ++n) {
    jobs.run([&, n]() -> BackgroundJobs::Finish {
      EXPECT_NE(std::this_thread::get_id(), owner);
      return [&finished, n] { finished.push_back(n); };
    });
  }
  woken.get_future().wait();
  EXPECT_TRUE(jobs.busy());
  while (jobs.finish()) {
  }
  EXPECT_EQ(finished, (std::vector<int>{0, 1, 2}));
  EXPECT_FALSE(jobs.busy());
}

TEST(BackgroundJobs, DestructorWaitsForAllJobs) {
  int done = 0;
  {
    BackgroundJobs jobs([] {});
    for (int n = 0; n < 5; ++n) {
      jobs.run([&]() -> BackgroundJobs::Finish {
        ++done;
        return {};
      });
    }
  }
  EXPECT_EQ(done, 5);
}

TEST(BackgroundJobs, ExceptionOfAJobReachesTheOwner) {
  std::promise<void> woken;
  BackgroundJobs jobs([&] { woken.set_value(); });
  jobs.run([]() -> BackgroundJobs::Finish { throw std::runtime_error("no"); });
  woken.get_future().wait();
  EXPECT_THROW(jobs.finish(), std::runtime_error);
  EXPECT_FALSE(jobs.busy());
}

}  // namespace
}  // namespace emscape::view
