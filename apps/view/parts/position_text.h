/// Positions and lengths as the window's panels show them.
#pragma once

#include <string>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/playback/view/view_state.h"

namespace emscape::view {

/// "36.35012°, −84.25014°".
std::string positionText(const GeodeticPosition& position, const playback::ViewState& view);
/// "412 m".
std::string heightText(double height_m, const playback::ViewState& view);
/// "840 m", "12.34 km".
std::string distanceText(double distance_m, const playback::ViewState& view);
/// "087.5°". @param bearing_deg  any angle, clockwise from north
std::string bearingText(double bearing_deg);

}  // namespace emscape::view
