/// Check of the files that a GDAL virtual raster (VRT) names.
#pragma once

#include <string>

namespace emscape::scenario {

/// Checks that a file, if it is a VRT, names only files in its folder and subfolders: no other files of the
/// machine and none on the network. VRTs that it names are also checked.
/// @return the fault; empty if there is none or the file is not a VRT
std::string foreignSourceOfVrt(const std::string& file);

}  // namespace emscape::scenario
