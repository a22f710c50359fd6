/// Maps as CZML: outlines of classes over time, with emitters and tracks.
#pragma once

#include "study/files/map_collection.h"

namespace emscape::study {

/// A class of a time is available until the next of the study's times; those for heights above mean sea level
/// are at their height. The first product at its first height is shown.
/// @throws Error (other) naming the file
std::unique_ptr<MapCollection> makeCzml(const std::filesystem::path& file, const MapStudy& study);

}  // namespace emscape::study
