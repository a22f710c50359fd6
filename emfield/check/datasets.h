/// The datasets' functions, one file per family; the table in reference_check.cpp lists them.
#pragma once

#include <filesystem>

#include "emscape/emfield/reference_check.h"

namespace emscape::emfield {

// check_atmosphere.cpp
DatasetCheck checkSpecificGasAttenuation(const std::filesystem::path& folder);
DatasetCheck checkSlantGasAttenuation(const std::filesystem::path& folder);
DatasetCheck checkRain(const std::filesystem::path& folder);

// check_clutter.cpp
DatasetCheck checkSeaClutter(const std::filesystem::path& file);
DatasetCheck checkClutterExamples(const std::filesystem::path& file);

// check_detection.cpp
DatasetCheck checkSwerling(const std::filesystem::path& file);
DatasetCheck checkDetectionProbability(const std::filesystem::path& file);
DatasetCheck checkRadarEquation(const std::filesystem::path& file);
DatasetCheck checkFreeSpaceConversions(const std::filesystem::path& file);

// check_diffraction.cpp
DatasetCheck checkDeltaBullington(const std::filesystem::path& folder);
DatasetCheck checkKnifeEdge(const std::filesystem::path& file);

// check_itm.cpp
DatasetCheck checkItmPointToPoint(const std::filesystem::path& folder);
DatasetCheck checkItmPublished(const std::filesystem::path& folder);
DatasetCheck checkItmArea(const std::filesystem::path& folder);

// check_p1812.cpp
DatasetCheck checkP1812(const std::filesystem::path& folder);

// check_p452.cpp
DatasetCheck checkP452(const std::filesystem::path& folder);

// check_p528.cpp
DatasetCheck checkP528(const std::filesystem::path& folder);

// check_geoid.cpp
DatasetCheck checkGeoid(const std::filesystem::path& folder);

// check_two_ray.cpp
DatasetCheck checkTwoRay(const std::filesystem::path& file);

}  // namespace emscape::emfield
