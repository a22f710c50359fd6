#include "playback/live/live_fields.h"

#include <condition_variable>

#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

using testing::Contains;
using testing::ElementsAre;

/// Made-up frames of dummy scenarios: an edit is another object.
class EditableFrames : public MadeFrames {
 public:
  using MadeFrames::MadeFrames;
  void setScenario(std::shared_ptr<const scenario::Scenario> scenario) override {
    if (scenario->name == "too large") throw Error(ErrorCode::device, "cudaMalloc: out of memory\nat x");
    if (scenario->name == "without ground") throw Error(ErrorCode::bad_input, "no ground\nat all");
    ++edits;
  }
  void setTimeGoal(double goal_ms) override { has_goal_ = goal_ms > 0; }
  Frame makeFrame(int index) override {
    Frame frame = MadeFrames::makeFrame(index);
    frame.column_step = is_slow && has_goal_ ? 2 : 1;
    return frame;
  }
  std::atomic<int> edits{0};
  std::atomic<bool> is_slow{false};  ///< with a time goal a part of the columns is computed

 private:
  bool has_goal_ = false;
};

std::shared_ptr<const scenario::Scenario> scenarioNamed(const std::string& name) {
  auto scenario = std::make_shared<scenario::Scenario>();
  scenario->name = name;
  return scenario;
}

/// A LiveFields over made-up frames, and its results.
class Fields {
 public:
  explicit Fields(int steps, const LiveFields::Options& options = defaults(),
                  std::function<void(int)> before = {}) {
    auto made = std::make_unique<EditableFrames>(seconds(steps), std::move(before));
    source = made.get();
    LiveFields::Events events;
    events.deliver = [this](FieldDelivery delivery, auto) {
      const std::lock_guard<std::mutex> lock(mutex_);
      delivered_.push_back(std::move(delivery));
    };
    events.changed = [this] {
      const std::lock_guard<std::mutex> lock(mutex_);
      changed_.notify_all();
    };
    request_.revision = 1;
    fields = std::make_unique<LiveFields>(
        [opened = std::make_shared<std::unique_ptr<EditableFrames>>(std::move(made))](const StopFlag&) {
          return std::move(*opened);
        },
        request_, options, events);
  }

  static LiveFields::Options defaults() {
    LiveFields::Options options;
    options.cache_bytes = std::size_t{1} << 30;
    return options;
  }

  void ask(const std::function<void(FieldRequest&)>& change) {
    change(request_);
    ++request_.revision;
    fields->request(request_);
  }
  void seek(int step) {
    ask([step](FieldRequest& request) { request.view.time_s = step; });
  }
  /// Waits until the last request is answered or has failed.
  void wait() {
    waitFor([this] { return lastRevision() == request_.revision; });
  }
  void waitFor(const std::function<bool()>& condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!condition()) changed_.wait_for(lock, std::chrono::milliseconds(10));
  }
  std::size_t deliveries() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return delivered_.size();
  }
  int columnStep() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return delivered_.back().frame.column_step;
  }
  double shown_s() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return delivered_.back().frame.volume.info().time_s;
  }
  /// Must be called with the lock.
  long long lastRevision() const {
    return std::max(delivered_.empty() ? 0 : delivered_.back().revision, fields->status().failed_revision);
  }

  EditableFrames* source;

 private:
  FieldRequest request_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<FieldDelivery> delivered_;

 public:
  std::unique_ptr<LiveFields> fields;  // destroyed first
};

TEST(LiveFields, TwoHundredSeeksInABurstComputeAtMostFortyFieldsAndTheLastIsShown) {
  LiveFields::Options options = Fields::defaults();
  options.min_seek_interval_ms = 60;
  Fields live(1000, options);
  live.wait();
  const auto begin = std::chrono::steady_clock::now();
  for (int n = 0; n < 200; ++n) {
    live.seek((n * 617) % 1000);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const double took_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  live.wait();
  EXPECT_EQ(live.shown_s(), (199 * 617) % 1000);
  EXPECT_LE(live.fields->status().fields_computed, took_ms / options.min_seek_interval_ms + 3);
}

TEST(LiveFields, AStepThatWasShownIsNotComputedAgain) {
  Fields live(10);
  for (const int step : {3, 7, 3, 7, 3}) {
    live.seek(step);
    live.wait();
    EXPECT_EQ(live.shown_s(), step);
  }
  EXPECT_THAT(live.source->asked(), testing::AnyOf(ElementsAre(0, 3, 7), ElementsAre(3, 7)));
  EXPECT_THAT(live.fields->status().cached_steps, Contains(7));
}

TEST(LiveFields, AnEditEmptiesTheCacheAndIsComputedAtOnce) {
  LiveFields::Options options = Fields::defaults();
  options.min_seek_interval_ms = 1e9;  // delays everything except edits forever
  Fields live(10, options);
  live.wait();
  live.ask([](FieldRequest& request) {
    request.view.time_s = 4;
    request.scenario = scenarioNamed("edited");
  });
  live.wait();
  EXPECT_EQ(live.source->edits, 1);
  EXPECT_THAT(live.source->asked(), ElementsAre(0, 4));
  EXPECT_THAT(live.fields->status().cached_steps, ElementsAre(4));
}

TEST(LiveFields, FailedEditIsReportedUntilAnotherOneSucceeds) {
  Fields live(10);
  live.wait();
  live.ask([](FieldRequest& request) { request.scenario = scenarioNamed("without ground"); });
  live.wait();
  EXPECT_EQ(live.fields->status().error, "no ground");
  EXPECT_EQ(live.fields->status().failed_revision, 2);
  live.ask([](FieldRequest& request) { request.scenario = scenarioNamed("with ground"); });
  live.wait();
  EXPECT_EQ(live.fields->status().error, "");
  EXPECT_THAT(live.source->asked(), ElementsAre(0, 0));
}

TEST(LiveFields, DeviceFailureNamesTheRemedy) {
  Fields live(10);
  live.wait();
  live.ask([](FieldRequest& request) { request.scenario = scenarioNamed("too large"); });
  live.wait();
  EXPECT_EQ(live.fields->status().error, "cudaMalloc: out of memory; --backend cpu computes without the GPU");
}

TEST(LiveFields, AStepThatFailsLeavesTheOthers) {
  Fields live(10, Fields::defaults(), [](int step) {
    if (step == 5) throw Error(ErrorCode::bad_input, "step 5 is damaged");
  });
  live.wait();
  live.seek(5);
  live.wait();
  EXPECT_EQ(live.fields->status().error, "step 5 is damaged");
  EXPECT_EQ(live.shown_s(), 0);
  live.seek(6);
  live.wait();
  EXPECT_EQ(live.shown_s(), 6);
}

TEST(LiveFields, RangeOfTheSeriesIsSearchedBesideRequests) {
  Fields live(48);
  live.wait();
  live.ask([](FieldRequest& request) { request.search = 7; });
  live.wait();
  live.waitFor([&] { return live.fields->status().series.search == 7; });
  EXPECT_EQ(live.fields->status().series.range, (ValueRange{0, 48}));
  EXPECT_EQ(live.source->asked().size(), 24U) << "every other step, each once";
  EXPECT_EQ(live.shown_s(), 0) << "what is shown stays";
}

TEST(LiveFields, StepsAskedForInOrderAreComputedAhead) {
  LiveFields::Options options = Fields::defaults();
  options.steps_ahead = 2;
  Fields live(10, options);
  live.wait();
  live.seek(1);
  live.waitFor([&] { return live.fields->status().cached_steps == std::vector<int>{0, 1, 2, 3}; });
  live.seek(7);
  live.wait();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_THAT(live.fields->status().cached_steps, ElementsAre(0, 1, 2, 3, 7)) << "a jump is no playing";
}

/// Work of 10 s, with checkpoints.
void workForLong() {
  for (int n = 0; n < 10000; ++n) {
    checkpoint();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(LiveFields, ASupersededFieldIsAbandonedAndNeverShown) {
  std::atomic<bool> is_slow{false}, has_begun{false};
  Fields live(10, Fields::defaults(), [&](int step) {
    if (step != 0 && is_slow) {
      has_begun = true;
      workForLong();
    }
  });
  live.wait();
  is_slow = true;
  live.ask([](FieldRequest& request) {
    request.scenario = scenarioNamed("slow");
    request.view.time_s = 5;
  });
  live.waitFor([&] { return has_begun.load(); });
  EXPECT_EQ(live.fields->status().progress.what, "made at 5 s");
  live.ask([](FieldRequest& request) {
    request.scenario = nullptr;
    request.view.time_s = 0;
  });
  live.wait();
  EXPECT_EQ(live.shown_s(), 0);
  EXPECT_EQ(live.deliveries(), 2U);
  EXPECT_EQ(live.fields->status().fields_abandoned, 1);
  EXPECT_EQ(live.fields->status().fields_computed, 1) << "the field before is still in memory";
  EXPECT_THAT(live.fields->status().cached_steps, ElementsAre(0)) << "so are its steps";
}

TEST(LiveFields, PlayingFinishesItsFieldsAndTheNewestTimeFollows) {
  Fields live(1000, Fields::defaults(),
              [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(20)); });
  live.wait();
  for (int n = 1; n <= 100; ++n) {
    live.ask([n](FieldRequest& request) {
      request.view.time_s = n;
      request.patience_ms = Patience::kEndless;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  live.wait();
  EXPECT_EQ(live.shown_s(), 100);
  EXPECT_EQ(live.fields->status().fields_abandoned, 0);
  EXPECT_GT(live.deliveries(), 3U);
}

TEST(LiveFields, AStreamOfSeeksShowsFieldsThatTakeLongerThanThePauses) {
  Fields live(1000, Fields::defaults(), [](int) {
    for (int n = 0; n < 100; ++n) {
      checkpoint();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  live.wait();
  for (int n = 1; n <= 100; ++n) {
    live.ask([n](FieldRequest& request) {
      request.view.time_s = n;
      request.patience_ms = Patience::kShort;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  live.wait();
  EXPECT_EQ(live.shown_s(), 100);
  EXPECT_GT(live.deliveries(), 3U) << "the picture follows";
}

TEST(LiveFields, AFieldWithAPartOfItsColumnsIsCompletedWhenItRests) {
  Fields live(10);
  live.wait();
  live.source->is_slow = true;
  const auto play = [&](int step) {
    live.ask([step](FieldRequest& request) {
      request.view.time_s = step;
      request.patience_ms = Patience::kEndless;
    });
    live.wait();
  };
  play(3);
  EXPECT_EQ(live.columnStep(), 2);
  EXPECT_THAT(live.fields->status().cached_steps, testing::Not(Contains(3))) << "only complete ones are kept";
  live.waitFor([&] { return live.fields->status().fields_computed == 3; });
  live.wait();
  EXPECT_EQ(live.columnStep(), 1);
  EXPECT_EQ(live.shown_s(), 3);
  EXPECT_THAT(live.source->asked(), ElementsAre(0, 3, 3));
  EXPECT_THAT(live.fields->status().cached_steps, Contains(3));
  play(4);
  live.ask([](FieldRequest& request) { request.patience_ms = Patience::kNone; });
  live.wait();
  EXPECT_EQ(live.columnStep(), 1) << "a single change has all columns at once";
}

TEST(LiveFields, ARequestAbandonsTheCompletionOfAField) {
  std::atomic<int> at_three{0};
  Fields live(10, Fields::defaults(), [&](int step) {
    if (step != 3 || ++at_three < 2) return;
    for (int n = 0; n < 20000; ++n) {
      checkpoint();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  live.wait();
  live.source->is_slow = true;
  for (const int step : {3, 4}) {
    live.ask([step](FieldRequest& request) {
      request.view.time_s = step;
      request.patience_ms = Patience::kEndless;
    });
    live.wait();
    EXPECT_EQ(live.shown_s(), step);
    while (step == 3 && at_three < 2) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  live.waitFor([&] { return live.fields->status().fields_computed == 4; });
  EXPECT_EQ(live.fields->status().fields_abandoned, 0) << "no requested field was";
}

TEST(LiveFields, CachedStepsStayWithinTheLimit) {
  LiveFields::Options options = Fields::defaults();
  options.cache_bytes = 3 * MadeFrames::kVoxels * sizeof(float);
  Fields live(10, options);
  for (int step = 0; step < 10; ++step) {
    live.seek(step);
    live.wait();
    EXPECT_LE(live.fields->status().cached_bytes, options.cache_bytes);
  }
  EXPECT_EQ(live.fields->status().cached_steps.size(), 3U);
}

TEST(LiveFields, ThreadSleepsWithoutWork) {
  Fields live(10);
  live.seek(4);
  live.wait();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const long long before = live.fields->status().wake_ups;
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(live.fields->status().wake_ups, before);
}

}  // namespace
}  // namespace emscape::playback::test
