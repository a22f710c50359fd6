/// Places of the labels of markers. A place depends on the markers' positions alone, not on earlier pictures,
/// so that a picture that is drawn again has the same labels. Labels of fixed objects are placed first,
/// around what does not move either: with a fixed camera they stay.
#pragma once

#include <optional>
#include <vector>

#include "render/annotate/canvas.h"

namespace emscape::render {

/// Fractions of the picture that labels may cover: those of fixed objects, and all.
constexpr double kFixedLabelsPart = 0.08, kLabelsPart = 0.1;

struct LabelRequest {
  Point2 at;          ///< of the marker
  double radius = 0;  ///< of its symbol
  double width = 0, height = 0;
  int rank = 0;      ///< lower ones are placed first, of one rank the nearest
  double depth = 0;  ///< distance from the camera
  bool moves = false;
};

struct LabelPlace {
  Rect rect;
  bool needs_line = false;  ///< not beside the symbol, or nearer to another one: a line leads to it
};

/// No two of the places overlap, none covers `taken` or the symbol of a fixed object, and no line to a place
/// crosses another one.
/// @param gap  between symbol and label (pixels)
/// @return one for each request; none if there is no place left
std::vector<std::optional<LabelPlace>> placeLabels(const std::vector<LabelRequest>& requests, ImageSize size,
                                                   double gap, const std::vector<Rect>& taken);

/// The point of a rectangle that is nearest to a point.
Point2 nearestIn(const Rect& rect, const Point2& to);

}  // namespace emscape::render
