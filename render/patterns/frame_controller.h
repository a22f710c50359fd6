/// The states busy, restore and idle: when pixels are interpolated, and when the picture is made exact.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "emscape/base/enum_names.h"
#include "emscape/render/scene/renderer.h"
#include "render/patterns/pattern_choice.h"
#include "render/patterns/running_median.h"

namespace emscape::render {

using emscape::toString;

/// Causes of a change of the picture.
enum class SceneEvent { transfer_function, view, field, resized, mode };

enum class ControllerState {
  busy,     ///< the scene changes; frames are interpolated
  restore,  ///< the scene has stopped changing; the missing pixels are being cast
  idle      ///< the picture is exact; nothing is drawn
};
constexpr auto namesOf(ControllerState) {
  return std::array{"BUSY", "RESTORE", "IDLE"};
}

struct ControllerOptions {
  std::optional<Pattern> pattern;  ///< of busy frames; none: chosen to meet the budget (PatternChoice)
  Interpolation interpolation = Interpolation::float32;
  double budget_ms = 40;  ///< time between two busy pictures, > 0
  double epsilon_floor_ms = 50;
  std::optional<double> epsilon_ms;  ///< none: measured, see FrameController::epsilon_ms()
  bool smooths_edges = false;        ///< a restoration also smooths edges: full frames have one, too
};

/// The next task of the caller.
struct ControllerAction {
  enum class Kind {
    draw,          ///< draw a frame by `plan` and show it; then frameDone()
    restore,       ///< begin to restore the last drawn frame; then restoreDone()
    stop_restore,  ///< stop the restoration as soon as possible; then restoreDone()
    wait           ///< nothing, until an event, the end of the present task, or `until_ms`
  };
  Kind kind = Kind::wait;
  FramePlan plan;
  double until_ms = 0;  ///< may be infinity
};

/// The state machine of the paper's Fig. 4 (Feng et al. 2016), without drawing: the caller reports events
/// with their time (milliseconds of any monotonic clock), asks for the next action, and executes it.
///
///     BUSY     draws while events arrive; no event for epsilon -> RESTORE
///     RESTORE  casts the missing pixels -> IDLE; any event -> stop it, BUSY from the start
///     IDLE     any event -> BUSY
///
/// It starts in IDLE with no picture. A frame that was cast in full needs no restoration: BUSY -> IDLE after
/// epsilon, unless its edges are to be smoothed. A picture may be shown after frameDone(), or if
/// restoreDone() returns true. For one thread.
class FrameController {
 public:
  static constexpr int kWarmUpFrames =
      1;  ///< frames that are not measured, at the start and after a resize or mode change

  explicit FrameController(const ControllerOptions& options = {});

  /// Reports a change of the scene.
  void event(SceneEvent event, double now_ms);
  /// Changes the options, for example the pattern. Counts as an event of kind `mode`.
  void setOptions(const ControllerOptions& options, double now_ms);

  /// The next action. An action `draw` or `restore` is returned once and counts as begun.
  ControllerAction next(double now_ms);

  /// Reports that the frame is drawn. It shows the scene at the time when it was begun.
  void frameDone(const FrameCost& cost);
  /// Reports the end of the restoration. @param complete false: it was stopped
  /// @return true if the picture may be shown: it is complete and the scene has not changed
  bool restoreDone(bool complete);

  ControllerState state() const { return state_; }
  /// The plan of the next busy frame.
  FramePlan plan() const;
  /// Reason for the pattern, as a sentence without its full stop.
  const std::string& reason() const { return choice_.reason(); }
  /// Time without events (ms) after which a restoration begins: ControllerOptions::epsilon_ms if given; else
  /// the median time of the last frames of this pattern, times 1.5 if at least three of four pixels are
  /// interpolated, but not below a minimum; the minimum before the first measurement.
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
