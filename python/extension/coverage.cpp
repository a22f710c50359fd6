/// Maps of coverage as arrays.
#include "emscape/study/maps/coverage.h"

#include <cmath>

#include "playback/frames/open_on_target.h"
#include "python/extension/module.h"
#include "report/maps/map_options.h"
#include "report/warnings.h"

namespace emscape::python {
namespace {

/// Maps, their grid, warnings.
using MapsAndGrid = nb::typed<nb::tuple, nb::typed<nb::list, Dict>, Dict, std::vector<std::string>>;

const char* toString(study::MapKind kind) {
  switch (kind) {
    case study::MapKind::level:
      return "level";
    case study::MapKind::difference:
      return "difference";
    case study::MapKind::probability:
      return "probability";
    case study::MapKind::fraction:
      return "part";
    case study::MapKind::count:
      return "count";
    case study::MapKind::classes:
      return "classes";
    case study::MapKind::category:
      break;
  }
  return "category";
}

Dict describe(const study::MapGrid& grid) {
  Dict result;
  result["width"] = grid.width;
  result["height"] = grid.height;
  result["cell_m"] = grid.cell_m;
  result["left_m"] = grid.left_m;
  result["top_m"] = grid.top_m;
  result["crs"] = grid.crs;
  result["wkt"] = grid.wkt;
  return result;
}

Dict describe(study::CoverageMap map, const study::MapGrid& grid) {
  Dict result;
  result["name"] = map.name;
  result["kind"] = toString(map.kind);
  result["title"] = map.title;
  result["unit"] = map.unit;
  result["description"] = map.description;
  if (map.height) {
    const bool above_ground = map.height->reference == emfield::HeightReference::ground;
    result["height"] = std::pair(above_ground ? "agl" : "msl", map.height->metres);
  }
  if (map.time_s) result["time_s"] = *map.time_s;
  result["labels"] = map.labels;
  result["known_area_m2"] = map.known_area_m2;
  result["class_area_m2"] = map.class_area_m2;
  result["values"] = ownedArray(
      std::move(map.values), {static_cast<std::size_t>(grid.height), static_cast<std::size_t>(grid.width)});
  return result;
}

MapsAndGrid coverage(const ScenarioHandle& handle, const std::string& heights,
                     const std::vector<std::string>& products, const std::string& quantity,
                     std::optional<double> threshold, std::vector<double> times_s,
                     std::optional<double> cell_m, const std::string& area_text, const std::string& crs,
                     const std::string& backend, const ProgressCall& progress) {
  refuseForkedProcess();
  const std::shared_ptr<const scenario::Scenario>& scenario = handle.scenario;
  study::MapGrid grid;
  std::vector<study::CoverageMap> maps;
  std::vector<std::string> warnings;
  const ProgressSink sink = progressSink(progress);
  {
    const nb::gil_scoped_release unlocked;
    report::MapOptions options;
    options.heights = heights;
    options.products = products;
    options.quantity = quantity;
    options.threshold = threshold.value_or(NAN);
    options.times_s = std::move(times_s);
    options.cell_m = cell_m.value_or(NAN);
    options.area = area_text;
    options.crs = crs;
    const study::CoverageRequest request = report::requestOf(options, scenario->clock);
    const study::MapArea area = report::areaOf(options, *scenario);
    grid = *report::gridOf(options, *scenario, area);
    const scenario::TerrainPtr terrain = study::loadTerrain(*scenario, area);
    if (terrain) study::requireGround(*scenario, *terrain, grid);
    warnings = playback::openOnTarget(backend, [&](const playback::ComputeTarget& target) {
      maps.clear();
      return study::computeCoverage(
          scenario, terrain, grid, request, target.fieldOptions(),
          [&](study::CoverageMap map) { maps.push_back(std::move(map)); }, sink);
    });
  }
  nb::list described;
  for (study::CoverageMap& map : maps) described.append(describe(std::move(map), grid));
  return nb::borrow<MapsAndGrid>(
      nb::make_tuple(described, describe(grid), report::withoutChecks(warnings, {scenario})));
}

}  // namespace

void bindCoverage(nb::module_& module) {
  module.def("coverage", &coverage, nb::arg("scenario"), nb::arg("heights"), nb::arg("products"),
             nb::arg("quantity"), nb::arg("threshold").none(), nb::arg("times_s"), nb::arg("cell_m").none(),
             nb::arg("area"), nb::arg("crs"), nb::arg("backend"), nb::arg("progress").none(),
             "Maps, their grid, warnings.");
  module.def("product_names", [] {
    std::vector<std::string> names;
    for (const study::ProductInfo& row : study::productTable()) names.emplace_back(row.name);
    return names;
  });
}

}  // namespace emscape::python
