/// Heights of points in files of sites.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace emscape::scenario {

/// What a height is above; the keys of a platform's position.
enum class HeightReference { agl, msl, ellipsoid };
inline constexpr const char* kHeightKeys[] = {"height_agl_m", "height_msl_m", "height_ellipsoid_m"};

struct PointHeight {
  HeightReference reference = HeightReference::msl;
  double height_m = 0;

  const char* key() const { return kHeightKeys[static_cast<int>(reference)]; }
};

/// The reference that a column or field states: one of kHeightKeys in any case, also without the unit or cut
/// to the ten characters of a shapefile's fields.
std::optional<HeightReference> heightReferenceOf(std::string_view name);

/// Says that two heights of one place contradict each other: those above mean sea level and above the
/// ellipsoid differ by the geoid's height. @return empty if they do not, and for other references
std::string contradictionOfHeights(double latitude_deg, double longitude_deg, const PointHeight& a,
                                   const PointHeight& b);

}  // namespace emscape::scenario
