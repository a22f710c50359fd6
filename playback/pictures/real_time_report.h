/// Report of a real-time loop: its events and their totals.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/patterns/frame_controller.h"

namespace emscape::playback {

/// An event: a busy frame, a restoration, or a settled picture.
struct RealTimeEvent {
  double time_ms = 0;     ///< of the playback, at its end
  double scenario_s = 0;  ///< time of the scenario that it shows
  render::ControllerState state = render::ControllerState::busy;
  render::Pattern pattern = render::Pattern::full;  ///< of the busy frame
  long long rays = 0;
  double field_ms = 0;    ///< 0: the field was not new
  int column_step = 1;    ///< of a new field: Frame::column_step
  double prepare_ms = 0;  ///< for the new field or view
  double cast_ms = 0;
  double interpolate_ms = 0;
  double labels_ms = 0;  ///< time to label pictures that are written
  std::optional<double>
      abort_latency_ms;   ///< from the event that stopped a restoration to the beginning of this frame
  bool late = false;      ///< shown after the slot in which it was due
  bool restored = false;  ///< all interpolated pixels have been cast
  std::optional<bool> equals_full;  ///< of settled pictures that were compared with a full cast
  std::string reason;               ///< reason for a change of the pattern
};

/// Totals over the events of a playback.
struct RealTimeTotals {
  long long busy = 0, late = 0;                    ///< busy frames; of these shown after their slot
  std::map<render::Pattern, long long> frames_of;  ///< busy frames by pattern
  long long restores_done = 0, restores_aborted = 0;
  long long settled = 0, compared = 0, equal = 0;  ///< settled pictures; of these compared, and equal
  std::optional<double> max_abort_latency_ms;      ///< none if no restoration was stopped

  void add(const RealTimeEvent& event);
  /// Settled pictures that differ from a full cast.
  long long unequal() const { return compared - equal; }
};

struct RealTimeReport {
  double frames_per_s = 0;  ///< requested
  double seconds = 0;
  double epsilon_ms = 0;  ///< at the end
  long long due = 0;      ///< slots of 1 / frames_per_s with a change to show
  int field_updates = 0;
  int field_updates_interpolated = 0;  ///< of these with interpolated columns
  int field_steps_skipped = 0;         ///< steps that could not be computed in time
  RealTimeTotals totals;
  std::vector<RealTimeEvent> events;  ///< empty without RealTimeOptions::keep_events
};

}  // namespace emscape::playback
