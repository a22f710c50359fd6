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
double voxel_ns(const emfield::FieldPlan& plan, std::size_t channel, int e,
                const std::optional<emfield::IntervalBeam>& beam) {
  const emfield::ChannelPlan& of_channel = plan.channel_plans[channel];
  const Emitter& emitter = plan.scenario->emitters[static_cast<std::size_t>(e)];
  if (of_channel.occupancy_threshold_wm2 > 0) {
    return kPosition_ns * triedPositions(*plan.scenario, emitter, beam->of_sweep,
                                         static_cast<double>(of_channel.occupancy_threshold_wm2));
  }
  if (of_channel.reducesPower()) return kPower_ns;
  const auto& radars = plan.scenario->emitters;
  const auto jammers = std::count_if(radars.begin(), radars.end(), [](const Emitter& other) {
    return other.kind == scenario::EmitterKind::jammer;
  });
  double arcs = 0;
  if (beam) {
    const emfield::IntervalArcs& found = beam->looks.arcs;
    arcs = double(found.directions.size() + found.counts.size() + found.passes.size());
  }
  const std::optional<emfield::ClutterMapTask> map = clutterMapOf(*plan.scenario, emitter);
  const double trips = map ? map->grid.trips.count : 1;
  const bool has_jamming = scenario::needsJammer(plan.channels[channel].quantity);
  return kEcho_ns + (has_jamming ? kJammer_ns * double(jammers) : 0) +
         (emitter.clutter ? kClutter_ns : 0) * trips + kArc_ns * arcs;
}

/// How often in a run the fields of channels are computed anew.
class ChangedSteps {
 public:
  ChangedSteps(const emfield::FieldPlan& plan, const std::vector<double>& times_s)
      : plan_(plan), steps_(double(times_s.size())) {
    const Scenario& scenario = *plan.scenario;
    const bool is_instant = scenario.output.interval.kind == IntervalKind::instant;
    for (const Emitter& emitter : scenario.emitters) {
      const bool moves = movesAt(emitter.platform);
      bool turns = emitter.scan.kind == scenario::ScanKind::victim && movesAt(emitter.scan.victim);
      std::optional<emfield::IntervalBeam> beam;
      bool is_same_sweep = true;
      if (is_instant) {
        turns = turns || scenario::scanCycle_s(emitter.scan) > 0;
      } else if (emitter.enabled) {
        beam = beamOf(scenario, emitter, times_s.front());
        is_same_sweep =
            times_s.size() == 1 || beamOf(scenario, emitter, times_s[1]).of_sweep == beam->of_sweep;
        turns = turns || !is_same_sweep;
      }
      const double switched = std::min(steps_, 1 + 2 * double(emitter.active_s.size()));
      emitters_.push_back({moves, moves || turns, is_same_sweep, switched, std::move(beam)});
    }
  }

  const std::optional<emfield::IntervalBeam>& beam(std::size_t e) const { return emitters_[e].beam; }
  /// Intervals whose sweep is another than that of the one before; the first is one.
  double ofSweep(std::size_t e) const { return emitters_[e].is_same_sweep ? 1 : steps_; }
  /// Steps at which an emitter is elsewhere than at the step before; the first is one.
  double ofPlace(std::size_t e) const { return emitters_[e].moves ? steps_ : 1; }
  /// Steps at which the sum of a channel changes. Beams of radars that follow targets do not turn by
  /// themselves.
  double ofChannel(std::size_t c) const {
    const std::vector<int>& members = plan_.channels[c].emitters;
    const std::vector<emfield::RadarTask>& radars = plan_.channel_plans[c].radars;
    double changed = 1;
    for (std::size_t n = 0; n < members.size(); ++n) {
      const OfEmitter& emitter = emitters_[static_cast<std::size_t>(members[n])];
      const bool follows = n < radars.size() && radars[n].look.kind != emfield::LookKind::held &&
                           plan_.scenario->output.interval.kind == IntervalKind::instant;
      changed =
          std::max({changed, emitter.switched, (follows ? emitter.moves : emitter.changes) ? steps_ : 1});
    }
    for (const int j : plan_.channels[c].jammers) {
      const OfEmitter& jammer = emitters_[static_cast<std::size_t>(j)];
      changed = std::max({changed, jammer.switched, jammer.changes ? steps_ : 1});
    }
    return changed;
  }

 private:
  struct OfEmitter {
    bool moves = false, changes = false, is_same_sweep = true;
    double switched = 1;                        ///< steps at which it begins or ends, at most
    std::optional<emfield::IntervalBeam> beam;  ///< of the first interval; none: of an instant
  };

  bool movesAt(int platform) const {
    return platform >= 0 && plan_.scenario->platforms[static_cast<std::size_t>(platform)].track.size() > 1;
  }

  const emfield::FieldPlan& plan_;
  double steps_;
  std::vector<OfEmitter> emitters_;
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
      sums_ns += voxel_ns(plan, c, static_cast<int>(e), beam) * voxels * changed.ofChannel(c);
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
