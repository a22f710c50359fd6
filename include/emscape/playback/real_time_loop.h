/// Playing against a clock, without a window: field -> busy frame -> settled picture.
#pragma once

#include <functional>
#include <optional>
#include <set>

#include "emscape/base/progress.h"
#include "emscape/playback/async_task.h"
#include "emscape/playback/clock.h"
#include "emscape/playback/frame_source.h"
#include "emscape/playback/painter.h"
#include "emscape/playback/real_time_report.h"
#include "emscape/render/frame_controller.h"

namespace emscape::playback {

struct RealTimeOptions {
  double frames_per_s = 25;          ///< slots: at the start of each, what is new is shown
  double speed = 1;                  ///< scenario seconds in a second
  std::optional<double> duration_s;  ///< of the clock; none: until one step after the last
  double orbit_rate_deg_s = 0;       ///< the camera goes round, clockwise from above
  bool verify = false;  ///< compare each settled picture with a full cast; the clock stands still meanwhile
  render::ControllerOptions controller;
};

/// Takes each picture that was on display, in order, once it is known for how many slots.
using Display = std::function<void(const render::Image8& picture, int slots)>;

/// Plays a source. Every step of the source is an event, due when its time has come; a moving camera is one
/// in every slot. A frame is begun at the start of a slot, or later in it as soon as the field is there. The
/// next field is computed on a thread of its own from the end of one busy frame on; restorations run on
/// another, so that an event can stop them.
class RealTimeLoop {
 public:
  /// @param painter    draws the source in this style; outlives this, as style, source and clock
  /// @param display    empty: pictures get no labels and go nowhere
  /// @param clock      tests give one of their own
  /// @param interrupt  ends play() with Stopped; may be null, else outlives this
  /// @throws Error (usage) for an orbit rate with a camera that does not orbit
  RealTimeLoop(const RealTimeOptions& options, const PictureStyle& style, FrameSource& source,
               Painter& painter, Display display, Clock& clock, const StopFlag* interrupt = nullptr);
  /// Stops what still runs.
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
  void beginField(int step);
  void beginNextField();
  void takeField();
  void raiseEvents();
  void raise(render::SceneEvent event);

  // What the controller asks for
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
  const PictureStyle& style_;
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

  std::optional<NewField> computed_;  // waits until it is due
  std::optional<NewField> pending_;   // is due, will be seen in the next frame
  int shown_step_ = 0;
  std::set<int> unchanged_steps_;
  double field_ms_ = 0;  // of the last update

  long long begun_slot_ = -1;       // in which the last frame was begun
  long long accounted_slot_ = -1;   // up to here, slots with something new are counted
  long long view_slot_ = -1;        // whose camera was told to the controller
  std::optional<double> event_ms_;  // that stopped a restoration for the next frame
  render::FrameReport drawn_;
  std::optional<render::Pattern> told_pattern_;  // whose reason was reported last
  bool settled_ = true;

  std::optional<render::Image8> displayed_;
  long long displayed_since_ = 0;  // slot; the first picture stands for the time before it too

  StopFlag stop_{false};
  Event event_;
  AsyncTask<render::FrameReport> restoration_{event_};
  AsyncTask<NewField> field_{event_};
};

}  // namespace emscape::playback
