#include "apps/view/parts/position_text.h"

#include <fmt/format.h>

#include <cmath>

#include "base/geodesy/position_text.h"
#include "base/text/display_units.h"

namespace emscape::view {

std::string positionText(const GeodeticPosition& position, const playback::ViewState& view) {
  return emscape::positionText(position.latitude_deg, position.longitude_deg, view.positions);
}

std::string heightText(double height_m, const playback::ViewState& view) {
  return emscape::heightText(height_m, view.units);
}

std::string distanceText(double distance_m, const playback::ViewState& view) {
  return emscape::distanceText(distance_m, view.units);
}

std::string bearingText(double bearing_deg) {
  const double rest = std::fmod(bearing_deg, 360);
  const double rounded = std::fmod(std::round((rest < 0 ? rest + 360 : rest) * 10) / 10, 360);
  return fmt::format("{:05.1f}°", rounded);
}

}  // namespace emscape::view
