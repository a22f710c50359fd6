#include "report/runs/measured_report.h"

#include <algorithm>

#include "report/text.h"
#include "report/warnings.h"

namespace emscape::report {
namespace {

using emfield::ErrorStatistics;
using emfield::MeasuredPath;
using emfield::PathTerrain;

Json toJson(const ErrorStatistics& statistics) {
  return {{"paths", statistics.paths},
          {"without", statistics.without},
          {"mean_db", statistics.paths > 0 ? number(statistics.mean_db) : Json()},
          {"sd_db", statistics.paths > 0 ? number(statistics.sd_db) : Json()},
          {"rms_db", statistics.paths > 0 ? number(statistics.rms_db) : Json()}};
}

Json endJson(const emfield::PathEnd& end, double height_agl_m) {
  return {{"latitude_deg", end.position.latitude_deg},
          {"longitude_deg", end.position.longitude_deg},
          {"height_msl_m", end.height_msl_m},
          {"height_agl_m", height_agl_m}};
}

std::string statisticsText(const ErrorStatistics& statistics) {
  if (statistics.paths == 0) return fmt::format("{:>5} {:>6} {:>5} {:>5}", 0, "", "", "");
  return fmt::format("{:>5} {:>+6.1f} {:>5.1f} {:>5.1f}", statistics.paths, statistics.mean_db,
                     statistics.sd_db, statistics.rms_db);
}

/// Without the emitter, which is not that of the measurement.
std::vector<std::string> warningsOf(const MeasuredReport& report) {
  std::vector<std::string> warnings = joinedWarnings(report.check.warnings);
  for (std::string& warning : warnings) {
    const std::size_t end = warning.find("': ");
    if (warning.rfind("emitter '", 0) == 0 && end != std::string::npos) warning.erase(0, end + 3);
  }
  return warnings;
}

}  // namespace

Json toJson(const MeasuredReport& report) {
  Json models = Json::array();
  for (const emfield::ModelErrors& errors : report.check.models) {
    Json model{{"model", toString(errors.model)}, {"all", toJson(errors.all)}};
    for (std::size_t i = 0; i < errors.by_terrain.size(); ++i)
      model[toString(static_cast<PathTerrain>(i))] = toJson(errors.by_terrain[i]);
    if (!errors.refusal.empty()) model["refused"] = errors.refusal;
    models.push_back(std::move(model));
  }
  Json paths = Json::array();
  for (const MeasuredPath& path : report.check.paths) {
    Json computed = Json::object();
    for (std::size_t m = 0; m < path.computed_db.size(); ++m)
      computed[toString(report.check.models[m].model)] = number(path.computed_db[m]);
    paths.push_back({{"line", path.line},
                     {"rows", path.rows},
                     {"transmitter", endJson(path.transmitter, path.transmitter_agl_m)},
                     {"receiver", endJson(path.receiver, path.receiver_agl_m)},
                     {"frequency_hz", path.frequency_hz},
                     {"distance_m", path.distance_m},
                     {"elevation_deg", path.elevation_deg},
                     {"terrain", toString(path.terrain)},
                     {"measured_db", path.measured_db},
                     {"computed_db", std::move(computed)}});
  }
  return {{"file", report.file},
          {"scenario", report.scenario.empty() ? Json() : Json(report.scenario)},
          {"clutter", report.clutter},
          {"rows", report.check.rows},
          {"rows_selected", report.check.selected},
          {"models", std::move(models)},
          {"paths", std::move(paths)},
          {"warnings", warningsOf(report)}};
}

std::string measuredText(const MeasuredReport& report) {
  const std::vector<MeasuredPath>& paths = report.check.paths;
  const auto [nearest, farthest] = std::minmax_element(
      paths.begin(), paths.end(),
      [](const MeasuredPath& a, const MeasuredPath& b) { return a.distance_m < b.distance_m; });
  Text out;
  out.add("{}: {} of {} rows, {} paths of {:.2f} to {:.2f} km\n", report.file, report.check.selected,
          report.check.rows, paths.size(), nearest->distance_m / 1000, farthest->distance_m / 1000);
  out.add("ground cover: {}\n", report.clutter);
  out.add("Computed minus measured loss (dB); negative: the model promises too strong a signal\n\n");
  out.add("{:<20} {:<24}  {:<24}  {:<24}  {}\n", "", "all paths", "clear", "grazing", "blocked");
  const std::string head = fmt::format("{:>5} {:>6} {:>5} {:>5}", "n", "mean", "sd", "rms");
  out.add("{:<18} {}   {}   {}   {}\n", "model", head, head, head, head);
  for (const emfield::ModelErrors& errors : report.check.models) {
    if (errors.all.paths == 0) {
      out.add("{:<18} no loss: {}\n", toString(errors.model),
              errors.refusal.empty() ? "no field on these paths" : errors.refusal);
      continue;
    }
    out.add("{:<18} {}", toString(errors.model), statisticsText(errors.all));
    for (const ErrorStatistics& statistics : errors.by_terrain) out.add("   {}", statisticsText(statistics));
    if (errors.all.without > 0) out.add("   {} without a loss", errors.all.without);
    out.add("\n");
  }
  out.add(
      "\nclear: no terrain within 0.6 radii of the first Fresnel zone; blocked: terrain or the earth's bulge "
      "above the ray; rms^2 = mean^2 + sd^2\n");
  for (const std::string& warning : warningsOf(report)) out.add("warning: {}\n", warning);
  return out.take();
}

}  // namespace emscape::report
