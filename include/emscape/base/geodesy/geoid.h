/// EGM96 geoid: converts heights above mean sea level to heights above the ellipsoid and back.
#pragma once

#include <string>

namespace emscape {

/// Geoid undulation N = height_ellipsoid_m - height_msl_m of EGM96 (m, -107..+85), by bicubic interpolation
/// in the 15-minute grid egm96_15.gtx: the file of setGeoidFile(), else the one in the system's PROJ data
/// (environment variables PROJ_DATA and PROJ_LIB, GDAL's PROJ search paths, /usr/share/proj,
/// /usr/local/share/proj).
/// @param latitude_deg   -90..90
/// @param longitude_deg  any; wrapped
/// @throws Error (bad_input) on the first call if the grid is not installed
/// @accuracy within 0.02 m of NGA's check points
/// Safe to call from any thread.
double geoidUndulation_m(double latitude_deg, double longitude_deg);

/// Sets the grid file, for a program that ships its own. The grid is read once per process, by the first call
/// of geoidUndulation_m(). Safe to call from any thread.
/// @param file  path of egm96_15.gtx; empty: the system's
/// @throws Error (usage) after the grid was read
void setGeoidFile(const std::string& file);

}  // namespace emscape
