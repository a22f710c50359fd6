#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/playback/view/view_state.h"
#include "emscape/scenario/model/quantities.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/study/maps/map.h"

namespace emscape::study {

/// Inputs of the maps of a folder.
struct MapStudy {
  std::string command;  ///< subcommand of `emscape`, and name of the files that contain all maps: "coverage"
  std::string title;    ///< "Coverage of jacksboro"
  /// One or more. Emitters and tracks are those of the first.
  std::vector<std::shared_ptr<const scenario::Scenario>> scenarios;
  scenario::TerrainPtr terrain;  ///< of the maps and all platforms; null: none
  std::shared_ptr<const MapGrid> grid;
  scenario::Quantity quantity = scenario::Quantity::detection_probability;
  double threshold = 0.5;
  std::vector<double> times_s;     ///< ascending, one or more; of all maps
  std::vector<MapHeight> heights;  ///< of all maps
  playback::ViewState view;        ///< of the pictures: places, drape, range rings and units
};

}  // namespace emscape::study
