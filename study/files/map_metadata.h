/// What the files of maps say about them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "emscape/study/map_folder.h"

namespace emscape::study {

/// Items that every map's file carries, EMSCAPE_NAME and value.
std::vector<std::pair<std::string, std::string>> metadataOf(const scenario::Scenario& scenario,
                                                            scenario::Quantity quantity, double threshold,
                                                            const Map& map);
std::vector<std::pair<std::string, std::string>> metadataOf(const MapStudy& study, const Map& map);

}  // namespace emscape::study
