/// Check of the header of classic netCDF files (CDF-1, -2 and -5): the netCDF library ends the program on
/// some damaged ones.
#pragma once

#include <filesystem>
#include <string>

namespace emscape {

/// Why the header of a classic netCDF file cannot be read; empty: it can, or the file is of another format.
/// Format: NetCDF Classic Format Specification, Unidata.
std::string netcdfHeaderFault(const std::filesystem::path& file);

}  // namespace emscape
