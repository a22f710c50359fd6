/// Where the symbols of a picture's markers are.
#pragma once

#include <optional>
#include <vector>

#include "emscape/render/annotate/overlay.h"

namespace emscape::render {

/// Pixels of the picture.
struct MarkerPlace {
  double x = 0, y = 0;
  double radius = 0;
};

/// The places at which a picture draws the symbols of its markers: those of one position are side by side.
/// @return one per marker; none: it is not drawn
std::vector<std::optional<MarkerPlace>> markerPlaces(ImageSize size, const Camera& camera,
                                                     const SceneBox& box, const Annotations& annotations);

}  // namespace emscape::render
