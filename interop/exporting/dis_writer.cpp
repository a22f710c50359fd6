#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/utc.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "interop/exporting/writers.h"
#include "recording/dis/datagrams.h"
#include "recording/dis/force.h"
#include "recording/dis/orientation.h"
#include "recording/dis/pdu.h"

namespace emscape::interop {
namespace {

using dis::EntityState;
using dis::Header;

constexpr double kEntityHeartbeat_s = 5, kEmissionHeartbeat_s = 10, kTransmitterHeartbeat_s = 2;
/// Systems of a PDU, so that it has less than 8192 bytes.
constexpr std::size_t kMaxSystems = 100;
constexpr double kEndOfCaptures_s = 4294967296;  // of their 32 bits, from 1970 on
constexpr std::size_t kMaxNumber = 255;          ///< of a system
constexpr int kSearch = 1, kTrack = 4, kJam = 12;

enum class Event { state, emission, transmitter };

/// A PDU to write: of a platform, of a platform's emitters, or of a transmitter.
struct Due {
  double t_s = 0;
  Event event = Event::state;
  std::size_t index = 0;  ///< of the platform, or of the transmitter's emitter

  bool operator<(const Due& other) const {
    return std::tie(t_s, event, index) < std::tie(other.t_s, other.event, other.index);
  }
  bool operator==(const Due& other) const {
    return t_s == other.t_s && event == other.event && index == other.index;
  }
};

/// Times with heartbeats between them and up to the end; none without times.
std::vector<double> withHeartbeats(std::vector<double> times, double end_s, double heartbeat_s) {
  std::vector<double> result;
  if (times.empty()) return result;
  if (times.back() < end_s) times.push_back(end_s);
  for (const double t_s : times) {
    while (!result.empty() && t_s - result.back() > heartbeat_s)
      result.push_back(result.back() + heartbeat_s);
    if (result.empty() || t_s > result.back()) result.push_back(t_s);
  }
  return result;
}

Vec3d ecefOf(const PoseSample& pose) {
  return toEcef({pose.latitude_deg, pose.longitude_deg,
                 pose.height_msl_m + geoidUndulation_m(pose.latitude_deg, pose.longitude_deg)});
}

/// A name in ASCII, with one ? for each other character, cut to a marking's length.
std::string markingOf(const std::string& name) {
  std::string marking;
  for (const char c : name) {
    const bool is_continuation = (static_cast<unsigned char>(c) & 0xC0) == 0x80;  // of UTF-8
    if (marking.size() == dis::kMarkingBytes) break;
    if (!is_continuation) marking += c >= 0x20 && c < 0x7F ? c : '?';
  }
  return marking;
}

/// The scenario's t = 0 (s since 1970); 0 without an epoch.
double originOf(const scenario::Scenario& scenario) {
  const auto epoch_ms = parseUtc_ms(scenario.clock.epoch_utc);
  return epoch_ms ? static_cast<double>(*epoch_ms) / 1000 : 0;
}

class DisWriter {
 public:
  DisWriter(const ExportJob& job, const PduSink& sink) : job_(job), scenario_(job.scenario), sink_(sink) {
    origin_s_ = originOf(scenario_);
  }

  long long run(std::vector<ExportedRow>& rows) {
    makeSchedule(rows);
    for (std::size_t i = 0; i < due_.size(); ++i) {
      if (job_.progress && i % 1000 == 0)
        job_.progress("writing DIS", static_cast<double>(i) / static_cast<double>(due_.size()));
      const Due& due = due_[i];
      if (due.event == Event::state) write(due.t_s, stateOf(due.index, due.t_s));
      if (due.event == Event::emission) writeEmissions(due.index, due.t_s);
      if (due.event == Event::transmitter) write(due.t_s, transmitterOf(due.index, due.t_s));
    }
    return records_;
  }

 private:
  void makeSchedule(std::vector<ExportedRow>& rows) {
    const auto add = [this](const std::vector<double>& times, Event event, std::size_t index) {
      for (const double t_s : times) due_.push_back({t_s, event, index});
    };
    for (std::size_t i = 0; i < scenario_.platforms.size(); ++i) {
      times_.push_back(withHeartbeats(timesOfPositions(scenario_, scenario_.platforms[i], job_.step_s),
                                      presenceOf(scenario_, scenario_.platforms[i]).end_s,
                                      kEntityHeartbeat_s));
      add(times_.back(), Event::state, i);
      domains_.push_back(domainOf(scenario_, scenario_.platforms[i], job_.terrain));
    }
    systems_.resize(scenario_.platforms.size());
    for (std::size_t i = 0; i < scenario_.emitters.size(); ++i) {
      const scenario::Emitter& emitter = scenario_.emitters[i];
      const bool is_radio = emitter.kind == scenario::EmitterKind::transmitter;
      const auto platform = static_cast<std::size_t>(emitter.platform);
      const double end_s = presenceOf(scenario_, scenario_.platforms[platform]).end_s;
      add(withHeartbeats(timesOfChanges(scenario_, emitter, job_.step_s), end_s,
                         is_radio ? kTransmitterHeartbeat_s : kEmissionHeartbeat_s),
          is_radio ? Event::transmitter : Event::emission, is_radio ? i : platform);
      if (!is_radio) systems_[platform].push_back(i);
      rows.push_back({fmt::format(is_radio ? "{{dis_radio: {}}}" : "{{dis_name: {}}}", i + 1), i});
    }
    for (std::size_t i = 0; i < systems_.size(); ++i) {
      if (systems_[i].size() <= kMaxNumber) continue;
      throw Error(
          ErrorCode::bad_input,
          fmt::format("the platform '{}' has {} radars and jammers, more than the {} that DIS can number; "
                      "give some of them another platform",
                      scenario_.platforms[i].name, systems_[i].size(), kMaxNumber));
    }
    std::sort(due_.begin(), due_.end());
    due_.erase(std::unique(due_.begin(), due_.end()), due_.end());
  }

  static dis::EntityId idOf(std::size_t platform) { return {1, 1, static_cast<std::uint16_t>(platform + 1)}; }

  EntityState stateOf(std::size_t index, double t_s) const {
    const scenario::Platform& platform = scenario_.platforms[index];
    const PoseSample pose = poseOf(platform, job_.terrain, t_s);
    EntityState state;
    state.id = idOf(index);
    state.force = dis::forceOf(platform.side.value_or(scenario::Side::unknown));
    const Domain domain = domains_[index];
    state.type = {1, domain == Domain::air ? 2 : domain == Domain::sea ? 3 : 1, 0, 0, 0, 0, 0};
    state.position_m = ecefOf(pose);
    state.orientation_rad =
        dis::eulerOf(dis::axesOf(dis::LocalAttitude{pose.heading_deg, pose.pitch_deg, pose.roll_deg},
                                 pose.latitude_deg, pose.longitude_deg));
    const auto& times = times_[index];
    const auto next = std::upper_bound(times.begin(), times.end(), t_s);
    if (next != times.end() && platform.track.size() > 1) {
      state.velocity_mps = (ecefOf(poseOf(platform, job_.terrain, *next)) - state.position_m) / (*next - t_s);
    }
    state.algorithm = platform.track.size() > 1 ? 2 : 1;
    state.marking = markingOf(platform.name);
    return state;
  }

  dis::EmissionSystem systemOf(std::size_t index, double t_s, std::size_t number) const {
    const scenario::Emitter& emitter = scenario_.emitters[index];
    const BeamState state = beamStateAt(scenario_, emitter, t_s);
    dis::EmissionSystem system;
    system.name = static_cast<std::uint16_t>(index + 1);
    system.number = static_cast<std::uint8_t>(number + 1);
    dis::EmissionBeam beam;
    beam.number = 1;
    beam.frequency_hz = state.frequency_hz;
    beam.frequency_range_hz = state.bandwidth_hz;
    beam.erp_dbm = state.erp_dbm;
    if (!std::isnan(state.prf_hz)) {
      beam.prf_hz = state.prf_hz;
      beam.pulse_width_us = state.pulse_width_s * 1e6;
    }
    beam.azimuth_rad = degToRad(state.azimuth_deg);
    beam.azimuth_sweep_rad = degToRad(state.azimuth_half_sweep_deg);
    beam.elevation_rad = degToRad(state.elevation_deg);
    beam.elevation_sweep_rad = degToRad(state.elevation_half_sweep_deg);
    const bool is_jammer = emitter.kind == scenario::EmitterKind::jammer;
    beam.function = static_cast<std::uint8_t>(is_jammer                          ? kJam
                                              : state.azimuth_half_sweep_deg > 0 ? kSearch
                                                                                 : kTrack);
    beam.is_off = !state.is_on;
    system.beams.push_back(beam);
    return system;
  }

  void writeEmissions(std::size_t platform, double t_s) {
    const std::vector<std::size_t>& emitters = systems_[platform];
    for (std::size_t begin = 0; begin < emitters.size(); begin += kMaxSystems) {
      dis::Emission emission;
      emission.entity = idOf(platform);
      emission.event = ++event_;
      for (std::size_t i = begin; i < std::min(begin + kMaxSystems, emitters.size()); ++i)
        emission.systems.push_back(systemOf(emitters[i], t_s, i));
      write(t_s, emission);
    }
  }

  dis::Transmitter transmitterOf(std::size_t index, double t_s) const {
    const scenario::Emitter& emitter = scenario_.emitters[index];
    const BeamState state = beamStateAt(scenario_, emitter, t_s);
    dis::Transmitter transmitter;
    transmitter.entity = idOf(static_cast<std::size_t>(emitter.platform));
    transmitter.radio = static_cast<std::uint16_t>(index + 1);
    transmitter.state = state.is_on ? 2 : 0;
    transmitter.antenna_m =
        ecefOf(poseOf(scenario_.platforms[static_cast<std::size_t>(emitter.platform)], job_.terrain, t_s));
    transmitter.frequency_hz = static_cast<std::uint64_t>(std::llround(state.frequency_hz));
    transmitter.bandwidth_hz = state.bandwidth_hz;
    transmitter.power_dbm = state.power_dbm;
    return transmitter;
  }

  template <class Pdu>
  void write(double t_s, const Pdu& pdu) {
    Header header;
    const double past_hour = std::fmod(origin_s_ + t_s, 3600) / 3600;
    header.timestamp =
        static_cast<std::uint32_t>(std::llround(past_hour * dis::kTimestampsPerHour) % (1ll << 31)) << 1 |
        (origin_s_ > 0 ? 1u : 0u);
    sink_(t_s, dis::encode(header, pdu));
    ++records_;
  }

  const ExportJob& job_;
  const scenario::Scenario& scenario_;
  const PduSink& sink_;
  double origin_s_ = 0;
  std::vector<Due> due_;
  std::vector<std::vector<double>> times_;  ///< of the platforms' states
  std::vector<Domain> domains_;
  std::vector<std::vector<std::size_t>> systems_;  ///< emitters of each platform, without transmitters
  std::uint16_t event_ = 0;
  long long records_ = 0;
};

}  // namespace

long long writeDis(const ExportJob& job, const PduSink& sink, std::vector<ExportedRow>& rows) {
  return DisWriter(job, sink).run(rows);
}

long long writeCapture(const ExportJob& job, std::ostream& stream, std::vector<ExportedRow>& rows) {
  const double origin_s = originOf(job.scenario);
  if (!(origin_s >= 0 && origin_s + job.scenario.clock.duration_s < kEndOfCaptures_s)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: epoch: {}: captures hold times from 1970 to 2106; export to .acmi, or "
                            "give another epoch, as with --set epoch=2000-01-01T00:00:00Z",
                            job.scenario.file, job.scenario.clock.epoch_utc));
  }
  dis::CaptureWriter capture(stream);
  return writeDis(
      job, [&](double t_s, const std::vector<std::uint8_t>& bytes) { capture.write(origin_s + t_s, bytes); },
      rows);
}

int countChangedMarkings(const scenario::Scenario& scenario) {
  return static_cast<int>(std::count_if(
      scenario.platforms.begin(), scenario.platforms.end(),
      [](const scenario::Platform& platform) { return markingOf(platform.name) != platform.name; }));
}

}  // namespace emscape::interop
