/// Real-time playback without a window: field -> busy frame -> settled picture.
#pragma once

#include <functional>
#include <optional>
#include <set>

#include "base/event.h"
#include "base/worker.h"
#include "emscape/base/progress.h"
#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/pictures/painter.h"
#include "playback/pictures/clock.h"
#include "playback/pictures/real_time_report.h"
#include "render/patterns/frame_controller.h"

namespace emscape::playback {

struct RealTimeOptions {
  double frames_per_s = 25;          ///< slots per second; changes are shown at the start of a slot
  double speed = 1;                  ///< scenario seconds per second
  std::optional<double> duration_s;  ///< of the clock; none: until one step after the last
  double orbit_rate_deg_s = 0;       ///< of the camera, clockwise from above
  bool whole_fields = false;         ///< every column of each field is computed, also if that takes longer
  bool verify = false;  ///< compare each settled picture with a full cast, with the clock stopped
  bool keep_events =
      true;  ///< keep the events in the report; false avoids memory that grows with the playback
  render::ControllerOptions controller;
};

/// Receives each displayed picture, in order, with its number of slots.
using Display = std::function<void(const render::Image8& picture, int slots)>;

/// Plays a source. Every step of the source is an event, due at its time; a moving camera is an event in
/// every slot. A frame begins at the start of a slot, or as soon as the field is ready. The next field is
/// computed on a separate thread after the end of a busy frame; where that takes longer than the time to the
/// next step, columns are interpolated (FrameSource::setTimeGoal()), until the field rests or ends.
/// Restorations run on another thread, so that an event can stop them.
class RealTimeLoop {
 public:
  /// @param painter    draws the source in this view. Painter, view, source and clock must outlive this
  /// object
  /// @param display    empty: pictures are not labelled and not displayed
  /// @param clock      tests use a simulated clock
  /// @param interrupt  ends play() with Stopped; may be null, else outlives this
  /// @throws Error (usage) for an orbit rate with a camera that does not orbit
  RealTimeLoop(const RealTimeOptions& options, const ViewState& view, FrameSource& source, Painter& painter,
               Display display, Clock& clock, const StopFlag* interrupt = nullptr);
  /// Stops the work in progress.
  ~RealTimeLoop();
  RealTimeLoop(const RealTimeLoop&) = delete;
  RealTimeLoop& operator=(const RealTimeLoop&) = delete;

  /// @param done  called after each event of the report
  /// @throws Error, Stopped
  RealTimeReport play(const std::function<void(const RealTimeEvent&)>& done);

 private:
  struct NewField {
    int step = 0;
    Frame frame;
    double ms = 0;
  };
  // Time
  double now_ms() const;
  long long slotAt(double time_ms) const;
  double slotBegin_ms(long long slot) const;
  int stepDueAt(long long slot) const;
  bool isDue(long long slot) const;
  double end_ms() const;
  void waitUntil(double time_ms);

  void rehearse();
  render::FrameCost costOf(const render::FrameReport& frame, double other_ms) const;

  // Events
  double fieldGoal_ms() const;
  void beginField(int step, bool is_whole);
  void beginNextField();
  void takeField();
  void raiseEvents();
  void raise(render::SceneEvent event);

  // Requests of the controller
  void act(const render::ControllerAction& action);
  void drawFrame(const render::FramePlan& plan);
  void beginRestoration();
  void endRestoration();
  void settle();

  void countSlots(long long slot, RealTimeEvent& event);
  double show();
  void passOn(double now_ms);
  void report(RealTimeEvent event);

  const RealTimeOptions options_;
  const ViewState& view_;
  FrameSource& source_;
  const Display display_;
  Clock& clock_;
  const StopFlag* const interrupt_;
  std::function<void(const RealTimeEvent&)> done_;
  render::FrameController controller_;
  Painter& painter_;
  RealTimeReport report_;

  double start_ms_ = 0;  // of the clock
  double stood_still_ms_ = 0;
  double period_ms_;

  std::optional<NewField> computed_;  // until it is due
  std::optional<NewField> pending_;   // due, for the next frame
  int shown_step_ = 0;
  std::set<int> unchanged_steps_;
  double field_ms_ = 0;       // of the last update
  double drawing_ms_ = 0;     // of the last frame
  bool needs_whole_ = false;  // the newest field has interpolated columns and rests

  long long begun_slot_ = -1;       // of the last frame
  long long accounted_slot_ = -1;   // slots with changes are counted up to here
  long long view_slot_ = -1;        // whose camera the controller has
  std::optional<double> event_ms_;  // that stopped a restoration for the next frame
  render::FrameReport drawn_;
  std::optional<render::Pattern> reported_pattern_;  // whose reason was last reported
  bool settled_ = true;

  std::optional<render::Image8> displayed_;
  long long displayed_since_ = 0;  // slot; the first picture covers the time before it too

  StopFlag stop_{false};
  Event event_;
  AsyncTasks<render::FrameReport> restoration_{[this] { event_.finish(); }};
  AsyncTasks<NewField> field_{[this] { event_.finish(); }};
};

}  // namespace emscape::playback
