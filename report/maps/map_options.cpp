#include "report/maps/map_options.h"

#include <fmt/core.h>

#include <algorithm>

#include "emscape/base/error.h"

namespace emscape::report {

std::vector<study::Product> productsOf(const MapOptions& options) {
  std::vector<study::Product> products;
  for (const std::string& name : options.products) {
    const study::Product product = study::productNamed(name);
    if (std::find(products.begin(), products.end(), product) != products.end()) {
      throw Error(ErrorCode::usage, fmt::format("{}products: '{}' is given twice", options.prefix, name));
    }
    products.push_back(product);
  }
  return products;
}

study::CoverageRequest requestOf(const MapOptions& options, const scenario::Clock& clock) {
  study::CoverageRequest request;
  request.heights = study::parseHeights(options.heights);
  request.products = productsOf(options);
  request.quantity = scenario::quantityFromName(options.quantity);
  const bool needs_threshold =
      std::any_of(request.products.begin(), request.products.end(),
                  [](study::Product product) { return product != study::Product::value; });
  request.threshold =
      needs_threshold || !std::isnan(options.threshold)
          ? study::thresholdOf(options.threshold, request.quantity, options.prefix + "threshold")
          : study::defaultThreshold(request.quantity).value_or(0);
  request.times_s = options.times_s.empty() ? scenario::parseTimes(options.times, clock) : options.times_s;
  return request;
}

study::MapArea areaOf(const MapOptions& options, const scenario::Scenario& scenario) {
  if (options.area.empty()) return study::areaOf(scenario.region);
  const study::MapArea area = study::parseArea(options.area);
  if (const std::string mistake = study::mistakenAreaText(area, scenario.region); !mistake.empty())
    throw Error(ErrorCode::usage, fmt::format("{}area '{}': {}", options.prefix, options.area, mistake));
  return area;
}

std::shared_ptr<const study::MapGrid> gridOf(const MapOptions& options, const scenario::Scenario& scenario,
                                             const study::MapArea& area) {
  const scenario::Region& region = scenario.region;
  const double usual_cell_m = std::max(1.0, std::round(region.size_m.x / region.dims.x));
  return std::make_shared<const study::MapGrid>(
      study::makeMapGrid(area, std::isnan(options.cell_m) ? usual_cell_m : options.cell_m, options.crs));
}

}  // namespace emscape::report
