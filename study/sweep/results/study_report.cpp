#include "study/sweep/results/study_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/files/json_writing.h"
#include "base/files/whole_file.h"
#include "base/text/count_text.h"
#include "base/text/quantity_text.h"
#include "document/schema_check.h"
#include "emfield/excess/clutter_text.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/study/maps/map.h"
#include "emscape/study/maps/map_grid.h"
#include "study/report/html_report.h"
#include "study/report/map_report.h"
#include "study/sweep/choose_sites.h"
#include "study/sweep/results/measure_plot.h"

namespace emscape::study {
namespace {

constexpr std::size_t kBest = 5, kMaxRows = 500, kMaxPlots = 60;

/// The value below which a part of the values are, linear between them. @param ascending  at least one
double percentileOf(const std::vector<double>& ascending, double part) {
  const double at = part * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  return ascending[below] + (at - static_cast<double>(below)) * (ascending[above] - ascending[below]);
}

std::string titleOf(const StudyMeasure& measure) {
  const std::string unit = unitOf(measure);
  return measure.name + (unit.empty() ? "" : " (" + unit + ")");
}

class ReportWriter {
 public:
  ReportWriter(const StudySpec& study, const StudyPlan& plan, const StudyResults& results)
      : study_(study),
        plan_(plan),
        results_(results),
        report_("Study: " + study.name,
                fmt::format("{} variants of {}", study.variants.count(), study.base->name)) {
    for (std::size_t v = 0; v < study.variants.count(); ++v) {
      if (results.is_computed[v]) computed_.push_back(v);
    }
  }

  StudySummary write(const std::filesystem::path& file) {
    addInputs();
    if (study_.sites) addSites(file.parent_path() / StudyFolder::kSites);
    for (std::size_t m = 0; m < study_.measures.size(); ++m) addMeasure(m);
    addTable();
    addModels(report_, *study_.base);
    report_.write(file);
    return std::move(summary_);
  }

 private:
  double value(std::size_t variant, std::size_t m) const {
    return results_.value(variant, m, study_.measures.size());
  }

  std::string text(std::size_t variant, std::size_t m) const {
    return figureText(value(variant, m), unitOf(study_.measures[m]));
  }

  void addInputs() {
    report_.section("Study");
    const std::vector<double>& times_s = study_.times_s;
    std::vector<std::pair<std::string, std::string>> inputs{
        {"Scenario", fmt::format("{} ({})", study_.base->name, study_.base->file)}};
    for (const scenario::Edit& edit : study_.base->edits())
      inputs.emplace_back("Changed by --set", scenario::toString(edit));
    for (const auto& [file, crc32] : study_.rasters)
      inputs.emplace_back("Terrain", fmt::format("{}, CRC-32 {:08x}",
                                                 std::filesystem::path(file).filename().string(), crc32));
    inputs.emplace_back("Clutter", emfield::clutterText(*study_.base));
    report_.facts(inputs);
    report_.facts({{"Study", study_.file},
                   {"Hash of study, scenario and files", study_.hash},
                   {"Variants computed", fmt::format("{} of {}", computed_.size(), study_.variants.count())},
                   {"Times", times_s.size() == 1 ? fmt::format("{} s", times_s.front())
                                                 : fmt::format("{} from {} to {} s", times_s.size(),
                                                               times_s.front(), times_s.back())},
                   {"Pixels", fmt::format("{} m, {}", study_.cell_m, study_.crs)},
                   {"Emscape", EMSCAPE_VERSION}});
    ReportTable measures{{"Measure", "Product", "Quantity", "Threshold", "Over", "Unit"}, {}, ""};
    for (const StudyMeasure& measure : study_.measures) {
      const std::string over =
          measure.over.empty() ? "the whole map" : std::filesystem::path(measure.over).filename().string();
      measures.rows.push_back(
          {measure.name,
           study::titleOf(measure.product, measure.quantity) +
               (info(measure.product).at_heights ? " at " + describe(measure.height) : std::string()),
           study::titleOf(measure.quantity),
           quantityText(measure.threshold, scenario::info(measure.quantity).unit), over, unitOf(measure)});
    }
    report_.table(measures);
    ReportTable parameters{{"Parameter", "Settings", "A change computes again"}, {}, ""};
    for (std::size_t path = 0; path < plan_.classes.size(); ++path) {
      const VariantFactor& factor = study_.variants.factors()[study_.variants.factorOf(path)];
      parameters.rows.push_back(
          {study_.variants.paths()[path], fmt::format("{}", factor.count), toString(plan_.classes[path])});
    }
    report_.table(parameters);
    report_.warnings({results_.warnings.begin(), results_.warnings.end()});
  }

  void addSites(const std::filesystem::path& file) {
    const std::size_t m = study_.sites->measure;
    const MapGrid grid = mapGridOf(study_);
    // Of equal sites the first is chosen: those at sea level, which may be water, come last.
    const scenario::TerrainPtr terrain = terrainOfSites();
    std::vector<bool> are_at_sea;
    for (const std::size_t v : computed_) are_at_sea.push_back(isAtSeaLevel(terrain.get(), v));
    std::vector<std::size_t> order(computed_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_partition(order.begin(), order.end(), [&](std::size_t site) { return !are_at_sea[site]; });
    std::vector<std::vector<std::uint8_t>> ordered, pixels;
    for (const std::size_t site : order) ordered.push_back(results_.pixels[computed_[site]]);
    for (const std::size_t v : computed_) pixels.push_back(results_.pixels[v]);
    std::vector<std::size_t> chosen =
        chooseSites(ordered, grid.areas_m2, static_cast<std::size_t>(study_.sites->choose));
    for (std::size_t& site : chosen) site = order[site];
    std::sort(chosen.begin(), chosen.end());
    summary_.equal_sites = equalSites(pixels, grid.areas_m2, chosen);
    const StudyMeasure& measure = study_.measures[m];
    const auto together = [&](const std::vector<std::size_t>& sites) {
      const double km2 = coveredWeight(pixels, grid.areas_m2, sites) / 1e6;
      // A percentage refers to the area with values, which is the same for every site.
      const std::size_t first = sites.front();
      const double own_km2 = coveredWeight(pixels, grid.areas_m2, {first}) / 1e6;
      return measure.figure == StudyMeasure::Figure::percent
                 ? (own_km2 > 0 ? value(computed_[first], m) * km2 / own_km2 : 0)
                 : km2;
    };
    report_.section("Sites");
    report_.paragraph(fmt::format(
        "{} of {} candidates, chosen by '{}': each place counts where at least one of them alone reaches the "
        "threshold, with the scenario's other emitters as they are.",
        chosen.size(), pixels.size(), measure.name));
    ReportTable table{
        {"Site", "Latitude (deg)", "Longitude (deg)", titleOf(measure) + " alone", "Together so far"},
        {},
        ""};
    std::vector<std::size_t> so_far;
    std::string at_sea;
    for (const std::size_t site : chosen) {
      so_far.push_back(site);
      const std::size_t v = computed_[site];
      const VariantFactor& factor = study_.variants.factors().front();
      summary_.sites.push_back({factor.names[v], degrees(v, 0), degrees(v, 1), are_at_sea[site]});
      if (summary_.sites.back().is_at_sea_level) at_sea += (at_sea.empty() ? "" : ", ") + factor.names[v];
      table.rows.push_back({factor.names[v], factor.value(v, 0), factor.value(v, 1), text(v, m),
                            figureText(together(so_far), unitOf(measure))});
    }
    if (!chosen.empty()) summary_.sites_value = together(chosen);
    report_.table(table);
    if (summary_.equal_sites > 0) report_.paragraph(equalSitesText(summary_) + ".");
    if (!at_sea.empty())
      report_.paragraph("The ground is at sea level, which may be water, at: " + at_sea +
                        ". To search on land, name candidates there in a table ('candidates').");
    writeCandidates(file, m, chosen, are_at_sea);
  }

  /// Null where the elevation files are no longer there: the report does without.
  scenario::TerrainPtr terrainOfSites() const {
    try {
      return loadTerrain(*study_.base, study_.area);
    } catch (const Error&) {
      return nullptr;
    }
  }
  bool isAtSeaLevel(const scenario::Terrain* terrain, std::size_t v) const {
    constexpr double kSea_m = 0.5;
    return terrain != nullptr &&
           std::abs(static_cast<double>(terrain->heightMsl_m(degrees(v, 0), degrees(v, 1)))) <= kSea_m;
  }

  /// A coordinate of a candidate.
  double degrees(std::size_t v, std::size_t coordinate) const {
    return document::numberOf(study_.variants.factors().front().value(v, coordinate)).value_or(NAN);
  }

  /// All candidates as points with their measure; `chosen` counts from 1.
  void writeCandidates(const std::filesystem::path& file, std::size_t m,
                       const std::vector<std::size_t>& chosen, const std::vector<bool>& are_at_sea) const {
    using SitesJson = nlohmann::ordered_json;
    SitesJson features = SitesJson::array();
    for (std::size_t site = 0; site < computed_.size(); ++site) {
      const std::size_t v = computed_[site];
      const auto rank = std::find(chosen.begin(), chosen.end(), site);
      const double alone = value(v, m);
      SitesJson place = SitesJson::array();
      place.push_back(degrees(v, 1));
      place.push_back(degrees(v, 0));
      SitesJson properties;
      properties["name"] = study_.variants.factors().front().names[v];
      properties[study_.measures[m].name] = std::isnan(alone) ? SitesJson() : SitesJson(alone);
      properties["chosen"] = rank == chosen.end() ? SitesJson() : SitesJson(rank - chosen.begin() + 1);
      properties["at_sea_level"] = static_cast<bool>(are_at_sea[site]);
      features.push_back({{"type", "Feature"},
                          {"properties", properties},
                          {"geometry", {{"type", "Point"}, {"coordinates", place}}}});
    }
    SitesJson all;
    all["type"] = "FeatureCollection";
    all["name"] = study_.name;
    all["features"] = features;
    writeWhole(file, [&](std::ostream& out) { out << dumpJson(all) << "\n"; });
  }

  void addMeasure(std::size_t m) {
    const StudyMeasure& measure = study_.measures[m];
    MeasureSummary summary;
    summary.name = measure.name;
    summary.unit = unitOf(measure);
    summary.min = summary.max = summary.mean = NAN;
    std::vector<std::size_t> ranked;
    for (const std::size_t v : computed_) {
      if (!std::isnan(value(v, m))) ranked.push_back(v);
    }
    std::stable_sort(ranked.begin(), ranked.end(),
                     [&](std::size_t a, std::size_t b) { return value(a, m) > value(b, m); });
    report_.section(titleOf(measure));
    if (ranked.empty()) {
      report_.paragraph("No variant has a value.");
      summary_.measures.push_back(summary);
      return;
    }
    double sum = 0;
    for (const std::size_t v : ranked) sum += value(v, m);
    summary.mean = sum / static_cast<double>(ranked.size());
    summary.max_variant = ranked.front();
    summary.max = value(ranked.front(), m);
    summary.with_max = static_cast<std::size_t>(std::count_if(
        ranked.begin(), ranked.end(), [&](std::size_t v) { return value(v, m) == summary.max; }));
    summary.min_variant = ranked.back();
    summary.min = value(ranked.back(), m);
    std::vector<double> ascending;
    double squares = 0;
    for (auto v = ranked.rbegin(); v != ranked.rend(); ++v) {
      ascending.push_back(value(*v, m));
      squares += (ascending.back() - summary.mean) * (ascending.back() - summary.mean);
    }
    if (ascending.size() > 1)
      summary.deviation = std::sqrt(squares / static_cast<double>(ascending.size() - 1));
    summary.percentile_5 = percentileOf(ascending, 0.05);
    summary.median = percentileOf(ascending, 0.5);
    summary.percentile_95 = percentileOf(ascending, 0.95);
    summary_.measures.push_back(summary);
    const auto figure = [&](double of) { return figureText(of, summary.unit); };
    std::string spread;
    if (ascending.size() > 1)
      spread = fmt::format(
          "; standard deviation {}; 5 % of the variants are below {}, half below {}, 95 % below {}",
          figure(summary.deviation), figure(summary.percentile_5), figure(summary.median),
          figure(summary.percentile_95));
    report_.paragraph(fmt::format("From {} to {}, mean {}{}.", figure(summary.min), figure(summary.max),
                                  figure(summary.mean), spread));
    const std::size_t count = std::min(kBest, ranked.size());
    report_.table(
        ranking(m, {ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count)}, "Largest"));
    if (ranked.size() > count) {
      report_.table(
          ranking(m, {ranked.rbegin(), ranked.rbegin() + static_cast<std::ptrdiff_t>(count)}, "Smallest"));
    }
    for (std::size_t path = 0; path < plan_.classes.size() && plots_ < kMaxPlots; ++path) addPlot(m, path);
  }

  ReportTable ranking(std::size_t m, const std::vector<std::size_t>& variants,
                      const std::string& caption) const {
    ReportTable table{{"Variant", titleOf(study_.measures[m]), "What it sets"}, {}, caption};
    for (const std::size_t v : variants) {
      table.rows.push_back({fmt::format("{}", v), text(v, m), describeVariant(study_, v)});
    }
    return table;
  }

  /// A measure over a parameter that has two values or more.
  void addPlot(std::size_t m, std::size_t path) {
    MeasurePlot plot;
    plot.parameter = study_.variants.paths()[path];
    plot.measure = titleOf(study_.measures[m]);
    std::map<std::string, double> positions;
    bool is_number = true;
    for (const std::size_t v : computed_) {
      const std::string& text = study_.variants.value(v, path);
      positions.emplace(text, 0);
      is_number = is_number && (text.empty() || document::numberOf(text).has_value());
    }
    if (positions.size() < 2 || (positions.size() == 2 && positions.count("") != 0)) return;
    if (!is_number) {
      for (auto& [text, position] : positions) {
        position = static_cast<double>(plot.labels.size());
        plot.labels.push_back(text.empty() ? "(unchanged)" : text);
      }
    }
    double smallest = HUGE_VAL, largest = -HUGE_VAL;
    for (const std::size_t v : computed_) {
      const std::string& text = study_.variants.value(v, path);
      plot.x.push_back(is_number ? document::numberOf(text).value_or(NAN) : positions[text]);
      plot.y.push_back(value(v, m));
      if (std::isnan(plot.x.back())) continue;
      smallest = std::min(smallest, plot.x.back());
      largest = std::max(largest, plot.x.back());
    }
    constexpr double kWide = 20;
    plot.is_logarithmic = is_number && smallest > 0 && largest > kWide * smallest;
    report_.drawing(drawMeasure(plot),
                    plot.measure + " over " + plot.parameter + "; blue: the variants, orange: their mean");
    ++plots_;
  }

  void addTable() {
    report_.section("Variants");
    if (computed_.size() > kMaxRows) {
      report_.paragraph(fmt::format("The first {} of {}; results.csv has all.", kMaxRows, computed_.size()));
    }
    ReportTable table{{"Variant", "What it sets"}, {}, ""};
    for (const StudyMeasure& measure : study_.measures) table.columns.push_back(titleOf(measure));
    for (std::size_t i = 0; i < std::min(kMaxRows, computed_.size()); ++i) {
      const std::size_t v = computed_[i];
      table.rows.push_back({fmt::format("{}", v), describeVariant(study_, v)});
      for (std::size_t m = 0; m < study_.measures.size(); ++m) table.rows.back().push_back(text(v, m));
    }
    report_.table(table);
  }

  const StudySpec& study_;
  const StudyPlan& plan_;
  const StudyResults& results_;
  HtmlReport report_;
  std::vector<std::size_t> computed_;
  StudySummary summary_;
  std::size_t plots_ = 0;
};

}  // namespace

std::string equalSitesText(const StudySummary& summary) {
  return countText(summary.equal_sites, "other candidate", "other candidates") + " would do as well";
}

StudySummary writeStudyReport(const std::filesystem::path& file, const StudySpec& study,
                              const StudyPlan& plan, const StudyResults& results) {
  return ReportWriter(study, plan, results).write(file);
}

}  // namespace emscape::study
