#include "recording/common/track_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/geodesy/position_limits.h"
#include "base/text/count_text.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"
#include "recording/common/dates.h"
#include "recording/common/samples.h"
#include "recording/common/tally.h"

namespace emscape::interop {
namespace {

constexpr double kMaxTime_s = 2.6e11;          ///< the year 9999
constexpr double kMaxSpan_s = 9.9e7;           ///< of a scenario's track
constexpr double kOutlierFactor = 3;           ///< of the speed without the position
constexpr double kNoise_mps = 1;               ///< noise of a receiver that stands
constexpr double kLastSpreadsheetDay = 73050;  ///< of the year 2099

/// Positions of one time that are farther apart (m) are those of several objects, if they are more than this
/// part of all.
constexpr double kFarApart_m = 1000, kFarPart = 0.05;

/// A place in ECEF; heights above the sea stand for those above the ellipsoid, and 0 for an unknown one.
Vec3d roughEcef(const PoseSample& pose) {
  return toEcef(
      {pose.latitude_deg, pose.longitude_deg, std::isnan(pose.height_msl_m) ? 0 : pose.height_msl_m});
}

/// Positions of an object in the order of time, of which the last one of each time counts.
struct SameTimes {
  long long dropped = 0;  ///< at another place than that one
  long long far = 0;      ///< of these farther than kFarApart_m
  double farthest_m = 0;
  double first_t_s = 0;  ///< of the first one
};

SameTimes sameTimesOf(const std::vector<PoseSample>& poses) {
  SameTimes found;
  for (std::size_t begin = 0, end = 0; begin < poses.size(); begin = end) {
    while (end < poses.size() && poses[end].t_s == poses[begin].t_s) ++end;
    const Vec3d kept = roughEcef(poses[end - 1]);
    for (std::size_t i = begin; i + 1 < end; ++i) {
      const double distance_m = length(roughEcef(poses[i]) - kept);
      if (!(distance_m > 0)) continue;
      if (found.dropped++ == 0) found.first_t_s = poses[i].t_s;
      if (distance_m > kFarApart_m) ++found.far;
      found.farthest_m = std::max(found.farthest_m, distance_m);
    }
  }
  return found;
}

/// A speed that most of an object's legs exceed.
struct ImpossibleSpeed {
  double mps = 0;
  std::size_t first_leg = 0;  ///< that is so fast
};

std::optional<ImpossibleSpeed> impossibleSpeedOf(const RecordedObject& object, double seconds_per_unit) {
  const auto& poses = object.poses;
  if (poses.size() < 2) return std::nullopt;
  const double shortest_s = std::min(kShortestStep_s, kShortestStep_s * seconds_per_unit);
  std::size_t fast = 0;
  double path_m = 0;
  ImpossibleSpeed found;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double leg_m = length(roughEcef(poses[i]) - roughEcef(poses[i - 1]));
    const double leg_s = (poses[i].t_s - poses[i - 1].t_s) * seconds_per_unit;
    path_m += leg_m;
    if (leg_m <= kFastest_mps * std::max(leg_s, shortest_s)) continue;
    if (fast++ == 0) found.first_leg = i;
  }
  const double span_s = (poses.back().t_s - poses.front().t_s) * seconds_per_unit;
  found.mps = path_m / std::max(span_s, shortest_s);
  // Single fast legs are outliers, which are told.
  return 2 * fast > poses.size() - 1 && found.mps > kFastest_mps ? std::optional(found) : std::nullopt;
}

}  // namespace

double heightMsl_m(double latitude_deg, double longitude_deg, double height_ellipsoid_m) {
  return height_ellipsoid_m - geoidUndulation_m(latitude_deg, longitude_deg);
}

PoseSample poseOfEcef(double t_s, const Vec3d& position_m) {
  PoseSample pose;
  const GeodeticPosition position = fromEcef(position_m);
  pose.t_s = t_s;
  pose.latitude_deg = position.latitude_deg;
  pose.longitude_deg = position.longitude_deg;
  pose.height_msl_m = heightMsl_m(position.latitude_deg, position.longitude_deg, position.height_ellipsoid_m);
  return pose;
}

TrackRecorder::TrackRecorder(std::string format, const ReadOptions& options) : options_(options) {
  recording_.format = std::move(format);
}

std::size_t TrackRecorder::objectOf(const std::string& id) {
  const auto [found, is_new] = indices_.try_emplace(id, recording_.objects.size());
  if (!is_new) return found->second;
  if (recording_.objects.size() >= RecordingLimits::kObjects) {
    throw Error(ErrorCode::bad_input,
                fmt::format("more than {} objects; cut the recording into parts", RecordingLimits::kObjects));
  }
  RecordedObject object;
  object.id = object.name = id.empty() ? "object" : id;
  recording_.objects.push_back(std::move(object));
  return found->second;
}

std::size_t TrackRecorder::addBeam(std::size_t object) {
  if (recording_.beams.size() >= RecordingLimits::kObjects)
    throw Error(ErrorCode::bad_input, fmt::format("more than {} beams", RecordingLimits::kObjects));
  RecordedBeam beam;
  beam.object = object;
  recording_.beams.push_back(std::move(beam));
  return recording_.beams.size() - 1;
}

void TrackRecorder::countSample() {
  if (++samples_ > RecordingLimits::kSamples) {
    throw Error(ErrorCode::bad_input,
                fmt::format("more than {} positions and states; cut the recording into parts",
                            RecordingLimits::kSamples));
  }
}

bool TrackRecorder::isPosition(PoseSample& pose, const std::string& location) {
  const bool is_sound = std::abs(pose.latitude_deg) <= PositionLimits::kLatitude_deg &&
                        std::abs(pose.longitude_deg) <= 720 &&
                        !(pose.height_msl_m < PositionLimits::kLowest_m) &&
                        !(pose.height_msl_m > PositionLimits::kHighest_m) && std::abs(pose.t_s) <= kMaxTime_s;
  if (!is_sound) {
    countBad(
        recording_.tally, location,
        fmt::format("latitude {:.6g}, longitude {:.6g}, height {:.6g} m: no position within -90 to 90 and "
                    "-720 to 720 degrees and {} to {} m above mean sea level",
                    pose.latitude_deg, pose.longitude_deg, pose.height_msl_m, PositionLimits::kLowest_m,
                    PositionLimits::kHighest_m));
    return false;
  }
  pose.longitude_deg = wrapLongitude_deg(pose.longitude_deg);
  // A heading alone is that of a level object.
  const bool has_heading = !std::isnan(pose.heading_deg);
  pose.pitch_deg = !has_heading                 ? kUnknown
                   : std::isnan(pose.pitch_deg) ? 0
                                                : std::clamp(pose.pitch_deg, -90.0, 90.0);
  pose.roll_deg = !has_heading ? kUnknown : std::isnan(pose.roll_deg) ? 0 : pose.roll_deg;
  return true;
}

void TrackRecorder::add(std::size_t object, PoseSample pose, const std::string& location) {
  if (!isPosition(pose, location)) return;
  recording_.objects[object].poses.push_back(pose);
  countSample();
}

void TrackRecorder::addFixed(std::size_t object, PoseSample pose, const std::string& location) {
  if (isPosition(pose, location)) fixed_[object] = pose;
}

void TrackRecorder::endAtGaps(RecordedObject& object, double gap_s) {
  for (std::size_t i = 1; i < object.poses.size(); ++i) {
    const double begin_s = object.poses[i - 1].t_s, end_s = object.poses[i].t_s;
    if (end_s - begin_s <= gap_s) continue;
    object.presence.push_back({begin_s, false});
    object.presence.push_back({end_s, true});
  }
}

void TrackRecorder::tellSameTimes() {
  SameTimes all;
  std::string first;
  for (RecordedObject& object : recording_.objects) {
    auto& poses = object.poses;
    std::stable_sort(poses.begin(), poses.end(),
                     [](const PoseSample& a, const PoseSample& b) { return a.t_s < b.t_s; });
    const SameTimes same = sameTimesOf(poses);
    if (same.dropped == 0) continue;
    const bool is_one_time = poses.front().t_s == poses.back().t_s;
    const bool are_several = static_cast<double>(same.far) > kFarPart * static_cast<double>(poses.size());
    if (!objects_remedy_.empty() && (is_one_time || are_several)) {
      throw Error(
          ErrorCode::bad_input,
          fmt::format("'{}' would be at two places at once: {} of {} positions have the time of a later one, "
                      "up to {:.4g} m away, the first at {:.10g} s{}. They are of several objects, or their "
                      "times have lost digits. {}",
                      object.name, same.dropped, poses.size(), same.farthest_m, same.first_t_s,
                      is_one_time ? ", as all times are equal" : "", objects_remedy_));
    }
    if (first.empty()) first = fmt::format("{} at {:.10g} s", object.name, same.first_t_s);
    all.dropped += same.dropped;
    all.farthest_m = std::max(all.farthest_m, same.farthest_m);
  }
  if (all.dropped == 0) return;
  recording_.tally.notes.push_back(fmt::format(
      "{} the time of a later one of the same object, up to {:.4g} m away, and {} not used; the first: {}",
      countText(all.dropped, "position has", "positions have"), all.farthest_m,
      all.dropped == 1 ? "is" : "are", first));
}

/// Interpolates the heights that are not known in time; before and after the known ones the nearest is taken.
void TrackRecorder::fillHeights(RecordedObject& object) {
  auto& poses = object.poses;
  const auto isKnown = [](const PoseSample& pose) { return !std::isnan(pose.height_msl_m); };
  auto before = poses.end();
  for (auto here = poses.begin(); here != poses.end();) {
    if (isKnown(*here)) {
      before = here++;
      continue;
    }
    const auto after = std::find_if(here, poses.end(), isKnown);
    const bool has_before = before != poses.end(), has_after = after != poses.end();
    for (; here != after; ++here) {
      const double part =
          has_before && has_after ? (here->t_s - before->t_s) / (after->t_s - before->t_s) : 0;
      const double from_m = has_before ? before->height_msl_m : has_after ? after->height_msl_m : 0;
      here->height_msl_m = from_m + (has_before && has_after ? part * (after->height_msl_m - from_m) : 0);
      assumeHeight(
          has_before || has_after
              ? "height of a position without one: interpolated in time between the known ones of its object"
              : "height of a position of an object without any: 0 m is taken");
    }
  }
}

void TrackRecorder::tellOutliers() {
  long long outliers = 0;
  std::string first;
  for (const RecordedObject& object : recording_.objects) {
    const auto& poses = object.poses;
    if (poses.size() < 3) continue;
    const auto speed_mps = [&](const Vec3d& from, const Vec3d& to, std::size_t i, std::size_t k) {
      return length(to - from) / std::max(poses[k].t_s - poses[i].t_s, kShortestStep_s);
    };
    Vec3d before = roughEcef(poses[0]), here = roughEcef(poses[1]);
    for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
      const Vec3d after = roughEcef(poses[i + 1]);
      const double limit_mps = kOutlierFactor * std::max(speed_mps(before, after, i - 1, i + 1), kNoise_mps);
      const bool is_outlier =
          speed_mps(before, here, i - 1, i) > limit_mps && speed_mps(here, after, i, i + 1) > limit_mps;
      if (is_outlier && outliers++ == 0) first = fmt::format("{} at {:.3f} s", object.name, poses[i].t_s);
      before = here;
      here = after;
    }
  }
  if (outliers == 0) return;
  recording_.tally.notes.push_back(
      fmt::format("{} more than {} times as fast as without it; the first: {}",
                  countText(outliers, "position makes its object", "positions make their objects"),
                  kOutlierFactor, first));
}

/// Days of spreadsheets as UTC.
void TrackRecorder::takeTimesAsDays() {
  for (RecordedObject& object : recording_.objects) {
    for (PoseSample& pose : object.poses) pose.t_s = (pose.t_s - kSpreadsheetDayOf1970) * kSecondsPerDay;
  }
  hasUtc();
  recording_.tally.notes.emplace_back(
      "times are taken as days since 1900, as spreadsheets number them: as seconds they would make an object "
      "faster than 10 km/s");
}

void TrackRecorder::checkSpeeds() {
  for (const RecordedObject& object : recording_.objects) {
    const auto speed = impossibleSpeedOf(object, 1);
    if (!speed) continue;
    const auto isDay = [](const PoseSample& pose) {
      return pose.t_s >= kSpreadsheetDayOf1970 && pose.t_s <= kLastSpreadsheetDay;
    };
    const bool are_days =
        std::all_of(recording_.objects.begin(), recording_.objects.end(), [&](const RecordedObject& other) {
          return std::all_of(other.poses.begin(), other.poses.end(), isDay) &&
                 !impossibleSpeedOf(other, kSecondsPerDay);
        });
    if (may_be_days_ && !utc_begin_s_ && are_days) return takeTimesAsDays();
    if (object.poses.size() < 3) continue;  // of two positions one may be wrong
    const PoseSample &from = object.poses[speed->first_leg - 1], &to = object.poses[speed->first_leg];
    throw Error(
        ErrorCode::bad_input,
        fmt::format(
            "'{}' would move at {:.4g} km/s, faster than any object (10 km/s): from latitude {:.5f}, "
            "longitude {:.5f} to {:.5f}, {:.5f} deg between times {:.10g} and {:.10g}. Another unit or "
            "column is the time; of a table, --columns (or 'columns' of a track) states it: "
            "time=NAME:UNIT, with ms, s, h, days, or excel for days since 1900. {}",
            object.name, speed->mps / 1000, from.latitude_deg, from.longitude_deg, to.latitude_deg,
            to.longitude_deg, from.t_s, to.t_s,
            objects_remedy_.empty() ? "Where rows are of several objects, id=NAME tells them apart"
                                    : objects_remedy_));
  }
}

Recording TrackRecorder::finish() {
  tellSameTimes();
  for (RecordedObject& object : recording_.objects) {
    sortByTime(object);
    fillHeights(object);
  }
  checkSpeeds();
  for (RecordedBeam& beam : recording_.beams) sortByTime(beam);
  const TimeSpan span = spanOf(recording_);
  if (span.end_s - span.begin_s > kMaxSpan_s) {
    throw Error(ErrorCode::bad_input,
                fmt::format("its times are {:.6g} s apart, more than {:.6g} s; cut the recording into parts",
                            span.end_s - span.begin_s, kMaxSpan_s));
  }
  const double origin_s = std::floor(span.begin_s);
  const bool has_times = std::any_of(recording_.objects.begin(), recording_.objects.end(),
                                     [](const RecordedObject& object) { return !object.poses.empty(); });
  for (const auto& [index, pose] : fixed_) {
    auto& poses = recording_.objects[index].poses;
    if (!poses.empty()) continue;
    poses.push_back(pose);
    poses.back().t_s = span.begin_s;
    fillHeights(recording_.objects[index]);
  }
  for (RecordedObject& object : recording_.objects) {
    if (options_.gap_s > 0) endAtGaps(object, options_.gap_s);
    for (PoseSample& pose : object.poses) pose.t_s -= origin_s;
    for (PresenceSample& sample : object.presence) sample.t_s -= origin_s;
    std::stable_sort(object.presence.begin(), object.presence.end(),
                     [](const auto& a, const auto& b) { return a.t_s < b.t_s; });
  }
  for (RecordedBeam& beam : recording_.beams) {
    for (BeamState& state : beam.states) state.t_s -= origin_s;
  }
  tellOutliers();
  if (utc_begin_s_ && has_times) {
    recording_.epoch_ms = std::llround((*utc_begin_s_ + origin_s) * 1000);
  } else {
    recording_.origin_s = origin_s;
  }
  for (const auto& [assumption, count] : assumptions_)
    recording_.tally.notes.push_back(fmt::format("{} ({})", assumption, countText(count, "time", "times")));
  return std::move(recording_);
}

}  // namespace emscape::interop
