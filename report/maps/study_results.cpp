#include "report/maps/study_results.h"

#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"
#include "emscape/study/maps/map.h"
#include "playback/frames/open_on_target.h"
#include "report/text.h"
#include "report/warnings.h"

namespace emscape::report {
namespace {

VariantTimes measureTimes(const study::LoadedStudy& loaded, const std::string& backend,
                          const ProgressSink& progress) {
  return playback::openOnTarget(backend, [&](const playback::ComputeTarget& target) {
    Stopwatch watch;
    study::StudyRunner runner(loaded.spec, loaded.plan, loaded.terrain, target.fieldOptions());
    const std::vector<std::uint32_t>& order = loaded.plan.order;
    const auto run = [&](std::size_t position) {
      if (progress) progress("variants", 0);
      runner.run({order[position]}, [](const study::VariantResult&) {});
      return watch.lap_ms() / 1000;
    };
    VariantTimes times;
    times.first_s = run(0);
    constexpr std::size_t kSearched = 100000;
    std::size_t at = 0;
    for (std::size_t c = 0; c < study::kChangeClasses; ++c) {
      for (std::size_t i = 1; i < std::min(order.size(), kSearched); ++i) {
        const auto change = study::changeBetween(loaded.spec, loaded.plan, order[i - 1], order[i]);
        if (static_cast<std::size_t>(change) != c) continue;
        if (at != i - 1) run(i - 1);
        times.by_class[c] = run(at = i);
        break;
      }
    }
    return times;
  });
}

/// Parameters with their classes, and changes by class.
std::pair<Json, Json> partsOf(const PlanReport& plan) {
  const study::LoadedStudy& loaded = *plan.loaded;
  const study::VariantSet& variants = loaded.spec.variants;
  Json parameters = Json::array(), changes = Json::object();
  for (std::size_t path = 0; path < variants.paths().size(); ++path) {
    parameters.push_back({{"path", variants.paths()[path]},
                          {"class", toString(loaded.plan.classes[path])},
                          {"settings", variants.factors()[variants.factorOf(path)].count}});
  }
  for (std::size_t c = 0; c < study::kChangeClasses; ++c) {
    changes[toString(static_cast<study::ChangeClass>(c))] = {{"variants", loaded.plan.changes[c]},
                                                             {"seconds_each", plan.times.by_class[c]}};
  }
  return {parameters, changes};
}

}  // namespace

PlanReport planReport(const study::LoadedStudy& loaded, int parts, int jobs, double loading_s,
                      const std::string& backend, const ProgressSink& progress) {
  const study::VariantSet& variants = loaded.spec.variants;
  const VariantTimes times = measureTimes(loaded, backend, progress);
  study::checkParts(parts, variants.count());
  double computing_s = times.first_s;
  for (std::size_t c = 0; c < study::kChangeClasses; ++c) {
    const std::size_t first = c == 0 ? 1 : 0;
    computing_s += static_cast<double>(loaded.plan.changes[c] - first) * times.by_class[c];
  }
  const double expected_s = loading_s + computing_s / jobs;
  const double single_s = static_cast<double>(variants.count()) * (loading_s + times.first_s);
  const double bytes_of_row =
      24.0 * static_cast<double>(1 + variants.paths().size() + loaded.spec.measures.size());
  const double bytes = 4 * bytes_of_row * static_cast<double>(variants.count()) + 1000.0 * parts;
  return {&loaded, parts, jobs, times, expected_s, single_s, bytes};
}

Json toJson(const PlanReport& plan) {
  const study::StudySpec& spec = plan.loaded->spec;
  const auto [parameters, changes] = partsOf(plan);
  return {{"study", spec.name},
          {"hash", spec.hash},
          {"variants", spec.variants.count()},
          {"parts", plan.parts},
          {"jobs", plan.jobs},
          {"parameters", parameters},
          {"changes", changes},
          {"expected_s", plan.expected_s},
          {"single_runs_s", plan.single_runs_s},
          {"bytes", plan.bytes}};
}

std::string planText(const PlanReport& plan) {
  const study::StudySpec& spec = plan.loaded->spec;
  const auto [parameters, changes] = partsOf(plan);
  const int parts = plan.parts, jobs = plan.jobs;
  Text out;
  out.add("Study {}: {} variants of {}, {} measure{}, in {} part{}\n", spec.name, spec.variants.count(),
          spec.base->name, spec.measures.size(), spec.measures.size() == 1 ? "" : "s", parts,
          parts == 1 ? "" : "s");
  out.add("  {:<56} {:>8}  {}\n", "parameter", "settings", "a change computes again");
  for (const Json& parameter : parameters) {
    out.add("  {:<56} {:>8}  {}\n", parameter["path"].get<std::string>(),
            parameter["settings"].get<std::size_t>(), parameter["class"].get<std::string>());
  }
  out.add("  {:<56} {:>8}  {}\n", "variants that change", "number", "ms each");
  for (const auto& [name, change] : changes.items()) {
    const auto number = change["variants"].get<std::size_t>();
    if (number == 0) continue;
    out.add("  {:<56} {:>8}  {:.1f}\n", name, number,
            1000 * (name == "geometry" && number == 1 ? plan.times.first_s
                                                      : change["seconds_each"].get<double>()));
  }
  out.add("  expected: {:.1f} s in {} process{}, {:.1f} MB; as single runs {:.1f} s, {:.1f} times as long\n",
          plan.expected_s, jobs, jobs == 1 ? "" : "es", plan.bytes / 1e6, plan.single_runs_s,
          plan.single_runs_s / plan.expected_s);
  return out.take();
}

StudyReport mergeParts(const study::LoadedStudy& loaded, const study::StudyFolder& folder) {
  const std::vector<int> missing = folder.missingParts();
  study::StudyResults results = folder.read();
  std::vector<std::string> warnings(results.warnings.begin(), results.warnings.end());
  if (results.machines.size() > 1) {
    std::string machines;
    for (const std::string& machine : results.machines) machines += (machines.empty() ? "" : "; ") + machine;
    warnings.push_back("parts were computed on different processors, which may differ in the last digit: " +
                       machines);
  }
  warnings = joinedWarnings(warnings);
  results.warnings = {warnings.begin(), warnings.end()};
  folder.writeResults(results);
  auto summary = study::writeStudyReport(folder.path() / "report.html", loaded.spec, loaded.plan, results);
  return {&loaded, folder.path().string(), folder.parts(), missing, std::move(warnings), std::move(summary)};
}

Json toJson(const StudyReport& report) {
  const study::StudySpec& spec = report.loaded->spec;
  Json json{{"study", spec.name},      {"hash", spec.hash},
            {"folder", report.folder}, {"variants", spec.variants.count()},
            {"parts", report.parts},   {"missing_parts", report.missing_parts}};
  json["warnings"] = report.warnings;
  json["best"] = Json::array();
  for (const study::MeasureSummary& summary : report.summary.measures) {
    json["best"].push_back({{"measure", summary.name},
                            {"unit", summary.unit},
                            {"max", number(summary.max)},
                            {"max_variant", summary.max_variant},
                            {"variants_with_max", summary.with_max},
                            {"min", number(summary.min)},
                            {"min_variant", summary.min_variant},
                            {"mean", number(summary.mean)},
                            {"standard_deviation", number(summary.deviation)},
                            {"percentile_5", number(summary.percentile_5)},
                            {"median", number(summary.median)},
                            {"percentile_95", number(summary.percentile_95)}});
  }
  if (!report.summary.sites.empty()) {
    Json chosen = Json::array(), places = Json::array();
    for (const study::ChosenSite& site : report.summary.sites) {
      chosen.push_back(site.name);
      places.push_back({{"latitude_deg", site.latitude_deg},
                        {"longitude_deg", site.longitude_deg},
                        {"at_sea_level", site.is_at_sea_level}});
    }
    json["sites"] = {{"chosen", chosen},
                     {"places", places},
                     {"value", report.summary.sites_value},
                     {"equal_candidates", report.summary.equal_sites}};
  }
  return json;
}

std::string studyText(const StudyReport& report) {
  const study::StudySpec& spec = report.loaded->spec;
  Text out;
  for (const study::MeasureSummary& summary : report.summary.measures) {
    if (std::isnan(summary.max)) {
      out.add("{:<24} no value in any variant\n", summary.name);
      continue;
    }
    const std::string unit = summary.unit.empty() ? "" : " " + summary.unit;
    if (summary.min == summary.max && summary.with_max > 1) {
      out.add("{:<24} {}{} in each of {} variants\n", summary.name,
              study::figureText(summary.max, summary.unit), unit, summary.with_max);
      continue;
    }
    out.add("{:<24} {} to {}{}; the largest: {}{}\n", summary.name,
            study::figureText(summary.min, summary.unit), study::figureText(summary.max, summary.unit), unit,
            study::describeVariant(spec, summary.max_variant),
            summary.with_max > 1 ? fmt::format(", and the same in {} more", summary.with_max - 1) : "");
  }
  if (!report.summary.sites.empty()) {
    std::string names;
    for (const study::ChosenSite& site : report.summary.sites)
      names += fmt::format("{}{} ({:.5f}, {:.5f}{})", names.empty() ? "" : ", ", site.name, site.latitude_deg,
                           site.longitude_deg,
                           site.is_at_sea_level ? "; the ground there is at sea level: water?" : "");
    const std::string unit = unitOf(spec.measures[spec.sites->measure]);
    out.add("sites: {}: {} {}{}\n", names, study::figureText(report.summary.sites_value, unit), unit,
            report.summary.equal_sites > 0 ? "; " + study::equalSitesText(report.summary) : "");
  }
  out.add("{}: results.csv, results.nc, report.html\n", report.folder);
  return out.take();
}

}  // namespace emscape::report
