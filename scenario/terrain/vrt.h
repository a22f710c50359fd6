/// Files that a GDAL virtual raster (VRT) names.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace emscape::scenario {

/// The files from which a VRT, and the VRTs that it names, take values. All must be in the VRT's folder and
/// its subfolders, so that it reads no other files of the machine and none on the network.
/// @return absolute paths, VRTs left out; empty if the file is not a VRT
/// @throws Error (bad_input), without a location, for any other source
std::set<std::filesystem::path> sourcesOfVrt(const std::string& file);

}  // namespace emscape::scenario
