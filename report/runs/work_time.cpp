#include "report/runs/work_time.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "emfield/geometry/clutter_map.h"
#include "emfield/ground/ground_posts.h"
#include "emfield/solver/beam_positions.h"
#include "emfield/solver/field_plan.h"
#include "emfield/solver/interval_beam.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/units.h"
#include "emscape/emfield/solver/field_solver.h"
#include "propagation/registry/model_info.h"
#include "scenario/scan/scan_sweep.h"
#include "scenario/scan/swept_antenna.h"
#include "scenario/terrain/view.h"

namespace emscape::report {
namespace {

using scenario::Emitter;
using scenario::IntervalKind;
using scenario::Scenario;

// Processor times (ns) of the field's loops, one core of 2020.
constexpr double kColumn_ns = 150;       ///< position and ground of a column of the grid
constexpr double kOutside_ns = 12;       ///< a post beside the finest raster: found by its position
constexpr double kPower_ns = 3;          ///< antenna and sum of a voxel and emitter
constexpr double kEcho_ns = 15;          ///< a radar's look at a voxel
constexpr double kJammer_ns = 8;         ///< a jammer seen by that look
constexpr double kClutter_ns = 60;       ///< clutter beside the echo
constexpr double kMapFace_ns = 30;       ///< a face of the ground in a radar's map of clutter
constexpr double kMapSea_ns = 100;       ///< the same with a sea
constexpr double kMapCell_ns = 45;       ///< a cell of the map, with those beside it
constexpr double kArc_ns = 4;            ///< an arc of looks or passes at a voxel
constexpr double kPosition_ns = 4;       ///< a position of a beam, for occupancy
constexpr double kProduct_ns = 3;        ///< a channel's value
constexpr double kPatternEntry_ns = 10;  ///< an entry of the pattern of an interval, per tilt or dwell
constexpr double kPathsAlone_ns = 1e8;   ///< of a jammer to radars, by a march
constexpr double kArrayEntry = 3;        ///< times as much for the pattern of a phased array

double metresApart(const GeodeticPosition& a, const GeodeticPosition& b) {
  return length(toEcef(a) - toEcef(b));
}

/// The paths from an emitter to the region's columns.
struct Paths {
  double mean_m = 0;
  double outside = 0;  ///< part of their middles that the finest raster does not hold
};

Paths pathsOf(const Scenario& scenario, const scenario::Terrain* terrain, const Emitter& emitter) {
  constexpr int kSamples = 5;
  const volume::Grid grid = emfield::gridOf(scenario.region);
  const GeoFrame frame(grid.frame);
  const scenario::SitePosition& site =
      scenario.platforms[static_cast<std::size_t>(emitter.platform)].track.front().position;
  const bool has_raster = terrain != nullptr && terrain->view().count > 0;
  Paths paths;
  for (int n = 0; n < kSamples * kSamples; ++n) {
    const int i = (2 * (n % kSamples) + 1) * grid.dims.x / (2 * kSamples);
    const int j = (2 * (n / kSamples) + 1) * grid.dims.y / (2 * kSamples);
    const GeodeticPosition column = frame.toGeodetic(grid.center_m(i, j, 0));
    constexpr double kEach = 1.0 / (kSamples * kSamples);
    paths.mean_m += kEach * metresApart({site.latitude_deg, site.longitude_deg, 0},
                                        {column.latitude_deg, column.longitude_deg, 0});
    const double middle_deg =
        site.longitude_deg + std::remainder(column.longitude_deg - site.longitude_deg, 360.0) / 2;
    if (has_raster && std::isnan(terrain->view().rasters[0].heightAt(
                          degToRad((site.latitude_deg + column.latitude_deg) / 2), degToRad(middle_deg))))
      paths.outside += kEach;
  }
  return paths;
}

/// A radar's map of surface clutter; none without one.
std::optional<emfield::ClutterMapTask> clutterMapOf(const Scenario& scenario, const Emitter& radar) {
  const scenario::SitePosition& site =
      scenario.platforms[static_cast<std::size_t>(radar.platform)].track.front().position;
  return emfield::clutterMapTask(
      scenario, radar,
      emfield::makeStation({site.latitude_deg, site.longitude_deg, 0}, 0, scenario.atmosphere));
}

double clutterMap_ns(const Scenario& scenario, const scenario::Terrain* terrain, const Emitter& radar) {
  const std::optional<emfield::ClutterMapTask> task = clutterMapOf(scenario, radar);
  if (!task) return 0;
  const emfield::ClutterGrid& grid = task->grid;
  const auto posts = double(emfield::clutterPostRanges(grid, emfield::postSpacing_m(terrain)).size());
  const double faces = posts + double(grid.ranges) / grid.steps_of_cell;
  return grid.azimuths *
         ((task->surface.has_sea ? kMapSea_ns : kMapFace_ns) * faces + kMapCell_ns * grid.ranges);
}

/// The sweep of an emitter's beam in the interval that begins at a time, and a radar's looks.
emfield::IntervalBeam beamOf(const Scenario& scenario, const Emitter& emitter, double t_s) {
  return emfield::intervalBeam(scenario, emitter, {}, t_s, false, nullptr);
}

double tiltsOf(const scenario::ScanSweep& sweep) {
  std::set<double> tilts;
  for (const scenario::SweptArc& arc : sweep.arcs) tilts.insert(arc.elevation_deg);
  return double(tilts.size());
}

double entryOf(const Emitter& emitter) {
  return emitter.antenna->view().kind == scenario::PatternKind::phased_array ? kArrayEntry : 1;
}

/// Entries of the pattern of an interval, times the positions from which each is computed.
double patternEntries(const Emitter& emitter, const scenario::ScanSweep& sweep, IntervalKind interval) {
  const auto [azimuths, elevations, of_row] = scenario::sweptSizeOf(*emitter.antenna, sweep);
  const double tilts = tiltsOf(sweep);
  const auto arcs = double(sweep.arcs.size());
  // Many arcs of a tilt are one convolution, or runs for the largest values.
  constexpr double kArc = 4.5, kRun = 0.2;
  const bool is_mean = interval == IntervalKind::mean;
  const double together = is_mean ? tilts * azimuths / 64 : arcs * kRun;
  const bool are_many =
      scenario::areManyArcs(sweep.arcs.size(), static_cast<std::size_t>(tilts),
                            is_mean ? scenario::SweptPattern::mean : scenario::SweptPattern::largest);
  const double each = are_many ? std::min(kArc * arcs, together) : kArc * arcs;
  const double of_pattern = of_row * tilts + azimuths * double(sweep.dwells.size());
  return elevations * (entryOf(emitter) * of_pattern + azimuths * each);
}

/// Entries of the tables by which occupancy finds how far a pattern reaches, one table for each tilt.
double reachEntries(const Emitter& emitter, const scenario::ScanSweep& sweep) {
  const auto entries = [](double beamwidth_deg) { return 180 / std::clamp(beamwidth_deg / 8, 0.1, 0.5); };
  if (emfield::stays(sweep)) return 0;
  return 2 * entryOf(emitter) * tiltsOf(sweep) * entries(emitter.antenna->beamwidth_az_deg) *
         entries(emitter.antenna->beamwidth_el_deg);
}

/// Positions of a beam that occupancy tries at a voxel, on average over some ranges: those from which it may
/// be above the threshold; each arc counts as one more. With a reflected ray all are tried, twice.
double triedPositions(const Scenario& scenario, const Emitter& emitter, const scenario::ScanSweep& sweep,
                      double threshold_wm2) {
  if (emfield::stays(sweep)) return 1;
  const double beamwidth_deg = emitter.antenna->beamwidth_az_deg;
  double all = 0;
  for (const scenario::SweptArc& arc : sweep.arcs)
    all += emfield::beamPositions(std::min(arc.width_deg, emfield::kTurn_deg), beamwidth_deg);
  const auto arcs = double(sweep.arcs.size() + sweep.dwells.size());
  if (propagation::modelInfo(emitter.propagation.model).has_reflected_ray) return arcs + 2 * all;
  const double eirp_w = emitter.power_w * dbToRatio(emitter.antenna->gain_dbi - emitter.losses_db);
  const double side_lobes = std::pow(double(emitter.antenna->view().side_lobe_amplitude), 2);
  const double mean_path_m = pathsOf(scenario, nullptr, emitter).mean_m;
  constexpr double kPaths[] = {0.3, 0.7, 1.3}, kHalfPower_db = 3;
  double reached = 0;
  for (const double part : kPaths) {
    const double path_m = part * mean_path_m;
    const double level = threshold_wm2 * 4 * kPi * path_m * path_m / eirp_w;
    if (level < side_lobes || level >= 1) continue;  // always above, or never
    reached +=
        std::min(beamwidth_deg * std::sqrt(-ratioToDb(level) / kHalfPower_db) / emfield::kTurn_deg, 1.0);
  }
  return arcs + all * reached / double(std::size(kPaths));
}

/// Time (ns) of an emitter's contribution to a channel at one voxel.
/// @param jammers  that are active, on average
double voxel_ns(const emfield::FieldPlan& plan, std::size_t channel, int e,
                const std::optional<emfield::IntervalBeam>& beam, double jammers) {
  const emfield::ChannelPlan& of_channel = plan.channel_plans[channel];
  const Emitter& emitter = plan.scenario->emitters[static_cast<std::size_t>(e)];
  if (of_channel.occupancy_threshold_wm2 > 0) {
    return kPosition_ns * triedPositions(*plan.scenario, emitter, beam->of_sweep,
                                         static_cast<double>(of_channel.occupancy_threshold_wm2));
  }
  if (of_channel.reducesPower()) return kPower_ns;
  double arcs = 0;
  if (beam) {
    const emfield::IntervalArcs& found = beam->looks.arcs;
    arcs = double(found.directions.size() + found.counts.size() + found.passes.size());
  }
  const std::optional<emfield::ClutterMapTask> map = clutterMapOf(*plan.scenario, emitter);
  const double trips = map ? map->grid.trips.count : 1;
  const bool has_jamming = scenario::needsJammer(plan.channels[channel].quantity);
  return kEcho_ns + (has_jamming ? kJammer_ns * jammers : 0) + (emitter.clutter ? kClutter_ns : 0) * trips +
         kArc_ns * arcs;
}

/// True if an emitter is active at a step: at its time, or at some time of its interval.
bool isActiveAtStep(const Scenario& scenario, const Emitter& emitter, double t_s) {
  if (!emitter.enabled) return false;
  const double duration_s =
      scenario::intervalDuration_s(scenario.output.interval, emitter.scan, scenario.clock);
  return duration_s > 0 ? !scenario::activeTimes(scenario, emitter, t_s, duration_s).empty()
                        : scenario::isActiveAt(emitter, t_s);
}

/// How often in a run the fields of channels are computed anew.
class ChangedSteps {
 public:
  ChangedSteps(const emfield::FieldPlan& plan, const std::vector<double>& times_s)
      : plan_(plan), steps_(double(times_s.size())) {
    // Of a long clock some steps, each with the one before.
    constexpr std::size_t kMostSteps = 1000;
    const std::size_t stride = 1 + times_s.size() / kMostSteps;
    const Scenario& scenario = *plan.scenario;
    const bool is_instant = scenario.output.interval.kind == IntervalKind::instant;
    for (const Emitter& emitter : scenario.emitters) {
      OfEmitter of;
      of.moves = movesAt(emitter.platform);
      std::vector<double> active_s;  // the first two steps
      for (std::size_t n = 0; n < times_s.size(); n += stride) {
        of.is_active.push_back(isActiveAtStep(scenario, emitter, times_s[n]));
        of.was_active.push_back(
            n > 0 && (stride == 1 ? of.is_active[n - 1] : isActiveAtStep(scenario, emitter, times_s[n - 1])));
        if (of.is_active.back() && active_s.size() < 2) active_s.push_back(times_s[n]);
      }
      bool turns = emitter.scan.kind == scenario::ScanKind::victim && movesAt(emitter.scan.victim);
      if (is_instant) {
        turns = turns || scenario::scanCycle_s(emitter.scan) > 0;
      } else if (emitter.enabled) {
        of.beam = beamOf(scenario, emitter, active_s.empty() ? times_s.front() : active_s.front());
        of.is_same_sweep =
            active_s.size() < 2 || beamOf(scenario, emitter, active_s.back()).of_sweep == of.beam->of_sweep;
        turns = turns || !of.is_same_sweep;
      }
      of.changes = of.moves || turns;
      emitters_.push_back(std::move(of));
    }
    for (std::size_t c = 0; c < plan.channels.size(); ++c) {
      std::vector<bool>& is_changed = channels_.emplace_back();
      for (std::size_t n = 0; n < emitters_.front().is_active.size(); ++n)
        is_changed.push_back(isChanged(c, n));
    }
  }

  const std::optional<emfield::IntervalBeam>& beam(std::size_t e) const { return emitters_[e].beam; }
  /// Intervals whose sweep is another than that of the one before; the first is one.
  double ofSweep(std::size_t e) const {
    const OfEmitter& of = emitters_[e];
    return countOf([&](std::size_t n) { return of.is_active[n] && !(of.is_same_sweep && of.was_active[n]); });
  }
  /// Steps at which an active emitter is elsewhere than when it was last active; the first is one.
  double ofPlace(std::size_t e) const {
    return emitters_[e].moves ? activeSteps(e) : std::min(1.0, activeSteps(e));
  }
  /// Steps at which the sum of a channel changes; the first is one.
  double ofChannel(std::size_t c) const {
    return countOf([&](std::size_t n) { return channels_[c][n]; });
  }
  /// Those of them at which an emitter is active, and a second one.
  double ofMember(std::size_t c, std::size_t e, std::size_t other) const {
    const OfEmitter &one = emitters_[e], &two = emitters_[other];
    return countOf([&](std::size_t n) { return channels_[c][n] && one.is_active[n] && two.is_active[n]; });
  }

 private:
  struct OfEmitter {
    bool moves = false, changes = false, is_same_sweep = true;
    std::vector<bool> is_active, was_active;    ///< at each step that is looked at, and at the one before it
    std::optional<emfield::IntervalBeam> beam;  ///< of the first interval; none: of an instant
  };

  template <class Test>
  double countOf(const Test& test) const {
    const std::size_t seen = emitters_.front().is_active.size();
    std::size_t count = 0;
    for (std::size_t n = 0; n < seen; ++n) count += test(n);
    return double(count) * steps_ / double(seen);
  }
  double activeSteps(std::size_t e) const {
    return countOf([&](std::size_t n) { return emitters_[e].is_active[n]; });
  }
  /// Beams of radars that follow targets do not turn by themselves.
  bool isChanged(std::size_t c, std::size_t n) const {
    if (n == 0) return true;
    const std::vector<int>& members = plan_.channels[c].emitters;
    const std::vector<emfield::RadarTask>& radars = plan_.channel_plans[c].radars;
    const auto changes = [n](const OfEmitter& emitter, bool changes_alone) {
      return emitter.is_active[n] != emitter.was_active[n] || (emitter.is_active[n] && changes_alone);
    };
    for (std::size_t m = 0; m < members.size(); ++m) {
      const OfEmitter& emitter = emitters_[static_cast<std::size_t>(members[m])];
      const bool follows = m < radars.size() && radars[m].look.kind != emfield::LookKind::held &&
                           plan_.scenario->output.interval.kind == IntervalKind::instant;
      if (changes(emitter, follows ? emitter.moves : emitter.changes)) return true;
    }
    const std::vector<int>& jammers = plan_.channels[c].jammers;
    return std::any_of(jammers.begin(), jammers.end(), [&](int j) {
      const OfEmitter& jammer = emitters_[static_cast<std::size_t>(j)];
      return changes(jammer, jammer.changes);
    });
  }

  bool movesAt(int platform) const {
    return platform >= 0 && plan_.scenario->platforms[static_cast<std::size_t>(platform)].track.size() > 1;
  }

  const emfield::FieldPlan& plan_;
  double steps_;
  std::vector<OfEmitter> emitters_;
  std::vector<std::vector<bool>> channels_;  ///< whether each changes at the steps that are looked at
};

}  // namespace

WorkTime workTimeOf(const Scenario& scenario, const scenario::Terrain* terrain,
                    const std::vector<emfield::EmitterChoice>& choices) {
  const emfield::FieldPlan plan =
      emfield::makePlan(std::make_shared<const Scenario>(scenario), emfield::FieldOptions());
  const std::vector<double> times_s = scenario::timesOf(scenario.clock);
  const ChangedSteps changed(plan, times_s);
  const auto voxels = double(scenario.region.dims.count());
  const double columns = double(scenario.region.dims.x) * scenario.region.dims.y;
  const double post_m = emfield::postSpacing_m(terrain) / 2;
  double losses_ns = kColumn_ns * columns, patterns_ns = 0, sums_ns = 0;
  for (std::size_t e = 0; e < scenario.emitters.size(); ++e) {
    const Emitter& emitter = scenario.emitters[e];
    if (!emitter.enabled) continue;
    const propagation::ModelCost& cost = propagation::modelInfo(emitter.propagation.model).cost;
    const Paths paths = pathsOf(scenario, terrain, emitter);
    const double posts = terrain == nullptr || cost.post_ns == 0 ? 0 : paths.mean_m / post_m;
    const double post_ns = cost.post_ns + kOutside_ns * paths.outside;
    double once_ns = (cost.column_ns + post_ns * posts) * columns + 1e9 * cost.emitter_s +
                     (terrain == nullptr ? cost.voxel_ns : cost.voxel_over_terrain_ns) * voxels;
    for (const emfield::EmitterChoice& choice : choices) {
      if (choice.emitter == emitter.name) once_ns += 1e9 * choice.time_s;
    }
    if (plan.needs[e].clutter_map) once_ns += clutterMap_ns(scenario, terrain, emitter);
    // Of jammers of radars alone only the paths to these.
    losses_ns += (plan.needs[e].any ? once_ns : std::min(once_ns, kPathsAlone_ns)) * changed.ofPlace(e);
    const std::optional<emfield::IntervalBeam>& beam = changed.beam(e);
    bool has_power = false;
    for (std::size_t c = 0; c < plan.channels.size(); ++c) {
      const std::vector<int>& members = plan.channels[c].emitters;
      if (std::find(members.begin(), members.end(), static_cast<int>(e)) == members.end()) continue;
      has_power |= plan.channel_plans[c].reducesPower();
      if (plan.channel_plans[c].occupancy_threshold_wm2 > 0)
        patterns_ns += kPatternEntry_ns * reachEntries(emitter, beam->of_sweep);
      const double computed = changed.ofMember(c, e, e);
      double jammers = 0;
      for (std::size_t j = 0; j < scenario.emitters.size() && computed > 0; ++j) {
        if (scenario.emitters[j].kind == scenario::EmitterKind::jammer)
          jammers += changed.ofMember(c, e, j) / computed;
      }
      sums_ns += voxel_ns(plan, c, static_cast<int>(e), beam, jammers) * voxels * computed;
    }
    if (beam && has_power && !emfield::stays(beam->of_sweep)) {
      patterns_ns += kPatternEntry_ns *
                     patternEntries(emitter, beam->of_sweep, scenario.output.interval.kind) *
                     changed.ofSweep(e);
    }
  }
  for (std::size_t c = 0; c < plan.channels.size(); ++c)
    sums_ns += kProduct_ns * voxels * changed.ofChannel(c);
  return {1e-9 * losses_ns, 1e-9 * patterns_ns, 1e-9 * sums_ns};
}

}  // namespace emscape::report
