#include "apps/view/values/position_text.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "base/geodesy/position_text.h"
#include "base/text/display_units.h"
#include "emscape/render/annotate/legend.h"

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

std::string valueText(const playback::ProbeReading& reading, const volume::VolumeInfo& info,
                      const playback::ViewState& view) {
  const bool has_unit = reading.sample.kind == playback::VolumeSample::Kind::value && !info.categorical;
  return valueText(reading.sample.value, has_unit ? info.unit : "", reading.text, view);
}

std::string valueText(double stored, const std::string& unit, const std::string& text,
                      const playback::ViewState& view) {
  const render::FieldScale scale = render::fieldScale(unit, view.field_unit);
  return render::unitText(scale.unit != unit ? fmt::format("{:.4g} {}", scale.shown(stored), scale.unit)
                                             : text);
}

std::string withDegreeSigns(std::string text) {
  constexpr const char kUnit[] = " deg", kSign[] = "°";
  constexpr std::size_t kLength = sizeof kUnit - 1;
  const auto is = [&](std::size_t at, int (*of_kind)(int)) {
    return at < text.size() && of_kind(static_cast<unsigned char>(text[at])) != 0;
  };
  for (std::size_t at = text.find(kUnit); at != std::string::npos; at = text.find(kUnit, at + 1)) {
    if (at > 0 && is(at - 1, std::isdigit) && !is(at + kLength, std::isalpha))
      text.replace(at, kLength, kSign);
  }
  return text;
}

std::string bearingText(double bearing_deg) {
  const double rest = std::fmod(bearing_deg, 360);
  const double rounded = std::fmod(std::round((rest < 0 ? rest + 360 : rest) * 10) / 10, 360);
  return fmt::format("{:05.1f}°", rounded);
}

}  // namespace emscape::view
