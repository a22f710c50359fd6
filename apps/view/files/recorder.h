/// Records a view over a range of times, as pictures or a video, in the background.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/files/own_file.h"
#include "base/worker.h"
#include "emscape/playback/frames/compute_target.h"
#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/pictures/painter.h"

namespace emscape::view {

/// Limits of the pictures per second of a video.
inline constexpr double kMinFramesPerSecond = 0.1, kMaxFramesPerSecond = 240;

/// Times to record; all fields empty: every step of the series.
struct RecordRange {
  std::optional<double> begin_s, end_s;
  std::optional<double> step_s;           ///< empty: that of the series
  double frames_per_s = 10;               ///< of a video
  std::optional<render::ImageSize> size;  ///< of the pictures; none: that of the view
};

/// Size, length and cost of a recording.
struct RecordEstimate {
  int pictures = 0;
  double film_s = 0;  ///< length of a video
  double speed = 0;   ///< seconds of the scenario in one second of the video
  double work_s = 0;  ///< time that recording takes; 0: not known
  double bytes = 0;   ///< of the output, roughly
};
/// @param step_s      between two pictures
/// @param picture_ms  to compute and cast a picture of the size; 0: not known
RecordEstimate estimateOf(const RecordRange& range, double begin_s, double end_s, double step_s,
                          render::ImageSize size, double picture_ms, bool is_video);

/// The usual time of a field: the median of the last ones, of which the first after the opening is none.
/// @return 0: not known
class FieldTimes {
 public:
  /// @param fields  computed so far
  void add(long long fields, double field_ms);
  double usual_ms() const;

 private:
  long long fields_ = 0;
  std::deque<double> last_ms_;
};

/// The view to draw, and the output.
struct RecordJob {
  playback::ViewState view;
  std::shared_ptr<const scenario::Scenario> opened;  ///< as FrameSelection::opened
  std::string times;                                 ///< as FrameSelection::times
  playback::ComputeTarget target;
  double frames_per_s = 10;
  std::string output;  ///< NAME.mp4, NAME.png (one time) or a folder
  Replaces replaces = Replaces::own;
};

/// Makes one recording at a time, on its own thread and from its own source, as `emscape render` does. For
/// use by the window's thread.
class Recorder {
 public:
  Recorder() = default;
  /// Cancels the recording.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// @param wake  called from the thread of the recording after each picture and at its end
  /// @throws Error (usage) if a recording is running
  void start(const RecordJob& job, std::function<void()> wake);
  /// Returns at once; the recording ends after the current picture at the latest.
  void cancel() { stop_ = true; }
  bool running() const { return task_.active(); }

  struct Progress {
    std::string output;
    int pictures = 0;
    int total = 0;      ///< 0: not known yet
    double left_s = 0;  ///< until the end, by the pictures after the first one; 0: not known yet
  };
  Progress progress() const;

  /// Result of a recording.
  struct Outcome {
    std::string text;
    bool is_error = false;
    bool is_complete = true;  ///< false: it was cancelled
  };
  /// The result of an ended recording; returned once.
  std::optional<Outcome> takeOutcome();

 private:
  struct Counter {
    std::atomic<int> pictures{0}, total{0};
    std::atomic<double> left_s{0};
  };

  StopFlag stop_{false};
  std::shared_ptr<Counter> counter_ = std::make_shared<Counter>();
  std::string output_;
  AsyncTasks<Outcome> task_;
};

}  // namespace emscape::view
