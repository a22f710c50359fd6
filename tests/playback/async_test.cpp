#include <stdexcept>

#include "emscape/playback/live/async_task.h"
#include "playback/series/background_writer.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

TEST(AsyncTask, ItsEventIsSetAtTheEndAndTheResultTakenOnce) {
  Event event;
  AsyncTask<int> task(event);
  EXPECT_FALSE(task.active());
  task.start([] { return 7; });
  EXPECT_TRUE(task.active());
  event.wait();
  EXPECT_TRUE(task.done());
  EXPECT_FALSE(event.hasWork());
  EXPECT_EQ(task.take(), 7);
  EXPECT_FALSE(task.active());
}

TEST(AsyncTask, ExceptionOfTheWorkReachesTheOwner) {
  Event event;
  AsyncTask<int> task(event);
  task.start([]() -> int { throw std::runtime_error("broken"); });
  EXPECT_THROW(task.take(), std::runtime_error);
  task.start([] { return 1; });
  EXPECT_EQ(task.take(), 1);
}

TEST(BackgroundWriter, RunsJobsInOrderAndReportsFirstFailure) {
  std::vector<int> done;
  {
    BackgroundWriter writer(2);
    for (int i = 0; i < 20; ++i) writer.push([&done, i] { done.push_back(i); });
    writer.finish();
    EXPECT_EQ(done.size(), 20U);
    EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
    writer.push([] { throw std::runtime_error("full"); });
    EXPECT_THROW(writer.finish(), std::runtime_error);
    EXPECT_THROW(writer.push([] {}), std::runtime_error);
  }
  EXPECT_EQ(done.size(), 20U);
}

}  // namespace
}  // namespace emscape::playback::test
