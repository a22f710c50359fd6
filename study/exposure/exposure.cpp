#include "emscape/study/exposure/exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "emfield/excess/clutter_text.h"
#include "emfield/excess/model_check.h"
#include "emfield/link/target_view.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/scenario/model/waveform.h"
#include "emscape/volume/dense_volume.h"
#include "scenario/scan/scan_sampling.h"
#include "study/maps/causes.h"
#include "study/maps/warnings.h"

namespace emscape::study {
namespace {

using scenario::EmitterKind;
using scenario::Quantity;

/// Number of track positions solved together. Fixed emitters have one geometry for all; the geometry of
/// moving emitters is computed for all positions at each time.
constexpr std::size_t kPositions = 32;

/// @throws Error (usage)
void checkRequest(const scenario::Scenario& scenario, const ExposureRequest& request) {
  const scenario::QuantityInfo& quantity = scenario::info(request.quantity);
  if (request.times_s.empty()) throw Error(ErrorCode::usage, "an exposure needs a time");
  if (quantity.categorical) {
    throw Error(ErrorCode::usage,
                fmt::format("quantity '{}' is an index; an exposure asks for a level", quantity.name));
  }
  const scenario::Platform& platform = scenario.platforms[request.platform];
  if (std::none_of(request.times_s.begin(), request.times_s.end(),
                   [&](double t_s) { return platform.isPresentAt(t_s); })) {
    throw Error(ErrorCode::usage, scenario::absenceText(platform, request.times_s.front()) +
                                      (request.times_s.size() > 1 ? "; likewise at all other times" : ""));
  }
  if (request.target && scenario.targets[*request.target].platform != request.platform) {
    throw Error(
        ErrorCode::usage,
        fmt::format("target '{}' is on platform '{}', not on '{}'", scenario.targets[*request.target].name,
                    scenario.platforms[scenario.targets[*request.target].platform].name, platform.name));
  }
}

ExposureState stateOf(double value, double threshold) {
  return std::isnan(value)    ? ExposureState::unknown
         : value >= threshold ? ExposureState::reached
                              : ExposureState::below;
}

class Track {
 public:
  Track(const scenario::Scenario& scenario, scenario::TerrainPtr terrain, const ExposureRequest& request,
        emfield::FieldOptions options)
      : request_(request), terrain_(std::move(terrain)), options_(std::move(options)) {
    auto own = std::make_shared<scenario::Scenario>(scenario);
    own->output.quantities = {scenario::info(request.quantity).name};
    own->output.radar_look = request.look;
    own->output.interval = {};
    if (own->output.combine != scenario::CombineMode::max) own->output.combine = scenario::CombineMode::sum;
    scenario_ = own;
    finds_causes_ =
        hasCauses(request.quantity) &&
        std::none_of(own->emitters.begin(), own->emitters.end(), [](const scenario::Emitter& emitter) {
          return emitter.propagation.model == propagation::PropagationModel::parabolic_equation;
        });
    options_.quantities.clear();
    options_.also_per_emitter = true;
    options_.allow_missing_terrain = scenario::mayLackTerrain(*own, true);
    options_.keep_partly_unknown = true;
    const std::vector<emfield::Channel> channels =
        emfield::channelsOf(*own, own->output.quantities, scenario::CombineMode::per_emitter);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const bool is_alone = channels[c].emitters.size() == 1;
      if (!is_alone || isOwn(channels[c].emitters.front())) continue;
      emitters.push_back(channels[c].emitters.front());
      channels_.push_back(c + 1);  // after that of all together
    }
  }

  /// Rows of some times, whose field values are solved together.
  void addRows(std::size_t begin, std::size_t end, std::vector<ExposureRow>& rows,
               const ProgressSink& progress) {
    std::vector<scenario::Snapshot> snapshots;
    for (std::size_t t = begin; t < end; ++t) {
      snapshots.push_back(scenario::instantAt(scenario_, terrain_.get(), request_.times_s[t]));
    }
    auto surface = std::make_shared<emfield::Surface>();
    surface->width = static_cast<int>(snapshots.size());
    surface->height = 1;
    surface->reference = emfield::HeightReference::mean_sea_level;
    surface->heights_m = {0};
    for (const scenario::Snapshot& snapshot : snapshots) {
      const scenario::PlatformState& state = snapshot.platforms[request_.platform];
      surface->positions.push_back({state.position.latitude_deg, state.position.longitude_deg});
      surface->offsets_m.push_back(static_cast<float>(state.height_msl_m));
    }
    emfield::FieldOptions on_track = options_;
    on_track.surface = surface;
    emfield::FieldSolver solver(scenario_, terrain_, on_track);
    for (std::size_t p = 0; p < snapshots.size(); ++p) {
      if (progress) {
        progress("track", static_cast<double>(begin + p) / static_cast<double>(request_.times_s.size()));
      }
      scenario::Snapshot& snapshot = snapshots[p];
      for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
        if (!counts(static_cast<int>(e))) snapshot.emitters[e].active = false;
      }
      if (request_.target) snapshot.scenario = withTarget(snapshot);
      solver.update(snapshot);
      rows.push_back(rowOf(snapshot, solver, p));
    }
    emfield::SteepGrounds now;
    addOnce(warnings_, solver.warnings(&now));
    emfield::keepSteepest(steep_, now);
  }

  std::set<std::string> warnings() const {
    std::set<std::string> all = warnings_;
    addOnce(all, emfield::steepGroundWarnings(steep_));
    return all;
  }

  std::vector<int> emitters;  ///< with a separate value

 private:
  bool isOwn(int emitter) const {
    return scenario_->emitters[static_cast<std::size_t>(emitter)].platform == request_.platform;
  }
  /// Whether an emitter is included: those on the platform only as jammers of radars.
  bool counts(int emitter) const {
    const bool jams = scenario_->emitters[static_cast<std::size_t>(emitter)].kind == EmitterKind::jammer &&
                      scenario::needsJammer(request_.quantity);
    return jams || !isOwn(emitter);
  }

  /// The scenario with the cross section, fluctuation and radial speed of the request's target, by radar.
  std::shared_ptr<const scenario::Scenario> withTarget(const scenario::Snapshot& snapshot) const {
    const scenario::Target& target = scenario_->targets[*request_.target];
    auto seen = std::make_shared<scenario::Scenario>(*scenario_);
    for (std::size_t e = 0; e < seen->emitters.size(); ++e) {
      scenario::Emitter& emitter = seen->emitters[e];
      const int radar = static_cast<int>(e);
      if (emitter.kind != EmitterKind::radar || isOwn(radar)) continue;
      emitter.receiver.target_rcs_m2 = emfield::rcsTowards_m2(snapshot, target, radar);
      emitter.receiver.swerling = target.swerling;
      if (emitter.clutter)
        emfield::aimFilter(snapshot, radar, target.platform, terrain_.get(), *emitter.clutter);
    }
    return seen;
  }

  ExposureRow rowOf(const scenario::Snapshot& snapshot, const emfield::FieldSolver& solver,
                    std::size_t index) const {
    const scenario::PlatformState& state = snapshot.platforms[request_.platform];
    const auto valueOf = [&](std::size_t channel) {
      const auto volume = solver.volumes()[channel].host();
      const bool is_valid = volume->first_valid_k.empty() || volume->first_valid_k[index] == 0;
      return is_valid ? static_cast<double>(volume->values[index]) : NAN;
    };
    ExposureRow row;
    row.time_s = snapshot.time_s;
    if (!state.present) {
      row.latitude_deg = row.longitude_deg = row.height_msl_m = row.height_agl_m = row.value = NAN;
      row.each.assign(emitters.size(), NAN);
      row.state = ExposureState::absent;
      return row;
    }
    row.latitude_deg = state.position.latitude_deg;
    row.longitude_deg = state.position.longitude_deg;
    row.height_msl_m = state.height_msl_m;
    const double ground_m =
        terrain_ == nullptr ? 0
                            : static_cast<double>(terrain_->heightMsl_m(row.latitude_deg, row.longitude_deg));
    row.height_agl_m = state.height_msl_m - ground_m;
    row.value = valueOf(0);
    const std::vector<std::uint8_t>& partly_unknown = solver.partlyUnknown(0);
    const bool is_bound = !partly_unknown.empty() && partly_unknown[index] != 0;
    if (is_bound && row.value < request_.threshold) row.value = NAN;  // the others may reach it
    row.state = stateOf(row.value, request_.threshold);
    if (row.state == ExposureState::below && finds_causes_) {
      const emfield::PathEnd end{state.position, state.height_msl_m};
      row.decides = causeAt(snapshot, request_.quantity, request_.threshold, end, terrain_.get());
    }
    const double floor = scenario_->output.floor;
    double largest = -HUGE_VAL;
    for (std::size_t n = 0; n < emitters.size(); ++n) {
      const bool is_on = snapshot.emitters[static_cast<std::size_t>(emitters[n])].active;
      const double value = is_on ? valueOf(channels_[n]) : -HUGE_VAL;
      row.each.push_back(value);
      // A target that no echo reveals is reported at the rate of false alarms.
      const double by_chance =
          1.001 * scenario_->emitters[static_cast<std::size_t>(emitters[n])].receiver.pfa;
      const bool has_field =
          value > (request_.quantity == Quantity::detection_probability ? by_chance : floor);
      if (!has_field || value <= largest) continue;
      row.best = static_cast<int>(n);
      largest = value;
    }
    return row;
  }

  const ExposureRequest& request_;
  scenario::TerrainPtr terrain_;
  emfield::FieldOptions options_;
  std::shared_ptr<const scenario::Scenario> scenario_;
  std::vector<std::size_t> channels_;  ///< of the solver, by emitter
  std::set<std::string> warnings_;
  emfield::SteepGrounds steep_;
  bool finds_causes_ = false;
};

/// Sets the cumulative probabilities of detection.
void accumulate(const scenario::Scenario& scenario, Exposure& exposure) {
  const bool has_looks = exposure.request.quantity == Quantity::detection_probability &&
                         exposure.request.look == scenario::RadarAim::target;
  std::vector<double> missed(exposure.emitters.size(), 1.0);
  const auto passes = [&](ExposureSummary& summary, double never, double time_s) {
    if (has_looks && !summary.cumulative_first_s && 1 - never >= exposure.request.threshold)
      summary.cumulative_first_s = time_s;
  };
  for (std::size_t t = 0; t < exposure.rows.size(); ++t) {
    ExposureRow& row = exposure.rows[t];
    double all = 1;
    for (std::size_t n = 0; n < missed.size(); ++n) {
      const std::optional<double> period_s =
          scenario::scanPeriod_s(scenario.emitters[static_cast<std::size_t>(exposure.emitters[n])].scan);
      long long looks = 1;
      if (period_s) {
        const double first_s = exposure.rows.front().time_s;
        looks = emfield::looksUntil(first_s, row.time_s, *period_s);
        if (t > 0) looks -= emfield::looksUntil(first_s, exposure.rows[t - 1].time_s, *period_s);
      }
      const double probability = row.each[n] > 0 ? row.each[n] : 0;
      missed[n] *= std::pow(1 - probability, static_cast<double>(looks));
      all *= missed[n];
      passes(exposure.each[n], missed[n], row.time_s);
    }
    row.cumulative_probability = has_looks ? 1 - all : NAN;
    passes(exposure.together, all, row.time_s);
  }
  for (std::size_t n = 0; n < missed.size(); ++n) {
    exposure.each[n].cumulative_probability = has_looks ? 1 - missed[n] : NAN;
  }
  exposure.together.cumulative_probability = exposure.rows.back().cumulative_probability;
}

/// Statistics of a value over time.
template <class ValueOf>
ExposureSummary summaryOf(const std::string& name, const Exposure& exposure, const ValueOf& valueOf) {
  const std::vector<ExposureRow>& rows = exposure.rows;
  ExposureSummary summary;
  summary.name = name;
  summary.max = NAN;
  double reached_s = 0, unknown_s = 0, all_s = 0, gap_s = 0;
  for (std::size_t t = 0; t < rows.size(); ++t) {
    const double value = valueOf(rows[t]);
    if (std::isfinite(value) && !(value <= summary.max)) {
      summary.max = value;
      summary.max_time_s = rows[t].time_s;
    }
    const bool is_alone = rows.size() == 1;  // a single time represents the whole time
    if (rows[t].state == ExposureState::absent) {
      gap_s = 0;
      continue;
    }
    const double length_s = is_alone ? 1 : t + 1 < rows.size() ? rows[t + 1].time_s - rows[t].time_s : 0;
    all_s += length_s;
    const ExposureState state = stateOf(value, exposure.request.threshold);
    if (state == ExposureState::reached) {
      reached_s += length_s;
      if (!summary.first_s) summary.first_s = rows[t].time_s;
    }
    if (state == ExposureState::unknown) unknown_s += length_s;
    gap_s = state == ExposureState::below && !is_alone ? gap_s + length_s : 0;
    summary.longest_gap_s = std::max(summary.longest_gap_s, gap_s);
  }
  summary.unknown_fraction = all_s > 0 ? unknown_s / all_s : 0;
  summary.fraction = unknown_s < all_s ? reached_s / (all_s - unknown_s) : NAN;
  return summary;
}

/// Warning about time steps in which a beam may pass the platform unnoticed.
std::optional<std::string> scanWarning(const scenario::Scenario& scenario, const Exposure& exposure) {
  if (exposure.request.look != scenario::RadarAim::scan || exposure.rows.size() < 2) return std::nullopt;
  double step_s = 0;
  for (std::size_t t = 1; t < exposure.rows.size(); ++t) {
    step_s = std::max(step_s, exposure.rows[t].time_s - exposure.rows[t - 1].time_s);
  }
  for (const int e : exposure.emitters) {
    const scenario::Emitter& emitter = scenario.emitters[static_cast<std::size_t>(e)];
    const std::optional<double> period_s = scenario::scanPeriod_s(emitter.scan);
    if (period_s && step_s > *period_s / 2) {
      return fmt::format(
          "'{}' passes the platform every {:.3g} s; steps of {:g} s miss passes: smaller --times, or --look "
          "target",
          emitter.name, *period_s, step_s);
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<int> targetOn(const scenario::Scenario& scenario, int platform) {
  const auto found =
      std::find_if(scenario.targets.begin(), scenario.targets.end(),
                   [&](const scenario::Target& target) { return target.platform == platform; });
  if (found == scenario.targets.end()) return std::nullopt;
  return static_cast<int>(found - scenario.targets.begin());
}

Exposure computeExposure(const std::shared_ptr<const scenario::Scenario>& scenario,
                         const scenario::TerrainPtr& terrain, const ExposureRequest& request,
                         emfield::FieldOptions options, const ProgressSink& progress) {
  checkRequest(*scenario, request);
  Exposure exposure;
  exposure.request = request;
  exposure.scenario = scenario->name;
  exposure.title = titleOf(*scenario);
  exposure.platform = scenario->platforms[request.platform].name;
  exposure.unit = scenario::info(request.quantity).unit;
  exposure.clutter = emfield::clutterText(*scenario);
  if (scenario::needsRadar(request.quantity)) {
    exposure.cross_section = request.target ? fmt::format("that of target '{}' from each radar",
                                                          scenario->targets[*request.target].name)
                                            : "target_rcs_m2 of each radar";
  }
  Track track(*scenario, terrain, request, std::move(options));
  exposure.emitters = track.emitters;
  for (const int e : track.emitters) exposure.names.push_back(scenario->emitters[e].name);
  for (std::size_t begin = 0; begin < request.times_s.size(); begin += kPositions) {
    const std::size_t end = std::min(begin + kPositions, request.times_s.size());
    track.addRows(begin, end, exposure.rows, progress);
  }
  if (progress) progress("track", 1);
  exposure.warnings = warningsOf(*scenario);
  for (const std::string& warning : track.warnings()) exposure.warnings.push_back(warning);
  for (const std::string& warning :
       {scenario::outsideClockText(request.times_s, scenario->clock),
        scenario::absenceText(scenario->platforms[request.platform], request.times_s)}) {
    if (!warning.empty()) exposure.warnings.push_back(warning);
  }
  for (std::size_t n = 0; n < exposure.names.size(); ++n) {
    exposure.each.push_back(
        summaryOf(exposure.names[n], exposure, [n](const ExposureRow& row) { return row.each[n]; }));
    const auto best = std::count_if(exposure.rows.begin(), exposure.rows.end(),
                                    [n](const ExposureRow& row) { return row.best == static_cast<int>(n); });
    exposure.each.back().best_fraction =
        static_cast<double>(best) / static_cast<double>(exposure.rows.size());
  }
  exposure.together = summaryOf("together", exposure, [](const ExposureRow& row) { return row.value; });
  accumulate(*scenario, exposure);
  if (exposure.names.empty()) {
    exposure.warnings.push_back(fmt::format(
        "all {} are on platform '{}' itself, whose own emitters are left out: the value is that of none",
        scenario::needsRadar(request.quantity) ? "radars" : "emitters", exposure.platform));
  }
  const bool has_looks =
      request.quantity == Quantity::detection_probability && request.look == scenario::RadarAim::target;
  for (std::size_t n = 0; n < exposure.emitters.size() && has_looks; ++n) {
    const scenario::Emitter& radar = scenario->emitters[static_cast<std::size_t>(exposure.emitters[n])];
    if (std::string text = scenario::mergedLooksText(radar.name, radar.scan, request.times_s); !text.empty())
      exposure.warnings.push_back(std::move(text));
  }
  if (const std::optional<std::string> warning = scanWarning(*scenario, exposure)) {
    exposure.warnings.push_back(*warning);
  }
  if (std::string text = scenario::missedActivityText(*scenario, request.times_s); !text.empty())
    exposure.warnings.push_back(std::move(text));
  return exposure;
}

}  // namespace emscape::study
