/// Model `p528`: air-ground paths over a smooth earth, ITU-R P.528-5 (equations are cited as section-number
/// of its Annex 2).
///
/// Computes the basic transmission loss that is not exceeded for a percentage of time, from the line of sight
/// through diffraction to scatter, in a mean continental atmosphere, over land of average constants: neither
/// terrain nor the k factor is used.
#pragma once

#include <memory>

#include "propagation/complex.h"
#include "propagation/limits.h"
#include "propagation/p528/atmosphere.h"

namespace emscape::propagation {

// clang-format off
constexpr ModelLimit kP528Frequency{"frequency", "MHz", 1e6, 100, 30000, Beyond::refused, ""};
constexpr ModelLimit kP528Height{"antenna height above the smooth earth", "m", 1, 1.5, 20000, Beyond::refused, ""};
constexpr ModelLimit kP528Percentage{"percentage of time", "%", 1, 1, 99, Beyond::refused, ""};
// clang-format on
constexpr const ModelLimit* kP528Limits[] = {&kP528Frequency, &kP528Height, &kP528Percentage};

enum class P528Mode { line_of_sight = 1, diffraction = 2, troposcatter = 3 };

struct P528Loss {
  double loss_db = 0;        ///< basic transmission loss; NaN if the distance or the percentage is refused
  double free_space_db = 0;  ///< part of it, along the ray
  double absorption_db = 0;  ///< part of it, by oxygen and water vapour
  P528Mode mode = P528Mode::line_of_sight;
};

/// One end of a path.
struct P528Terminal {
  double height_km = 0;
  double effective_height_km = 0;   ///< over the effective earth
  double height_difference_km = 0;  ///< of the two
  P528Ray horizon_ray;              ///< that grazes the ground
  double horizon_km = 0;            ///< distance along the ground to the grazing point
};

/// @param height_m  above the smooth earth
/// @throws Error (bad_input) for a height outside kP528Height
P528Terminal p528Terminal(const P528Atmosphere& atmosphere, double height_m);

/// Loss against distance for one pair of heights. The terms that do not depend on the distance are computed
/// once, at construction; a point then takes about 16 us. Safe to share between threads.
class P528Curve {
 public:
  /// @param atmosphere  of the same frequency; curves of several heights share it
  /// @param height_m    of both antennas above the smooth earth (m), in any order
  /// @throws Error (bad_input) for a frequency or a height outside kP528Frequency, kP528Height
  P528Curve(const std::shared_ptr<const P528Atmosphere>& atmosphere, double frequency_hz,
            double first_height_m, double second_height_m, bool vertical_polarization = false);
  /// The same between terminals of that atmosphere.
  P528Curve(std::shared_ptr<const P528Atmosphere> atmosphere, double frequency_hz, const P528Terminal& first,
            const P528Terminal& second, bool vertical_polarization = false);

  /// @param distance_m    along the ground, >= 0
  /// @param time_percent  1..99
  P528Loss at(double distance_m, double time_percent) const;

  /// Distance (m) of the radio horizon: the end of the line of sight.
  double horizon_m() const { return horizon_km_ * 1000; }

 private:
  struct TwoRays;
  struct Scatter;
  struct Line {
    double at_zero_db;
    double slope_db_km;
    double at(double distance_km) const { return at_zero_db + slope_db_km * distance_km; }
  };
  struct LineOfSight {
    P528Loss loss;
    double k_db;  ///< of the fading
  };

  double diffraction_db(double distance_km) const;
  TwoRays raysAt(double grazing_rad) const;
  TwoRays raysAtDistance(double distance_km) const;
  TwoRays raysAtDelay(double path_difference_km) const;
  Complex<double> reflectedField(const TwoRays& rays) const;
  double twoRayGain_db(const TwoRays& rays) const;
  void setLobing();
  void setBeyondHorizon();
  Scatter scatterAt(double distance_km) const;
  LineOfSight lineOfSight(double distance_km, double time_percent) const;
  P528Loss transhorizon(double distance_km, double time_percent) const;

  std::shared_ptr<const P528Atmosphere> atmosphere_;
  double frequency_mhz_;
  double wavelength_km_;
  bool vertical_;
  P528Terminal terminal_[2];  ///< the lower one first
  double horizon_km_;         ///< d_ML: both horizons' distances, summed
  Line diffraction_;
  double horizon_loss_db_;  ///< A_dML: by diffraction, at the horizon
  double lobing_end_km_;    ///< d_0: end of the two-ray region, followed by a line to the horizon
  double lobing_end_gain_db_;
  double last_lobe_rad_;    ///< psi_limit: rays steeper than this have the free-space level, no lobes
  double horizon_k_db_;     ///< of the fading at the horizon
  Line beyond_;             ///< the diffraction line, turned to meet the scatter curve if necessary
  double scatter_from_km_;  ///< d_crx
  bool lesser_counts_;      ///< from scatter_from_km_ on: the smaller loss of both; else only scatter
};

}  // namespace emscape::propagation
