/// The header of a classic netCDF file.
#pragma once

#include <cstdint>
#include <istream>
#include <string>

namespace emscape {

/// Reports a header of a classic netCDF file (versions 1, 2 and 5) that does not follow the format: the
/// library that reads such files does not survive it. Empty for a sound header and for other files.
std::string faultOfNetcdfHeader(const std::string& file);
/// The same for bytes of a file.
std::string faultOfNetcdfHeader(std::istream& stream, std::uintmax_t size);

}  // namespace emscape
