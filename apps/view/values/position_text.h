/// Positions, lengths and values as the window's panels show them.
#pragma once

#include <string>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/playback/view/view_state.h"
#include "playback/editing/probe.h"

namespace emscape::view {

/// "36.35012°, −84.25014°".
std::string positionText(const GeodeticPosition& position, const playback::ViewState& view);
/// "412 m".
std::string heightText(double height_m, const playback::ViewState& view);
/// "840 m", "12.34 km".
std::string distanceText(double distance_m, const playback::ViewState& view);
/// The value of the volume in the unit in which fields are shown, or the reason for a missing one.
std::string valueText(const playback::ProbeReading& reading, const volume::VolumeInfo& info,
                      const playback::ViewState& view);
/// A value in the unit in which fields are shown. @param text  in the unit of the quantity, or other words
std::string valueText(double stored, const std::string& unit, const std::string& text,
                      const playback::ViewState& view);
/// A text with "12.5 deg" as "12.5°".
std::string withDegreeSigns(std::string text);
/// "087.5°". @param bearing_deg  any angle, clockwise from north
std::string bearingText(double bearing_deg);

}  // namespace emscape::view
