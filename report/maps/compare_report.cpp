#include "report/maps/compare_report.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/files/json_writing.h"
#include "emfield/excess/clutter_text.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/study/maps/area.h"
#include "report/json.h"
#include "report/maps/output_files.h"
#include "report/text.h"
#include "report/warnings.h"
#include "study/maps/surface_maps.h"

namespace emscape::report {
namespace {

std::string heightText(const study::ComparisonRow& row) {
  return row.height ? study::describe(*row.height) : "";
}
std::string timeText(const study::ComparisonRow& row) {
  return row.time_s ? fmt::format("{:g}", *row.time_s) : "all";
}
std::string km2(double area_m2) {
  return fmt::format("{:.2f}", area_m2 / 1e6);
}
std::string percent(double area_m2, double of_m2) {
  return fmt::format("{:.1f}", of_m2 > 0 ? 100 * area_m2 / of_m2 : 0.0);
}
std::string decimals(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

std::string keyOf(study::Product product) {
  return study::info(product).name;
}

/// Areas of the products that mark an area, and differences of the other products; either may be empty.
/// @param nameOf  text of a product
template <class NameOf>
std::pair<study::ReportTable, study::ReportTable> tablesOf(const study::Comparison& comparison,
                                                           const NameOf& nameOf) {
  std::pair<study::ReportTable, study::ReportTable> tables;
  tables.first.columns = {"product",    "height",   "time s",   "A km2", "B km2",
                          "gained km2", "lost km2", "gained %", "lost %"};
  tables.first.caption = "Percent are of the area with a value in both.";
  tables.second.columns = {"product", "height", "time s", "unit", "mean B - A", "smallest", "largest"};
  for (const study::ComparisonRow& row : comparison.rows) {
    const std::string name = nameOf(row.product);
    if (row.is_area) {
      tables.first.rows.push_back({name, heightText(row), timeText(row), km2(row.area_a_m2),
                                   km2(row.area_b_m2), km2(row.gained_m2), km2(row.lost_m2),
                                   percent(row.gained_m2, row.known_area_m2),
                                   percent(row.lost_m2, row.known_area_m2)});
    } else {
      tables.second.rows.push_back({name, heightText(row), timeText(row), row.unit,
                                    decimals(row.mean_difference), decimals(row.min_difference),
                                    decimals(row.max_difference)});
    }
  }
  return tables;
}

void addTable(Text& out, const study::ReportTable& table) {
  if (table.rows.empty()) return;
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    widths.push_back(table.columns[c].size());
    for (const auto& row : table.rows) widths[c] = std::max(widths[c], row[c].size());
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      text +=
          c < 2 ? fmt::format("  {:<{}}", cells[c], widths[c]) : fmt::format("  {:>{}}", cells[c], widths[c]);
    }
    out.add("{}\n", text);
  };
  line(table.columns);
  for (const auto& row : table.rows) line(row);
}

/// "Lost: 12.3 km2 about 36.30000, -84.20000 at 150 m above ground, t = 80 s"
std::string titleOf(const study::ChangedArea& area) {
  return fmt::format("{}: {} km2 about {:.5f}, {:.5f} at {}, t = {:g} s", area.is_gained ? "Gained" : "Lost",
                     km2(area.area_m2), area.latitude_deg, area.longitude_deg, study::describe(area.height),
                     area.time_s);
}

/// Values of the decisive emitter in A and B.
std::string valuesText(const study::ChangedArea& area, const std::string& quantity) {
  if (area.emitter.empty()) return "No emitter radiates there in either scenario.";
  const auto text = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.4g}", *value) : "none";
  };
  return fmt::format("'{}': {} {} in A, {} in B", area.emitter, quantity, text(area.a.value),
                     text(area.b.value));
}

Json pathJson(const study::ExplainedPath& path) {
  return {{"verdict", path.verdict},
          {"value", number(path.value)},
          {"jammer_to_signal_db", number(path.jammer_to_signal_db)}};
}

/// The entries of report.json other than the maps.
Json comparisonJson(const study::Comparison& comparison, const study::ComparedScenario& a,
                    const study::ComparedScenario& b) {
  const auto nameOf = [](const scenario::Scenario& scenario) {
    Json edits = Json::array();
    for (const scenario::Edit& edit : scenario.edits()) edits.push_back(edit.path + "=" + edit.value);
    return Json{{"scenario", scenario.name},
                {"scenario_hash", scenario.hash},
                {"set", edits},
                {"clutter", emfield::clutterText(scenario)}};
  };
  Json json{{"a", nameOf(*a.scenario)}, {"b", nameOf(*b.scenario)}};
  json["comparison"] = Json::array();
  for (const study::ComparisonRow& row : comparison.rows) {
    Json of_row{{"product", study::info(row.product).name},
                {"height", row.height ? Json(study::nameOf(*row.height)) : Json(nullptr)},
                {"time_s", number(row.time_s)},
                {"known_area_km2", row.known_area_m2 / 1e6}};
    if (row.is_area) {
      of_row["a_km2"] = row.area_a_m2 / 1e6;
      of_row["b_km2"] = row.area_b_m2 / 1e6;
      of_row["gained_km2"] = row.gained_m2 / 1e6;
      of_row["lost_km2"] = row.lost_m2 / 1e6;
    } else {
      of_row["unit"] = row.unit;
      of_row["mean_difference"] = number(row.mean_difference);
      of_row["min_difference"] = number(row.min_difference);
      of_row["max_difference"] = number(row.max_difference);
    }
    json["comparison"].push_back(of_row);
  }
  json["changed_areas"] = Json::array();
  for (const study::ChangedArea& area : comparison.changed_areas) {
    Json of_area{{"change", area.is_gained ? "gained" : "lost"},
                 {"product", study::info(area.product).name},
                 {"height", study::nameOf(area.height)},
                 {"time_s", area.time_s},
                 {"area_km2", area.area_m2 / 1e6},
                 {"latitude_deg", area.latitude_deg},
                 {"longitude_deg", area.longitude_deg}};
    if (comparison.has_paths) {
      of_area["height_msl_m"] = area.height_msl_m;
      of_area["emitter"] = area.emitter;
      of_area["a"] = pathJson(area.a);
      of_area["b"] = pathJson(area.b);
    }
    json["changed_areas"].push_back(std::move(of_area));
  }
  return json;
}

/// "Coverage at 150 m above ground, t = 80 s: B gains 12.30 km² (1.4 %) and loses nothing."
std::string summaryOf(const study::ComparisonRow& row, std::string product) {
  product.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(product.front())));
  const auto part = [&](const char* verb, double area_m2) {
    return area_m2 > 0
               ? fmt::format("{} {} km² ({} %)", verb, km2(area_m2), percent(area_m2, row.known_area_m2))
               : fmt::format("{} nothing", verb);
  };
  return fmt::format("{}{}{}: B {} and {}.", product, row.height ? " at " + heightText(row) : "",
                     row.time_s ? fmt::format(", t = {} s", timeText(row)) : "", part("gains", row.gained_m2),
                     part("loses", row.lost_m2));
}

/// Adds the sections "Gained and lost" and "Why". @param quantity  its name
void addSections(study::HtmlReport& report, const study::Comparison& comparison,
                 const std::string& quantity) {
  const scenario::Quantity of = scenario::quantityFromName(quantity);
  const auto titleOfProduct = [&](study::Product product) { return study::titleOf(product, of); };
  auto [areas, differences] = tablesOf(comparison, titleOfProduct);
  for (std::string& column : areas.columns) column = render::displayText(column);
  constexpr std::size_t kMaxSentences = 8;
  std::size_t sentences = 0;
  for (const study::ComparisonRow& row : comparison.rows) {
    if (row.is_area && sentences++ < kMaxSentences)
      report.summary(summaryOf(row, titleOfProduct(row.product)));
  }
  report.section("Gained and lost");
  if (!areas.rows.empty()) report.table(areas);
  if (!differences.rows.empty()) report.table(differences);
  if (comparison.changed_areas.empty()) return;
  report.section(comparison.has_paths ? "Why" : "Largest areas that changed");
  if (comparison.has_paths) {
    report.paragraph(
        "The largest connected areas that changed, and the path to the pixel in their middle from the "
        "emitter with the largest value there, as emscape profile explains it.");
  }
  for (const study::ChangedArea& area : comparison.changed_areas) {
    report.paragraph(render::displayText(titleOf(area)) +
                     (comparison.has_paths ? ". " + valuesText(area, study::titleOf(of)) : "."));
    if (!area.emitter.empty()) report.facts({{"A", area.a.verdict}, {"B", area.b.verdict}});
  }
}

}  // namespace

void requireReplaceable(const study::MapFolder& folder, const std::vector<study::CoverageMap>& maps) {
  std::vector<std::string> names;
  for (const study::CoverageMap& map : maps) {
    study::Map change;
    change.name = study::changeNameOf(map.product);
    change.height = map.height;
    change.time_s = map.time_s;
    names.push_back(fileNameOf(change));
  }
  folder.requireReplaceable(names);
}

ScenarioComparison::ScenarioComparison(std::shared_ptr<const scenario::Scenario> a,
                                       std::shared_ptr<const scenario::Scenario> b, const MapOptions& maps,
                                       int areas, const std::string& folder, const std::string& name_b)
    : a_{std::move(a), nullptr}, b_{std::move(b), nullptr} {
  checkMapFolder(folder, {a_.scenario, b_.scenario}, maps.prefix + "output");
  request_.coverage = report::requestOf(maps, a_.scenario->clock);
  request_.areas = areas;
  study::checkRequest(request_, *a_.scenario, *b_.scenario);
  const study::MapArea area = report::areaOf(maps, *a_.scenario);
  grid_ = report::gridOf(maps, *a_.scenario, area);
  a_.terrain = study::loadTerrain(*a_.scenario, area);
  b_.terrain = study::loadTerrain(*b_.scenario, area);
  folder_ = std::make_unique<study::MapFolder>(
      folder,
      study::MapStudy{"compare",
                      fmt::format("Comparison of {} (A) and {} (B)", a_.scenario->name, name_b),
                      {a_.scenario, b_.scenario},
                      a_.terrain,
                      grid_,
                      request().quantity,
                      request().threshold,
                      request().times_s,
                      request().heights,
                      maps.view},
      maps.formats);
  requireReplaceable(*folder_, study::outlinesOf(request()));
}

study::Comparison ScenarioComparison::compute(const emfield::FieldOptions& options,
                                              const ProgressSink& progress) {
  return study::computeComparison(
      a_, b_, *grid_, request_, options, [&](const study::Map& map) { folder_->add(map); }, progress);
}

std::string ScenarioComparison::finish(const study::Comparison& comparison) {
  return finishComparison(*folder_, comparison, a_, b_, scenario::info(request().quantity).name);
}

std::string finishComparison(study::MapFolder& folder, const study::Comparison& comparison,
                             const study::ComparedScenario& a, const study::ComparedScenario& b,
                             const std::string& quantity) {
  logWarnings(comparison.warnings, {a.scenario, b.scenario});
  folder.finish(joinedWarnings(comparison.warnings), dumpJson(comparisonJson(comparison, a, b)),
                [&](study::HtmlReport& report) { addSections(report, comparison, quantity); });
  return folder.reportJson();
}

std::string comparisonText(const study::Comparison& comparison, const std::string& quantity) {
  Text out;
  const auto [areas, differences] = tablesOf(comparison, keyOf);
  addTable(out, areas);
  addTable(out, differences);
  for (const study::ChangedArea& area : comparison.changed_areas) {
    out.add("\n{}\n", titleOf(area));
    if (comparison.has_paths) out.add("  {}\n", valuesText(area, quantity));
    if (!area.emitter.empty()) out.add("  A: {}\n  B: {}\n", area.a.verdict, area.b.verdict);
  }
  return out.take();
}

}  // namespace emscape::report
