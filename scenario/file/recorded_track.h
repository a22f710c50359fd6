/// Tracks in files of other programs: GPX, KML, ACMI, tables with other columns, and the further formats of
/// recordings.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emscape/scenario/model/platform.h"
#include "recording/common/recording.h"

namespace emscape::scenario {

/// What the section of a track says besides the file.
struct TrackChoice {
  std::string object;                  ///< name or id; empty: the only one that moves
  std::string columns;                 ///< of a table; empty: by their names
  double gap_s = 0;                    ///< > 0: the platform is absent where no position is known for longer
  std::optional<double> height_agl_m;  ///< in place of the heights of the file
};

/// Points of a track file, and the assumptions and losses of its reading.
struct TrackFile {
  std::vector<TrackPoint> points;
  std::vector<std::string> warnings;
};

/// True if a file is a recording of another program, not a track file of the scenario format. A table with a
/// column t_s is one of the format.
bool isRecordedTrack(std::string_view bytes, const TrackChoice& choice);

/// The track of one object. t = 0 is the scenario's epoch; without one it is the recording's first second, or
/// t = 0 of its own times if these are no dates. Times of a day are those of the epoch's day, or of the next
/// one if all would be before the epoch.
/// @param epoch_ms  of the scenario, since 1970-01-01T00:00:00Z
/// @throws Error (bad_input), without a location: no such object, several of them, one that does not move, or
/// times that are too far from the epoch
TrackFile recordedTrack(const interop::Recording& recording, const TrackChoice& choice,
                        std::optional<std::int64_t> epoch_ms);

/// Sets what gap_s and height_agl_m say.
void applyChoice(const TrackChoice& choice, std::vector<TrackPoint>& points);

}  // namespace emscape::scenario
