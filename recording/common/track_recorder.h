/// Tracks as a recording.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "emscape/base/vec.h"
#include "recording/common/read_options.h"
#include "recording/common/recording.h"

namespace emscape::interop {

/// Faster than any object: a satellite makes 8 km/s. Steps of a track that are shorter count as this.
constexpr double kFastest_mps = 10e3, kShortestStep_s = 1e-3;

/// Of a time that does not say its zone.
constexpr const char* kUtcWithoutZone =
    "time without a zone: taken as UTC; if it is local, write its offset with it (2026-06-01 08:00:00+02:00)";

/// What to do with heights above the ground, for messages.
constexpr const char* kHeightsAboveGround =
    "'height_agl_m' of a track is one height above the ground for all its positions, and a track file of the "
    "scenario format (columns t_s, latitude_deg, longitude_deg, height_agl_m) has one in each row";

/// Takes positions of objects in any order.
class TrackRecorder {
 public:
  /// @param format  its name, for people
  TrackRecorder(std::string format, const ReadOptions& options);

  /// Index of the object of an id, which is made at its first call.
  /// @throws Error (bad_input) if there are too many
  std::size_t objectOf(const std::string& id);
  RecordedObject& object(std::size_t index) { return recording_.objects[index]; }
  /// Adds a beam of an object.
  std::size_t addBeam(std::size_t object);
  RecordedBeam& beam(std::size_t index) { return recording_.beams[index]; }

  /// Adds a pose. With a heading unknown angles are 0; one that is no position is counted as bad; of two at
  /// one time the later one is kept, and the others are told.
  /// @param pose  t_s counts from any begin, or from that of hasUtc(); an unknown height is interpolated in
  /// time, and told
  /// @param location  in the file, for messages
  void add(std::size_t object, PoseSample pose, const std::string& location);
  /// Adds the place of an object that does not move.
  void addFixed(std::size_t object, PoseSample pose, const std::string& location);
  /// Times are UTC: seconds since `begin_s` after 1970.
  void hasUtc(double begin_s = 0) { utc_begin_s_ = begin_s; }

  /// Times without a unit: if they make an object faster than any, they are days since 1900 as spreadsheets
  /// write them, as far as these do not. False: times have a unit.
  void mayBeDays(bool are_numbers) { may_be_days_ = are_numbers; }

  /// How the rows of several objects are told apart. With it positions of one object that are far apart at
  /// one time are refused, else told.
  void tellObjectsApartBy(std::string remedy) { objects_remedy_ = std::move(remedy); }

  ReadingTally& tally() { return recording_.tally; }
  /// Counts a position that needs an assumption, which becomes a note.
  void assume(const std::string& assumption) { ++assumptions_[assumption]; }
  /// The same for an assumption on a height.
  void assumeHeight(const std::string& assumption) {
    if (options_.uses_heights) assume(assumption);
  }
  /// Counts a pose or state against the limit of a recording. @throws Error (bad_input)
  void countSample();

  /// The recording, with t = 0 at the second at or before the first pose. Call once.
  Recording finish();

 private:
  bool isPosition(PoseSample& pose, const std::string& location);
  void endAtGaps(RecordedObject& object, double gap_s);
  void tellSameTimes();
  void fillHeights(RecordedObject& object);
  void tellOutliers();
  void checkSpeeds();
  void takeTimesAsDays();

  Recording recording_;
  ReadOptions options_;
  std::unordered_map<std::string, std::size_t> indices_;
  std::unordered_map<std::size_t, PoseSample> fixed_;
  std::map<std::string, long long> assumptions_;
  std::size_t samples_ = 0;
  bool may_be_days_ = false;
  std::string objects_remedy_;
  std::optional<double> utc_begin_s_;
};

/// A pose at a position in ECEF (m), with its height above mean sea level by EGM96.
PoseSample poseOfEcef(double t_s, const Vec3d& position_m);
/// Height above mean sea level (m) of a height above the ellipsoid.
double heightMsl_m(double latitude_deg, double longitude_deg, double height_ellipsoid_m);

}  // namespace emscape::interop
