#include "scenario/file/scenario_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "emscape/scenario/model/quantities.h"
#include "recording/common/ticks.h"
#include "recording/common/track_recorder.h"
#include "scenario/file/far_outside.h"
#include "scenario/file/radar_warnings.h"
#include "scenario/file/warning_of_items.h"
#include "scenario/scan/scan_sampling.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::scenario {
namespace {

void warnOfEmittersWithoutBand(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size() && !scenario.bands.empty(); ++i) {
    const double frequency_hz = scenario.emitters[i].frequency_hz;
    const bool in_band = std::any_of(scenario.bands.begin(), scenario.bands.end(), [&](const Band& band) {
      return frequency_hz >= band.begin_hz && frequency_hz < band.end_hz;
    });
    if (in_band) continue;
    const std::string& name = scenario.emitters[i].name;
    warning.add(sections[i].locationOf("frequency_hz"), name,
                fmt::format("emitter '{}' ({} Hz) is in none of the bands", name, frequency_hz));
  }
  warning.addTo(context.problems);
}

/// Tells of jammers in the band of a radar on their own platform, which do not jam it.
void tellOfOwnJammers(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& jammer = scenario.emitters[i];
    if (jammer.kind != EmitterKind::jammer || !jammer.enabled) continue;
    const auto radar =
        std::find_if(scenario.emitters.begin(), scenario.emitters.end(), [&](const Emitter& other) {
          return other.enabled && other.platform == jammer.platform && isInBandOf(other, jammer);
        });
    if (radar == scenario.emitters.end()) continue;
    warning.add(sections[i].locationOf("platform"), jammer.name,
                fmt::format("jammer '{}' is on the platform of radar '{}', in its band, and left out there: "
                            "coupling between antennas of one platform is not modelled",
                            jammer.name, radar->name));
  }
  warning.addTo(context.problems);
}

/// Warns about jammers outside the bands of all radars, if the output depends on jamming.
void warnOfIdleJammers(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<std::string>& quantities = scenario.output.quantities;
  const bool counts = std::any_of(quantities.begin(), quantities.end(), [](const std::string& quantity) {
    return needsJammer(quantityFromName(quantity));
  });
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size() && counts; ++i) {
    const Emitter& jammer = scenario.emitters[i];
    if (jammer.kind != EmitterKind::jammer || !jammer.enabled) continue;
    const bool jams = std::any_of(scenario.emitters.begin(), scenario.emitters.end(),
                                  [&jammer](const Emitter& radar) { return isInBandOf(radar, jammer); });
    if (jams) continue;
    warning.add(
        sections[i].locationOf("frequency_hz"), jammer.name,
        fmt::format("jammer '{}' ({} Hz, {} Hz wide) is outside the band of every radar: it jams none",
                    jammer.name, jammer.frequency_hz, jammer.bandwidth_hz));
  }
  warning.addTo(context.problems);
}

/// Adds an antenna to a warning if its gain exceeds the directivity of its pattern, or is far below it.
/// @param of_low   the warning of gains far below
/// @param section  of the emitter or receiver
void addGain(WarningOfItems& warning, WarningOfItems& of_low, const std::string& name, const Antenna& antenna,
             const Section& section, const char* consequence) {
  constexpr double kTolerance_db = 0.5, kDirective_dbi = 6, kMaxLoss_db = 12;
  const double directivity_dbi = antenna.directivity_dbi();
  const Section own = section.section("antenna");
  const SourceLocation location = own.has("gain_dbi") ? own.locationOf("gain_dbi") : own.location();
  if (directivity_dbi > kDirective_dbi && antenna.gain_dbi < 0 &&
      antenna.gain_dbi < directivity_dbi - kMaxLoss_db) {
    of_low.add(location, name,
               fmt::format("the gain of {:.2f} dBi is {:.2f} dB below the pattern's directivity, {:.2f} dBi: "
                           "the antenna would lose more than nine tenths of its power; is the sign or the "
                           "unit of the gain right?",
                           antenna.gain_dbi, directivity_dbi - antenna.gain_dbi, directivity_dbi));
  }
  if (antenna.gain_dbi <= directivity_dbi + kTolerance_db) return;
  warning.add(
      location, name,
      fmt::format("the gain of {:.2f} dBi is {:.2f} dB above the pattern's directivity, {:.2f} dBi: the "
                  "antenna would {}; lower the gain, the beamwidths or the side lobes",
                  antenna.gain_dbi, antenna.gain_dbi - directivity_dbi, directivity_dbi, consequence));
}

void warnOfGains(const Scenario& scenario, const Section& root, ParseContext& context) {
  WarningOfItems of_emitters, of_receivers, of_low;
  const std::vector<Section> emitters = root.sections("emitters");
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    const Emitter& emitter = scenario.emitters[i];
    addGain(of_emitters, of_low, emitter.name, *emitter.antenna, emitters[i],
            "radiate more power than it is fed");
  }
  std::size_t placed = 0;
  for (const Section& item : root.sections("receivers")) {
    if (!item.has("platform")) continue;
    const PlacedReceiver& receiver = scenario.placed_receivers[placed++];
    if (item.has("antenna"))
      addGain(of_receivers, of_low, receiver.name, *receiver.antenna, item,
              "receive more power than reaches it");
  }
  of_emitters.addTo(context.problems);
  of_receivers.addTo(context.problems);
  of_low.addTo(context.problems);
}

/// Warns about emitters at frequencies for which the antenna's file does not state its pattern. A file of one
/// frequency is used around it.
void warnOfAntennaFrequencies(const Scenario& scenario, const Section& root, ParseContext& context) {
  constexpr double kAround = 1.25;
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& emitter = scenario.emitters[i];
    const Section antenna = sections[i].section("antenna");
    if (!antenna.has("file")) continue;
    const auto stated_band = context.files.antenna_bands.find(context.resolve(antenna.text("file")));
    if (stated_band == context.files.antenna_bands.end()) continue;
    const StatedBand& band = stated_band->second;
    const bool is_one = band.lowest_hz == band.highest_hz;
    const double around = is_one ? kAround : 1;
    if (emitter.frequency_hz >= band.lowest_hz / around && emitter.frequency_hz <= band.highest_hz * around)
      continue;
    const auto inMegahertz = [](double frequency_hz) { return fmt::format("{:g} MHz", frequency_hz / 1e6); };
    const std::string stated = is_one                        ? inMegahertz(band.lowest_hz)
                               : std::isinf(band.highest_hz) ? inMegahertz(band.lowest_hz) + " and above"
                               : band.lowest_hz == 0
                                   ? "up to " + inMegahertz(band.highest_hz)
                                   : inMegahertz(band.lowest_hz) + " to " + inMegahertz(band.highest_hz);
    warning.add(
        antenna.locationOf("file"), emitter.name,
        fmt::format(
            "emitter '{}' transmits at {}, but the file of its antenna is for {}: gain and pattern may "
            "be others; a file for that frequency states them",
            emitter.name, inMegahertz(emitter.frequency_hz), stated));
  }
  warning.addTo(context.problems);
}

/// Warns about jammers of a few hertz, as 30 for 30e6 Hz, and about those without a bandwidth.
void warnOfNarrowJammers(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems of_narrow, of_none;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& jammer = scenario.emitters[i];
    if (jammer.kind != EmitterKind::jammer || jammer.bandwidth_hz >= kNarrow_hz) continue;
    if (!sections[i].has("bandwidth_hz")) {
      of_none.add(
          sections[i].location(), jammer.name,
          fmt::format("jammer '{}' has no 'bandwidth_hz': it is narrower than any receiver, all its power "
                      "falls into the radars' bands",
                      jammer.name));
    } else if (jammer.bandwidth_hz > 0) {
      of_narrow.add(
          sections[i].locationOf("bandwidth_hz"), jammer.name,
          fmt::format("the signal of jammer '{}' is {:g} Hz wide, narrower than any noise: all its power "
                      "falls into the radars' bands; 'bandwidth_hz' is in hertz",
                      jammer.name, jammer.bandwidth_hz));
    }
  }
  of_narrow.addTo(context.problems);
  of_none.addTo(context.problems);
}

void warnOfLongStep(const Scenario& scenario, const Section& root, ParseContext& context) {
  const Clock& clock = scenario.clock;
  if (!(clock.duration_s > 0) || clock.step_s <= clock.duration_s) return;
  context.problems.addWarning(
      root.locationOf("step_s"),
      fmt::format("'step_s' of {:g} s is longer than 'duration_s', {:g} s: there is one step, at 0 s",
                  clock.step_s, clock.duration_s));
}

/// Warns about fluctuating targets of radars whose method of detection supports only steady ones.
void warnOfTargetsTakenAsSteady(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("targets");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Target& target = scenario.targets[i];
    if (target.swerling == 0) continue;
    std::string radars;
    for (const Emitter& radar : scenario.emitters) {
      if (radar.kind != EmitterKind::radar || radar.receiver.detection != DetectionMethod::albersheim ||
          radar.platform == target.platform)
        continue;
      radars += fmt::format("{}'{}'", radars.empty() ? "" : ", ", radar.name);
    }
    if (radars.empty()) continue;
    warning.add(sections[i].has("swerling") ? sections[i].locationOf("swerling") : sections[i].location(),
                target.name,
                fmt::format("the target '{}' of swerling {} is taken as steady (swerling 0) by radars whose "
                            "'detection' is albersheim: {}",
                            target.name, target.swerling, radars));
  }
  warning.addTo(context.problems);
}

/// Warns at the first of the beams.
void warnOfCoarseSteps(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::optional<UnlitAzimuths> unlit = unlitAzimuths(scenario, scenario.clock);
  if (!unlit) return;
  const bool rotates = scenario.emitters[unlit->first_emitter].scan.kind == ScanKind::rotate;
  const Section scan = root.sections("emitters")[unlit->first_emitter].section("scan");
  context.problems.addWarning(scan.locationOf(rotates ? "rate_rpm" : "rate_deg_s"), unlit->warning);
}

/// Warns about beams that pass between the voxels.
void warnOfNarrowBeams(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& emitter = scenario.emitters[i];
    const std::optional<NarrowBeam> beam = narrowBeam(scenario, emitter);
    if (!beam) continue;
    const Section antenna = sections[i].section("antenna");
    const char* const key = beam->in_azimuth ? "beamwidth_az_deg" : "beamwidth_el_deg";
    warning.add(antenna.has(key) ? antenna.locationOf(key) : antenna.location(), emitter.name,
                narrowBeamText(scenario, emitter, *beam));
  }
  warning.addTo(context.problems);
}

/// Warns about emitters that switch on and off between the steps, of instants.
void warnOfMissedActivity(const Scenario& scenario, const Section& root, ParseContext& context) {
  constexpr double kMaxTimes = 20000;
  const Clock& clock = scenario.clock;
  if (scenario.output.interval.kind != IntervalKind::instant || !(clock.duration_s > 0)) return;
  const std::string text = missedActivityText(
      scenario, timesOf(0, std::min(clock.duration_s, kMaxTimes * clock.step_s), clock.step_s));
  if (!text.empty()) context.problems.addWarning(root.locationOf("step_s"), text);
}

/// Whether values of the output depend on what emitters do in the course of its interval.
bool isOverJamming(const OutputSpec& output) {
  return output.interval.kind != IntervalKind::instant &&
         std::any_of(output.quantities.begin(), output.quantities.end(),
                     [](const std::string& name) { return needsJammer(quantityFromName(name)); });
}

/// Warns about jammers whose beam turns during an interval, in which it is that of its begin, and about
/// several radars whose largest values are added.
void warnOfJammingOverIntervals(const Scenario& scenario, const Section& root, ParseContext& context) {
  if (!isOverJamming(scenario.output)) return;
  const std::vector<Section> sections = root.sections("emitters");
  const bool adds_largest =
      scenario.output.interval.kind == IntervalKind::max_hold &&
      scenario.output.combine == CombineMode::sum &&
      std::count_if(scenario.emitters.begin(), scenario.emitters.end(), [](const Emitter& emitter) {
        return emitter.kind == EmitterKind::radar && emitter.enabled;
      }) > 1;
  WarningOfItems of_beams, of_sums;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& jammer = scenario.emitters[i];
    if (jammer.kind != EmitterKind::jammer || !jammer.enabled) continue;
    const bool jams_any =
        std::any_of(scenario.emitters.begin(), scenario.emitters.end(), [&jammer](const Emitter& radar) {
          return radar.enabled && radar.platform != jammer.platform && isInBandOf(radar, jammer);
        });
    if (!jams_any) continue;
    const bool is_directive = jammer.antenna->view().kind != PatternKind::isotropic;
    if (is_directive && scanCycle_s(jammer.scan) > 0) {
      of_beams.add(sections[i].section("scan").location(), jammer.name,
                   fmt::format("the beam of jammer '{}' moves, but all looks of a radar in an interval meet "
                               "it where it is at the volume's time: 'interval: {{kind: instant}}' and "
                               "smaller steps follow it",
                               jammer.name));
    }
    if (adds_largest && !jammer.active_s.empty()) {
      of_sums.add(sections[i].location(), jammer.name,
                  fmt::format("jammer '{}' is not always active, but jams all looks of an interval of kind "
                              "max_hold for several radars together ('combine: sum'); 'combine: max' or "
                              "per_emitter takes each look by itself",
                              jammer.name));
    }
  }
  of_beams.addTo(context.problems);
  of_sums.addTo(context.problems);
}

/// Warns about platforms of emitters that leave their voxel during an interval, in which they are where they
/// are at its begin.
void warnOfMotionInIntervals(const Scenario& scenario, const Section& root, ParseContext& context) {
  if (scenario.output.interval.kind == IntervalKind::instant) return;
  constexpr double kSamples = 200, kShortest_s = 1e-3;
  const std::vector<Section> sections = root.sections("platforms");
  const Dims& dims = scenario.region.dims;
  const double voxel_m = std::max(scenario.region.size_m.x / dims.x, scenario.region.size_m.y / dims.y);
  WarningOfItems warning;
  for (std::size_t p = 0; p < sections.size(); ++p) {
    const Platform& platform = scenario.platforms[p];
    double interval_s = 0;
    for (const Emitter& emitter : scenario.emitters) {
      if (emitter.enabled && emitter.platform == static_cast<int>(p))
        interval_s =
            std::max(interval_s, intervalDuration_s(scenario.output.interval, emitter.scan, scenario.clock));
    }
    if (!platform.moves() || interval_s == 0) continue;
    const double step_s = std::max(scenario.clock.step_s, scenario.clock.duration_s / kSamples);
    const auto farthestIn_m = [&](double seconds) {
      double farthest_m = 0;
      for (double t_s = 0; t_s <= scenario.clock.duration_s; t_s += step_s) {
        const SitePosition from = pointAt(platform, t_s).position,
                           to = pointAt(platform, t_s + seconds).position;
        farthest_m = std::max(farthest_m, geodesicInverse(from.latitude_deg, from.longitude_deg,
                                                          to.latitude_deg, to.longitude_deg)
                                              .distance_m);
      }
      return farthest_m;
    };
    const double farthest_m = farthestIn_m(interval_s);
    if (!(farthest_m > voxel_m)) continue;
    double fits_s = interval_s;
    for (double moved_m = farthest_m; moved_m > voxel_m && fits_s > kShortest_s;
         moved_m = farthestIn_m(fits_s)) {
      fits_s *= voxel_m / moved_m;
      const double digit_s = std::pow(10, std::floor(std::log10(fits_s)) - 1);  // of two
      fits_s = std::floor(fits_s / digit_s) * digit_s;
    }
    warning.add(
        sections[p].location(), platform.name,
        fmt::format("platform '{}' moves up to {:.4g} m in an interval of {:g} s, but its emitters are "
                    "where they are at the volume's time, as all platforms: an interval of {:g} s "
                    "keeps it within a voxel ({:.4g} m)",
                    platform.name, farthest_m, interval_s, fits_s, voxel_m));
  }
  warning.addTo(context.problems);
}

/// Warns about platforms that are never near the region, with the mistake that may be the cause.
void warnOfPlatformsFarOutside(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("platforms");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const std::vector<TrackPoint>& track = scenario.platforms[i].track;
    std::vector<GeodeticPosition> positions;
    for (const TrackPoint& point : track)
      positions.push_back({point.position.latitude_deg, point.position.longitude_deg, 0});
    const std::string text = farOutsideText(scenario.region, positions);
    if (text.empty()) continue;
    const std::string& name = scenario.platforms[i].name;
    warning.add(sections[i].locationOf(sections[i].has("track") ? "track" : "position"), name,
                fmt::format("platform '{}': {}", name, text));
  }
  warning.addTo(context.problems);
}

struct TrackLeg {
  double length_m, time_s;
};
/// Times of recordings have a resolution.
constexpr double kShortestStep_s = 1e-3;

/// The leg to a point of a track.
TrackLeg legTo(const std::vector<TrackPoint>& track, std::size_t k) {
  checkpoint();
  const SitePosition &from = track[k - 1].position, &to = track[k].position;
  return {
      geodesicInverse(from.latitude_deg, from.longitude_deg, to.latitude_deg, to.longitude_deg).distance_m,
      track[k].t_s - track[k - 1].t_s};
}

/// Warns about tracks whose legs are faster than any object.
void warnOfSpeeds(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("platforms");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const std::vector<TrackPoint>& track = scenario.platforms[i].track;
    for (std::size_t k = 1; k < track.size(); ++k) {
      const TrackLeg leg = legTo(track, k);
      if (leg.length_m <= interop::kFastest_mps * std::max(leg.time_s, interop::kShortestStep_s)) continue;
      const std::string& name = scenario.platforms[i].name;
      warning.add(
          sections[i].locationOf("track"), name,
          fmt::format("the track of '{}' moves {:.4g} km from {:.10g} to {:.10g} s, at {:.4g} km/s: faster "
                      "than any object (10 km/s); are the times in seconds?",
                      name, leg.length_m / 1000, track[k - 1].t_s, track[k].t_s,
                      leg.length_m / leg.time_s / 1000));
      break;
    }
  }
  warning.addTo(context.problems);
}

/// Warns about emitters that are never in or beside the region, as at a mistyped position.
void warnOfEmittersOutside(const Scenario& scenario, const Section& root, ParseContext& context) {
  const GeoFrame frame(scenario.region.origin);
  const Vec3d half = scenario.region.size_m * 0.5;
  const auto distance_m = [&](const TrackPoint& point) {
    checkpoint();
    const Vec3d at = frame.toLocal({point.position.latitude_deg, point.position.longitude_deg, 0});
    return std::hypot(std::max(std::abs(at.x) - half.x, 0.0), std::max(std::abs(at.y) - half.y, 0.0));
  };
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& emitter = scenario.emitters[i];
    double nearest_m = HUGE_VAL;
    for (const TrackPoint& point : scenario.platforms[emitter.platform].track)
      nearest_m = std::min(nearest_m, distance_m(point));
    constexpr double kBeside = 0.01;  // of the region's longer side: at its edge, as in vertical slices
    if (!(nearest_m > kBeside * std::max(scenario.region.size_m.x, scenario.region.size_m.y)) ||
        nearest_m > kFarOutside_m)
      continue;
    warning.add(
        sections[i].locationOf("platform"), emitter.name,
        fmt::format(
            "emitter '{}' is outside the region, {} from it: maps of the region do not show where it is",
            emitter.name,
            nearest_m < 1000 ? fmt::format("{:.0f} m", nearest_m)
                             : fmt::format("{:.1f} km", nearest_m / 1000)));
  }
  warning.addTo(context.problems);
}

/// Warns about lengths that only make sense in kilometres.
void warnOfKilometres(const Scenario& scenario, const Section& root, ParseContext& context) {
  constexpr double kSmallRegion_m = 200, kShortRange_m = 1000;
  const Vec3d& size_m = scenario.region.size_m;
  if (std::max(size_m.x, size_m.y) < kSmallRegion_m) {
    context.problems.addWarning(
        root.section("region").locationOf("size_m"),
        fmt::format("the region is {:g} m by {:g} m: 'size_m' is in metres, not in kilometres", size_m.x,
                    size_m.y));
  }
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& radar = scenario.emitters[i];
    const double range_m =
        radar.waveform ? radar.waveform->instrumented_range_m.value_or(HUGE_VAL) : HUGE_VAL;
    if (range_m >= kShortRange_m) continue;
    warning.add(sections[i].section("waveform").locationOf("instrumented_range_m"), radar.name,
                fmt::format("radar '{}' looks only {:g} m far: 'instrumented_range_m' is in metres, not in "
                            "kilometres",
                            radar.name, range_m));
  }
  warning.addTo(context.problems);
}

/// A time of a track to the rounding within which times are equal.
double roundedTime_s(double t_s) {
  return std::round(t_s / (2 * interop::kTickRounding_s)) * (2 * interop::kTickRounding_s);
}

/// "before 100 s and after 160 s"; empty if [begin, end] is within the track's time.
std::string timesOutside(const std::vector<TrackPoint>& track, const Clock& clock) {
  const double first_s = roundedTime_s(track.front().t_s), last_s = roundedTime_s(track.back().t_s);
  std::string text = first_s > 0 ? fmt::format("before {:.10g} s", first_s) : "";
  if (last_s < clock.duration_s - interop::kTickRounding_s)
    text += fmt::format("{}after {:.10g} s", text.empty() ? "" : " and ", last_s);
  return text;
}

void warnOfTimesOutsideTracks(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("platforms");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Platform& platform = scenario.platforms[i];
    if (!platform.moves() || platform.outside_track == OutsideTrack::hold) continue;
    const double first_s = platform.track.front().t_s, last_s = platform.track.back().t_s;
    const double end_s = scenario.clock.duration_s;
    const std::string outside = timesOutside(platform.track, scenario.clock);
    if (outside.empty()) continue;
    const bool is_never_there = first_s > end_s || last_s < 0;
    warning.add(
        sections[i].locationOf("track"), platform.name,
        fmt::format(
            "the track of '{}' runs from {:.10g} to {:.10g} s, the scenario from 0 to {:.10g} s: {} the "
            "platform is absent, with all that it carries; 'outside: hold' in 'track' keeps "
            "it at the track's ends",
            platform.name, roundedTime_s(first_s), roundedTime_s(last_s), end_s,
            is_never_there ? "always" : outside));
  }
  warning.addTo(context.problems);
}

void warnOfActiveTimesOutside(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& emitter = scenario.emitters[i];
    const bool is_ever_active =
        emitter.active_s.empty() ||
        std::any_of(emitter.active_s.begin(), emitter.active_s.end(), [&](const TimeInterval& active) {
          return active.begin_s <= scenario.clock.duration_s && active.end_s > 0;
        });
    if (is_ever_active || !emitter.enabled) continue;
    warning.add(sections[i].locationOf("active_s"), emitter.name,
                fmt::format("emitter '{}' is active from {:g} s, but the scenario ends at {:g} s: it never "
                            "transmits",
                            emitter.name, emitter.active_s.front().begin_s, scenario.clock.duration_s));
  }
  warning.addTo(context.problems);
}

/// Largest speed over ground (m/s) between the points of a track.
double topSpeed_mps(const Platform& platform) {
  double largest_mps = 0;
  for (std::size_t k = 1; k < platform.track.size(); ++k) {
    const TrackLeg leg = legTo(platform.track, k);
    if (!platform.track[k - 1].gap_after)
      largest_mps = std::max(largest_mps, leg.length_m / std::max(leg.time_s, kShortestStep_s));
  }
  return largest_mps;
}

/// Warns about clutter of moving radars that is left out, and about the spread across a two-way Gaussian beam
/// abeam, v beamwidth / (4 (ln 2)^(1/2)), of which their filters are not told.
void warnOfMovingRadars(const Scenario& scenario, const Section& root, ParseContext& context) {
  constexpr double kFlies_mps = 30, kRounding = 0.99;
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& radar = scenario.emitters[i];
    if (!radar.clutter || !radar.clutter->hasSurface()) continue;
    const double speed_mps = topSpeed_mps(scenario.platforms[static_cast<std::size_t>(radar.platform)]);
    const double spread_mps =
        speed_mps * degToRad(radar.antenna->beamwidth_az_deg) / (4 * std::sqrt(std::log(2.0)));
    const double told_mps = radar.clutter->mti ? radar.clutter->mti->surface_spread_mps : HUGE_VAL;
    const bool spreads = spread_mps * kRounding > std::max(told_mps, 0.05);
    if (!spreads && speed_mps < kFlies_mps) continue;
    std::string text = fmt::format(
        "radar '{}' moves at up to {:.0f} m/s: its clutter has neither an altitude line (the ground straight "
        "below) nor side lobes at other Doppler shifts: detection among those is too good",
        radar.name, speed_mps);
    if (radar.clutter->mti) text += "; the Doppler shift of the ground is taken as compensated by the radar";
    if (spreads) {
      text += fmt::format(
          "; abeam the width of the beam spreads the clutter by {:.2g} m/s: 'link' and 'exposure' compute it "
          "towards their targets, elsewhere 'surface_spread_m_s: {:.2g}' would include it",
          spread_mps, std::hypot(spread_mps, told_mps));
    }
    warning.add(sections[i].section("clutter").location(), radar.name, text);
  }
  warning.addTo(context.problems);
}

/// Reminds once of the emitters that are switched off.
void tellOfDisabledEmitters(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("emitters");
  std::vector<std::string> names;
  SourceLocation first;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (scenario.emitters[i].enabled) continue;
    if (names.empty()) first = sections[i].locationOf("enabled");
    names.push_back("'" + scenario.emitters[i].name + "'");
  }
  if (names.empty()) return;
  constexpr std::size_t kMaxNames = 5;
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kMaxNames));
  context.problems.addWarning(
      first, fmt::format("{} of {} emitters {} disabled: {}{}", names.size(), sections.size(),
                         names.size() == 1 ? "is" : "are", fmt::join(names.begin(), end, ", "),
                         names.size() > kMaxNames ? " and others" : ""));
}

}  // namespace

void addScenarioWarnings(const Scenario& scenario, const Section& root, ParseContext& context) {
  warnOfTimesOutsideTracks(scenario, root, context);
  warnOfActiveTimesOutside(scenario, root, context);
  warnOfMovingRadars(scenario, root, context);
  tellOfDisabledEmitters(scenario, root, context);
  warnOfEmittersWithoutBand(scenario, root, context);
  warnOfIdleJammers(scenario, root, context);
  tellOfOwnJammers(scenario, root, context);
  warnOfJammingOverIntervals(scenario, root, context);
  warnOfMotionInIntervals(scenario, root, context);
  warnOfGains(scenario, root, context);
  warnOfAntennaFrequencies(scenario, root, context);
  addRadarWarnings(scenario, root, context);
  warnOfNarrowJammers(scenario, root, context);
  if (context.read_for == ReadFor::series) warnOfLongStep(scenario, root, context);
  warnOfTargetsTakenAsSteady(scenario, root, context);
  warnOfPlatformsFarOutside(scenario, root, context);
  warnOfSpeeds(scenario, root, context);
  warnOfEmittersOutside(scenario, root, context);
  warnOfKilometres(scenario, root, context);
  if (context.read_for == ReadFor::series) {
    warnOfCoarseSteps(scenario, root, context);
    warnOfNarrowBeams(scenario, root, context);
    warnOfMissedActivity(scenario, root, context);
  }
}

}  // namespace emscape::scenario
