/// P.528: variability in time: slow changes of the median, fast fading, and both together.
#pragma once

namespace emscape::propagation {

/// Smallest value of K (dB): almost no fading.
constexpr double kP528MinK_db = -40;

/// Slow variability at a percentage of time.
struct P528Slow {
  double gain_db;        ///< Y_e: above the median without variability
  double adjustment_db;  ///< A_Y: limits the level above free space
};

/// @param horizons_km   distance of both terminals' horizons, summed
/// @param angle_factor        f_theta_h, 0..1
/// @param gain_db             A_T: level without variability, against free space
/// @see P.528-5 Annex 2, section 14
P528Slow p528SlowVariability(double horizons_km, double distance_km, double frequency_mhz,
                             double time_percent, double angle_factor, double gain_db);

/// Nakagami-Rice fading: loss (dB) against its median that is not exceeded for a percentage of time.
/// @param k_db          ratio of the scattered to the steady power; clamped to the table, -40..20 dB
/// @param time_percent  1..99
double p528Fading_db(double k_db, double time_percent);

/// K (dB) of the fading whose loss not exceeded for 99 % of the time is given (dB against the median).
double p528KOfLossAt99Percent_db(double loss_db);

/// Level (dB) exceeded for a percentage of time, with slow variability and fading.
/// @see P.528-5 Annex 2, section 16
double p528Combined_db(double slow_median_db, double slow_db, double fading_db, double time_percent);

}  // namespace emscape::propagation
