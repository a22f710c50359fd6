#include "emfield/link/links_of_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "emfield/columns/station.h"
#include "emfield/columns/two_rays.h"
#include "emfield/excess/model_check.h"
#include "emfield/link/path_report.h"
#include "emfield/link/path_verdict.h"
#include "emfield/link/target_view.h"
#include "emfield/radar/receiver.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "emscape/scenario/model/waveform.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::EmitterState;
using scenario::PlacedReceiver;
using scenario::Scenario;

bool isAbove(const GeodeticPosition& a, const GeodeticPosition& b) {
  return geodesicInverse(a.latitude_deg, a.longitude_deg, b.latitude_deg, b.longitude_deg).distance_m <
         kMinPath_m;
}

/// Components of a direction, east-north-up, in the axes of a pose.
Vec3d inAxesOf(const scenario::BeamPose& pose, const Vec3d& direction) {
  return {dot(direction, pose.forward), dot(direction, pose.right), dot(direction, pose.up)};
}

/// A receiver with its antenna's gain towards a wave.
scenario::ReceiverProfile profileOf(const PlacedReceiver& receiver, double pattern_db) {
  scenario::ReceiverProfile profile = receiver;
  profile.gain_dbi = receiver.antenna->gain_dbi + pattern_db;
  return profile;
}

/// Effect (dB) of a receiver's antenna on the power of both rays; the budget includes only the emitter's
/// antenna.
/// @param direct, reflected  amplitudes of the receiver's pattern along the rays
double gainOfBothRays_db(const ReflectedRay& ray, const PathPointing& emitter, double direct,
                         double reflected) {
  const auto power_db = [&ray](double along_direct, double along_reflected) {
    return ratioToDb(static_cast<double>(
        powerOfBothRays(ray, static_cast<float>(along_direct), static_cast<float>(along_reflected))));
  };
  const double of_emitter_db = power_db(emitter.amplitude, emitter.reflected->amplitude);
  if (!std::isfinite(of_emitter_db)) return 0;  // it radiates along neither ray
  return power_db(emitter.amplitude * direct, emitter.reflected->amplitude * reflected) - of_emitter_db;
}

double tunedTo_hz(const PlacedReceiver& receiver, const Emitter& wanted) {
  return receiver.center_frequency_hz > 0 ? receiver.center_frequency_hz : wanted.frequency_hz;
}

/// False only for an emitter outside the band: a quick test for most of many emitters.
bool isNearBand(const Emitter& emitter, const PlacedReceiver& receiver, double tuned_hz) {
  return std::abs(emitter.frequency_hz - tuned_hz) <= emitter.bandwidth_hz + receiver.bandwidth_hz + 1;
}

bool isInBand(const Emitter& emitter, const PlacedReceiver& receiver, double tuned_hz) {
  return bandOverlap(emitter.frequency_hz, emitter.bandwidth_hz, tuned_hz, receiver.bandwidth_hz) > 0;
}

double dbm(double power_w) {
  return ratioToDb(power_w) + 30;
}

bool isPresent(const scenario::Snapshot& snapshot, int platform) {
  return snapshot.platforms[static_cast<std::size_t>(platform)].present;
}

/// Fills the columns of a row that describe its path.
/// @param budget   null: one end is straight above the other, or absent
/// @param to       platform of the other end
/// @param unknown  the path crosses missing terrain
void fillPath(PathRow& row, const scenario::Snapshot& snapshot, int emitter_index, int to,
              const PathBudget* budget, bool unknown) {
  row.has_path = budget != nullptr;
  if (budget == nullptr) {
    const Emitter& emitter = snapshot.scenario->emitters[static_cast<std::size_t>(emitter_index)];
    row.power_density_dbwm2 = unknown ? std::nan("") : -HUGE_VAL;
    row.path = unknown ? std::string("Unknown: terrain is missing on the path.")
                       : fmt::format("No path: '{}' is straight above or below.", emitter.name);
    for (const int end : {to, emitter.platform}) {
      if (isPresent(snapshot, end)) continue;
      row.path = fmt::format(
          "No path: {}.",
          scenario::absenceText(snapshot.scenario->platforms[static_cast<std::size_t>(end)], row.time_s));
    }
    row.verdict = row.path;
    return;
  }
  row.active = budget->active;
  row.range_m = budget->geometry.slant_range_m;
  row.power_density_dbwm2 = budget->active ? budget->find("power_density_dbwm2")->value : -HUGE_VAL;
  row.is_blocked = isBlocked(*budget);
  row.pattern_db = budget->pointing.pattern_db;
  row.off_axis_rad = budget->pointing.off_axis_rad;
  row.verdict = budget->verdict;
  row.path = pathVerdictOf(*budget);
}

/// A warning without figures, which change from time to time as the ends move.
std::string wordsOf(const std::string& warning) {
  std::string words;
  std::copy_if(warning.begin(), warning.end(), std::back_inserter(words),
               [](char c) { return std::strchr("0123456789.-", c) == nullptr; });
  return words;
}

/// Keeps the first warning of each kind of a pair.
void keepWarnings(std::vector<std::string>& all, const std::string& from, const std::string& to,
                  const PathBudget& budget) {
  const std::string ends = fmt::format("'{}' to '{}': ", from, to);
  for (const std::string& warning : budget.warnings) {
    const bool is_known = std::any_of(all.begin(), all.end(), [&](const std::string& known) {
      if (known.compare(0, ends.size(), ends) != 0) return false;
      const std::string other = known.substr(ends.size());
      return other == warning || wordsOf(other) == wordsOf(warning);
    });
    if (!is_known && all.size() < 50) all.push_back(ends + warning);
  }
}

/// True for an error of missing terrain that the scenario allows.
bool isUnknown(const Scenario& scenario, const Error& error) {
  return error.hint() == Hint::allow_missing_terrain && scenario::mayLackTerrain(scenario, false);
}

/// Adds the ends and the time to an error of a path.
[[noreturn]] void refuse(const std::string& from, const std::string& to, double time_s, const Error& error) {
  throw Error(error.code(), error.location(),
              fmt::format("'{}' to '{}' at t = {:g} s: {}", from, to, time_s, error.message()));
}

}  // namespace

ReceiverListener::ReceiverListener(const Scenario& scenario, int receiver, const LinkOptions& options)
    : receiver_(receiver), waves_(scenario.emitters.size()) {
  const PlacedReceiver& own = scenario.placed_receivers[receiver];
  std::vector<int> others;  // on other platforms, not in the band of a link so far
  for (std::size_t e = 0; e < waves_.size(); ++e) {
    waves_[e].model = scenario.emitters[e].propagation.model;
    if (scenario.emitters[e].platform != own.platform) others.push_back(static_cast<int>(e));
  }
  double searched_hz = 0;  // the last frequency at which others were searched for
  for (const int e : options.emitters) {
    const Emitter& wanted = scenario.emitters[e];
    if (wanted.platform == own.platform || !isInBand(wanted, own, tunedTo_hz(own, wanted))) continue;
    links.push_back({e, receiver, {}});
    waves_[e].is_needed = true;
    if (options.model) waves_[e].model = *options.model;
    const double tuned_hz = tunedTo_hz(own, wanted);
    if (tuned_hz == searched_hz) continue;
    searched_hz = tuned_hz;
    const auto isHeard = [&](int other) {
      const Emitter& emitter = scenario.emitters[other];
      if (!isNearBand(emitter, own, tuned_hz) || !isInBand(emitter, own, tuned_hz)) return false;
      waves_[other].is_needed = true;
      return true;
    };
    others.erase(std::remove_if(others.begin(), others.end(), isHeard), others.end());
  }
}

void ReceiverListener::receive(int emitter, const scenario::Snapshot& snapshot,
                               const scenario::Terrain* terrain) {
  const Scenario& scenario = *snapshot.scenario;
  const PlacedReceiver& own = scenario.placed_receivers[receiver_];
  const scenario::ReceiverState& state = snapshot.receivers[receiver_];
  const EmitterState& from = snapshot.emitters[emitter];
  Wave& wave = waves_[emitter];
  wave.is_present = wave.is_unknown = false;
  const bool is_absent = !isPresent(snapshot, own.platform) ||
                         !isPresent(snapshot, scenario.emitters[static_cast<std::size_t>(emitter)].platform);
  if (is_absent || isAbove(from.position, state.position)) {
    wave.budget.reset();
    return;
  }
  try {
    wave.budget = std::make_unique<PathBudget>(powerBudget(
        snapshot, emitter, {state.position, state.height_msl_m}, wave.model, terrain, wave.budget.get()));
  } catch (const Error& error) {
    wave.budget.reset();
    wave.is_unknown = isUnknown(scenario, error);
    if (wave.is_unknown) return;
    refuse(scenario.emitters[emitter].name, own.name, snapshot.time_s, error);
  }
  keepWarnings(warnings, scenario.emitters[emitter].name, own.name, *wave.budget);
  if (const auto& found = wave.budget->excess.steep)
    keepSteepest(steep, scenario.emitters[emitter].name, *found);
  wave.is_present = from.active;
  const Station station = makeStation(state.position, state.height_msl_m, scenario.atmosphere);
  Vec3d ray = lineTo(station, from.position);
  ray.z +=
      refractionLift_m(station, wave.budget->profile.range_m, std::hypot(ray.x, ray.y), from.height_msl_m);
  const auto amplitudeTowards = [&](const Vec3d& direction) {
    return own.antenna->signedAmplitudeTowards(inAxesOf(state.beam, direction), state.beam.steer_u,
                                               state.beam.steer_v);
  };
  const double direct = amplitudeTowards(ray * (1 / length(ray)));
  double pattern_db = 2 * ratioToDb(std::abs(direct));  // of the receiver's antenna
  if (const auto& reflection = wave.budget->excess.reflection) {
    const Vec3f below = reflectedDirection(vecCast<float>(ray), reflection->arrival_sine);
    pattern_db = gainOfBothRays_db(*reflection, wave.budget->pointing, direct,
                                   amplitudeTowards(vecCast<double>(below)));
  }
  wave.power_density_wm2 = dbToRatio(wave.budget->find("power_density_dbwm2")->value);
  wave.area_m2 = inBandArea_m2(scenario.emitters[emitter], profileOf(own, pattern_db));
}

void ReceiverListener::findPowers(const Scenario& scenario, double tuned_hz,
                                  std::vector<double>& powers_w) const {
  const PlacedReceiver& own = scenario.placed_receivers[receiver_];
  for (std::size_t e = 0; e < waves_.size(); ++e) {
    const Wave& wave = waves_[e];
    const Emitter& emitter = scenario.emitters[e];
    const bool may_be_heard = wave.is_present && isNearBand(emitter, own, tuned_hz);
    powers_w[e] = may_be_heard ? wave.power_density_wm2 *
                                     (wave.area_m2 * partInBand(emitter, tuned_hz, own.bandwidth_hz))
                               : 0;
  }
}

void ReceiverListener::add(const scenario::Snapshot& snapshot, const scenario::Terrain* terrain,
                           bool is_last) {
  const Scenario& scenario = *snapshot.scenario;
  const PlacedReceiver& own = scenario.placed_receivers[receiver_];
  for (std::size_t e = 0; e < waves_.size(); ++e) {
    if (waves_[e].is_needed) receive(static_cast<int>(e), snapshot, terrain);
  }
  const double noise_w = receiverNoise_w(own);
  std::vector<double> powers_w(waves_.size());
  double tuned_hz = 0;  // of powers_w
  for (Link& link : links) {
    const Emitter& wanted = scenario.emitters[link.emitter];
    if (tunedTo_hz(own, wanted) != tuned_hz) {
      tuned_hz = tunedTo_hz(own, wanted);
      findPowers(scenario, tuned_hz, powers_w);
    }
    double interference_w = 0, jamming_w = 0;
    for (std::size_t e = 0; e < waves_.size(); ++e) {
      if (static_cast<int>(e) == link.emitter || powers_w[e] == 0) continue;
      interference_w += powers_w[e];
      if (scenario.emitters[e].kind == scenario::EmitterKind::jammer) jamming_w += powers_w[e];
    }
    const Wave& wave = waves_[link.emitter];
    const double signal_w = powers_w[static_cast<std::size_t>(link.emitter)];
    LinkRow row;
    row.time_s = snapshot.time_s;
    fillPath(row, snapshot, link.emitter, own.platform, wave.budget.get(), wave.is_unknown);
    row.active = snapshot.emitters[link.emitter].active;
    row.received_power_dbm = dbm(signal_w);
    row.interference_dbm = dbm(interference_w);
    row.noise_dbm = dbm(noise_w);
    row.sinr_db = ratioToDb(signal_w / (noise_w + interference_w));
    row.jammer_to_signal_db = jamming_w > 0 ? ratioToDb(jamming_w / signal_w) : -HUGE_VAL;
    row.is_received = own.hasThreshold() && signal_w > 0 &&
                      row.received_power_dbm >= own.sensitivity_dbm.value_or(-HUGE_VAL) &&
                      row.sinr_db >= own.required_sinr_db.value_or(-HUGE_VAL);
    link.rows.push_back(std::move(row));
  }
  if (is_last) waves_.clear();
}

std::unique_ptr<TargetScene> TargetScenes::take(const scenario::Snapshot& snapshot) {
  std::unique_ptr<TargetScene> scene;
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      scene = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (!scene) {
    scene = std::make_unique<TargetScene>();
    scene->scenario = std::make_shared<Scenario>(*snapshot.scenario);
    scene->scenario->output.radar_look = scenario::RadarAim::target;
  }
  if (!scene->snapshot.scenario || scene->snapshot.time_s != snapshot.time_s) {
    scene->snapshot = snapshot;
    scene->snapshot.scenario = scene->scenario;
  }
  return scene;
}

void TargetScenes::giveBack(std::unique_ptr<TargetScene> scene) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(scene));
}

TargetWatcher::TargetWatcher(const Scenario& scenario, int radar, int target, const LinkOptions& options)
    : model_(options.model.value_or(scenario.emitters[radar].propagation.model)),
      period_s_(scenario::scanPeriod_s(scenario.emitters[radar].scan)) {
  detection.radar = radar;
  detection.target = target;
  Emitter with_target = scenario.emitters[radar];
  with_target.receiver.swerling = scenario.targets[target].swerling;
  curve_ = detectionCurveOf(with_target);
}

long long TargetWatcher::looksUntil(double time_s) const {
  const double first_s = detection.rows.empty() ? time_s : detection.rows.front().time_s;
  return emfield::looksUntil(first_s, time_s, *period_s_);
}

void TargetWatcher::add(const scenario::Snapshot& snapshot, const scenario::Terrain* terrain,
                        TargetScenes& scenes) {
  const Emitter& radar = snapshot.scenario->emitters[detection.radar];
  const EmitterState& radar_state = snapshot.emitters[detection.radar];
  const scenario::Target& target = snapshot.scenario->targets[detection.target];
  const scenario::PlatformState& carrier = snapshot.platforms[target.platform];
  const bool is_present = carrier.present && isPresent(snapshot, radar.platform);
  DetectionRow row;
  row.time_s = snapshot.time_s;
  row.active = radar_state.active;
  row.rcs_m2 = is_present ? rcsTowards_m2(snapshot, target, detection.radar) : NAN;
  if (radar.clutter) {
    row.radial_speed_mps =
        is_present ? radialSpeed_mps(snapshot, detection.radar, target.platform, terrain) : NAN;
  }

  bool is_unknown = false;
  std::optional<PathBudget> budget;
  if (is_present && !isAbove(radar_state.position, carrier.position)) {
    std::unique_ptr<TargetScene> scene = scenes.take(snapshot);
    Emitter& with_target = scene->scenario->emitters[detection.radar];
    with_target.receiver.swerling = target.swerling;
    with_target.receiver.target_rcs_m2 = row.rcs_m2;
    if (with_target.clutter)
      aimFilter(snapshot, detection.radar, target.platform, terrain, *with_target.clutter);
    try {
      budget = pathBudget(scene->snapshot, detection.radar, {carrier.position, carrier.height_msl_m}, model_,
                          terrain);
    } catch (const Error& error) {
      is_unknown = isUnknown(*snapshot.scenario, error);
      if (!is_unknown) refuse(radar.name, target.name, snapshot.time_s, error);
    }
    with_target = radar;
    scenes.giveBack(std::move(scene));
    if (budget) {
      keepWarnings(warnings, radar.name, target.name, *budget);
      if (const auto& found = budget->excess.steep) keepSteepest(steep, radar.name, *found);
    }
  }
  fillPath(row, snapshot, detection.radar, target.platform, budget ? &*budget : nullptr, is_unknown);
  row.look_pattern_db = budget ? budget->look_pattern_db.value_or(row.pattern_db) : 0;
  const auto valueOr = [&](const char* key, double otherwise) {
    const BudgetTerm* const term = budget ? budget->find(key) : nullptr;
    return term == nullptr ? otherwise : term->value;
  };
  row.snr_db = valueOr("snr_db", -HUGE_VAL);
  row.sclnr_db = valueOr("sclnr_db", row.snr_db);
  row.jammer_to_signal_db = valueOr("jammer_to_signal_db", -HUGE_VAL);
  row.detection_probability = valueOr("detection_probability", 0);
  const long long before = detection.rows.empty() ? 0 : looksUntil(detection.rows.back().time_s);
  const long long looks = period_s_ ? looksUntil(row.time_s) - before : 1;
  row.looks = row.active && is_present ? static_cast<int>(std::min<long long>(looks, 1000000)) : 0;
  missed_ *= std::pow(1 - row.detection_probability, row.looks);
  row.cumulative_probability = 1 - missed_;
  detection.rows.push_back(std::move(row));
}

}  // namespace emscape::emfield
