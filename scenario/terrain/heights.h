/// Unit and datum of the heights in an elevation file: what the file, its format, its name and the scenario
/// say of them, and what is assumed.
#pragma once

#include <string>
#include <vector>

#include "base/geodesy/gdal.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::scenario {

/// Where the datum of a file comes from, the strongest last.
enum class DatumOrigin { assumed, product, format, file, key };

/// A file, as far as its heights depend on it.
struct HeightFacts {
  std::string name;             ///< for messages
  std::string own_name;         ///< without archive
  std::string driver;           ///< GDAL's short name
  std::string band_unit;        ///< empty: the band states none
  double scale = 1;             ///< of the band
  OGRSpatialReferenceH system;  ///< of the file, with its vertical part
  TerrainFileKeys keys;
  bool is_ellipsoidal = false;  ///< stated beside the system
};

/// The meaning of a file's numbers.
struct HeightMeaning {
  double unit_m = 1;
  std::string unit;  ///< for messages
  VerticalDatum datum = VerticalDatum::egm96;
  DatumOrigin origin = DatumOrigin::assumed;
  std::string datum_text;        ///< such as "EGM96 (stated by the file: EGM96 height)"
  bool is_unit_assumed = false;  ///< nothing says the unit, and no warning of its own was made
  std::vector<std::string> notes, warnings;
};

/// @throws Error (bad_input), without a location: an unknown unit, depths, a key that contradicts the file
HeightMeaning heightMeaningOf(const HeightFacts& facts);

/// Metres of a unit.
double metresOf(HeightUnit unit);

/// "EGM96", "the ellipsoid" ...
std::string textOf(VerticalDatum datum);

}  // namespace emscape::scenario
