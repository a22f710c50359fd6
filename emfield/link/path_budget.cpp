#include "emscape/emfield/link/path_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text/quantity_text.h"
#include "emfield/channels/products.h"
#include "emfield/columns/station.h"
#include "emfield/columns/two_rays.h"
#include "emfield/excess/elevation_cut.h"
#include "emfield/excess/model_check.h"
#include "emfield/link/path_radar.h"
#include "emfield/link/path_verdict.h"
#include "emfield/radar/detection_losses.h"
#include "emfield/radar/receiver.h"
#include "emscape/base/units.h"
#include "emscape/emfield/solver/field_solver.h"
#include "propagation/registry/model_info.h"
#include "scenario/file/quantity_needs.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::EmitterState;
using scenario::Quantity;
using Kind = BudgetTerm::Kind;

/// Distance of the horizon of a height over a smooth earth at mean sea level.
double smoothHorizon_m(double height_msl_m, double effective_earth_radius_m) {
  return std::sqrt(2 * effective_earth_radius_m * std::max(height_msl_m, 0.0));
}

double elevationOf_rad(const Vec3d& direction) {
  return std::atan2(direction.z, std::hypot(direction.x, direction.y));
}

/// @param ray direction of its start, east-north-up
RayPointing pointingOf(const Emitter& emitter, const scenario::BeamPose& beam, const Vec3d& ray) {
  const Vec3d unit = ray * (1 / length(ray));
  const Vec3d direction{dot(unit, beam.forward), dot(unit, beam.right), dot(unit, beam.up)};
  RayPointing pointing;
  pointing.azimuth_rad = std::atan2(direction.y, direction.x);
  pointing.elevation_rad = std::atan2(direction.z, std::hypot(direction.x, direction.y));
  const double level2 = 1 - beam.steer_u * beam.steer_u - beam.steer_v * beam.steer_v;
  const Vec3d axis{std::sqrt(std::max(level2, 0.0)), beam.steer_u, beam.steer_v};
  pointing.off_axis_rad = std::atan2(length(cross(direction, axis)), dot(direction, axis));
  pointing.amplitude = emitter.antenna->signedAmplitudeTowards(direction, beam.steer_u, beam.steer_v);
  pointing.pattern_db = 20 * std::log10(std::abs(pointing.amplitude));
  return pointing;
}

/// The direct ray and, where there is one, the reflected ray.
/// @param ray  start of the refracted direct ray, east-north-up
PathPointing pointingOf(const Emitter& emitter, const scenario::BeamPose& beam, const Vec3d& ray,
                        const std::optional<propagation::PathReflection>& reflection) {
  PathPointing pointing;
  static_cast<RayPointing&>(pointing) = pointingOf(emitter, beam, ray);
  if (reflection) {
    const Vec3f below = reflectedDirection(vecCast<float>(ray), reflection->depression_sine);
    pointing.reflected = pointingOf(emitter, beam, vecCast<double>(below));
  }
  return pointing;
}

/// The value of a quantity for a power density of one emitter, as in the field's product stage without the
/// floor.
double quantityOf(Quantity quantity, const scenario::Scenario& scenario, int emitter,
                  double power_density_dbwm2) {
  Channel channel;
  channel.quantity = quantity;
  channel.emitters = {emitter};
  const ChannelPlan plan = channelPlan(channel, scenario);
  const double accumulator_db = power_density_dbwm2 + ratioToDb(static_cast<double>(plan.weights.front()));
  return static_cast<double>(plan.product.scale) * accumulator_db + static_cast<double>(plan.product.offset);
}

/// Spreading over the slant range (dB/m2).
double spreading_dbm2(const PathGeometry& geometry) {
  const double distance_m = std::max(geometry.slant_range_m, static_cast<double>(kMinDistance_m));
  return -ratioToDb(4 * kPi * distance_m * distance_m);
}

/// Power density at the path's end with the boresight gain along every ray.
double boresightDensity_dbwm2(const Emitter& emitter, const PathBudget& budget) {
  return ratioToDb(emitter.power_w) - emitter.losses_db + emitter.antenna->gain_dbi +
         spreading_dbm2(budget.geometry) - budget.excess.loss_db;
}

void addRadiatedTerms(const Emitter& emitter, const PathPointing& pointing, std::vector<BudgetTerm>& terms) {
  const double power_dbw = ratioToDb(emitter.power_w);
  terms.push_back({"transmitter_power_dbw", "transmitter power", power_dbw, "dBW",
                   quantityText(emitter.power_w, "W") + " at " + quantityText(emitter.frequency_hz, "Hz")});
  terms.push_back({"transmit_losses_db", "transmit losses", -emitter.losses_db, "dB", ""});
  terms.push_back({"antenna_gain_dbi", "antenna gain, at its maximum", emitter.antenna->gain_dbi, "dBi",
                   emitter.antenna->description});
  terms.push_back(
      {"antenna_pattern_db", "antenna pattern toward the ray", pointing.pattern_db, "dB",
       fmt::format("{:.2f} deg off axis; azimuth {:+.2f}, elevation {:+.2f} deg in the antenna's frame",
                   radToDeg(pointing.off_axis_rad), radToDeg(pointing.azimuth_rad),
                   radToDeg(pointing.elevation_rad))});
  terms.push_back({"eirp_dbw", "EIRP along the ray",
                   power_dbw - emitter.losses_db + emitter.antenna->gain_dbi + pointing.pattern_db, "dBW", "",
                   Kind::sum});
}

void addReceiverTerms(const scenario::Scenario& scenario, int emitter_index, double power_density_dbwm2,
                      std::vector<BudgetTerm>& terms) {
  const Emitter& emitter = scenario.emitters[emitter_index];
  const scenario::ReceiverProfile& receiver = scenario.receivers[scenario.output.receiver];
  const double wavelength = wavelength_m(emitter.frequency_hz);
  const double area_db = ratioToDb(wavelength * wavelength / (4 * kPi));
  const double polarization_db =
      receiver.polarization
          ? ratioToDb(scenario::polarizationFactor(emitter.polarization, *receiver.polarization,
                                                   receiver.cross_polar_isolation_db))
          : 0;
  const double of_one_watt_dbm = quantityOf(Quantity::received_power_dbm, scenario, emitter_index, 0);
  const double antenna_db = receiver.gain_dbi - receiver.losses_db;
  terms.push_back(
      {"isotropic_area_dbm2", "area of an isotropic antenna", area_db, "dBm2", "lambda^2 / (4 pi)"});
  terms.push_back({"receiver_antenna_db", "receiver's antenna gain less losses", antenna_db, "dB",
                   fmt::format("receiver '{}'", receiver.name)});
  terms.push_back({"polarization_db", "polarisation mismatch", polarization_db, "dB",
                   fmt::format("{} to {}", toString(emitter.polarization),
                               receiver.polarization ? toString(*receiver.polarization) : "matched")});
  terms.push_back({"in_band_db", "part of the signal within the receiver's band",
                   of_one_watt_dbm - 30 - area_db - antenna_db - polarization_db, "dB", ""});
  terms.push_back(
      {"received_power_dbm", "received power", of_one_watt_dbm + power_density_dbwm2, "dBm", "", Kind::sum});
  if (!scenario::unmetNeed(Quantity::intercept_margin_db, scenario, scenario.output).empty()) return;
  terms.push_back({"intercept_margin_db", "received power over the receiver's threshold",
                   quantityOf(Quantity::intercept_margin_db, scenario, emitter_index, power_density_dbwm2),
                   "dB", "", Kind::sum});
}

/// Why a radar detects nothing from a range, whatever its echo; empty: it may.
std::string unheardRange(const scenario::Waveform& waveform, double range_m) {
  if (range_m <= waveform.farthestDetection_m()) return "";
  const bool is_instrumented = waveform.instrumented_range_m && range_m > *waveform.instrumented_range_m;
  return fmt::format("beyond the radar's {} range of {:.1f} km",
                     is_instrumented ? "instrumented" : "unambiguous", waveform.farthestDetection_m() / 1000);
}

/// Reasons why a radar detects less from a range than by its echo.
std::vector<std::string> rangeWarnings(const scenario::Waveform& waveform, double range_m) {
  const auto detection = [&](const char* applied) {
    return waveform.limits_detection ? applied
                                     : "detection is computed nevertheless ('limits_detection: false')";
  };
  std::vector<std::string> warnings;
  const double eclipsed = waveform.eclipsedPart(range_m);
  if (eclipsed > 0) {
    const std::string part = eclipsed < 0.01 ? "less than 1 %" : fmt::format("{:.0f} %", 100 * eclipsed);
    warnings.push_back(part + " of the echo arrives while the radar transmits (eclipsed); " +
                       detection("detection is computed with the rest"));
  }
  const std::string unheard = unheardRange(waveform, range_m);
  if (!unheard.empty())
    warnings.push_back("the point is " + unheard + "; " + detection("nothing is detected there"));
  return warnings;
}

/// A warning if clutter above the noise counts as independent from pulse to pulse of those integrated.
std::vector<std::string> steadyClutterWarnings(const Emitter& emitter, const RadarAtPoint& radar) {
  if (!radar.clutter || emitter.clutter->mti || emitter.clutter->independent_samples ||
      emitter.receiver.pulses < 2)
    return {};
  const double to_noise_db =
      ratioToDb(dbToRatio(radar.clutter->surface_to_noise_db) + dbToRatio(radar.clutter->rain_to_noise_db));
  if (!(to_noise_db > 0)) return {};
  return {fmt::format(
      "emitter '{}': clutter is {:.1f} dB above the noise and counts as independent in each of the {} pulses "
      "integrated, as noise does: of clutter that changes more slowly, detection is too good; 'clutter: "
      "{{independent_samples: 1}}' is that of clutter that stands still during these pulses, 'mti' filters "
      "it",
      emitter.name, to_noise_db, emitter.receiver.pulses)};
}

void addClutterTerms(const Emitter& emitter, const RadarAtPoint::Clutter& clutter,
                     std::vector<BudgetTerm>& terms) {
  const auto add = [&terms](const char* key, const char* label, double value, const std::string& note) {
    if (!std::isnan(value)) terms.push_back({key, label, value, "dB", note});
  };
  const auto addClutter = [&](const char* key, const char* label, double to_noise_db, double improvement_db) {
    add(key, label, to_noise_db,
        emitter.clutter->mti
            ? fmt::format("before the filter, which improves the echo by {:.1f} dB", improvement_db)
            : "");
  };
  if (emitter.clutter->hasSurface())
    addClutter("surface_clutter_to_noise_db", "clutter of land and sea over noise",
               clutter.surface_to_noise_db, clutter.surface_improvement_db);
  if (emitter.clutter->rain)
    addClutter("rain_clutter_to_noise_db", "clutter of rain over noise", clutter.rain_to_noise_db,
               clutter.rain_improvement_db);
  if (emitter.clutter->mti) {
    const auto& speed_mps = emitter.clutter->target_radial_speed_mps;
    terms.push_back({"filter_response_db", "filter's response to the target", clutter.response_db, "dB",
                     fmt::format("{}; first blind speed {:.1f} m/s",
                                 speed_mps ? fmt::format("radial speed {:.1f} m/s", *speed_mps)
                                           : std::string("mean of all radial speeds"),
                                 emitter.waveform->firstBlindSpeed_mps(emitter.frequency_hz))});
  }
  terms.push_back({"sclnr_db", "echo over clutter and noise, one pulse", clutter.sclnr_db, "dB",
                   fmt::format("range cell of {:g} m", emitter.clutter->range_cell_m), Kind::sum});
  if (const double loss_db = correlationLossDb(emitter); loss_db > 0) {
    terms.push_back({"clutter_correlation_loss_db", "what clutter counts more than noise", loss_db, "dB",
                     fmt::format("in detection: {} independent samples among {} pulses",
                                 *emitter.clutter->independent_samples, emitter.receiver.pulses)});
  }
}

void addRadarTerms(const scenario::Scenario& scenario, int emitter_index, const RadarAtPoint& radar,
                   double pattern_db, std::vector<BudgetTerm>& terms) {
  const Emitter& emitter = scenario.emitters[emitter_index];
  const scenario::RadarReceiver& receiver = emitter.receiver;
  const bool is_instant = scenario.output.interval.kind == scenario::IntervalKind::instant;
  const char* const look = isFixed(emitter)                                         ? "fixed beam"
                           : scenario.output.radar_look != scenario::RadarAim::scan ? "beam on the target"
                           : is_instant ? "beam where the scan has it"
                                        : "beam as close as the scan brings it in the interval";
  if (radar.look_pattern_db && std::abs(*radar.look_pattern_db - pattern_db) > 0.005) {
    terms.push_back({"look_pattern_db", "antenna pattern of the radar's look at the target",
                     *radar.look_pattern_db, "dB",
                     fmt::format("each way, in place of the {:.2f} dB toward the ray", pattern_db)});
  }
  terms.push_back({"snr_db", "echo's signal-to-noise, one pulse", radar.snr_db, "dB",
                   fmt::format("there and back, {}; target of {:g} m2, noise figure {:g} dB, {}", look,
                               receiver.target_rcs_m2, receiver.noise_figure_db,
                               quantityText(receiver.bandwidth_hz, "Hz")),
                   Kind::sum});
  if (std::isfinite(radar.jammer_to_signal_db)) {
    std::string note = isFixed(emitter) ? "the fixed beam" : "the beam on the target";
    for (const PathJammer& jammer : radar.jamming.jammers) {
      note += fmt::format("; '{}' {:.1f} dB", jammer.name, jammer.to_signal_db);
      if (receiver.side_lobe_blanking)
        note += fmt::format(", {:.0f} % of its pulses blanked", 100 * jammer.blanked_part);
    }
    for (const Emitter& jammer : scenario.emitters) {
      if (jammer.kind != scenario::EmitterKind::jammer) continue;
      const double loss_db = polarizationLossDb(emitter, jammer);
      if (loss_db > 0.05)
        note += fmt::format("; polarisation mismatch of '{}' {:.1f} dB", jammer.name, loss_db);
    }
    terms.push_back({"jammer_to_signal_db", "jamming over the echo", radar.jammer_to_signal_db, "dB", note});
  }
  if (radar.clutter) addClutterTerms(emitter, *radar.clutter, terms);
  const std::string settings = fmt::format("{} pulse{}, Pfa {:g}, Swerling {}", receiver.pulses,
                                           receiver.pulses == 1 ? "" : "s", receiver.pfa, receiver.swerling);
  const DetectionLosses losses = detectionLosses(emitter);
  if (losses.total_db() > 0) {
    terms.push_back({"detection_losses_db", "detection losses", losses.total_db(), "dB",
                     fmt::format("beam shape {:.2f}, CFAR {:.2f}, M-of-N {:.2f}", losses.beam_shape_db,
                                 losses.cfar_db, losses.binary_db)});
  }
  terms.push_back(
      {"required_snr_db",
       fmt::format("of which detection with probability {:g} takes", requiredProbability(receiver)),
       requiredSnrDb(emitter), "dB", settings});
  terms.push_back({"detection_probability", "probability of detection", radar.detection_probability, "",
                   settings, Kind::sum});
}

std::vector<BudgetTerm> termsOf(const scenario::Snapshot& snapshot, int emitter_index,
                                const PathBudget& budget, const std::optional<RadarAtPoint>& radar) {
  const scenario::Scenario& scenario = *snapshot.scenario;
  const Emitter& emitter = scenario.emitters[emitter_index];
  std::vector<BudgetTerm> terms;
  addRadiatedTerms(emitter, budget.pointing, terms);
  double level_db = terms.back().value;

  const double distance_m = std::max(budget.geometry.slant_range_m, static_cast<double>(kMinDistance_m));
  const double spreading_db = -ratioToDb(4 * kPi * distance_m * distance_m);
  terms.push_back({"spreading_dbm2", "spreading over the slant range", spreading_db, "dB/m2",
                   fmt::format("1 / (4 pi R^2), R = {:.3f} km", distance_m / 1000)});
  level_db += spreading_db;
  for (const propagation::ExcessPart& part : budget.excess.parts) {
    terms.push_back({part.key + "_db", part.label, -part.loss_db, "dB", toString(budget.model)});
    level_db -= part.loss_db;
  }
  if (const auto& reflected = budget.pointing.reflected) {
    const PathPointing& direct = budget.pointing;
    const double both_rays =
        static_cast<double>(powerOfBothRays(*budget.excess.reflection, static_cast<float>(direct.amplitude),
                                            static_cast<float>(reflected->amplitude)));
    const double weighed_db = ratioToDb(both_rays) - direct.pattern_db;
    terms.push_back(
        {"reflected_ray_db", "reflected ray weighed by the antenna pattern", weighed_db, "dB",
         fmt::format("the interference with {:.2f} dB along the reflected ray, {:.2f} deg below the "
                     "horizontal, in place of {:.2f} dB",
                     reflected->pattern_db, radToDeg(std::asin(budget.excess.reflection->depression_sine)),
                     direct.pattern_db)});
    level_db += weighed_db;
  }
  terms.push_back({"power_density_dbwm2", "power density", level_db, "dBW/m2", "", Kind::sum});
  terms.push_back({"field_strength_dbuvm", "field strength (RMS)",
                   quantityOf(Quantity::field_strength_dbuvm, scenario, emitter_index, level_db), "dBuV/m",
                   "", Kind::sum});
  if (emitter.waveform) {
    terms.push_back({"mean_power_density_dbwm2", "mean power density",
                     quantityOf(Quantity::mean_power_density_dbwm2, scenario, emitter_index, level_db),
                     "dBW/m2", fmt::format("duty cycle {:.4g} %", 100 * emitter.dutyCycle()), Kind::sum});
  }
  const std::vector<std::string>& wanted = scenario.output.quantities;
  if (std::find(wanted.begin(), wanted.end(), scenario::info(Quantity::exposure_ratio).name) !=
      wanted.end()) {
    const double level_wm2 =
        scenario::referenceLevel_wm2(scenario.output.exposure_group, emitter.frequency_hz).value_or(HUGE_VAL);
    terms.push_back(
        {"exposure_ratio", "mean power density over the reference level",
         dbToRatio(level_db) * emitter.dutyCycle() / level_wm2, "",
         fmt::format("{:g} W/m2 at {}, ICNIRP 2020, {}", level_wm2, quantityText(emitter.frequency_hz, "Hz"),
                     toString(scenario.output.exposure_group)),
         Kind::sum});
  }
  if (!scenario.receivers.empty()) addReceiverTerms(scenario, emitter_index, level_db, terms);
  if (radar) addRadarTerms(scenario, emitter_index, *radar, budget.pointing.pattern_db, terms);

  const double wavelength = wavelength_m(emitter.frequency_hz);
  const double free_space_db =
      -spreading_dbm2(budget.geometry) - ratioToDb(wavelength * wavelength / (4 * kPi));
  terms.push_back({"free_space_loss_db", "free-space loss between isotropic antennas", free_space_db, "dB",
                   "for comparison with other tools"});
  terms.push_back({"transmission_loss_db", "basic transmission loss", free_space_db + budget.excess.loss_db,
                   "dB", "free space and the model's excess"});
  return terms;
}

}  // namespace

const BudgetTerm* PathBudget::find(const std::string& key) const {
  const auto found =
      std::find_if(terms.begin(), terms.end(), [&](const BudgetTerm& term) { return term.key == key; });
  return found == terms.end() ? nullptr : &*found;
}

namespace {

bool isAt(const PathEnd& end, const PathEnd& other) {
  return end.position.latitude_deg == other.position.latitude_deg &&
         end.position.longitude_deg == other.position.longitude_deg && end.height_msl_m == other.height_msl_m;
}

/// Names the trees and buildings of obstacles by the land cover, unless a surface model has their heights.
void nameCover(PathBudget& budget, const scenario::Terrain* terrain) {
  const scenario::LandCover* const classes = terrain == nullptr ? nullptr : terrain->landCover();
  if (classes == nullptr || terrain->view().surface_count > 0) return;
  const PathProfile& profile = budget.profile;
  for (PathObstacle& obstacle : budget.obstacles) {
    if (!(obstacle.cover_m > 0)) continue;
    const GeodeticPosition at =
        geodesicDirect(profile.begin.position.latitude_deg, profile.begin.position.longitude_deg,
                       profile.azimuth_rad, obstacle.range_m);
    const int number = classes->classAt(at.latitude_deg, at.longitude_deg);
    if (number >= 0) obstacle.cover_name = classes->classes()[static_cast<std::size_t>(number)].name;
  }
}

/// The budget; values that do not depend on the beam are taken from an earlier budget if neither end has
/// moved.
PathBudget budgetOf(const scenario::Snapshot& snapshot, int emitter_index, const PathEnd& point,
                    propagation::PropagationModel model, const scenario::Terrain* terrain,
                    bool with_detection, const PathBudget* earlier) {
  const scenario::Scenario& scenario = *snapshot.scenario;
  const Emitter& emitter = scenario.emitters[emitter_index];
  const EmitterState& state = snapshot.emitters[emitter_index];
  if (!snapshot.platforms[emitter.platform].present) {
    throw Error(ErrorCode::usage,
                scenario::absenceText(scenario.platforms[emitter.platform], snapshot.time_s));
  }
  Emitter by_model = emitter;
  by_model.propagation.model = model;
  PathBudget budget;
  budget.emitter = emitter.name;
  budget.time_s = snapshot.time_s;
  budget.active = state.active;
  budget.frequency_hz = emitter.frequency_hz;
  budget.k_factor = scenario.atmosphere.k_factor;
  budget.model = model;
  const PathEnd begin{state.position, state.height_msl_m};
  const bool at_crossings = propagation::readsCrossings(by_model.propagation);
  const bool is_still = earlier != nullptr && earlier->profile.at_crossings == at_crossings &&
                        isAt(earlier->profile.begin, begin) && isAt(earlier->profile.end, point);
  budget.profile =
      is_still ? earlier->profile : readPathProfile(begin, point, scenario.atmosphere, terrain, at_crossings);
  const PathProfile& profile = budget.profile;
  const Station station = makeStation(state.position, state.height_msl_m, scenario.atmosphere);
  const double wavelength = wavelength_m(emitter.frequency_hz);

  PathGeometry& geometry = budget.geometry;
  const Vec3d line = lineTo(station, point.position);
  Vec3d ray = line;
  ray.z += refractionLift_m(station, profile.range_m, std::hypot(line.x, line.y), point.height_msl_m);
  geometry.slant_range_m = length(line);
  geometry.straight_elevation_rad = elevationOf_rad(line);
  geometry.launch_elevation_rad = elevationOf_rad(ray);
  geometry.begin_ground_msl_m = static_cast<double>(profile.ground_msl_m.front());
  geometry.end_ground_msl_m = static_cast<double>(profile.ground_msl_m.back());
  const auto horizonOf_m = [&](double height_msl_m) {
    return smoothHorizon_m(station.refraction.grazingHeight_m(height_msl_m),
                           station.effective_earth_radius_m);
  };
  geometry.horizon_range_m = horizonOf_m(profile.begin.height_msl_m) + horizonOf_m(profile.end.height_msl_m);
  const double aperture_m = emitter.antenna->apertureDimension_m(wavelength);
  geometry.far_field_m = 2 * aperture_m * aperture_m / wavelength;

  const bool keeps_excess = is_still && !elevationCut(by_model, state.beam);
  budget.excess =
      keeps_excess ? earlier->excess : pathExcess(scenario, by_model, state.beam, profile, terrain);
  budget.pointing = pointingOf(emitter, state.beam, ray, budget.excess.reflection);
  budget.boresight_dbwm2 = boresightDensity_dbwm2(emitter, budget);
  budget.warnings = budget.excess.warnings;
  for (std::vector<std::string>& warnings : std::array{laterTripWarnings(scenario, emitter, station),
                                                       ductedClutterWarnings(scenario, by_model, station)}) {
    for (std::string& warning : warnings) budget.warnings.push_back(std::move(warning));
  }
  if (terrain != nullptr) {
    const float lowest_m = *std::min_element(profile.ground_msl_m.begin(), profile.ground_msl_m.end());
    for (std::string& warning :
         seaWarnings(scenario, by_model, static_cast<double>(lowest_m), partAtSeaLevel(profile.ground_msl_m)))
      budget.warnings.push_back(std::move(warning));
  }
  if (!is_still && !budget.excess.cover.ranges_m.empty())
    budget.profile = withCover(profile, budget.excess.cover, scenario.atmosphere);
  budget.obstacles = is_still ? earlier->obstacles : pathObstacles(profile, wavelength);
  if (!is_still) nameCover(budget, terrain);
  if (geometry.slant_range_m < geometry.far_field_m) {
    budget.warnings.push_back(fmt::format(
        "the point is {:.0f} m from the antenna, closer than the far-field distance (2 D^2 / lambda = "
        "{:.0f} m): the "
        "far-field formula is used nevertheless",
        geometry.slant_range_m, geometry.far_field_m));
  }
  if (with_detection && emitter.waveform && emitter.kind == scenario::EmitterKind::radar) {
    if (emitter.waveform->limits_detection)
      budget.unheard = unheardRange(*emitter.waveform, geometry.slant_range_m);
    for (std::string& warning : rangeWarnings(*emitter.waveform, geometry.slant_range_m))
      budget.warnings.push_back(std::move(warning));
  }
  std::optional<RadarAtPoint> radar;
  if (with_detection && emitter.kind == scenario::EmitterKind::radar && state.active) {
    radar = radarAtPoint(snapshot, emitter_index, ray, budget, terrain);
    for (std::string& warning : steadyClutterWarnings(emitter, *radar))
      budget.warnings.push_back(std::move(warning));
    budget.look_pattern_db = radar->look_pattern_db;
    budget.has_fixed_beam = isFixed(emitter);
    budget.jamming = radar->jamming;
    budget.probability_in_any_range = radar->probability_in_any_range;
  }
  budget.terms = termsOf(snapshot, emitter_index, budget, radar);
  budget.verdict = verdictOf(budget);
  return budget;
}

}  // namespace

PathBudget pathBudget(const scenario::Snapshot& snapshot, int emitter, const PathEnd& point,
                      propagation::PropagationModel model, const scenario::Terrain* terrain) {
  return budgetOf(snapshot, emitter, point, model, terrain, true, nullptr);
}

PathBudget powerBudget(const scenario::Snapshot& snapshot, int emitter, const PathEnd& point,
                       propagation::PropagationModel model, const scenario::Terrain* terrain,
                       const PathBudget* earlier) {
  return budgetOf(snapshot, emitter, point, model, terrain, false, earlier);
}

}  // namespace emscape::emfield
