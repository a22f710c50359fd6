#include "report/paths/profile_report.h"

#include <fmt/core.h>

#include <cmath>

#include "base/text/quantity_text.h"
#include "emfield/excess/clutter_text.h"
#include "emfield/link/path_report.h"
#include "emfield/link/path_section.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_cause.h"
#include "emscape/scenario/file/scenario_file.h"
#include "propagation/registry/model_info.h"
#include "report/paths/profile_plot.h"
#include "report/paths/refractivity_report.h"
#include "report/paths/section_plot.h"
#include "report/paths/waveform_report.h"
#include "report/text.h"
#include "scenario/file/far_outside.h"
#include "scenario/model/ground_tolerance.h"

namespace emscape::report {
namespace {

using emfield::BudgetTerm;
using emfield::PathBudget;
using emfield::PathEnd;
using emfield::PathObstacle;
using emfield::valueText;

Json toJson(const PathEnd& end, double ground_msl_m) {
  return {{"latitude_deg", end.position.latitude_deg},
          {"longitude_deg", end.position.longitude_deg},
          {"height_msl_m", end.height_msl_m},
          {"height_agl_m", end.height_msl_m - ground_msl_m},
          {"height_ellipsoid_m", end.position.height_ellipsoid_m},
          {"ground_msl_m", ground_msl_m}};
}

Json geometryJson(const PathBudget& budget) {
  const emfield::PathGeometry& geometry = budget.geometry;
  Json json{{"range_m", budget.profile.range_m},
            {"slant_range_m", geometry.slant_range_m},
            {"azimuth_deg", radToDeg(budget.profile.azimuth_rad)},
            {"straight_elevation_deg", radToDeg(geometry.straight_elevation_rad)},
            {"launch_elevation_deg", radToDeg(geometry.launch_elevation_rad)},
            {"k_factor", budget.k_factor},
            {"effective_earth_radius_m", budget.profile.effective_earth_radius_m},
            {"smooth_horizon_m", geometry.horizon_range_m},
            {"far_field_m", geometry.far_field_m},
            {"off_axis_deg", radToDeg(budget.pointing.off_axis_rad)},
            {"antenna_azimuth_deg", radToDeg(budget.pointing.azimuth_rad)},
            {"antenna_elevation_deg", radToDeg(budget.pointing.elevation_rad)}};
  if (budget.look_pattern_db) json["look_pattern_db"] = number(*budget.look_pattern_db);
  if (const auto& reflected = budget.pointing.reflected) {
    const auto depression_sine = static_cast<double>(budget.excess.reflection->depression_sine);
    json["reflected_launch_elevation_deg"] = -radToDeg(std::asin(depression_sine));
    json["reflected_off_axis_deg"] = radToDeg(reflected->off_axis_rad);
    json["reflected_pattern_db"] = number(reflected->pattern_db);
  }
  return json;
}

Json toJson(const PathObstacle& obstacle) {
  return {{"range_m", obstacle.range_m},
          {"ground_msl_m", obstacle.ground_msl_m},
          {"clearance_m", obstacle.clearance_m},
          {"fresnel_radius_m", obstacle.fresnel_radius_m},
          {"clearance_fresnel_radii", obstacle.clearanceInFresnelRadii()},
          {"nu", obstacle.nu},
          {"knife_edge_db", obstacle.knife_edge_db},
          {"cover_m", obstacle.cover_m},
          {"cover_name", obstacle.cover_name},
          {"kind", obstacle.is_cover         ? "cover"
                   : obstacle.is_earth_bulge ? "earth"
                                             : "terrain"},
          {"decides", obstacle.decides && obstacle.clearanceInFresnelRadii() < 1}};
}

Json toJson(const Comparison& comparison) {
  Json json{{"model", toString(comparison.model)}};
  if (!comparison.refusal.empty()) {
    json["refused"] = comparison.refusal;
    return json;
  }
  json["excess_db"] = number(comparison.budget.excess.loss_db);
  json["power_density_dbwm2"] = number(comparison.budget.find("power_density_dbwm2")->value);
  json["warnings"] = comparison.budget.warnings;
  return json;
}

void addGeometry(Text& out, const PathBudget& budget) {
  out.add("Geometry\n");
  for (const emfield::ReportLine& line : emfield::geometryLines(budget)) {
    out.add("  {:<22} {}\n", line.name, line.text);
  }
}

void addObstacles(Text& out, const PathBudget& budget) {
  out.add(
      "\nObstacles: the ground, with the trees and buildings that the model reads, within 0.6 first Fresnel "
      "radii of the ray or above it, else the nearest\n");
  if (budget.obstacles.empty()) {
    out.add("  none: the path is shorter than the spacing of the terrain\n");
    return;
  }
  out.add("  {:>11} {:>11} {:>11} {:>14} {:>15} {:>9}\n", "distance km", "ground m", "clearance m",
          "Fresnel rad. m", "in Fresnel rad.", "alone dB");
  for (const PathObstacle& obstacle : budget.obstacles) {
    const std::string remark = emfield::remarkOf(obstacle);
    out.add("  {:11.3f} {:11.1f} {:+11.1f} {:14.1f} {:+15.2f} {:9.1f}{}{}\n", obstacle.range_m / 1000,
            obstacle.ground_msl_m, obstacle.clearance_m, obstacle.fresnel_radius_m,
            obstacle.clearanceInFresnelRadii(), obstacle.knife_edge_db, remark.empty() ? "" : "  ", remark);
  }
}

void addBudget(Text& out, const PathBudget& budget) {
  out.add("\nBudget by '{}': {}\n", toString(budget.model), budget.excess.why);
  for (const BudgetTerm& term : budget.terms) {
    const bool is_sum = term.kind == BudgetTerm::Kind::sum;
    out.add("{} {:<48} {:>9} {:<8} {}\n", is_sum ? " =" : "  ", term.label, valueText(term.value),
            std::isinf(term.value) ? "" : term.unit, term.note);
  }
  out.add(
      "  Of this emitter alone, at the point itself: a volume has values at the centres of its voxels, of "
      "all "
      "emitters unless output.combine is per_emitter\n");
}

void addCompared(Text& out, const std::vector<Comparison>& compared, const PathBudget& own) {
  if (compared.empty()) return;
  out.add("\nCompared\n  {:<18} {:>10} {:>22}\n", "model", "excess dB", "power density dBW/m2");
  const auto row = [&](const PathBudget& budget, const char* remark) {
    out.add("  {:<18} {:>10} {:>22} {}\n", toString(budget.model), valueText(budget.excess.loss_db),
            valueText(budget.find("power_density_dbwm2")->value), remark);
  };
  row(own, "the scenario's");
  for (const Comparison& comparison : compared) {
    if (comparison.refusal.empty()) {
      row(comparison.budget, "");
    } else {
      out.add("  {:<18} {}\n", toString(comparison.model), comparison.refusal);
    }
  }
}

/// The scenario with one more platform, the last one, at the point: its ground is read and its height checked
/// as for any platform.
std::shared_ptr<const scenario::Scenario> withPoint(const scenario::Scenario& scenario,
                                                    const scenario::SitePosition& point) {
  auto result = std::make_shared<scenario::Scenario>(scenario);
  scenario::Platform platform;
  platform.name = "--to";
  platform.track.emplace_back();
  platform.track.back().position = point;
  result->platforms.push_back(platform);
  return result;
}

/// The first budget, of the emitter's model or a compared one, whose model provides a field over range and
/// height.
const emfield::PathBudget* budgetOfSection(const ProfileReport& report) {
  const auto hasSection = [](const emfield::PathBudget& budget) {
    return propagation::modelInfo(budget.model).radial != nullptr;
  };
  if (hasSection(report.budget)) return &report.budget;
  for (const Comparison& comparison : report.compared) {
    if (comparison.refusal.empty() && hasSection(comparison.budget)) return &comparison.budget;
  }
  return nullptr;
}

Json jammersJson(const PathBudget& budget) {
  Json jammers = Json::array();
  for (const emfield::PathJammer& jammer : budget.jamming.jammers) {
    jammers.push_back({{"name", jammer.name},
                       {"jammer_to_signal_db", number(jammer.to_signal_db)},
                       {"blanked_part", jammer.blanked_part}});
  }
  return jammers;
}

const scenario::Emitter& emitterOf(const ProfileReport& report) {
  return report.snapshot.scenario->emitters[static_cast<std::size_t>(report.emitter)];
}

}  // namespace

ProfileReport profileReport(const std::string& file, const scenario::Scenario& scenario,
                            const ProfileRequest& request) {
  const auto refuse = [&](ErrorCode code, const std::string& text) {
    throw Error(code, request.option + ": " + text);
  };
  const scenario::SitePosition& to = request.to;
  const std::string mistake = scenario::mistakenPlaceText(scenario.region, to.latitude_deg, to.longitude_deg);
  if (!mistake.empty()) refuse(ErrorCode::usage, mistake);
  const auto with_point = withPoint(scenario, to);
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*with_point);
  if (terrain && to.height_msl_m) {
    const auto ground_m = static_cast<double>(terrain->heightMsl_m(to.latitude_deg, to.longitude_deg));
    if (ground_m - *to.height_msl_m > scenario::kGroundTolerance_m)
      refuse(ErrorCode::bad_input,
             fmt::format(
                 "{:g} m above mean sea level are {:.1f} m below the ground there, which is at {:.1f} m; {} "
                 "takes the height above ground",
                 *to.height_msl_m, ground_m - *to.height_msl_m, ground_m, request.agl_option));
  }
  const scenario::Snapshot snapshot = scenario::instantAt(with_point, terrain.get(), request.time_s);
  const PathEnd point{snapshot.platforms.back().position, snapshot.platforms.back().height_msl_m};
  const auto budgetBy = [&](propagation::PropagationModel model) {
    PathBudget budget = emfield::pathBudget(snapshot, request.emitter, point, model, terrain.get());
    emfield::tellSteepGround(budget);
    return budget;
  };
  const scenario::Emitter& emitter = scenario.emitters[static_cast<std::size_t>(request.emitter)];
  ProfileReport report{file, snapshot, terrain, request.emitter, budgetBy(emitter.propagation.model), {}};
  if (const std::string outside = scenario::outsideClockText({request.time_s}, scenario.clock);
      !outside.empty())
    report.budget.warnings.push_back(outside);
  if (terrain) {
    for (std::string& warning : terrain->warnings()) report.budget.warnings.push_back(std::move(warning));
  }
  for (const propagation::PropagationModel model : request.models) {
    Comparison comparison;
    comparison.model = model;
    try {
      comparison.budget = budgetBy(model);
    } catch (const Error& error) {
      comparison.refusal = error.message();
    }
    report.compared.push_back(std::move(comparison));
  }
  return report;
}

Json toJson(const ProfileReport& report) {
  const PathBudget& budget = report.budget;
  Json obstacles = Json::array();
  for (const PathObstacle& obstacle : budget.obstacles) obstacles.push_back(toJson(obstacle));
  Json terms = Json::object();
  for (const BudgetTerm& term : budget.terms) terms[term.key] = number(term.value);
  Json excess_parts = Json::object();
  for (const propagation::ExcessPart& part : budget.excess.parts)
    excess_parts[part.key] = number(part.loss_db);
  Json compared = Json::array();
  for (const Comparison& comparison : report.compared) compared.push_back(toJson(comparison));
  std::vector<std::string> warnings = warningsOf(*report.snapshot.scenario);
  warnings.insert(warnings.end(), budget.warnings.begin(), budget.warnings.end());
  return {{"scenario", report.scenario},
          {"emitter", budget.emitter},
          {"time_s", budget.time_s},
          {"time_utc", report.snapshot.time_utc},
          {"active", budget.active},
          {"frequency_hz", budget.frequency_hz},
          {"waveform", waveformJson(*report.snapshot.scenario, emitterOf(report))},
          {"from", toJson(budget.profile.begin, budget.geometry.begin_ground_msl_m)},
          {"to", toJson(budget.profile.end, budget.geometry.end_ground_msl_m)},
          {"geometry", geometryJson(budget)},
          {"obstacles", obstacles},
          {"model", toString(budget.model)},
          {"model_why", budget.excess.why},
          {"air", airSource(*report.snapshot.scenario)},
          {"clutter", emfield::clutterText(*report.snapshot.scenario, emitterOf(report))},
          {"excess_db", number(budget.excess.loss_db)},
          {"excess_parts_db", excess_parts},
          {"budget", terms},
          {"jammers", jammersJson(budget)},
          {"compared", compared},
          {"warnings", warnings},
          {"verdict", budget.verdict},
          {"decides", emfield::decisionText(budget)},
          {"profile",
           {{"range_m", budget.profile.ranges_m},
            {"ground_msl_m", budget.profile.ground_msl_m},
            {"cover_m", budget.profile.cover_m},
            {"ray_msl_m", budget.profile.ray_msl_m}}}};
}

std::string profileText(const ProfileReport& report) {
  Text out;
  const PathBudget& budget = report.budget;
  out.add("Path from '{}' at t = {:g} s{}, {}\n\n", budget.emitter, budget.time_s,
          report.snapshot.time_utc.empty() ? "" : " (" + report.snapshot.time_utc + ")",
          quantityText(budget.frequency_hz, "Hz"));
  addGeometry(out, budget);
  addWaveform(out, *report.snapshot.scenario, emitterOf(report));
  addObstacles(out, budget);
  addBudget(out, budget);
  addCompared(out, report.compared, budget);
  const std::string air = airSource(*report.snapshot.scenario);
  if (!air.empty()) out.add("\nAir: {}\n", air);
  out.add("\nground cover along the path: {}\n",
          emfield::clutterText(*report.snapshot.scenario, emitterOf(report)));
  if (!budget.warnings.empty()) out.add("\n");
  for (const std::string& warning : budget.warnings) out.add("Warning: {}\n", warning);
  out.add("\n{}\n", budget.verdict);
  return out.take();
}

void plotPath(const ProfileReport& report, render::ImageSize size, const std::string& file) {
  constexpr int kRanges = 400, kHeights = 240;
  const PathBudget* const budget = budgetOfSection(report);
  if (budget == nullptr) return plotProfile(report.budget, size, file);
  const emfield::PathSection section =
      emfield::pathSection(report.snapshot, report.emitter, budget->model, budget->profile,
                           report.terrain.get(), kRanges, kHeights);
  plotSection(*budget, section, size, file);
}

}  // namespace emscape::report
