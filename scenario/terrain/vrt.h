/// Files that a GDAL virtual raster (VRT) names.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace emscape::scenario {

/// The files from which a VRT, and the VRTs that it names, take values. All must be in the VRT's folder and
/// its subfolders, so that it reads no other files of the machine and none on the network. GDAL must still be
/// kept from reading them in formats that name further files or servers.
/// @return absolute paths, VRTs left out; empty if the file is not a VRT
/// @throws Error (bad_input), without a location, for any other source, and for elements and attributes other
/// than those of mosaics, extracts and reprojections
std::set<std::filesystem::path> sourcesOfVrt(const std::string& file);

}  // namespace emscape::scenario
