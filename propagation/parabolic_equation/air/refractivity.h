/// Modified refractivity of the air along a path, for refraction in the parabolic equation.
///
/// The earth is flattened: M = (n - 1 + z/a) 10^6 = N + 0.157 z. Only differences of M bend rays. A profile
/// is a list of levels; M is linear between them.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace emscape::propagation {

/// dM/dz of standard air (M-units per metre): dN/dz of -39.2 per km over an earth of 6371 km.
constexpr double kStandardGradient_m = 0.118;
/// dM/dz of air without gradient of N: 10^6 / 6371 km.
constexpr double kFlatteningGradient_m = 1e6 / 6371000.0;
/// M at the surface if a profile does not give it.
constexpr double kSurface_m_units = 330;
/// Roughness length of the evaporation duct's profile (m).
constexpr double kEvaporationRoughness_m = 1.5e-4;

struct RefractivityLevel {
  double height_msl_m = 0;
  double m_units = 0;

  bool operator==(const RefractivityLevel& other) const {
    return height_msl_m == other.height_msl_m && m_units == other.m_units;
  }
};

/// M against height. Below the first level: the first layer's gradient; above the last: top_gradient_m.
struct RefractivityProfile {
  std::vector<RefractivityLevel> levels;        ///< 1 or more, heights strictly ascending
  double top_gradient_m = kStandardGradient_m;  ///< M-units per metre
  /// Height (m above mean sea level) up to which the air was measured; infinite: by a formula.
  double known_to_m = HUGE_VAL;

  double at(double height_msl_m) const;
  /// True if M decreases with height somewhere (a trapping layer).
  bool traps() const;
  bool operator==(const RefractivityProfile& other) const {
    return levels == other.levels && top_gradient_m == other.top_gradient_m && known_to_m == other.known_to_m;
  }
};

RefractivityProfile standardRefractivity(double surface_m_units = kSurface_m_units);
/// One gradient (M-units per metre) at all heights; 10^6 / (k a) for an earth of radius k a.
RefractivityProfile linearRefractivity(double gradient_m, double surface_m_units = kSurface_m_units);
/// M = M0 + 0.125 (z - d ln((z + z0) / z0)) up to 1 km, as 256 levels, for 14 m within 0.001 M-units of the
/// formula; standard above.
/// @param duct_height_m  d, 0..60; 0: without the logarithm
/// @throws Error (bad_input) outside that range
/// @see Paulus 1985, Radio Sci. 20(4), neutral air
RefractivityProfile evaporationDuct(double duct_height_m, double surface_m_units = kSurface_m_units);
/// M decreases from the surface by a deficit up to the top; standard above.
/// @param top_m            > 0
/// @param deficit_m_units  > 0
/// @throws Error (bad_input)
RefractivityProfile surfaceDuct(double top_m, double deficit_m_units,
                                double surface_m_units = kSurface_m_units);
/// Standard up to base_m, decreasing by the deficit up to top_m, standard above. A surface-based duct if M at
/// the top is below that of the surface, else an elevated one.
/// @param base_m           >= 0
/// @param top_m            > base_m
/// @param deficit_m_units  > 0
/// @throws Error (bad_input)
RefractivityProfile trilinearRefractivity(double base_m, double top_m, double deficit_m_units,
                                          double surface_m_units = kSurface_m_units);
/// Levels as measured.
/// @throws Error (bad_input) that names the level, if there are not 2..256, a height is not above the one
/// before, above 60 km or not finite, M is outside 0..2500 or its gradient outside +-5 M-units per metre
RefractivityProfile profileOfLevels(std::vector<RefractivityLevel> levels);
/// The profile with an evaporation duct added: its departure from standard air. The departure's gradient is
/// that of evaporationDuct() up to twice the duct height and fades to 0 at three times the duct height, so
/// that M is only shifted above.
/// @param duct_height_m  0..60; 0: the profile itself
/// @throws Error (bad_input) outside that range
RefractivityProfile withEvaporationDuct(const RefractivityProfile& profile, double duct_height_m);
/// A measured profile with standard air above its last level, up to 5 km, and from there, or from its last
/// level, with N that falls by e in 7.35 km (ITU-R P.453), as levels up to 40 km.
RefractivityProfile withUpperAir(RefractivityProfile profile);
/// Mean of profiles: level by level, in height and in M, if all have the same number of levels, else M at
/// each height.
/// @param weights  as many, >= 0, not all 0
RefractivityProfile meanProfile(const std::vector<RefractivityProfile>& profiles,
                                const std::vector<double>& weights);
/// Profile with fewer levels by the Douglas-Peucker algorithm; at levels left out M differs by at most a
/// tolerance (M-units).
std::vector<RefractivityLevel> thinned(const std::vector<RefractivityLevel>& levels, double tolerance);
/// Error in the level `index`, or an empty string; the check of profileOfLevels(), for file readers.
std::string faultOfLevel(const std::vector<RefractivityLevel>& levels, std::size_t index);

/// M along the range. Between two profiles with equal numbers of levels each level is interpolated in height
/// and in M, so that a duct's base and top move. Otherwise M is interpolated at each height, which gives two
/// weak ducts halfway.
class RefractivityAlongPath {
 public:
  RefractivityAlongPath() : RefractivityAlongPath(standardRefractivity()) {}
  /// The same at all ranges.
  RefractivityAlongPath(RefractivityProfile profile);
  /// @param ranges_m  strictly ascending, as many as profiles; the first and the last profile hold before and
  /// beyond
  /// @throws Error (bad_input) if empty, of unequal sizes or not ascending
  RefractivityAlongPath(std::vector<double> ranges_m, std::vector<RefractivityProfile> profiles);

  RefractivityProfile at(double range_m) const;
  bool operator==(const RefractivityAlongPath& other) const {
    return ranges_m_ == other.ranges_m_ && profiles_ == other.profiles_;
  }
  const std::vector<double>& ranges_m() const { return ranges_m_; }
  const std::vector<RefractivityProfile>& profiles() const { return profiles_; }
  bool constant() const { return profiles_.size() == 1; }
  bool traps() const;
  /// True if neighbours have different numbers of levels and are interpolated at each height (for a warning).
  bool pointwise() const;

 private:
  std::vector<double> ranges_m_;
  std::vector<RefractivityProfile> profiles_;
};

}  // namespace emscape::propagation
