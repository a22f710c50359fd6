/// Reference levels for the exposure of people to radio waves.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace emscape::scenario {

/// The people for whom levels hold.
enum class ExposureGroup { general_public, occupational };
constexpr auto namesOf(ExposureGroup) {
  return std::array{"general_public", "occupational"};
}

/// Reference level of the incident power density (W/m2) of a plane wave, averaged over the whole body and
/// over 30 minutes. Below 30 MHz the levels are those of the electric and the magnetic field, of which the
/// plane wave that reaches the first of them is taken.
/// @param frequency_hz  without a level outside 100 kHz .. 300 GHz
/// @see ICNIRP, Guidelines for Limiting Exposure to Electromagnetic Fields (100 kHz to 300 GHz), Health
/// Physics 118 (2020), table 5
std::optional<double> referenceLevel_wm2(ExposureGroup group, double frequency_hz);

}  // namespace emscape::scenario
