#include "interop/live/live_acmi.h"

#include <cmath>
#include <functional>
#include <utility>

#include "emscape/base/error.h"
#include "recording/acmi/acmi_text.h"

namespace emscape::interop {
namespace {

/// Time (s) between two looks at what has changed but poses: each costs as much as a recording of the
/// objects.
constexpr double kNote_s = 0.2;

void mix(std::size_t& hash, std::size_t value) {
  hash ^= value + 0x9E3779B97F4A7C15ull + (hash << 6) + (hash >> 2);
}

/// What a scenario of the recording depends on, poses apart; angles to half a degree.
std::size_t structureOf(const Recording& recording) {
  const std::hash<std::string> text;
  std::size_t hash = recording.objects.size();
  const auto add = [&hash](double value) {
    mix(hash, std::isnan(value) ? 7 : static_cast<std::size_t>(std::llround(2 * value) + 1000));
  };
  for (const RecordedObject& object : recording.objects) {
    mix(hash, text(object.id));
    mix(hash, text(object.name));
    mix(hash, text(object.type));
    mix(hash, static_cast<std::size_t>(object.side));
    mix(hash, object.presence.empty() || object.presence.back().is_present ? 1 : 2);
  }
  for (const RecordedBeam& beam : recording.beams) {
    mix(hash, beam.object);
    if (beam.states.empty()) continue;
    const BeamState& state = beam.states.back();
    mix(hash, state.is_on ? 1 : 2);
    mix(hash, state.target);
    add(state.azimuth_deg);
    add(state.elevation_deg);
    add(state.beamwidth_az_deg);
    add(state.beamwidth_el_deg);
  }
  return hash;
}

}  // namespace

void LiveAcmi::take(const std::uint8_t* bytes, std::size_t size, double) {
  for (std::size_t i = 0; i < size; ++i) {
    const char c = static_cast<char>(bytes[i]);
    if (c == '\n') {
      takeLine();
    } else if (line_.size() < LineReader::kLongest) {
      line_ += c;
    } else if (!std::exchange(is_cut_, true)) {
      countTooLong();  // its end may never come
    }
  }
}

void LiveAcmi::countTooLong() {
  ++counts_.records;
  countBad(kTooLongAcmiLine);
}

void LiveAcmi::takeLine() {
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  const long long too_long = lines_.tooLong();
  const bool was_cut = std::exchange(is_cut_, false);
  const auto logical = lines_.take(line_, was_cut);
  if (lines_.tooLong() != too_long) {
    if (!was_cut) countTooLong();
  } else if (logical) {
    ++counts_.records;
    is_noted_ = false;
    try {
      reader_.take(*logical, lines_.line());
    } catch (const Error& error) {
      countBad(error.message());
    }
  }
  line_.clear();
}

void LiveAcmi::expire(double now_s) {
  if (is_noted_ || now_s - noted_s_ < kNote_s) return;
  is_noted_ = true;
  noted_s_ = now_s;
  note();
}

void LiveAcmi::note() {
  counts_.forgotten += static_cast<long long>(reader_.keepLatest(LiveLimits::kObjects));
  const ReadingTally& tally = reader_.tally();
  counts_.bad += tally.bad - std::exchange(reader_bad_, tally.bad);
  if (counts_.first_bad.empty()) counts_.first_bad = tally.first_bad;
  latest_ = AcmiReader(reader_).finish();
  latest_.tally = {};
  // Objects without a position are not there yet.
  std::vector<std::size_t> kept_as(latest_.objects.size(), kNoTarget);
  std::vector<RecordedObject> objects;
  for (std::size_t i = 0; i < latest_.objects.size(); ++i) {
    if (latest_.objects[i].poses.empty()) continue;
    kept_as[i] = objects.size();
    objects.push_back(std::move(latest_.objects[i]));
    objects.back().poses = {withAnglesInRange(objects.back().poses.back())};
    objects.back().poses.front().t_s = 0;
    const auto& presence = objects.back().presence;
    const bool is_present = presence.empty() || presence.back().is_present;
    objects.back().presence = {{0, is_present}};
  }
  std::vector<RecordedBeam> beams;
  for (RecordedBeam& beam : latest_.beams) {
    if (kept_as[beam.object] == kNoTarget || beam.states.empty()) continue;
    beam.object = kept_as[beam.object];
    BeamState state = beam.states.back();
    state.t_s = 0;
    if (state.target != kNoTarget) state.target = kept_as[state.target];
    beam.states = {state};
    beams.push_back(std::move(beam));
  }
  latest_.objects = std::move(objects);
  latest_.beams = std::move(beams);
  const std::size_t structure = structureOf(latest_);
  if (structure == structure_) return;
  structure_ = structure;
  ++revision_;
}

LiveRecording LiveAcmi::recording(double) {
  LiveRecording result{latest_, {}};
  result.recording.epoch_ms.reset();
  for (const RecordedObject& object : latest_.objects) result.keys.push_back(acmiId(object.id).value_or(0));
  return result;
}

std::vector<LivePose> LiveAcmi::poses(double) const {
  std::vector<LivePose> poses;
  for (const auto& [id, latest] : reader_.latestPoses()) {
    PoseSample pose = withAnglesInRange(latest);
    if (std::isnan(pose.heading_deg)) pose.heading_deg = pose.pitch_deg = pose.roll_deg = 0;
    poses.push_back({id, pose});
  }
  return poses;
}

}  // namespace emscape::interop
