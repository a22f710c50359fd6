#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "study/compare/changed_areas.h"
#include "study/compare/compare.h"
#include "study/compare/map_comparer.h"
#include "study/report/earlier_outputs.h"
#include "study/report/map_report.h"

namespace emscape::study {
namespace {

/// @param what  name of the property in which B differs from A
[[noreturn]] void failDiffer(const CoverageFolder& a, const CoverageFolder& b, const std::string& what,
                             const std::string& of_a, const std::string& of_b, const char* hint = "") {
  throw Error(ErrorCode::bad_input, {b.path.string(), 0, 0},
              fmt::format("{} differs from {}: {} instead of {}{}", what, a.path.string(), of_b, of_a, hint));
}

std::string textOf(const MapGrid& grid) {
  return fmt::format("{} x {} of {} m in {}, from {}, {}", grid.width, grid.height, grid.cell_m, grid.crs,
                     grid.left_m, grid.top_m);
}

void checkAlike(const CoverageFolder& a, const CoverageFolder& b) {
  const MapGrid &of_a = *a.grid, &of_b = *b.grid;
  if (of_a.wkt != of_b.wkt || textOf(of_a) != textOf(of_b)) {
    failDiffer(a, b, "the grid of pixels", textOf(of_a), textOf(of_b),
               "; emscape coverage makes them alike with the same --area, --cell and --crs");
  }
  if (a.quantity != b.quantity) {
    failDiffer(a, b, "the quantity", scenario::info(a.quantity).name, scenario::info(b.quantity).name);
  }
}

bool isSame(const std::optional<MapHeight>& a, const std::optional<MapHeight>& b) {
  return a.has_value() == b.has_value() && (!a || (a->reference == b->reference && a->metres == b->metres));
}

/// Within the rounding errors of times that were computed from steps in different ways.
bool isSameTime(double a_s, double b_s) {
  return std::abs(a_s - b_s) <= 1e-9 + 1e-15 * std::abs(a_s);
}

bool isSame(const std::optional<double>& a_s, const std::optional<double>& b_s) {
  return a_s.has_value() == b_s.has_value() && (!a_s || isSameTime(*a_s, *b_s));
}

bool isSameMap(const CoverageMap& a, const CoverageMap& b) {
  return a.product == b.product && isSame(a.height, b.height) && isSame(a.time_s, b.time_s);
}

/// True for maps of a choice. Maps for all heights or times belong to every choice.
bool isChosen(const CoverageMap& map, const MapChoice& choice) {
  const auto holds = [](const auto& list, const auto& test) {
    return list.empty() || std::any_of(list.begin(), list.end(), test);
  };
  const bool is_of_product =
      choice.products.empty()
          ? map.kind != MapKind::category
          : holds(choice.products, [&](Product product) { return product == map.product; });
  return is_of_product &&
         (!map.height ||
          holds(choice.heights, [&](const MapHeight& height) { return isSame(height, map.height); })) &&
         (!map.time_s ||
          holds(choice.times_s, [&](double time_s) { return isSameTime(time_s, *map.time_s); }));
}

/// Index of the corresponding map; -1: none.
std::ptrdiff_t indexOf(const CoverageFolder& folder, const CoverageMap& map) {
  const auto found = std::find_if(folder.maps.begin(), folder.maps.end(),
                                  [&](const CoverageMap& other) { return isSameMap(other, map); });
  return found == folder.maps.end() ? -1 : found - folder.maps.begin();
}

/// @throws Error (bad_input) if a chosen map of one folder is not in the other
void requireMapsOf(const CoverageFolder& one, const CoverageFolder& other, const MapChoice& choice) {
  for (const CoverageMap& map : one.maps) {
    if (!isChosen(map, choice) || indexOf(other, map) >= 0) continue;
    throw Error(
        ErrorCode::bad_input, {(other.path / "report.json").string(), 0, 0},
        fmt::format("has no map of {}, which {} has; --products, --heights and --times choose maps that "
                    "both have",
                    nameOf(map), one.path.string()));
  }
}

/// @param has    the values of the folder's maps, as text
/// @param asked  the choice, which matches none of them
[[noreturn]] void failNotThere(const CoverageFolder& folder, const char* option, const std::string& asked,
                               const std::set<std::string>& has) {
  throw Error(ErrorCode::usage, fmt::format("{}: {} has no map {}; it has {}", option, folder.path.string(),
                                            asked, fmt::join(has, ", ")));
}

/// Maps for all heights or times match every choice, so they are ignored: otherwise a missing choice would
/// not be noticed.
/// @throws Error (usage) if the folder has no map of a chosen product or height, or of any chosen time
void requireChoice(const CoverageFolder& folder, const MapChoice& choice) {
  std::set<std::string> products, heights, times;
  bool has_time = choice.times_s.empty();
  for (const CoverageMap& map : folder.maps) {
    if (map.kind != MapKind::category) products.insert(info(map.product).name);
    if (map.height) heights.insert(describe(*map.height));
    if (!map.time_s) continue;
    times.insert(fmt::format("{:g} s", *map.time_s));
    has_time = has_time || std::any_of(choice.times_s.begin(), choice.times_s.end(),
                                       [&](double time_s) { return isSameTime(time_s, *map.time_s); });
  }
  for (const Product product : choice.products) {
    if (products.count(info(product).name) == 0)
      failNotThere(folder, "--products", fmt::format("of {}", info(product).name), products);
  }
  for (const MapHeight& height : choice.heights) {
    if (!heights.empty() && heights.count(describe(height)) == 0)
      failNotThere(folder, "--heights", "at " + describe(height), heights);
  }
  if (!has_time && !times.empty()) failNotThere(folder, "--times", "at these times", times);
}

/// The maps that are not as the folder's study.json lists them.
/// @param maps  that are compared, and were read
std::vector<std::string> changedMapsOf(const CoverageFolder& folder, const std::set<std::size_t>& maps) {
  std::set<std::string> files;
  for (const std::size_t map : maps) files.insert(folder.geotiffs[map]);
  std::vector<std::string> changed;
  for (const nlohmann::ordered_json& output : outputsOf(folder.path, "coverage")) {
    const std::string file = output.at("file");
    if (files.count(file) > 0 && digestJson(file, folder.path / file) != output)
      changed.push_back((folder.path / file).string());
  }
  return changed;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> pairsOf(const CoverageFolder& a, const CoverageFolder& b,
                                                         const MapChoice& choice) {
  requireDifferences(choice.products);
  checkAlike(a, b);
  requireMapsOf(a, b, choice);
  requireMapsOf(b, a, choice);
  requireChoice(a, choice);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t m = 0; m < a.maps.size(); ++m) {
    const CoverageMap& map = a.maps[m];
    if (!isChosen(map, choice)) continue;
    if (map.kind == MapKind::category)
      throw Error(ErrorCode::usage,
                  fmt::format("{}: differences of a categorical quantity are not defined", nameOf(map)));
    const auto n = static_cast<std::size_t>(indexOf(b, map));
    if (map.unit != b.maps[n].unit) {
      failDiffer(a, b, "the unit of " + nameOf(map), "'" + map.unit + "'", "'" + b.maps[n].unit + "'");
    }
    if (map.product != Product::value && a.threshold != b.threshold) {
      failDiffer(a, b, "the threshold of " + nameOf(map), fmt::format("{}", a.threshold),
                 fmt::format("{}", b.threshold));
    }
    pairs.emplace_back(m, n);
  }
  if (pairs.empty()) {
    throw Error(ErrorCode::usage,
                fmt::format("{}: has no map of these products, heights and times", a.path.string()));
  }
  return pairs;
}

Comparison compareFolders(const CoverageFolder& a, const CoverageFolder& b,
                          const std::vector<std::pair<std::size_t, std::size_t>>& chosen, int areas,
                          const std::function<void(const Map&)>& take, const ProgressSink& progress) {
  std::vector<Product> products;
  for (const auto& [of_a, of_b] : chosen) products.push_back(a.maps[of_a].product);
  MapComparer comparer(*a.grid, products, areas, take);
  std::set<std::size_t> read_a, read_b;
  for (std::size_t n = 0; n < chosen.size(); ++n) {
    if (progress) progress("maps", static_cast<double>(n) / static_cast<double>(chosen.size()));
    comparer.add(readMap(a, chosen[n].first), readMap(b, chosen[n].second));
    read_a.insert(chosen[n].first);
    read_b.insert(chosen[n].second);
  }
  if (progress) progress("maps", 1);
  Comparison comparison = comparer.finish();
  comparison.has_paths = a.has_inputs && b.has_inputs;
  for (ChangedArea& area : comparison.changed_areas) {
    if (comparison.has_paths) explain(area, a.quantity, {a.scenario, a.terrain}, {b.scenario, b.terrain});
  }
  const auto checkOf = [](const CoverageFolder& folder) {
    return folder.has_inputs ? warningsOf(*folder.scenario) : std::vector<std::string>{};
  };
  comparison.warnings = warningsOfBoth(checkOf(a), checkOf(b));
  for (const auto& [folder, read] : {std::pair(&a, &read_a), std::pair(&b, &read_b)}) {
    for (const std::string& file : changedMapsOf(*folder, *read)) {
      comparison.warnings.push_back(file +
                                    ": was changed since emscape coverage wrote it; it is compared as it is");
    }
  }
  for (const CoverageFolder* folder : {&a, &b}) {
    if (folder->has_inputs) continue;
    comparison.warnings.push_back(fmt::format(
        "{}: the scenario {} or one of its files is not there or has changed: changed areas are not "
        "explained",
        folder->path.string(), folder->scenario->file));
  }
  return comparison;
}

}  // namespace emscape::study
