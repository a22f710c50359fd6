/// Options of the subcommands that draw coverage maps.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "apps/emscape/common/command.h"
#include "emscape/study/maps/coverage.h"

namespace emscape::app {

struct MapOptions {
  std::string heights = "agl:150";
  std::vector<std::string> products{"covered", "value"};
  std::string quantity = "detection_probability";
  double threshold = NAN;  ///< NaN: default of the quantity
  std::string times = "0";
  double cell_m = NAN;  ///< NaN: the scenario's voxel size
  std::string area;     ///< empty: the scenario's region
  std::string crs = "utm";
  std::vector<std::string> formats{"cog", "png"};
};

/// @param options  must live as long as the command
void addMapOptions(CLI::App& command, MapOptions& options);

/// @throws Error (usage) that names the option and its allowed values
std::vector<study::Product> productsOf(const MapOptions& options);
study::CoverageRequest requestOf(const MapOptions& options, const scenario::Clock& clock);
study::MapArea areaOf(const MapOptions& options, const scenario::Scenario& scenario);
std::shared_ptr<const study::MapGrid> gridOf(const MapOptions& options, const scenario::Scenario& scenario,
                                             const study::MapArea& area);

}  // namespace emscape::app
