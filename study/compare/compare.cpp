#include "study/compare/compare.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/compare/changed_areas.h"
#include "study/compare/map_comparer.h"

namespace emscape::study {
std::vector<std::string> warningsOfBoth(const std::vector<std::string>& of_a,
                                        const std::vector<std::string>& of_b) {
  const auto has = [](const std::vector<std::string>& all, const std::string& warning) {
    return std::find(all.begin(), all.end(), warning) != all.end();
  };
  std::vector<std::string> warnings;
  for (const std::string& warning : of_a)
    warnings.push_back((has(of_b, warning) ? "A and B: " : "A: ") + warning);
  for (const std::string& warning : of_b)
    if (!has(of_a, warning)) warnings.push_back("B: " + warning);
  return warnings;
}

void checkRequest(const CompareRequest& request, const scenario::Scenario& a, const scenario::Scenario& b) {
  requireDifferences(request.coverage.products);
  const scenario::QuantityInfo& quantity = scenario::info(request.coverage.quantity);
  if (quantity.categorical) {
    throw Error(ErrorCode::usage,
                fmt::format("quantity '{}' is an index: it has no difference", quantity.name));
  }
  checkRequest(request.coverage, a);
  checkRequest(request.coverage, b);
}

Comparison computeComparison(const ComparedScenario& a, const ComparedScenario& b, const MapGrid& grid,
                             const CompareRequest& request, const emfield::FieldOptions& options,
                             const std::function<void(const Map&)>& take, const ProgressSink& progress) {
  checkRequest(request, *a.scenario, *b.scenario);
  const auto halfOf = [&](double done) -> ProgressSink {
    if (!progress) return {};
    return [&progress, done](const std::string& step, double part) { progress(step, done + part / 2); };
  };
  std::vector<CoverageMap> of_a;
  const std::vector<std::string> warnings_a = computeCoverage(
      a.scenario, a.terrain, grid, request.coverage, options,
      [&](CoverageMap map) { of_a.push_back(std::move(map)); }, halfOf(0));
  MapComparer comparer(grid, request.coverage.products, request.areas, take);
  std::size_t taken = 0;
  const auto takePair = [&](const CoverageMap& map_b) {
    CoverageMap& map_a = of_a[taken++];
    comparer.add(map_a, map_b);
    map_a.values = {};
  };
  const std::vector<std::string> warnings_b =
      computeCoverage(b.scenario, b.terrain, grid, request.coverage, options, takePair, halfOf(0.5));
  Comparison comparison = comparer.finish();
  comparison.has_paths = true;
  for (ChangedArea& area : comparison.changed_areas) explain(area, request.coverage.quantity, a, b);
  comparison.warnings = warningsOfBoth(warnings_a, warnings_b);
  return comparison;
}

}  // namespace emscape::study
