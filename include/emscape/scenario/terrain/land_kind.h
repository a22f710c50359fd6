/// Kinds of land by their radar echo.
#pragma once

#include <array>

#include "emscape/base/enum_names.h"

namespace emscape::scenario {

using emscape::toString;

/// Kind of land, by its gamma at 10 GHz.
/// @see M. W. Long, Radar Reflectivity of Land and Sea, 3rd ed. 2001; F. E. Nathanson, Radar Design
/// Principles, 2nd ed. 1999; as MATLAB's surfacegamma cites them
enum class LandKind {
  flatland,      ///< -20 dB
  farmland,      ///< -15 dB
  woods,         ///< -15 dB
  wooded_hills,  ///< -10 dB
  mountains,     ///< 0 dB
  urban          ///< 0 dB
};
constexpr auto namesOf(LandKind) {
  return std::array{"flatland", "farmland", "woods", "wooded_hills", "mountains", "urban"};
}

}  // namespace emscape::scenario
