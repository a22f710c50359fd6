#include "apps/emscape/common/map_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/emscape/common/study_options.h"
#include "emscape/base/error.h"
#include "emscape/study/maps/area.h"
#include "emscape/study/report/map_folder.h"

namespace emscape::app {

void addMapOptions(CLI::App& command, MapOptions& options) {
  command.add_option(
      "--heights", options.heights,
      "Heights in metres above ground (agl:) and above mean sea level (msl:): agl:30,150;msl:500:3000:500");
  addListOption(command, "--products", options.products, "Products, with commas between them");
  command.add_option("--quantity", options.quantity, "Quantity to map; see docs/scenario-format.md");
  addThresholdOption(command, options.threshold);
  command.add_option(
      "--times", options.times,
      "BEGIN:END:STEP, BEGIN:END (in steps of the scenario) or T, in seconds since the scenario's epoch");
  command.add_option("--cell", options.cell_m, "Side of a pixel (m); default: the scenario's voxels")
      ->default_str("");
  command.add_option(
      "--area", options.area,
      "LATITUDE,LONGITUDE,RADIUS_M or bbox:WEST,SOUTH,EAST,NORTH (deg); default: the box around the region");
  command.add_option(
      "--crs", options.crs,
      "Projection: utm (zone of the area's middle), local (azimuthal equidistant) or EPSG:NUMBER");
  std::vector<std::string> formats;
  for (const study::MapFormat& format : study::mapFormats()) formats.emplace_back(format.name);
  addListOption(command, "--format", options.formats, "Formats of maps, with commas between them")
      ->check(CLI::IsMember(formats));
}

std::vector<study::Product> productsOf(const MapOptions& options) {
  std::vector<study::Product> products;
  for (const std::string& name : options.products) {
    const study::Product product = study::productNamed(name);
    if (std::find(products.begin(), products.end(), product) != products.end()) {
      throw Error(ErrorCode::usage, fmt::format("--products: '{}' is given twice", name));
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
  request.threshold = needs_threshold || !std::isnan(options.threshold)
                          ? thresholdOf(options.threshold, request.quantity)
                          : study::defaultThreshold(request.quantity).value_or(0);
  request.times_s = scenario::parseTimes(options.times, clock);
  return request;
}

study::MapArea areaOf(const MapOptions& options, const scenario::Scenario& scenario) {
  return options.area.empty() ? study::areaOf(scenario.region) : study::parseArea(options.area);
}

std::shared_ptr<const study::MapGrid> gridOf(const MapOptions& options, const scenario::Scenario& scenario,
                                             const study::MapArea& area) {
  const scenario::Region& region = scenario.region;
  const double usual_cell_m = std::max(1.0, std::round(region.size_m.x / region.dims.x));
  return std::make_shared<const study::MapGrid>(
      study::makeMapGrid(area, std::isnan(options.cell_m) ? usual_cell_m : options.cell_m, options.crs));
}

}  // namespace emscape::app
