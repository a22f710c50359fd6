/// The colours of maps: one choice for pictures, overlays and styles.
#pragma once

#include <optional>

#include "emscape/base/units.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/study/maps/map.h"

namespace emscape::study {

/// Colours and legend of a map, over the range of its values; 0..1 for parts.
/// @param units, field_unit  in which lengths and fields are shown
render::Legend legendOf(const Map& map, Units units = Units::metric,
                        FieldUnit field_unit = FieldUnit::stored);

/// True for a pixel that pictures hatch: its answer is unknown.
bool isUnknown(const Map& map, std::size_t pixel);

/// The colour of a value by the map's legend; none if it is transparent: no value, the class 0, a fraction
/// below half a percent.
std::optional<render::Rgb> colorOf(const Map& map, const render::Legend& legend, float value);

}  // namespace emscape::study
