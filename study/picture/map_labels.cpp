#include "study/picture/map_labels.h"

#include <algorithm>
#include <array>

namespace emscape::study {

using render::Point2;
using render::Rect;

std::vector<std::optional<Rect>> placeLabels(const std::vector<Point2>& at, double radius,
                                             const std::vector<Rect>& extents, const Rect& bounds) {
  std::vector<Rect> taken;
  for (const Point2& center : at)
    taken.push_back({center.x - radius, center.y - radius, 2 * radius, 2 * radius});
  const auto placeOf = [&](const Point2& center, double width, double height) -> std::optional<Rect> {
    for (const double reach : {1.5, 3.0, 5.0, 8.0}) {
      const double far = reach * radius, slant = 0.75 * far;
      const std::array<Point2, 8> corners{{{center.x + far, center.y - height / 2},
                                           {center.x - far - width, center.y - height / 2},
                                           {center.x - width / 2, center.y - far - height},
                                           {center.x - width / 2, center.y + far},
                                           {center.x + slant, center.y - slant - height},
                                           {center.x - slant - width, center.y - slant - height},
                                           {center.x + slant, center.y + slant},
                                           {center.x - slant - width, center.y + slant}}};
      for (const Point2& corner : corners) {
        const Rect box{corner.x, corner.y, width, height};
        const bool is_inside = box.x >= bounds.x && box.y >= bounds.y &&
                               box.x + width <= bounds.x + bounds.width &&
                               box.y + height <= bounds.y + bounds.height;
        const auto hits = [&](const Rect& other) { return overlap(box, other); };
        if (is_inside && std::none_of(taken.begin(), taken.end(), hits)) return box;
      }
    }
    return std::nullopt;
  };
  std::vector<std::optional<Rect>> places;
  for (std::size_t n = 0; n < at.size(); ++n) {
    places.push_back(placeOf(at[n], extents[n].width, extents[n].height));
    if (places.back()) taken.push_back(*places.back());
  }
  return places;
}

}  // namespace emscape::study
