/// Report of a real-time loop, frame by frame.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/render/frame_controller.h"

namespace emscape::playback {

/// A busy frame, a restoration, or that the picture settled.
struct RealTimeEvent {
  double time_ms = 0;     ///< of the playback, at its end
  double scenario_s = 0;  ///< what it shows
  render::ControllerState state = render::ControllerState::busy;
  render::Pattern pattern = render::Pattern::full;  ///< of the busy frame
  long long rays = 0;
  double field_ms = 0;    ///< 0: the field was not new
  double prepare_ms = 0;  ///< for the new field or view
  double cast_ms = 0;
  double interpolate_ms = 0;
  double labels_ms = 0;  ///< where pictures are written
  std::optional<double>
      abort_latency_ms;             ///< from the event that stopped a restoration to this frame's begin
  bool late = false;                ///< shown after the slot that it was due in
  bool restored = false;            ///< all interpolated pixels have been cast
  std::optional<bool> equals_full;  ///< settled, and compared with a full cast
  std::string reason;               ///< reason for a change of the pattern
};

struct RealTimeReport {
  double frames_per_s = 0;  ///< asked for
  double seconds = 0;
  double epsilon_ms = 0;  ///< at the end
  long long due = 0;      ///< slots of 1 / frames_per_s with a change to show
  int field_updates = 0;
  int field_steps_skipped = 0;  ///< steps that could not be computed in time
  std::vector<RealTimeEvent> events;

  int count(render::ControllerState state) const;
  /// Settled pictures that differ from a full cast.
  int unequal() const;
};

}  // namespace emscape::playback
