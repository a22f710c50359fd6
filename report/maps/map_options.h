/// Maps of coverage as text: names, heights, times and areas as on the command line.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "emscape/playback/view/view_state.h"
#include "emscape/study/maps/area.h"
#include "emscape/study/maps/coverage.h"

namespace emscape::report {

struct MapOptions {
  std::string heights = "agl:150";
  std::vector<std::string> products{"covered", "value"};
  std::string quantity = "detection_probability";
  double threshold = NAN;       ///< NaN: default of the quantity
  std::string times = "0";      ///< as of scenario::parseTimes()
  std::vector<double> times_s;  ///< in their place; empty: none
  double cell_m = NAN;          ///< NaN: the scenario's voxel size
  std::string area;             ///< empty: the scenario's region
  std::string crs = "utm";
  std::vector<std::string> formats{"cog", "png"};
  playback::ViewState view;  ///< of pictures, as MapStudy::view
  std::string prefix;        ///< of the names of these options in messages: "--" on a command line
};

/// @throws Error (usage) that names the option and its allowed values
std::vector<study::Product> productsOf(const MapOptions& options);
/// @throws Error (usage) that names the option and its allowed values
study::CoverageRequest requestOf(const MapOptions& options, const scenario::Clock& clock);
study::MapArea areaOf(const MapOptions& options, const scenario::Scenario& scenario);
std::shared_ptr<const study::MapGrid> gridOf(const MapOptions& options, const scenario::Scenario& scenario,
                                             const study::MapArea& area);

}  // namespace emscape::report
