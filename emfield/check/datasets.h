/// The datasets' functions, one file per family; the table in reference_check.cpp lists them.
#pragma once

#include <filesystem>

#include "emfield/check/reference_check.h"

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
DatasetCheck checkDetectionLosses(const std::filesystem::path& file);
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

// check_pe_closed_forms.cpp
DatasetCheck checkPeTwoRay(const std::filesystem::path& file);
DatasetCheck checkPeCells(const std::filesystem::path& file);
DatasetCheck checkPeBeam(const std::filesystem::path& file);
DatasetCheck checkPeNarrowAngle(const std::filesystem::path& file);
DatasetCheck checkPeEdge(const std::filesystem::path& file);
DatasetCheck checkPeSlope(const std::filesystem::path& file);
DatasetCheck checkRoughness(const std::filesystem::path& file);

// check_pe_modes.cpp
DatasetCheck checkPeSmoothEarth(const std::filesystem::path& file);
DatasetCheck checkPeDecay(const std::filesystem::path& file);
DatasetCheck checkPeDucts(const std::filesystem::path& file);
DatasetCheck checkPeDuctModes(const std::filesystem::path& file);
DatasetCheck checkPeLfmf(const std::filesystem::path& file);

// check_two_ray.cpp
DatasetCheck checkTwoRay(const std::filesystem::path& file);

}  // namespace emscape::emfield
