/// Playing against the wall clock, without a window: field -> busy frame -> settled picture.
#pragma once

#include <functional>
#include <optional>
#include <set>

#include "apps/emscape/background.h"
#include "apps/emscape/frame_source.h"
#include "apps/emscape/painter.h"
#include "apps/emscape/playback_report.h"
#include "emscape/base/progress.h"
#include "emscape/render/frame_controller.h"

namespace emscape::app {

struct PlaybackOptions {
  double frames_per_s = 25;          ///< slots: at the start of each, what is new is shown
  double speed = 1;                  ///< scenario seconds in a second
  std::optional<double> duration_s;  ///< of the wall clock; none: until one step after the last
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
class Playback {
 public:
  /// @param painter  draws the source in this look; outlives this, as look and source
  /// @param display  empty: pictures get no labels and go nowhere
  /// @throws Error (usage) for an orbit rate with a camera that does not orbit
  Playback(const PlaybackOptions& options, const Look& look, FrameSource& source, Painter& painter,
           Display display);
  /// Stops what still runs.
  ~Playback();
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;

  /// @param done  called after each event of the report
  /// @throws Error, Interrupted
  PlaybackReport play(const std::function<void(const PlaybackEvent&)>& done);

 private:
  struct NewField {
    int step = 0;
    Frame frame;
    double ms = 0;
  };
  using Clock = std::chrono::steady_clock;

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

  void countSlots(long long slot, PlaybackEvent& event);
  double show();
  void passOn(double now_ms);
  void report(PlaybackEvent event);

  const PlaybackOptions options_;
  const Look& look_;
  FrameSource& source_;
  const Display display_;
  std::function<void(const PlaybackEvent&)> done_;
  render::FrameController controller_;
  Painter& painter_;
  PlaybackReport report_;

  Clock::time_point start_;
  Clock::duration stood_still_{};
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
  Bell bell_;
  Background<render::FrameReport> restoration_{bell_};
  Background<NewField> field_{bell_};
};

}  // namespace emscape::app
