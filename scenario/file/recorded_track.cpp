#include "scenario/file/recorded_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/count_text.h"
#include "base/text/utc.h"
#include "document/csv.h"
#include "document/schema_check.h"
#include "emscape/base/error.h"
#include "recording/common/text.h"
#include "recording/read_recording.h"
#include "scenario/file/schema.h"

namespace emscape::scenario {
namespace {

using interop::RecordedObject;
using interop::Recording;

constexpr std::size_t kNamesInMessage = 8;

[[noreturn]] void fail(const std::string& message) {
  throw Error(ErrorCode::bad_input, message);
}

/// "'red 1', 'red 2' and 3 more"
std::string namesOf(const std::vector<const RecordedObject*>& objects, bool with_id) {
  std::string text;
  for (std::size_t i = 0; i < std::min(objects.size(), kNamesInMessage); ++i) {
    text += fmt::format("{}'{}'", i == 0 ? "" : ", ", with_id ? objects[i]->id : objects[i]->name);
  }
  if (objects.size() > kNamesInMessage) text += fmt::format(" and {} more", objects.size() - kNamesInMessage);
  return text;
}

bool isMoving(const RecordedObject& object) {
  return object.poses.size() > 1;
}

const RecordedObject& chosenObject(const Recording& recording, const std::string& wanted) {
  std::vector<const RecordedObject*> moving, named;
  std::vector<std::string> names;
  for (const RecordedObject& object : recording.objects) {
    if (isMoving(object)) moving.push_back(&object);
    names.push_back(object.name);
    if (object.id == wanted) return object;
    if (!wanted.empty() && object.name == wanted) named.push_back(&object);
  }
  if (wanted.empty()) {
    if (moving.size() == 1) return *moving.front();
    if (moving.empty()) {
      const interop::PoseSample& first = recording.objects.front().poses.front();
      fail(
          fmt::format("no object in it has two positions, which a track needs; for one that stands write "
                      "'position: {{latitude_deg: {:.7f}, longitude_deg: {:.7f}, height_msl_m: {:.1f}}}'",
                      first.latitude_deg, first.longitude_deg, first.height_msl_m));
    }
    fail(fmt::format("{} objects in it move; choose one by its name: 'object: NAME', of {}", moving.size(),
                     namesOf(moving, false)));
  }
  if (named.size() > 1) {
    fail(fmt::format("{} objects in it have the name '{}'; choose one by its id: 'object: ID', of {}",
                     named.size(), wanted, namesOf(named, true)));
  }
  if (named.empty()) {
    const std::string near = document::didYouMean(wanted, names);
    fail(fmt::format("there is no object '{}' in it{}{}", wanted, near.empty() ? "; it has " : near,
                     near.empty() ? namesOf(moving, false) : ""));
  }
  return *named.front();
}

/// Seconds from the recording's t = 0 to the scenario's.
double shiftOf(const Recording& recording, std::optional<std::int64_t> epoch_ms,
               std::vector<std::string>& warnings) {
  constexpr std::int64_t kDay_ms = 86400000;
  if (recording.has_times_of_day) {
    if (!epoch_ms) {
      warnings.emplace_back(
          "its times are those of a day, and the scenario has no 'epoch': t = 0 is taken where the file "
          "begins");
      return 0;
    }
    const std::int64_t day_ms = *epoch_ms - ((*epoch_ms % kDay_ms) + kDay_ms) % kDay_ms;
    double shift_s = recording.origin_s + static_cast<double>(day_ms - *epoch_ms) / 1000;
    const bool is_next_day = interop::spanOf(recording).end_s + shift_s < 0;
    if (is_next_day) shift_s += static_cast<double>(kDay_ms) / 1000;
    warnings.push_back(
        fmt::format("its times have no date: they are taken as those of {}, the day of the "
                    "scenario's 'epoch'{}",
                    utcText(is_next_day ? day_ms + kDay_ms : day_ms).substr(0, 10),
                    is_next_day ? " or the next one" : ""));
    return shift_s;
  }
  if (!recording.epoch_ms) return recording.origin_s;
  if (epoch_ms) return static_cast<double>(*recording.epoch_ms - *epoch_ms) / 1000;
  warnings.push_back(fmt::format(
      "its times are UTC, but the scenario has no 'epoch': t = 0 is taken as {}, where the file begins; "
      "'epoch: \"{}\"' says so",
      utcText(*recording.epoch_ms), utcText(*recording.epoch_ms)));
  return 0;
}

void tellLosses(const interop::ReadingTally& tally, std::vector<std::string>& warnings) {
  if (tally.bad > 0) {
    warnings.push_back(fmt::format("{} cannot be read, the first: {}",
                                   countText(tally.bad, "record", "records"), tally.first_bad));
  }
  if (!tally.torn.empty()) warnings.push_back("it ends too early: " + tally.torn);
  warnings.insert(warnings.end(), tally.notes.begin(), tally.notes.end());
}

}  // namespace

bool isRecordedTrack(std::string_view bytes, const TrackChoice& choice) {
  if (!choice.object.empty() || !choice.columns.empty()) return true;
  const std::string head(bytes.substr(0, 4096));
  document::CsvReader reader(head);
  document::CsvRow row;
  if (reader.next(row) && std::any_of(row.cells.begin(), row.cells.end(), [](const auto& cell) {
        return interop::lowerCase(std::string(cell.text.substr(0, 3))) == "t_s";
      }))
    return false;
  return interop::isRecording(bytes);
}

TrackFile recordedTrack(const Recording& recording, const TrackChoice& choice,
                        std::optional<std::int64_t> epoch_ms) {
  TrackFile track;
  const RecordedObject& object = chosenObject(recording, choice.object);
  if (!isMoving(object)) {
    const interop::PoseSample& only = object.poses.front();
    fail(
        fmt::format("'{}' has one position, a track needs two; write 'position: {{latitude_deg: {:.7f}, "
                    "longitude_deg: {:.7f}, height_msl_m: {:.1f}}}'",
                    object.name, only.latitude_deg, only.longitude_deg, only.height_msl_m));
  }
  const double shift_s = shiftOf(recording, epoch_ms, track.warnings);
  const document::ValueSpec& time = trackRowSpec().find("t_s", nullptr)->value;
  for (const interop::PoseSample& pose : object.poses) {
    TrackPoint point;
    point.t_s = pose.t_s + shift_s;
    if (!track.points.empty() && point.t_s <= track.points.back().t_s)
      continue;  // closer than a double tells
    point.position.latitude_deg = pose.latitude_deg;
    point.position.longitude_deg = pose.longitude_deg;
    point.position.height_msl_m = pose.height_msl_m;
    if (!std::isnan(pose.heading_deg)) {
      point.heading_deg = pose.heading_deg;
      point.pitch_deg = pose.pitch_deg;
      point.roll_deg = pose.roll_deg;
    }
    track.points.push_back(point);
  }
  const double first_s = track.points.front().t_s, last_s = track.points.back().t_s;
  if (first_s < time.minimum || last_s > time.maximum) {
    fail(fmt::format(
        "its times are {:.6g} to {:.6g} s from the scenario's epoch, outside the allowed range {} "
        "to {} s; correct 'epoch'",
        first_s, last_s, time.minimum, time.maximum));
  }
  tellLosses(recording.tally, track.warnings);
  return track;
}

void applyChoice(const TrackChoice& choice, std::vector<TrackPoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (choice.height_agl_m) {
      points[i].position.height_msl_m.reset();
      points[i].position.height_agl_m = choice.height_agl_m;
    }
    if (choice.gap_s > 0 && i > 0) points[i - 1].gap_after = points[i].t_s - points[i - 1].t_s > choice.gap_s;
  }
}

}  // namespace emscape::scenario
