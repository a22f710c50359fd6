/// Symbols of emitters and platforms.
#include "emscape/base/units.h"
#include "render/annotate/overlay_parts.h"

namespace emscape::render {
namespace {

std::vector<Point2> turned(const std::vector<Point2>& shape, const Point2& center, double radius) {
  std::vector<Point2> points;
  for (const Point2& p : shape) points.push_back(center + p * radius);
  return points;
}

}  // namespace

Rgb colorOf(MarkerKind kind) {
  switch (kind) {
    case MarkerKind::radar:
      return parseColor("#ffffff");
    case MarkerKind::transmitter:
      return parseColor("#9fe0ff");
    case MarkerKind::jammer:
      return parseColor("#ff6b6b");
    case MarkerKind::receiver:
      return parseColor("#ffd166");
    case MarkerKind::platform:
      break;
  }
  return parseColor("#d0d7de");
}

void drawSymbol(Canvas& canvas, MarkerKind kind, bool is_active, const Point2& at, double radius,
                double alpha) {
  const Ink fill{colorOf(kind), is_active ? alpha : 0.15 * alpha};
  const Ink line{is_active ? parseColor("#10141b") : colorOf(kind), alpha};
  const double width = 0.2 * radius;
  std::vector<Point2> shape;
  switch (kind) {
    case MarkerKind::transmitter:
      shape = {{0, -1.15}, {1.05, 0.75}, {-1.05, 0.75}};
      break;
    case MarkerKind::jammer:
      shape = {{0, -1.2}, {1.2, 0}, {0, 1.2}, {-1.2, 0}};
      break;
    case MarkerKind::receiver:
      shape = {{-0.85, -0.85}, {0.85, -0.85}, {0.85, 0.85}, {-0.85, 0.85}};
      break;
    case MarkerKind::radar:
    case MarkerKind::platform: {
      const double part = kind == MarkerKind::radar ? 1.0 : 0.6;
      canvas.disc(at, part * radius, fill);
      canvas.circle(at, part * radius, line, width);
      if (kind == MarkerKind::radar) {
        canvas.arc(at, 0.45 * radius, -kPi, 0, line, width);
        canvas.line(at, at + Point2{0, 0.55 * radius}, line, width);
      }
      return;
    }
  }
  const std::vector<Point2> points = turned(shape, at, radius);
  canvas.polygon(points, fill);
  canvas.outline(points, line, width, true);
}

}  // namespace emscape::render
