#include "emscape/study/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "study/changed_areas.h"

namespace emscape::study {
namespace {

/// The map of what changed, and its figures.
class Pair {
 public:
  Pair(const MapGrid& grid, const CoverageMap& a, const CoverageMap& b) : grid_(grid), a_(a), b_(b) {
    row.product = a.product;
    row.height = a.height;
    row.time_s = a.time_s;
    row.unit = a.unit;
    row.is_area = info(a.product).area_class >= 0;
    row.mean_difference = row.min_difference = row.max_difference = NAN;
    map = a;
    map.labels.clear();
    map.colors.clear();
    map.area_class = -1;
    if (row.is_area) {
      change();
    } else {
      differ();
    }
  }

  Map map;
  ComparisonRow row;

 private:
  void change() {
    constexpr int kGreen = 2, kVermilion = 5, kSkyBlue = 1;
    map.name += "_change";
    map.kind = MapKind::classes;
    map.title = map.name;
    map.description = "change of " + a_.description;
    map.labels = {"neither", "gained", "lost", "kept"};
    map.colors = {0, kGreen, kVermilion, kSkyBlue};
    const auto marked = static_cast<float>(info(a_.product).area_class);
    forBoth([&](std::size_t p, double area_m2) {
      const bool in_a = a_.values[p] == marked, in_b = b_.values[p] == marked;
      map.values[p] = in_a && in_b ? kKept : in_b ? kGained : in_a ? kLost : 0;
      if (in_a) row.area_a_m2 += area_m2;
      if (in_b) row.area_b_m2 += area_m2;
      if (in_b && !in_a) row.gained_m2 += area_m2;
      if (in_a && !in_b) row.lost_m2 += area_m2;
    });
  }

  void differ() {
    map.name += "_difference";
    map.kind = MapKind::difference;
    map.title = map.name;
    map.description = "difference of " + a_.description;
    if (map.unit.rfind("dB", 0) == 0) map.unit = row.unit = "dB";
    double sum = 0;
    forBoth([&](std::size_t p, double area_m2) {
      const double difference = static_cast<double>(b_.values[p]) - static_cast<double>(a_.values[p]);
      map.values[p] = static_cast<float>(difference);
      sum += difference * area_m2;
      if (!(difference >= row.min_difference)) row.min_difference = difference;
      if (!(difference <= row.max_difference)) row.max_difference = difference;
    });
    if (row.known_area_m2 > 0) row.mean_difference = sum / row.known_area_m2;
  }

  template <class Visit>
  void forBoth(const Visit& visit) {
    map.values.assign(grid_.pixels(), NAN);
    for (std::size_t p = 0; p < grid_.pixels(); ++p) {
      if (std::isnan(a_.values[p]) || std::isnan(b_.values[p])) continue;
      const auto area_m2 = static_cast<double>(grid_.areas_m2[p]);
      row.known_area_m2 += area_m2;
      visit(p, area_m2);
    }
  }

  const MapGrid& grid_;
  const CoverageMap &a_, &b_;
};

void addOnce(std::vector<std::string>& all, const std::vector<std::string>& more, const char* of) {
  for (const std::string& warning : more) all.push_back(fmt::format("{}: {}", of, warning));
}

/// Keeps the largest areas of one kind.
void keepLargest(std::vector<ChangedArea>& areas, int most) {
  std::stable_sort(areas.begin(), areas.end(), [](const ChangedArea& one, const ChangedArea& other) {
    return one.area_m2 > other.area_m2;
  });
  areas.resize(std::min(areas.size(), static_cast<std::size_t>(std::max(most, 0))));
}

}  // namespace

Comparison computeComparison(const ComparedScenario& a, const ComparedScenario& b, const MapGrid& grid,
                             const CompareRequest& request, const emfield::FieldOptions& options,
                             const std::function<void(const Map&)>& take, const ProgressSink& progress) {
  const std::vector<Product>& products = request.coverage.products;
  if (std::find(products.begin(), products.end(), Product::best) != products.end()) {
    throw Error(ErrorCode::usage, "product 'best' is an index: it has no difference");
  }
  const auto halfOf = [&](double done) -> ProgressSink {
    if (!progress) return {};
    return [&progress, done](const std::string& step, double part) { progress(step, done + part / 2); };
  };
  std::vector<CoverageMap> of_a;
  Comparison comparison;
  const std::vector<std::string> warnings_a = computeCoverage(
      a.scenario, a.terrain, grid, request.coverage, options,
      [&](CoverageMap map) { of_a.push_back(std::move(map)); }, halfOf(0));
  // A path belongs to one height and time.
  const auto explained = std::find_if(products.begin(), products.end(),
                                      [](Product product) { return info(product).area_class >= 0; });
  std::vector<ChangedArea> gained, lost;
  const auto takePair = [&](const CoverageMap& map_b) {
    CoverageMap& map_a = of_a[comparison.rows.size()];
    const Pair pair(grid, map_a, map_b);
    map_a.values = {};
    comparison.rows.push_back(pair.row);
    const bool is_explained =
        explained != products.end() && pair.row.product == *explained && pair.row.height && pair.row.time_s;
    for (const float changed : {kGained, kLost}) {
      if (!is_explained) break;
      for (ChangedArea& area : largestAreas(grid, pair.map.values, changed, request.areas)) {
        area.product = pair.row.product;
        area.height = *pair.row.height;
        area.time_s = *pair.row.time_s;
        (area.is_gained ? gained : lost).push_back(area);
      }
    }
    take(pair.map);
  };
  const std::vector<std::string> warnings_b =
      computeCoverage(b.scenario, b.terrain, grid, request.coverage, options, takePair, halfOf(0.5));
  for (std::vector<ChangedArea>* areas : {&gained, &lost}) {
    keepLargest(*areas, request.areas);
    for (ChangedArea& area : *areas) {
      explain(area, request.coverage.quantity, a, b);
      comparison.changed_areas.push_back(std::move(area));
    }
  }
  addOnce(comparison.warnings, warnings_a, "A");
  addOnce(comparison.warnings, warnings_b, "B");
  return comparison;
}

}  // namespace emscape::study
