/// EGM96 geoid: heights above mean sea level to heights above the ellipsoid and back.
#pragma once

namespace emscape {

/// Geoid undulation N = height_ellipsoid_m - height_msl_m of EGM96 (m, -107..+85), bicubic in the 15-minute
/// grid of the system's PROJ data (egm96_15.gtx).
/// @param latitude_deg   -90..90
/// @param longitude_deg  any; wrapped
/// @throws Error (bad_input) on the first call if the grid is not installed
/// @accuracy within 0.02 m of NGA's check points
/// Safe to call from any thread.
double geoidUndulation_m(double latitude_deg, double longitude_deg);

}  // namespace emscape
