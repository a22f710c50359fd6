/// Usual mistakes in writing a position, for hints.
#pragma once

#include <cmath>
#include <optional>

#include "base/geodesy/position_limits.h"

namespace emscape {

struct PositionMistake {
  double latitude_deg, longitude_deg;  ///< without it
  const char* text;                    ///< "latitude and longitude are exchanged"
};

/// The first mistake without which a position fits.
/// @param fits  of a latitude and a longitude (deg)
template <class Fits>
std::optional<PositionMistake> mistakeIn(double latitude_deg, double longitude_deg, const Fits& fits) {
  const PositionMistake mistakes[] = {{longitude_deg, latitude_deg, "latitude and longitude are exchanged"},
                                      {latitude_deg, -longitude_deg, "longitude has the other sign"},
                                      {-latitude_deg, longitude_deg, "latitude has the other sign"},
                                      {-latitude_deg, -longitude_deg, "both have the other sign"}};
  for (const PositionMistake& mistake : mistakes) {
    if (std::abs(mistake.latitude_deg) <= PositionLimits::kLatitude_deg &&
        fits(mistake.latitude_deg, mistake.longitude_deg))
      return mistake;
  }
  return std::nullopt;
}

}  // namespace emscape
