/// The thread of a live view that opens the input and computes fields. Internal to the module.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/thread_arena.h"
#include "base/worker.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/view/view_state.h"
#include "playback/frames/range_search.h"
#include "playback/frames/step_cache.h"
#include "playback/live/mailbox.h"
#include "playback/live/patience.h"

namespace emscape::playback {

/// A request for the field: of the view the quantity, the time, and whether it compares.
struct FieldRequest {
  long long revision = 0;  ///< counts requests
  ViewState view;
  std::shared_ptr<const scenario::Scenario> scenario;  ///< null: as it was opened
  bool has_field = true;                               ///< false: the ground and the emitters alone
  PosesPtr poses = {};                                 ///< of a live source; null: those of the scenario
  long long search = 0;                  ///< number of the requested search of the series' range; 0: none
  double patience_ms = Patience::kNone;  ///< with the field in progress
};

/// A field and its data.
struct FieldDelivery {
  long long revision = 0;  ///< of its request; 0: shown until the requested field is ready
  std::string title;
  std::optional<LoadedScenario> scene;
  std::string quantity;
  Frame frame;
};

/// The range of the values of a series.
struct SeriesRange {
  long long search = 0;  ///< of the request
  ValueRange range;      ///< empty: not found
};

struct FieldsStatus {
  std::vector<double> times_s;                               ///< of the source; empty before it is open
  bool is_continuous = false;                                ///< VolumeSeries::isContinuous()
  double first_s = 0;                                        ///< time of requests without one
  std::shared_ptr<const scenario::Scenario> scenario;        ///< as it was opened; may be null
  std::vector<std::string> quantities;                       ///< of the input's files
  std::shared_ptr<const std::vector<std::string>> warnings;  ///< of the last field; may be null
  std::vector<int> cached_steps;
  std::size_t cached_bytes = 0;
  double field_ms = 0;  ///< of the last field
  long long fields_computed = 0;
  long long fields_abandoned = 0;
  double abandon_ms = 0;  ///< longest time from the end of a request's patience to the end of the field
  WorkProgress progress;  ///< of the field in progress; of the opening before the first
  long long failed_revision = 0;  ///< the last request that failed
  std::string error;              ///< reason; empty after another request has succeeded
  ErrorCode error_code = ErrorCode::other;
  SeriesRange series;  ///< of the last completed search
  long long wake_ups = 0;
};

/// Serves the latest request; a new one replaces a pending one, and the field in progress is abandoned
/// (Patience). Fields of requests that have patience may have a part of their columns (BusyField). After a
/// moment without requests such a field is completed; then the next steps of a playing series are computed,
/// and its range is searched.
class LiveFields {
 public:
  struct Options {
    std::size_t cache_bytes = 0;  ///< of the steps and of the source's own cache
    double min_seek_interval_ms = 0;
    double min_play_interval_ms = 0;  ///< the same for requests with endless patience
    int steps_ahead = 0;
    bool begins_without_field = false;  ///< delivers FrameSource::withoutField() before the first field
    int threads = 0;                    ///< 0: one fewer than all while other threads need them
    int niceness = 0;
  };
  /// Called on the thread of this object. `deliver` and `changed` are required.
  struct Events {
    std::function<void(FieldDelivery, Mailbox<FieldRequest>::Time asked)> deliver;
    std::function<void()> changed;    ///< of the status
    std::function<bool()> is_shared;  ///< true if others need the processor now; empty: never
  };
  using Open = std::function<std::unique_ptr<FrameSource>(const StopFlag& stop)>;

  /// @param open   makes the source, on the thread of this object; frames of it must be independent; null: no
  /// fields, and no request is served
  /// @param first  the first request
  LiveFields(Open open, FieldRequest first, const Options& options, Events events);
  /// Calls close().
  ~LiveFields();
  LiveFields(const LiveFields&) = delete;
  LiveFields& operator=(const LiveFields&) = delete;

  /// Any thread calls these.
  void request(FieldRequest request);
  /// Stops the work in progress at its next checkpoint.
  void stop();
  /// stop(), and waits for the end.
  void close();
  FieldsStatus status() const;
  /// True for a moment after a request without patience, until its field is delivered: other work that can
  /// wait leaves the processor to it.
  bool isHurried() const;

 private:
  using Time = Mailbox<FieldRequest>::Time;

  /// What the source shows, apart from the time.
  struct Shown {
    std::shared_ptr<const scenario::Scenario> scenario;
    PosesPtr poses;
    std::string quantity;
    Comparison comparison = Comparison::none;

    bool operator==(const Shown& other) const {
      return scenario == other.scenario && poses == other.poses && quantity == other.quantity &&
             comparison == other.comparison;
    }
  };
  /// The same with what the source has for it.
  struct Content {
    Shown shown;
    std::string title;
    std::optional<LoadedScenario> scene;
    std::vector<double> times_s;
    bool is_continuous = false;

    /// The time of the field for a requested time.
    double timeOf(double asked_s) const;
    /// The step at a time; -1: none.
    int stepAt(double time_s) const;
  };
  using ContentPtr = std::shared_ptr<const Content>;

  void run();
  void open();
  void accept();
  void serve();
  bool serveFromMemory(const Shown& wanted);
  double askedTime_s() const;
  Shown shownOf(const FieldRequest& request) const;
  void change(const Shown& wanted);
  void noteContent();
  /// @param is_busy  a part of the columns may be interpolated (BusyField)
  Frame compute(double time_s, bool is_busy);
  void completeField();
  void begin(const std::string& what);
  void applyPatience();
  void deliver(const ContentPtr& content, const Frame& frame);
  bool deliverWithoutField(long long revision);
  void fail(const std::string& line, ErrorCode code);
  void beginSearch();
  void endSearch(const ValueRange& range);
  /// @return the step to compute without a request; none: nothing to do
  std::optional<int> idleStep() const;
  void doIdleWork(int index);
  void waitUntil(Time time);
  void wait();
  StepCache<Frame>::Distance distance() const;

  const Open open_;
  const Options options_;
  const Events events_;
  Event event_;
  Mailbox<FieldRequest> box_{event_};
  StopFlag stop_{false};
  Work work_{&stop_};

  std::atomic<Time::rep> hurried_until_{0};
  std::mutex patience_mutex_;                        // of the next five
  double pending_patience_ms_ = Patience::kEndless;  // smallest of the requests in the box
  std::optional<Time> begun_;                        // a field that may be abandoned is being computed
  std::optional<Time> stop_at_;                      // of that field
  bool is_patient_ = false;                          // the field before was abandoned
  bool yields_ = false;                              // any request abandons that field

  // Of the thread
  std::unique_ptr<FrameSource> source_;
  ThreadArena arena_;         // of Options::threads; 0: all
  ThreadArena narrow_arena_;  // leaves a core to others
  FieldRequest wanted_;
  Time asked_;  // when
  bool is_due_ = false;
  std::shared_ptr<const scenario::Scenario> opened_scenario_;
  ContentPtr content_;  // of the source
  ContentPtr cached_;   // of the cache: that of the last computed step
  StepCache<Frame> cache_;
  ContentPtr last_;  // of the last delivered field
  Frame last_frame_;
  bool is_incomplete_ = false;       // columns of that field are to be completed
  int index_ = 0;                    // of the step nearest to the last request
  bool is_playing_ = false;          // steps are requested one after another
  std::optional<Time> field_begin_;  // of the last field
  Time quiet_from_{};
  double first_s_ = 0;    // as FieldsStatus
  long long search_ = 0;  // number of the last search begun
  RangeSearch range_search_;

  mutable std::mutex mutex_;
  FieldsStatus status_;

  Worker worker_;
};

}  // namespace emscape::playback
