/// Frames and captions of cutting planes.
#include <algorithm>

#include "render/annotate/overlay_parts.h"
#include "render/scene/plane_frame.h"

namespace emscape::render {
namespace {

constexpr double kWidth = 1.6;  // lengths at 1200 x 900
constexpr double kCaptionAbove = 11;

}  // namespace

void drawPlanes(Canvas& canvas, const Style& style, const Projector& projector,
                const Annotations& annotations, std::vector<Rect>& taken) {
  for (const CutPlane& plane : annotations.planes) {
    const std::optional<PlaneFrame> frame = plane.on ? frameOf(plane, projector.box) : std::nullopt;
    if (!frame) continue;
    std::vector<Point2> corners(frame->corners_m.size());
    bool is_in_front = true;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      is_in_front = projector.project(frame->corners_m[i], corners[i]) && is_in_front;
    }
    if (!is_in_front) continue;
    canvas.outline(corners, style.rimInk(1), (kWidth + 2) * style.unit, true);
    canvas.outline(corners, style.textInk(), kWidth * style.unit, true);
    // At the left end of the uppermost edge, where a section seen from above hides least.
    const auto higher = [](const Point2& a, const Point2& b) { return a.y < b.y; };
    std::sort(corners.begin(), corners.end(), higher);
    const Point2& corner = corners[0].x < corners[1].x ? corners[0] : corners[1];
    const std::string caption = captionOf(plane, annotations.units, annotations.georeferenced);
    const Rect extent = canvas.textBox(caption, style.small_px);
    const Point2 at{corner.x, corner.y - kCaptionAbove * style.unit};
    canvas.textWithRim(caption, at, style.small_px, style.textInk(), style.rimInk());
    taken.push_back({at.x, at.y - extent.height / 2, extent.width, extent.height});
  }
}

}  // namespace emscape::render
