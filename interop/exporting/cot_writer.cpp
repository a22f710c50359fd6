#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/xml_text.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "interop/exporting/writers.h"
#include "interop/importing/nodes.h"
#include "recording/beams/directions.h"
#include "recording/common/dates.h"

namespace emscape::interop {
namespace {

/// An object is seen for this time (s) after its last position.
constexpr double kStaleAfter_s = 10;

char affiliationOf(const scenario::Platform& platform) {
  switch (platform.side.value_or(scenario::Side::unknown)) {
    case scenario::Side::friendly:
      return 'f';
    case scenario::Side::hostile:
      return 'h';
    case scenario::Side::neutral:
      return 'n';
    case scenario::Side::unknown:
      break;
  }
  return 'u';
}

char dimensionOf(Domain domain) {
  if (domain == Domain::air) return 'A';
  return domain == Domain::sea ? 'S' : 'G';
}

/// An event to write: of a platform, or of an emitter's beam.
struct WrittenEvent {
  double t_s = 0;
  bool is_beam = false;
  std::size_t index = 0;   ///< of the platform or emitter
  std::size_t number = 0;  ///< of its times

  bool operator<(const WrittenEvent& other) const {
    return std::tie(t_s, is_beam, index) < std::tie(other.t_s, other.is_beam, other.index);
  }
};

class CotWriter {
 public:
  CotWriter(const ExportJob& job, const TextSink& sink)
      : job_(job), scenario_(job.scenario), sink_(sink), epoch_s_(epochOf_s(job.scenario)) {}

  long long run(std::vector<ExportedRow>& rows) {
    std::vector<WrittenEvent> events;
    for (std::size_t i = 0; i < scenario_.platforms.size(); ++i) {
      const scenario::Platform& platform = scenario_.platforms[i];
      platform_times_.push_back(timesOfPositions(scenario_, platform, job_.step_s));
      types_.push_back(fmt::format("a-{}-{}", affiliationOf(platform),
                                   dimensionOf(domainOf(scenario_, platform, job_.terrain))));
      for (std::size_t n = 0; n < platform_times_[i].size(); ++n)
        events.push_back({platform_times_[i][n], false, i, n});
    }
    for (std::size_t i = 0; i < scenario_.emitters.size(); ++i) {
      const scenario::Emitter& emitter = scenario_.emitters[i];
      const auto platform = static_cast<std::size_t>(emitter.platform);
      rows.push_back(
          {fmt::format("{{object_name: {}, beam_name: {}}}",
                       quotedPattern(scenario_.platforms[platform].name), quotedPattern(emitter.name)),
           i});
      // Directions are from true north: those of a platform that turns change with it.
      std::vector<double> times = timesOfChanges(scenario_, emitter, job_.step_s);
      if (scenario_.platforms[platform].moves()) {
        times.insert(times.end(), platform_times_[platform].begin(), platform_times_[platform].end());
        std::sort(times.begin(), times.end());
        times.erase(std::unique(times.begin(), times.end()), times.end());
      }
      for (std::size_t n = 0; n < times.size(); ++n) events.push_back({times[n], true, i, n});
      beam_times_.push_back(std::move(times));
    }
    std::sort(events.begin(), events.end());
    for (std::size_t i = 0; i < events.size(); ++i) {
      if (job_.progress && i % 1000 == 0)
        job_.progress("writing events", static_cast<double>(i) / static_cast<double>(events.size()));
      if (events[i].is_beam) {
        writeBeam(events[i]);
      } else {
        writePlatform(events[i]);
      }
    }
    return records_;
  }

 private:
  std::string timeText(double t_s) const { return utcTextOf(epoch_s_ + t_s); }

  void write(const std::string& uid, const std::string& type, double t_s, double stale_s,
             const PoseSample& pose, const std::string& detail) {
    const double height_m = pose.height_msl_m + geoidUndulation_m(pose.latitude_deg, pose.longitude_deg);
    const std::string time = timeText(t_s);
    sink_(fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<event version=\"2.0\" uid=\"{}\" type=\"{}\" "
        "time=\"{}\" "
        "start=\"{}\" stale=\"{}\" how=\"m-s\"><point lat=\"{}\" lon=\"{}\" hae=\"{}\" ce=\"9999999\" "
        "le=\"9999999\"/><detail>{}</detail></event>\n",
        uid, type, time, time, timeText(stale_s), decimalText(pose.latitude_deg, 8),
        decimalText(pose.longitude_deg, 8), decimalText(height_m, 3), detail));
    ++records_;
  }

  static std::string uidOf(const char* kind, std::size_t index) {
    return fmt::format("emscape.{}.{}", kind, index + 1);
  }

  void writePlatform(const WrittenEvent& event) {
    const scenario::Platform& platform = scenario_.platforms[event.index];
    const std::vector<double>& times = platform_times_[event.index];
    const PoseSample pose = poseOf(platform, job_.terrain, event.t_s);
    const Vec3d velocity = velocityAt_mps(platform, job_.terrain, times, event.number);
    const double next_s = event.number + 1 < times.size() ? times[event.number + 1] : event.t_s;
    const bool stands = velocity.x == 0 && velocity.y == 0;
    const double course_deg =
        std::fmod((stands ? pose.heading_deg : radToDeg(std::atan2(velocity.x, velocity.y))) + 360, 360);
    write(uidOf("platform", event.index), types_[event.index], event.t_s, next_s + kStaleAfter_s, pose,
          fmt::format(
              "<contact callsign=\"{}\"/><track course=\"{}\" speed=\"{}\"/><spatial><attitude roll=\"{}\" "
              "pitch=\"{}\" yaw=\"{}\"/></spatial>",
              escapedXml(platform.name), decimalText(course_deg, 2),
              decimalText(std::hypot(velocity.x, velocity.y), 2), decimalText(pose.roll_deg, 3),
              decimalText(pose.pitch_deg, 3), decimalText(pose.heading_deg, 3)));
  }

  /// A beam that is off is not written: it was seen until its last event's stale time.
  void writeBeam(const WrittenEvent& event) {
    const scenario::Emitter& emitter = scenario_.emitters[event.index];
    const BeamState state = beamStateAt(scenario_, emitter, event.t_s);
    if (!state.is_on) return;
    const auto platform = static_cast<std::size_t>(emitter.platform);
    const std::vector<double>& times = beam_times_[event.index];
    const PoseSample pose = poseOf(scenario_.platforms[platform], job_.terrain, event.t_s);
    const dis::BodyAxes axes =
        dis::axesOf(dis::LocalAttitude{pose.heading_deg, pose.pitch_deg, pose.roll_deg}, pose.latitude_deg,
                    pose.longitude_deg);
    const RelativeDirection direction = turned({state.azimuth_deg, state.elevation_deg}, axes, northAt(pose));
    const BeamWidths widths = widthsOf(state);
    const double stale_s = event.number + 1 < times.size()
                               ? times[event.number + 1]
                               : std::max(event.t_s, scenario_.clock.duration_s) + kStaleAfter_s;
    const double azimuth_deg = direction.azimuth_deg;
    write(uidOf("emitter", event.index), "b-m-p-s-p-loc", event.t_s, stale_s, pose,
          fmt::format(
              "<contact callsign=\"{0}\"/><link uid=\"{1}\" relation=\"p-p\" type=\"{2}\"/><sensor "
              "model=\"{0}\" azimuth=\"{3}\" elevation=\"{4}\" fov=\"{5}\" vfov=\"{6}\" range=\"{7}\"/>",
              escapedXml(emitter.name), uidOf("platform", platform), types_[platform],
              decimalText(azimuth_deg < 0 ? azimuth_deg + 360 : azimuth_deg, 3),
              decimalText(direction.elevation_deg, 3), decimalText(widths.azimuth_deg, 3),
              decimalText(widths.elevation_deg, 3), decimalText(drawnRange_m(scenario_), 0)));
  }

  const ExportJob& job_;
  const scenario::Scenario& scenario_;
  const TextSink& sink_;
  double epoch_s_ = 0;
  std::vector<std::vector<double>> platform_times_, beam_times_;
  std::vector<std::string> types_;  ///< of the platforms
  long long records_ = 0;
};

}  // namespace

long long writeCot(const ExportJob& job, const TextSink& sink, std::vector<ExportedRow>& rows) {
  return CotWriter(job, sink).run(rows);
}

}  // namespace emscape::interop
