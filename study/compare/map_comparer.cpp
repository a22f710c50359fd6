#include "study/compare/map_comparer.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "study/compare/changed_areas.h"

namespace emscape::study {
namespace {

bool isArea(Product product) {
  return info(product).area_class >= 0;
}

/// The map of changes, and its figures.
class Pair {
 public:
  Pair(const MapGrid& grid, const CoverageMap& a, const CoverageMap& b) : grid_(grid), a_(a), b_(b) {
    row.product = a.product;
    row.height = a.height;
    row.time_s = a.time_s;
    row.unit = a.unit;
    row.is_area = isArea(a.product);
    row.mean_difference = row.min_difference = row.max_difference = NAN;
    map = a;
    map.name = changeNameOf(a.product);
    setAnswers();
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
  /// Unknown where that of one map is. The difference of a bound is unknown, too.
  void setAnswers() {
    if (a_.answers.empty() || b_.answers.empty()) {
      map.answers.clear();
      return;
    }
    for (std::size_t p = 0; p < map.answers.size(); ++p) {
      const auto isOf = [&](PixelAnswer answer) {
        return a_.answers[p] == answer || b_.answers[p] == answer;
      };
      const bool is_unknown = isOf(PixelAnswer::unknown) || (!row.is_area && isOf(PixelAnswer::bound));
      map.answers[p] = is_unknown                 ? PixelAnswer::unknown
                       : isOf(PixelAnswer::none)  ? PixelAnswer::none
                       : isOf(PixelAnswer::bound) ? PixelAnswer::bound
                                                  : PixelAnswer::exact;
    }
  }

  void change() {
    constexpr int kGreen = 2, kVermilion = 5, kSkyBlue = 1;
    map.kind = MapKind::classes;
    map.title = "change of " + a_.title;
    map.subject = "change of " + a_.subject;
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
    map.kind = MapKind::difference;
    map.title = a_.title + ", B - A";
    map.subject = "difference B - A of " + a_.subject;
    map.description = "difference B - A of " + a_.description;
    map.floor.reset();
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
      if (!map.answers.empty() && map.answers[p] == PixelAnswer::unknown) continue;
      const auto area_m2 = static_cast<double>(grid_.areas_m2[p]);
      row.known_area_m2 += area_m2;
      visit(p, area_m2);
    }
  }

  const MapGrid& grid_;
  const CoverageMap &a_, &b_;
};

/// Keeps the largest areas of one kind.
void keepLargest(std::vector<ChangedArea>& areas, int most) {
  std::stable_sort(areas.begin(), areas.end(), [](const ChangedArea& one, const ChangedArea& other) {
    return one.area_m2 > other.area_m2;
  });
  areas.resize(std::min(areas.size(), static_cast<std::size_t>(std::max(most, 0))));
}

}  // namespace

MapComparer::MapComparer(const MapGrid& grid, const std::vector<Product>& products, int areas,
                         std::function<void(const Map&)> take)
    : grid_(grid), areas_(areas), take_(std::move(take)) {
  // A path belongs to one height and time, and areas of several products would repeat each other.
  std::copy_if(products.begin(), products.end(), std::back_inserter(products_), isArea);
}

void MapComparer::add(const CoverageMap& a, const CoverageMap& b) {
  const Pair pair(grid_, a, b);
  rows_.push_back(pair.row);
  const bool is_searched =
      !products_.empty() && pair.row.product == products_.front() && pair.row.height && pair.row.time_s;
  for (const float changed : {kGained, kLost}) {
    if (!is_searched) break;
    for (ChangedArea& area : largestAreas(grid_, pair.map.values, changed, areas_)) {
      area.product = pair.row.product;
      area.height = *pair.row.height;
      area.time_s = *pair.row.time_s;
      (area.is_gained ? gained_ : lost_).push_back(area);
    }
  }
  take_(pair.map);
}

Comparison MapComparer::finish() {
  Comparison comparison;
  comparison.rows = std::move(rows_);
  for (std::vector<ChangedArea>* areas : {&gained_, &lost_}) {
    keepLargest(*areas, areas_);
    comparison.changed_areas.insert(comparison.changed_areas.end(), areas->begin(), areas->end());
  }
  return comparison;
}

std::string changeNameOf(Product product) {
  return info(product).name + std::string(isArea(product) ? "_change" : "_difference");
}

void requireDifferences(const std::vector<Product>& products) {
  if (std::find(products.begin(), products.end(), Product::best) != products.end()) {
    throw Error(ErrorCode::usage, "product 'best' is an index: it has no difference");
  }
}

}  // namespace emscape::study
