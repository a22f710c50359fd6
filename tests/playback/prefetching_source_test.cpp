#include "playback/frames/prefetching_source.h"

#include <stdexcept>

#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

using testing::ElementsAre;

/// Blocks frame() until it is released.
class Gate {
 public:
  void pass(int /*index*/) {
    std::unique_lock<std::mutex> lock(mutex_);
    ++arrived_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return open_; });
  }
  /// Waits until a number of frames have been started.
  void waitForArrivals(int count) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return arrived_ >= count; });
  }
  void open() {
    std::lock_guard<std::mutex> lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int arrived_ = 0;
  bool open_ = false;
};

constexpr std::size_t kFrameBytes = MadeFrames::kVoxels * 4;

PrefetchOptions optionsOf(int steps_ahead, int frames) {
  PrefetchOptions options;
  options.steps_ahead = steps_ahead;
  options.cache_bytes = kFrameBytes * static_cast<std::size_t>(frames);
  return options;
}

/// Waits until prefetching is finished.
void waitUntilCached(const PrefetchingSource& frames, const std::vector<int>& indices) {
  while (frames.cached() != indices) std::this_thread::yield();
}

TEST(PrefetchingSource, OfManyRequestsTheOneBegunAndTheLastAreComputed) {
  Gate gate;
  MadeFrames source(seconds(300), [&](int index) { gate.pass(index); });
  ManualClock clock;
  PrefetchingSource frames(source, optionsOf(0, 10), clock);
  frames.request(0);
  gate.waitForArrivals(1);
  for (int index = 1; index <= 200; ++index) frames.request(index);
  EXPECT_EQ(frames.requested(), 200);
  EXPECT_FALSE(frames.latest());
  gate.open();
  EXPECT_EQ(frames.wait(200).volume.info().time_s, 200);
  EXPECT_THAT(source.asked(), ElementsAre(0, 200));
  EXPECT_EQ(frames.latest()->index, 200);
}

TEST(PrefetchingSource, TwoHundredSeeksInTwoSecondsComputeAtMostFortyFrames) {
  // Frames cost no time here, so that only the interval between seeks bounds their number.
  MadeFrames source(seconds(1000));
  SystemClock clock;
  PrefetchOptions options = optionsOf(0, 1000);
  PrefetchingSource frames(source, options, clock);
  const double begin_ms = clock.now_ms();
  Event never;
  for (int seek = 0; seek < 200; ++seek) {
    frames.request((seek * 617) % 1000);
    clock.waitUntil(begin_ms + seek, never);
  }
  const double took_ms = clock.now_ms() - begin_ms;
  EXPECT_EQ(frames.wait((199 * 617) % 1000).volume.info().time_s, (199 * 617) % 1000);
  EXPECT_LE(frames.computed(), took_ms / options.min_seek_interval_ms + 3);
}

TEST(PrefetchingSource, StepsInOrderAreNotHeldBack) {
  MadeFrames source(seconds(30));
  ManualClock clock;  // time does not advance: a seek would wait forever
  PrefetchOptions options = optionsOf(0, 30);
  PrefetchingSource frames(source, options, clock);
  for (int index = 0; index < 30; ++index) EXPECT_EQ(frames.wait(index).volume.info().time_s, index);
  EXPECT_EQ(clock.now_ms(), 0);
}

TEST(PrefetchingSource, FramesAfterTheRequestedOneAreComputedAhead) {
  MadeFrames source(seconds(6));
  ManualClock clock;
  std::atomic<int> told{0};
  PrefetchingSource frames(source, optionsOf(3, 10), clock, [&](int) { ++told; });
  frames.request(1);
  waitUntilCached(frames, {1, 2, 3, 4});
  EXPECT_EQ(frames.latest()->index, 1);
  frames.request(4);
  waitUntilCached(frames, {1, 2, 3, 4, 5});
  EXPECT_EQ(frames.latest()->index, 4) << "a frame that is there is shown at once";
  EXPECT_THAT(source.asked(), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(frames.computed(), 5);
}

TEST(PrefetchingSource, TheCacheKeepsWhatIsNearestAheadWithinItsBytes) {
  MadeFrames source(seconds(20));
  ManualClock clock;
  PrefetchingSource frames(source, optionsOf(2, 4), clock);
  frames.wait(0);
  waitUntilCached(frames, {0, 1, 2});
  frames.wait(10);
  waitUntilCached(frames, {2, 10, 11, 12});
  frames.wait(11);
  waitUntilCached(frames, {10, 11, 12, 13});
  frames.wait(12);
  waitUntilCached(frames, {11, 12, 13, 14});
}

TEST(PrefetchingSource, OneFrameIsKeptThoughItIsLargerThanTheCache) {
  MadeFrames source(seconds(5));
  ManualClock clock;
  PrefetchOptions options = optionsOf(2, 0);
  PrefetchingSource frames(source, options, clock);
  EXPECT_EQ(frames.wait(3).volume.info().time_s, 3);
  EXPECT_THAT(frames.cached(), ElementsAre(3));
  EXPECT_EQ(frames.wait(1).volume.info().time_s, 1);
  EXPECT_THAT(frames.cached(), ElementsAre(1));
}

TEST(PrefetchingSource, WhatIsShownIsTheLastThatWasThereUntilTheRequestedOneIs) {
  Gate gate;
  std::atomic<bool> gated{false};
  MadeFrames source(seconds(50), [&](int index) {
    if (gated) gate.pass(index);
  });
  ManualClock clock;
  PrefetchingSource frames(source, optionsOf(0, 10), clock);
  frames.wait(7);
  gated = true;
  EXPECT_EQ(frames.requestTime(30.4), 30);
  gate.waitForArrivals(1);
  EXPECT_EQ(frames.requested(), 30);
  EXPECT_EQ(frames.latest()->index, 7);
  gate.open();
  EXPECT_EQ(frames.wait(30).volume.info().time_s, 30);
}

TEST(PrefetchingSource, AFailureIsToldOnceAndOtherFramesCanBeHad) {
  MadeFrames source(seconds(5), [](int index) {
    if (index == 2) throw Error(ErrorCode::bad_input, "step 2 is damaged");
  });
  ManualClock clock;
  PrefetchingSource frames(source, optionsOf(0, 10), clock);
  EXPECT_EQ(errorOf([&] { frames.wait(2); }), "step 2 is damaged");
  EXPECT_EQ(frames.requested(), -1);
  EXPECT_EQ(frames.wait(3).volume.info().time_s, 3);
}

}  // namespace
}  // namespace emscape::playback::test
