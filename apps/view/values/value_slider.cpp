#include "apps/view/values/value_slider.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace emscape::view {
namespace {

using scenario::Parameter;
using Scale = ValueSlider::Scale;

struct KeyRange {
  const char* key;
  double min, max;
  Scale scale = Scale::linear;
  double knee = 1;
};
constexpr std::array<KeyRange, 37> kRanges{{
    {"power_w", 0.1, 1e7, Scale::logarithmic},
    {"losses_db", 0, 30},
    {"gain_dbi", -10, 60},
    {"beamwidth_az_deg", 0.1, 360, Scale::logarithmic},
    {"beamwidth_el_deg", 0.1, 180, Scale::logarithmic},
    {"side_lobe_db", -80, 0},
    {"columns", 1, 256, Scale::logarithmic},
    {"rows", 1, 256, Scale::logarithmic},
    {"azimuth_deg", -180, 360},
    {"elevation_deg", -10, 60},
    {"heading_deg", 0, 360},
    {"rate_rpm", -60, 60},
    {"rate_deg_s", 0.1, 360, Scale::logarithmic},
    {"bars", 1, 16},
    {"noise_figure_db", 0, 20},
    {"antenna_temperature_k", 0, 1000},
    {"processing_gain_db", -20, 60},
    {"cross_polar_isolation_db", 0, 60},
    {"pulses", 1, 256, Scale::logarithmic},
    {"pfa", 1e-12, 0.1, Scale::logarithmic},
    {"target_rcs_m2", 1e-3, 1e3, Scale::logarithmic},
    {"rcs_m2", 1e-3, 1e3, Scale::logarithmic},
    {"height_agl_m", 0, 3000, Scale::from_zero, 20},
    {"height_msl_m", 0, 12000, Scale::from_zero, 500},
    {"height_ellipsoid_m", 0, 12000, Scale::from_zero, 500},
    {"k_factor", 0.5, 4},
    {"pressure_hpa", 600, 1100},
    {"temperature_k", 230, 320},
    {"vapour_g_m3", 0, 30},
    {"rain_mm_h", 0, 100, Scale::from_zero, 5},
    {"irregularity_m", 0, 500, Scale::from_zero, 20},
    {"roughness_m", 0, 10, Scale::from_zero, 0.1},
    {"surface_spread_m_s", 0, 20, Scale::from_zero, 0.5},
    {"rain_spread_m_s", 0, 20, Scale::from_zero, 0.5},
    {"floor", -200, 0},
    {"count_threshold_dbwm2", -150, 0},
    {"conductivity_s_m", 0, 10, Scale::from_zero, 0.01},
}};
/// Values with wider ranges, and coordinates, are typed.
constexpr double kMaxWidth = 1000;

std::optional<ValueSlider> plainSliderOf(const Parameter& parameter) {
  const bool is_integer = parameter.type == Parameter::Type::integer;
  for (const KeyRange& range : kRanges) {
    if (parameter.key == range.key)
      return ValueSlider{range.min, range.max, range.scale, range.knee, is_integer};
  }
  const bool is_place = parameter.key == "latitude_deg" || parameter.key == "longitude_deg";
  if (is_place || parameter.unit == "Hz" || !(parameter.maximum - parameter.minimum <= kMaxWidth))
    return std::nullopt;
  return ValueSlider{parameter.minimum, parameter.maximum, Scale::linear, 1, is_integer};
}

}  // namespace

double ValueSlider::positionOf(double value) const {
  switch (scale) {
    case Scale::logarithmic:
      return std::log(std::max(value, 1e-300) / min) / std::log(max / min);
    case Scale::from_zero:
      return std::copysign(std::log1p(std::abs(value) / knee), value) / std::log1p(max / knee);
    case Scale::linear:
      break;
  }
  return (value - min) / (max - min);
}

double ValueSlider::valueAt(double position) const {
  switch (scale) {
    case Scale::logarithmic:
      return min * std::pow(max / min, position);
    case Scale::from_zero:
      return std::copysign(knee * std::expm1(std::abs(position) * std::log1p(max / knee)), position);
    case Scale::linear:
      break;
  }
  return min + position * (max - min);
}

double ValueSlider::stepAt(double value, double position_step) const {
  const double position = positionOf(value);
  const double difference = valueAt(position + position_step / 2) - valueAt(position - position_step / 2);
  const double decade = std::pow(10, std::floor(std::log10(difference) + 1e-9));
  const double digit = difference / decade;
  const double step = decade * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
  return is_integer ? std::max(1.0, std::round(step)) : step;
}

double ValueSlider::dragRate(double length_px) const {
  constexpr double kMaxRatio = 1.02;  // of the values of two neighbouring pixels
  if (scale != Scale::logarithmic) return 1;
  return std::min(1.0, std::log(kMaxRatio) * length_px / std::log(max / min));
}

double ValueSlider::steppedValueAt(double position, double position_step) const {
  const double value = valueAt(std::clamp(position, 0.0, 1.0));
  const double step = stepAt(value, position_step);
  return std::clamp(std::round(value / step) * step, min, max);
}

std::optional<ValueSlider> sliderOf(const Parameter& parameter, double value) {
  std::optional<ValueSlider> slider = plainSliderOf(parameter);
  if (!slider) return slider;
  slider->min =
      slider->scale == Scale::logarithmic && value <= 0 ? slider->min : std::min(slider->min, value);
  slider->max = std::max(slider->max, value);
  return slider;
}

}  // namespace emscape::view
