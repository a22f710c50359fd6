/// Busy, restore, idle: when the picture is interpolated and when it is made exact.
#pragma once

#include <optional>
#include <string>

#include "emscape/render/pattern_choice.h"
#include "emscape/render/renderer.h"
#include "emscape/render/running_median.h"

namespace emscape::render {

/// What changes a picture.
enum class SceneEvent { transfer_function, view, field, resized, mode };

enum class ControllerState {
  busy,     ///< the scene changes: frames are interpolated
  restore,  ///< it stopped changing: the pixels that are missing are being cast
  idle      ///< the picture is exact, nothing is drawn
};
/// "BUSY", "RESTORE", "IDLE".
const char* toString(ControllerState state);

struct ControllerOptions {
  std::optional<Pattern> pattern;  ///< of busy frames; none: that which meets the budget (PatternChoice)
  Interpolation interpolation = Interpolation::float32;
  double budget_ms = 40;  ///< between two busy pictures, > 0
  double epsilon_floor_ms = 50;
  std::optional<double> epsilon_ms;  ///< none: measured, see FrameController::epsilon_ms()
};

/// What the caller is to do now.
struct ControllerAction {
  enum class Kind {
    draw,          ///< draw a frame by `plan` and show it; then frameDone()
    restore,       ///< begin to restore the frame drawn last; then restoreDone()
    stop_restore,  ///< stop the restoration as fast as it goes; then restoreDone()
    wait           ///< nothing, until an event, the end of what is being done, or `until_ms`
  };
  Kind kind = Kind::wait;
  FramePlan plan;
  double until_ms = 0;  ///< may be infinity
};

/// The state machine of the paper's Fig. 4 (Feng et al. 2016), as pure logic: the caller reports what
/// happened and when (milliseconds of any clock that does not go back), asks what to do, and does it.
///
///     BUSY     draws as long as events come; no event for epsilon -> RESTORE
///     RESTORE  casts what is missing -> IDLE; any event -> stop it, BUSY from the start
///     IDLE     any event -> BUSY
///
/// It starts in IDLE with no picture. A frame that was cast in full leaves nothing to restore: BUSY -> IDLE
/// after epsilon. A picture may be shown when frameDone() was told of it, or restoreDone() said so. One
/// thread calls it.
class FrameController {
 public:
  static constexpr int kWarmUpFrames = 1;  ///< not measured, at the start and after a resize or mode change

  explicit FrameController(const ControllerOptions& options = {});

  /// The scene changed.
  void event(SceneEvent event, double now_ms);
  /// Other options, the pattern for example: an event of kind `mode`.
  void setOptions(const ControllerOptions& options, double now_ms);

  /// What to do. An action `draw` or `restore` is given once and counts as begun.
  ControllerAction next(double now_ms);

  /// The frame that was begun is drawn and shows the scene as it was when it was begun.
  void frameDone(const FrameCost& cost);
  /// The restoration that was begun has ended. @param complete  false: it was stopped
  /// @return whether the picture is to be shown: it is complete and the scene has not changed
  bool restoreDone(bool complete);

  ControllerState state() const { return state_; }
  /// How the next busy frame is drawn.
  FramePlan plan() const;
  /// Why with this pattern, as a sentence without its full stop.
  const std::string& reason() const { return choice_.reason(); }
  /// How long nothing must happen before a restoration begins (ms): what was ordered, or the median time of
  /// the last frames of this pattern, 1.5 times that where three of four pixels or more are interpolated, and
  /// at least the floor; the floor as long as nothing is measured.
  double epsilon_ms() const;

 private:
  enum class Doing { nothing, frame, restoration };

  void end(Doing doing);
  void forgetTimes();

  ControllerOptions options_;
  PatternChoice choice_;
  RunningMedian draw_ms_{9};
  int warm_up_left_ = kWarmUpFrames;
  ControllerState state_ = ControllerState::idle;
  Doing doing_ = Doing::nothing;
  bool changed_ = false;           // since the last frame was begun
  Pattern drawn_ = Pattern::full;  // of the last frame
  double last_event_ms_ = 0;
};

}  // namespace emscape::render
