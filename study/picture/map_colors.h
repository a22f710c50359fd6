/// The colours of maps: one choice for pictures, overlays and styles.
#pragma once

#include <optional>

#include "emscape/render/annotate/legend.h"
#include "emscape/study/maps/map.h"

namespace emscape::study {

/// Colours and legend of a map, over the range of its values; 0..1 for parts.
render::Legend legendOf(const Map& map);

/// The colour of a value by the map's legend; none if it is transparent: no value, the class 0, a fraction
/// below half a percent.
std::optional<render::Rgb> colorOf(const Map& map, const render::Legend& legend, float value);

}  // namespace emscape::study
