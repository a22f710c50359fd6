/// What the program does, in words: the only source of those of badge, status bar and log.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "apps/view/files/opening_progress.h"
#include "playback/live/live_view.h"

namespace emscape::view {

enum class Activity {
  empty,      ///< nothing is open
  opening,    ///< an input is being opened, up to its first field
  computing,  ///< a field is requested that no picture shows yet
  playing,
  busy,  ///< as render::ControllerState
  restore,
  idle
};
constexpr auto namesOf(Activity) {
  return std::array{"EMPTY", "OPENING", "COMPUTING", "PLAYING", "BUSY", "RESTORE", "IDLE"};
}

/// What the state depends on.
struct ProgramFacts {
  bool has_input = false;
  bool has_picture = false;
  bool has_field = true;  ///< the picture shows a field
  bool is_playing = false;
  double rate = 1;
  bool has_pending_edits = false;
  std::string stream;      ///< status of a live stream; may be empty
  double computing_s = 0;  ///< since the field was requested
  std::optional<OpeningProgress> opening;
};

struct ProgramState {
  Activity activity = Activity::empty;
  std::string badge;  ///< "COMPUTING 42 %"
  std::string what;   ///< "power_density_dbwm2 at 49.5 s: 'search radar' by itm, 1 of 4"; may be empty
  /// Of the picture, in the words of Painter::note(): "exact, full rays", "approximate, columns rays (12 %)",
  /// "the picture shows the view before"; may be empty.
  std::string picture;
  std::string stream;    ///< "DIS: 120 PDU/s, 14 entities, last 0.1 s ago"; empty without a stream
  double fraction = -1;  ///< completed; negative: unknown
  bool can_cancel = false;
};

ProgramState programState(const ProgramFacts& facts, const playback::LiveStatus& status);

}  // namespace emscape::view
