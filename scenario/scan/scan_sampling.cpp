#include "scenario/scan/scan_sampling.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "emscape/base/units.h"
#include "emscape/scenario/model/quantities.h"
#include "emscape/scenario/model/snapshot.h"
#include "scenario/limits.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::scenario {
namespace {

/// Limit of the examined times: longer series have covered all azimuths by then, or repeat themselves.
constexpr double kMaxSampledTimes = 20000;

/// Fraction of 0..range (deg) that is within half a width of one of the azimuths.
/// @param closed  0 and range are the same azimuth
double litShare(std::vector<double> azimuths_deg, double width_deg, double range_deg, bool closed) {
  std::sort(azimuths_deg.begin(), azimuths_deg.end());
  const double half_deg = width_deg / 2;
  double lit_deg = 0, lit_to_deg = 0;
  const auto light = [&](double middle_deg) {
    const double begin_deg = std::max(middle_deg - half_deg, lit_to_deg);
    const double end_deg = std::min(middle_deg + half_deg, range_deg);
    lit_deg += std::max(end_deg - begin_deg, 0.0);
    lit_to_deg = std::max(lit_to_deg, end_deg);
  };
  if (closed) light(azimuths_deg.back() - range_deg);
  for (double azimuth_deg : azimuths_deg) light(azimuth_deg);
  if (closed) light(azimuths_deg.front() + range_deg);
  return std::min(lit_deg / range_deg, 1.0);
}

/// Whether a quantity does not depend on where beams point: the model of a single emitter.
bool isOfAnyBeam(Quantity quantity, const Scenario& scenario) {
  return quantity == Quantity::dominant_model && scenario.emitters.size() == 1;
}

/// Whether the output shows the beams of radars, or of other emitters, in their scan direction at the time.
bool showsScans(const Scenario& scenario) {
  const OutputSpec& output = scenario.output;
  return output.interval.kind == IntervalKind::instant &&
         std::any_of(output.quantities.begin(), output.quantities.end(), [&](const std::string& name) {
           const Quantity quantity = quantityFromName(name);
           const bool is_of_target = quantity == Quantity::jammer_to_signal_db ||
                                     quantity == Quantity::burn_through_margin_db ||
                                     (needsRadar(quantity) && output.radar_look == RadarAim::target);
           return !is_of_target && !isOfAnyBeam(quantity, scenario);
         });
}

/// A kind of interval that all quantities of an output have.
std::optional<IntervalKind> intervalOf(const OutputSpec& output) {
  for (const IntervalKind kind : {IntervalKind::cumulative, IntervalKind::max_hold, IntervalKind::mean}) {
    const bool has_all =
        std::all_of(output.quantities.begin(), output.quantities.end(),
                    [&](const std::string& name) { return hasInterval(info(quantityFromName(name)), kind); });
    if (has_all) return kind;
  }
  return std::nullopt;
}

/// Planes in which a beam stays where it is while a volume shows it.
struct HeldPlanes {
  bool azimuth = false, elevation = false;
};

HeldPlanes heldPlanes(Quantity quantity, const Scenario& scenario, const Emitter& emitter) {
  const OutputSpec& output = scenario.output;
  if (needsRadar(quantity) && emitter.kind != EmitterKind::radar) return {};
  if (isOfAnyBeam(quantity, scenario)) return {};
  const bool is_instant = output.interval.kind == IntervalKind::instant;
  const bool shows_scan = !needsRadar(quantity) || (is_instant && output.radar_look == RadarAim::scan &&
                                                    quantity != Quantity::jammer_to_signal_db &&
                                                    quantity != Quantity::burn_through_margin_db);
  const bool is_one_time = !(scenario.clock.duration_s >= scenario.clock.step_s);
  if (shows_scan && is_instant && is_one_time) return {true, true};
  if (!shows_scan && isSteered(emitter)) return {};
  switch (emitter.scan.kind) {
    case ScanKind::fixed:
    case ScanKind::victim:
      return {true, true};
    case ScanKind::track:
      return {shows_scan, shows_scan};
    case ScanKind::rotate:
    case ScanKind::sector:
      return {false, true};
    case ScanKind::raster:
    case ScanKind::dwell_list:
      break;
  }
  return {};
}

/// Whether a pattern is weak a beamwidth to either side of its axis: that of a cosecant is not.
bool isPencil(const Antenna& antenna, bool in_azimuth, double width_deg) {
  constexpr double kWeak = 0.316;  // amplitude: -10 dB
  const auto amplitudeAt = [&](double side) {
    const double angle_rad = degToRad(side * width_deg);
    const Vec3d direction = in_azimuth ? Vec3d{std::cos(angle_rad), std::sin(angle_rad), 0}
                                       : Vec3d{std::cos(angle_rad), 0, std::sin(angle_rad)};
    return antenna.amplitudeTowards(direction, 0, 0);
  };
  return width_deg < 90 && amplitudeAt(-1) < kWeak && amplitudeAt(1) < kWeak;
}

/// The beam at the begin of a scenario; level across of one that is turned to other platforms.
BeamPose firstPose(const Scenario& scenario, const Emitter& emitter) {
  const ScanSpec& scan = emitter.scan;
  if (scan.kind == ScanKind::victim || scan.kind == ScanKind::track) return platformAxes({0, 0, 0});
  const TrackPoint at = pointAt(scenario.platforms[static_cast<std::size_t>(emitter.platform)], 0);
  const BeamPose axes =
      platformAxes({at.heading_deg.value_or(0), at.pitch_deg.value_or(0), at.roll_deg.value_or(0)});
  const BeamDirection beam = beamAt(scan, 0);
  return aimed(beam.electronic ? aimed(axes, scan.azimuth_deg, scan.elevation_deg) : axes, beam.azimuth_deg,
               beam.elevation_deg);
}

/// Emitters whose beams are alike.
struct Beams {
  double width_deg = 0;
  ScanSampling sampling;
  std::vector<std::string> names;

  bool isLike(double other_width_deg, const ScanSampling& other) const {
    return width_deg == other_width_deg && sampling.step_deg == other.step_deg &&
           sampling.lit_share == other.lit_share;
  }
  std::string text(double step_s) const {
    const bool is_one = names.size() == 1;
    return fmt::format(
        "the {} of '{}', {:.3g} deg wide, {} {:.4g} deg in a step of {} s: of {} azimuths {} are ever "
        "lit",
        is_one ? "beam" : "beams", fmt::join(names, "', '"), width_deg, is_one ? "sweeps" : "sweep",
        sampling.step_deg, step_s, is_one ? "its" : "their",
        sampling.lit_share < 0.01 ? "below 1 %" : fmt::format("{:.0f} %", 100 * sampling.lit_share));
  }
};

/// An emitter's activity and the times at which it is looked at.
struct ActivitySampling {
  double share = 0;              ///< of the time, active
  double share_of_times = 0;     ///< active
  int parts = 0, missed = 0;     ///< times of activity and pauses; those without any of the times
  double shortest_s = HUGE_VAL;  ///< of these parts
  bool missesActivity = false;   ///< a time of activity is missed, not only pauses
};

ActivitySampling activitySampling(const Scenario& scenario, const Emitter& emitter,
                                  const std::vector<double>& times_s) {
  const double first_s = times_s.front(), last_s = times_s.back();
  const std::vector<TimeInterval> active = activeTimes(scenario, emitter, first_s, last_s - first_s);
  ActivitySampling sampling;
  const auto add = [&](double begin_s, double end_s, bool is_active) {
    if (!(begin_s < end_s)) return;
    if (is_active) sampling.share += (end_s - begin_s) / (last_s - first_s);
    ++sampling.parts;
    if (begin_s > first_s && end_s < last_s)
      sampling.shortest_s = std::min(sampling.shortest_s, end_s - begin_s);
    const auto time = std::lower_bound(times_s.begin(), times_s.end(), begin_s);
    const bool is_met = time != times_s.end() && (*time < end_s || end_s == last_s);
    if (is_met) return;
    ++sampling.missed;
    sampling.missesActivity = sampling.missesActivity || is_active;
  };
  double before_s = first_s;
  for (const TimeInterval& time : active) {
    add(before_s, time.begin_s, false);
    add(time.begin_s, time.end_s, true);
    before_s = time.end_s;
  }
  add(before_s, last_s, false);
  const auto met = std::count_if(times_s.begin(), times_s.end(), [&](double t_s) {
    const auto holds = [t_s](const TimeInterval& time) { return t_s >= time.begin_s && t_s < time.end_s; };
    return t_s < last_s ? std::any_of(active.begin(), active.end(), holds) : isActiveAt(emitter, t_s);
  });
  sampling.share_of_times = static_cast<double>(met) / static_cast<double>(times_s.size());
  return sampling;
}

}  // namespace

std::string missedActivityText(const Scenario& scenario, const std::vector<double>& times_s) {
  constexpr int kMany = 20;
  constexpr double kSame = 0.02;
  if (times_s.size() < 2) return "";
  std::string text, alike;
  for (const Emitter& emitter : scenario.emitters) {
    if (!emitter.enabled || emitter.active_s.empty()) continue;
    const ActivitySampling sampling = activitySampling(scenario, emitter, times_s);
    const bool is_fair =
        sampling.parts >= kMany && std::abs(sampling.share - sampling.share_of_times) <= kSame;
    if (sampling.missed == 0 || is_fair) continue;
    if (!text.empty()) {
      alike += fmt::format("{}'{}'", alike.empty() ? "; likewise " : ", ", emitter.name);
      continue;
    }
    text = fmt::format(
        "emitter '{}' switches on and off between the times: from {:g} to {:g} s it radiates {:.0f} % of the "
        "time, and at {:.0f} % of the {} times; steps of {:g} s or less meet each of its {}",
        emitter.name, times_s.front(), times_s.back(), 100 * sampling.share, 100 * sampling.share_of_times,
        times_s.size(), sampling.shortest_s, sampling.missesActivity ? "active times" : "pauses");
  }
  return text + alike;
}

std::optional<ScanSampling> scanSampling(const ScanSpec& scan, double beamwidth_az_deg, const Clock& clock) {
  const bool rotates = scan.kind == ScanKind::rotate;
  if (!rotates && scan.kind != ScanKind::sector && scan.kind != ScanKind::raster) return std::nullopt;
  const double last = std::floor(clock.duration_s / clock.step_s + 1e-9);
  if (last < 1) return std::nullopt;
  ScanSampling sampling;
  sampling.step_deg = clock.step_s * (rotates ? 6 * std::abs(scan.rate_rpm) : scan.rate_deg_s);
  std::vector<double> azimuths_deg;
  const double left_deg = rotates ? 0 : scan.azimuth_deg - scan.width_deg / 2;
  for (double i = 0; i <= std::min(last, kMaxSampledTimes); ++i) {
    azimuths_deg.push_back(beamAt(scan, i * clock.step_s).azimuth_deg - left_deg);
  }
  sampling.lit_share =
      litShare(std::move(azimuths_deg), beamwidth_az_deg, rotates ? 360 : scan.width_deg, rotates);
  return sampling;
}

bool leavesGaps(const ScanSampling& sampling, double beamwidth_az_deg) {
  constexpr double kAll = 0.995;  // shares are printed in whole percent
  return sampling.step_deg > beamwidth_az_deg / 2 && sampling.lit_share < kAll;
}

std::optional<UnlitAzimuths> unlitAzimuths(const Scenario& scenario, const Clock& clock) {
  if (!showsScans(scenario)) return std::nullopt;
  const std::vector<Emitter>& emitters = scenario.emitters;
  std::vector<Beams> beams;
  UnlitAzimuths unlit;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    if (!emitters[e].enabled) continue;
    const double width_deg = emitters[e].antenna->beamwidth_az_deg;
    const auto sampling = scanSampling(emitters[e].scan, width_deg, clock);
    if (!sampling || !leavesGaps(*sampling, width_deg)) continue;
    if (beams.empty()) unlit.first_emitter = e;
    auto alike = std::find_if(beams.begin(), beams.end(),
                              [&](const Beams& other) { return other.isLike(width_deg, *sampling); });
    if (alike == beams.end()) alike = beams.insert(beams.end(), {width_deg, *sampling, {}});
    alike->names.push_back(emitters[e].name);
  }
  if (beams.empty()) return std::nullopt;
  for (const Beams& alike : beams)
    unlit.warning += (unlit.warning.empty() ? "" : "; ") + alike.text(clock.step_s);
  unlit.warning +=
      ". Smaller steps, or a rate whose steps fall between those of earlier turns, light the others";
  if (const auto kind = intervalOf(scenario.output))
    unlit.warning +=
        fmt::format("; the output's 'interval: {{kind: {}, turns: 1}}' shows what is lit between the steps",
                    toString(*kind));
  return unlit;
}

std::optional<NarrowBeam> narrowBeam(const Scenario& scenario, const Emitter& emitter) {
  constexpr double kOfRegion = 5;
  if (!emitter.enabled) return std::nullopt;
  HeldPlanes held;
  for (const std::string& name : scenario.output.quantities) {
    const HeldPlanes of_quantity = heldPlanes(quantityFromName(name), scenario, emitter);
    held = {held.azimuth || of_quantity.azimuth, held.elevation || of_quantity.elevation};
  }
  const Region& region = scenario.region;
  const Dims& dims = region.dims;
  const double worth_saying_m = std::max(region.size_m.x, region.size_m.y) / kOfRegion;
  const double level_m = std::max(region.size_m.x / dims.x, region.size_m.y / dims.y),
               upright_m = region.size_m.z / dims.z;
  // In a plane, from there each line of centres along an axis that crosses the beam has one in it.
  struct Plane {
    bool in_azimuth;
    double width_deg, from_level_m, from_upright_m;
    double range_m() const { return std::max(from_level_m, from_upright_m); }
  };
  std::vector<Plane> planes;
  /// @param across  unit vector across the beam in the plane, east-north-up
  const auto add = [&](bool in_azimuth, double width_deg, const Vec3d& across) {
    if (!isPencil(*emitter.antenna, in_azimuth, width_deg)) return;
    const double width_rad = degToRad(width_deg);
    planes.push_back({in_azimuth, width_deg, level_m * std::hypot(across.x, across.y) / width_rad,
                      upright_m * std::abs(across.z) / width_rad});
  };
  const BeamPose pose = firstPose(scenario, emitter);
  if (held.azimuth) add(true, emitter.antenna->beamwidth_az_deg, pose.right);
  if (held.elevation) add(false, emitter.antenna->beamwidth_el_deg, pose.up);
  double range_m = 0;  // the ellipse of half power covers a cell of the centres
  for (const Plane& plane : planes) range_m = std::hypot(range_m, plane.range_m());
  if (range_m <= worth_saying_m) return std::nullopt;
  const Plane& plane = *std::max_element(
      planes.begin(), planes.end(), [](const Plane& a, const Plane& b) { return a.range_m() < b.range_m(); });
  const bool is_level = plane.from_level_m > plane.from_upright_m;
  NarrowBeam narrow{plane.in_azimuth, is_level, plane.width_deg, is_level ? level_m : upright_m,
                    range_m,          dims};
  // Of both planes, so that they are at most worth_saying_m together.
  const double other_m = std::sqrt(std::max(range_m * range_m - plane.range_m() * plane.range_m(), 0.0));
  const double wanted_m = worth_saying_m * (planes.size() == 1               ? 1
                                            : other_m < 0.3 * worth_saying_m ? 0.95
                                                                             : 0.7);
  const auto refine = [&](int& count, int given, double from_m) {
    if (from_m <= wanted_m) return;
    const double finer = std::ceil(given * from_m / wanted_m / 10) * 10;
    count = std::max(count, static_cast<int>(std::min(finer, kMaxDim + 1.0)));
  };
  for (const Plane& each : planes) {
    refine(narrow.finer.x, dims.x, each.from_level_m);
    refine(narrow.finer.y, dims.y, each.from_level_m);
    refine(narrow.finer.z, dims.z, each.from_upright_m);
  }
  return narrow;
}

std::string narrowBeamText(const Scenario& scenario, const Emitter& emitter, const NarrowBeam& beam) {
  const Region& region = scenario.region;
  const bool is_everywhere = beam.range_m >= length(region.size_m);
  std::string text = fmt::format(
      "the beam of '{}', {:.3g} deg in {}{}, is narrower than the voxels of {:.4g} m {}: there it "
      "passes between their centres, and the volume has holes",
      emitter.name, beam.width_deg, beam.in_azimuth ? "azimuth" : "elevation",
      beam.in_azimuth == beam.is_level ? ""
      : beam.is_level                  ? " of the antenna, by tilt or roll along the ground"
                                       : " of the antenna, by tilt or roll in height",
      beam.voxel_m,
      is_everywhere ? "in the whole region" : fmt::format("up to {:.3g} km", beam.range_m / 1000));
  const auto addIfItHelps = [&](const std::string& more, const auto& edit) {
    Scenario changed = scenario;
    Emitter of_changed = emitter;
    edit(changed, of_changed);
    const bool helps = !narrowBeam(changed, of_changed);
    if (helps) text += "; " + more;
    return helps;
  };
  const Dims& finer = beam.finer;
  if (std::max({finer.x, finer.y, finer.z}) <= kMaxDim &&
      static_cast<double>(finer.x) * finer.y * finer.z <= kMaxVoxels) {
    addIfItHelps(
        fmt::format("'region: {{dims: [{}, {}, {}]}}' has them no farther than a fifth of the region",
                    beam.finer.x, beam.finer.y, beam.finer.z),
        [&](Scenario& changed, Emitter&) { changed.region.dims = beam.finer; });
  }
  const auto look = [](Scenario& changed, Emitter&) { changed.output.radar_look = RadarAim::target; };
  const auto turn = [](Scenario&, Emitter& turned) {
    turned.scan = {};
    turned.scan.kind = ScanKind::rotate;
    turned.scan.rate_rpm = 12;
  };
  const OutputSpec& output = scenario.output;
  if (emitter.scan.kind == ScanKind::fixed && emitter.kind == EmitterKind::radar) {
    const std::string still =
        fmt::format("a radar with a fixed beam does not turn{}",
                    output.radar_look == RadarAim::target ? ", also with 'radar_look: target'" : "");
    const char* const rotate = "'scan: {kind: rotate, rate_rpm: 12}'";
    if (!addIfItHelps(fmt::format("{}: {} turns it", still, rotate), turn)) {
      addIfItHelps(
          fmt::format("{}: {} and 'output: {{radar_look: target}}' have it on each voxel", still, rotate),
          [&](Scenario& changed, Emitter& turned) {
            turn(changed, turned);
            look(changed, turned);
          });
    }
  }
  const bool has_beam = output.radar_look == RadarAim::scan &&
                        output.interval.kind == IntervalKind::instant &&
                        addIfItHelps("'output: {radar_look: target}' has the beam on each voxel", look);
  const auto kind = intervalOf(output);
  if (!has_beam && kind && output.interval.kind == IntervalKind::instant) {
    addIfItHelps(
        fmt::format("'output: {{interval: {{kind: {}, turns: 1}}}}' has all that it passes", toString(*kind)),
        [&](Scenario& changed, Emitter&) { changed.output.interval.kind = *kind; });
  }
  return text;
}

std::string mergedLooksText(const std::string& radar, const ScanSpec& scan,
                            const std::vector<double>& times_s) {
  const std::optional<double> period_s = scanPeriod_s(scan);
  double step_s = 0;
  for (std::size_t t = 1; t < times_s.size(); ++t) step_s = std::max(step_s, times_s[t] - times_s[t - 1]);
  constexpr double kRounding = 1e-6;
  if (!period_s || step_s <= *period_s * (1 + kRounding)) return "";
  return fmt::format(
      "emitter '{}': up to {:.0f} looks, one every {:g} s, fall between two of the times and count with the "
      "probability at the later one: steps of {:g} s or less take each look by itself",
      radar, std::ceil(step_s / *period_s - kRounding), *period_s, std::floor(*period_s * 1000) / 1000);
}

}  // namespace emscape::scenario
