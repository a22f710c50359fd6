#include <fmt/format.h>

#include "base/text/utc.h"
#include "emscape/base/geodesy/geoid.h"
#include "interop/exporting/writers.h"
#include "interop/importing/nodes.h"
#include "recording/common/dates.h"

namespace emscape::interop {
namespace {

/// Ids of beams follow those of platforms.
constexpr int kFirstBeam = 100001;

const char* platformTypeOf(Domain domain) {
  if (domain == Domain::air) return "aircraft";
  return domain == Domain::sea ? "ship" : "groundvehicle";
}

char identityOf(const scenario::Platform& platform) {
  switch (platform.side.value_or(scenario::Side::unknown)) {
    case scenario::Side::friendly:
      return 'F';
    case scenario::Side::hostile:
      return 'H';
    case scenario::Side::neutral:
      return 'N';
    case scenario::Side::unknown:
      break;
  }
  return 'U';
}

std::string quotedWord(std::string text) {
  for (char& c : text) {
    if (c == '"') c = '\'';
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return "\"" + text + "\"";
}

class AsiWriter {
 public:
  AsiWriter(const ExportJob& job, const TextSink& sink) : job_(job), scenario_(job.scenario), sink_(sink) {}

  long long run(std::vector<ExportedRow>& rows) {
    line("# SIMDIS ASCII scenario, written by Emscape");
    line("Version 24");
    if (const auto epoch_ms = parseUtc_ms(scenario_.clock.epoch_utc)) {
      const std::string year = scenario_.clock.epoch_utc.substr(0, 4);
      line("ReferenceYear " + year);
      begin_s_ = static_cast<double>(*epoch_ms) / 1000 - secondsOfDate(std::stoi(year), 1, 1);
    }
    line("DegreeAngles 1");
    line("CoordSystem \"LLA\"");
    line("ScenarioInfo " + quotedWord(scenario_.name));
    for (std::size_t i = 0; i < scenario_.platforms.size(); ++i) {
      if (job_.progress)
        job_.progress("writing ASI",
                      static_cast<double>(i) / static_cast<double>(scenario_.platforms.size()));
      writePlatform(i);
    }
    // Hosts stand before what they carry.
    for (std::size_t i = 0; i < scenario_.emitters.size(); ++i) {
      writeBeam(i);
      rows.push_back({"{asi_beam: " + quotedPattern(scenario_.emitters[i].name) + "}", i});
    }
    return records_;
  }

 private:
  void line(const std::string& text) { sink_(text + "\n"); }
  std::string timeText(double t_s) const { return decimalText(begin_s_ + t_s, 6); }

  void writePlatform(std::size_t index) {
    const scenario::Platform& platform = scenario_.platforms[index];
    const std::size_t id = index + 1;
    const char* type = platformTypeOf(domainOf(scenario_, platform, job_.terrain));
    line(fmt::format("PlatformID {}", id));
    line(fmt::format("PlatformName {} {}", id, quotedWord(platform.name)));
    line(fmt::format("PlatformType {} \"{}\"", id, type));
    line(fmt::format("PlatformIcon {} \"{}\"", id, type));
    line(fmt::format("PlatformFHN {} {}", id, identityOf(platform)));
    const std::vector<double> times = timesOfPositions(scenario_, platform, job_.step_s);
    for (std::size_t i = 0; i < times.size(); ++i) {
      const PoseSample pose = poseOf(platform, job_.terrain, times[i]);
      const Vec3d velocity = velocityAt_mps(platform, job_.terrain, times, i);
      const double height_m = pose.height_msl_m + geoidUndulation_m(pose.latitude_deg, pose.longitude_deg);
      line(fmt::format("PlatformData {} {} {} {} {} {} {} {} {} {} {}", id, timeText(times[i]),
                       decimalText(pose.latitude_deg, 8), decimalText(pose.longitude_deg, 8),
                       decimalText(height_m, 3), decimalText(pose.heading_deg, 3),
                       decimalText(pose.pitch_deg, 3), decimalText(pose.roll_deg, 3),
                       decimalText(velocity.x, 3), decimalText(velocity.y, 3), decimalText(velocity.z, 3)));
      ++records_;
    }
  }

  void writeBeam(std::size_t index) {
    const scenario::Emitter& emitter = scenario_.emitters[index];
    const std::size_t id = kFirstBeam + index;
    const std::vector<double> times = timesOfChanges(scenario_, emitter, job_.step_s);
    const BeamWidths widths = widthsOf(beamStateAt(scenario_, emitter, 0));
    line(fmt::format("BeamID {} {}", emitter.platform + 1, id));
    line(fmt::format("BeamDesc {} {}", id, quotedWord(emitter.name)));
    line(fmt::format("BeamType {} \"BODY\"", id));
    line(fmt::format("HorzBW {} {}", id, decimalText(widths.azimuth_deg, 3)));
    line(fmt::format("VertBW {} {}", id, decimalText(widths.elevation_deg, 3)));
    std::optional<bool> was_on;
    for (const double t_s : times) {
      const BeamState state = beamStateAt(scenario_, emitter, t_s);
      if (was_on != state.is_on)
        line(fmt::format("BeamOnOffCmd {} {} {}", id, timeText(t_s), state.is_on ? 1 : 0));
      was_on = state.is_on;
      line(fmt::format("BeamDataRAE {} {} {} {} {}", id, timeText(t_s), decimalText(state.azimuth_deg, 3),
                       decimalText(state.elevation_deg, 3), decimalText(drawnRange_m(scenario_), 0)));
      ++records_;
    }
  }

  const ExportJob& job_;
  const scenario::Scenario& scenario_;
  const TextSink& sink_;
  double begin_s_ = 0;  ///< t = 0 in the reference year
  long long records_ = 0;
};

}  // namespace

long long writeAsi(const ExportJob& job, const TextSink& sink, std::vector<ExportedRow>& rows) {
  return AsiWriter(job, sink).run(rows);
}

}  // namespace emscape::interop
