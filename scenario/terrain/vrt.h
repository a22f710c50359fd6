/// What a GDAL virtual raster (VRT) may name.
#pragma once

#include <string>

namespace emscape::scenario {

/// Checks that a file, if it is a VRT, names only files of its own folder and the folders in it: no other
/// files of the machine and none of the network. VRTs that it names are checked, too.
/// @return what is wrong; empty if nothing is or the file is no VRT
std::string foreignSourceOfVrt(const std::string& file);

}  // namespace emscape::scenario
