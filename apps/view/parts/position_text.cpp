#include "apps/view/parts/position_text.h"

#include <fmt/format.h>

#include <cmath>

namespace emscape::view {
namespace {

/// With a minus sign in place of the hyphen.
std::string signedText(std::string text) {
  if (!text.empty() && text[0] == '-') text.replace(0, 1, "−");
  return text;
}

}  // namespace

std::string positionText(const GeodeticPosition& position, const playback::ViewState& /*view*/) {
  return signedText(fmt::format("{:.5f}", position.latitude_deg)) + "°, " +
         signedText(fmt::format("{:.5f}", position.longitude_deg)) + "°";
}

std::string heightText(double height_m, const playback::ViewState& /*view*/) {
  return signedText(fmt::format("{:.0f}", height_m + 0.0)) + " m";
}

std::string distanceText(double distance_m, const playback::ViewState& /*view*/) {
  return distance_m < 1000 ? fmt::format("{:.0f} m", distance_m)
                           : fmt::format("{:.2f} km", distance_m / 1000);
}

std::string bearingText(double bearing_deg) {
  const double rest = std::fmod(bearing_deg, 360);
  const double rounded = std::fmod(std::round((rest < 0 ? rest + 360 : rest) * 10) / 10, 360);
  return fmt::format("{:05.1f}°", rounded);
}

}  // namespace emscape::view
