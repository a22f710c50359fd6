/// Metadata in the files of maps.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "study/maps/map_study.h"

namespace emscape::study {

/// What pixels without a value are, of differences and of maps with a floor; empty of others.
std::string noValueText(const Map& map);

/// Items of every map's file, EMSCAPE_NAME and value.
std::vector<std::pair<std::string, std::string>> metadataOf(const scenario::Scenario& scenario,
                                                            scenario::Quantity quantity, double threshold,
                                                            const Map& map);
std::vector<std::pair<std::string, std::string>> metadataOf(const MapStudy& study, const Map& map);

}  // namespace emscape::study
