/// Reading of Tacview's ACMI 2.0 to 2.2.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "emscape/base/progress.h"
#include "recording/common/byte_source.h"
#include "recording/common/recording.h"

namespace emscape::interop {

/// Takes the lines of an ACMI text, one after another.
/// @see https://www.tacview.net/documentation/acmi/
class AcmiReader {
 public:
  /// @param line_number  of its first line, in messages
  /// @param line  a logical line: physical ones that end in a backslash joined with the next one
  void take(std::string_view line, long long line_number);

  /// The recording so far: positions are relative to the last ReferenceLongitude and ReferenceLatitude, which
  /// live streams may send late. Call once.
  Recording finish();

  /// For streams: drops all but the last pose and state of each object, the objects that were removed, and of
  /// the others all but the last ones that were told of. @return how many of the others
  std::size_t keepLatest(std::size_t max_objects);
  /// For streams: ids of the objects that have a position, ascending, and the last one of each.
  std::vector<std::pair<std::uint64_t, PoseSample>> latestPoses() const;

  ReadingTally& tally() { return recording_.tally; }

 private:
  /// What is known of an object so far.
  struct State {
    std::size_t object = 0;
    double longitude_deg = 0, latitude_deg = 0, altitude_m = 0;
    double roll_deg = kUnknown, pitch_deg = kUnknown, yaw_deg = kUnknown;
    std::optional<std::size_t> beam;
    BeamState radar;
    bool has_mode = false;                ///< RadarMode was told
    std::optional<std::uint64_t> locked;  ///< id of the target
    bool is_locked = true;                ///< LockedTargetMode
    std::string color, coalition;
  };

  void takeHeader(std::string_view line, long long line_number);
  void takeGlobal(std::string_view properties);
  void takeEvent(const std::string& event);
  void takeObject(std::uint64_t id, std::string_view properties, const std::string& location);
  void takeProperty(State& state, std::string_view name, std::string_view value, const std::string& location);
  bool takeRadarProperty(State& state, std::string_view name, std::string_view value);
  void place(State& state, std::string_view value, const std::string& location);
  void remove(std::uint64_t id);
  /// A pose with the reference position; none beyond a pole.
  std::optional<PoseSample> placed(PoseSample pose) const;
  void dropPosesOutside(RecordedObject& object);
  State& stateOf(std::uint64_t id);
  RecordedObject& objectOf(const State& state) { return recording_.objects[state.object]; }

  Recording recording_;
  std::unordered_map<std::uint64_t, State> states_;
  std::unordered_map<std::size_t, std::string> parents_;  ///< of objects: the ids of their parents
  int header_lines_ = 0;
  double time_s_ = 0;
  std::size_t samples_ = 0;
  double reference_longitude_deg_ = 0, reference_latitude_deg_ = 0;
};

/// Reads a whole ACMI text.
/// @param name  of the file, for messages
/// @throws Error (bad_input) for another format
Recording readAcmi(ByteSource& source, const std::string& name, const ProgressSink& progress);

}  // namespace emscape::interop
