/// Lines and points on the ground, and the scale bar.
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/text/display_units.h"
#include "render/annotate/overlay_parts.h"

namespace emscape::render {
namespace {

constexpr double kDot = 3.2;  // radius, lengths at 1200 x 900
constexpr double kPlaceGap = 7;
constexpr double kScaleBar = 150;  // longest

struct LineLook {
  Ink line, rim, text;
  double width;
};

LineLook lookOf(const Style& style, GroundInk ink) {
  switch (ink) {
    case GroundInk::graticule:
      return {style.mutedInk(0.65), style.rimInk(0.2), style.mutedInk(), 1};
    case GroundInk::coast:
      return {{parseColor("#7fc4e8"), 0.85}, style.rimInk(0.35), style.mutedInk(), 1.3};
    case GroundInk::ring:
      return {style.textInk(0.75), style.rimInk(0.35), style.textInk(), 1.2};
    case GroundInk::place:
      break;
  }
  return {{parseColor("#ffb454"), 0.9}, style.rimInk(0.45), style.textInk(), 1.4};
}

/// A vertex of a line in the picture.
struct Vertex {
  Point2 at;
  bool is_visible = false;
};

std::vector<Vertex> verticesOf(const GroundLine& line, const Projector& projector, const HiddenTest& hidden) {
  std::vector<Vertex> vertices;
  for (const Vec3d& point_m : line.points_m) {
    Vertex& vertex = vertices.emplace_back();
    const bool is_known = std::isfinite(point_m.z);  // no hole of the ground
    vertex.is_visible = is_known && projector.project(point_m, vertex.at) && !(hidden && hidden(point_m));
  }
  if (line.is_area && !vertices.empty()) vertices.push_back(vertices.front());
  return vertices;
}

void fillArea(Canvas& canvas, const GroundLine& line, const Projector& projector, const LineLook& look) {
  std::vector<Point2> corners;
  for (const Vec3d& point_m : line.points_m) {
    if (!std::isfinite(point_m.z)) continue;
    if (!projector.project(point_m, corners.emplace_back())) return;
  }
  constexpr double kFill = 0.16;
  canvas.polygon(corners, {look.line.color, kFill});
}

void drawVisible(Canvas& canvas, const Style& style, const std::vector<Vertex>& vertices,
                 const LineLook& look) {
  std::vector<Point2> run;
  const auto flush = [&] {
    if (run.size() > 1) {
      const double width = look.width * style.unit;
      if (look.rim.alpha > 0) canvas.outline(run, look.rim, width + 1.8 * style.unit, false);
      canvas.outline(run, look.line, width, false);
    }
    run.clear();
  };
  for (const Vertex& vertex : vertices) {
    if (vertex.is_visible) {
      run.push_back(vertex.at);
    } else {
      flush();
    }
  }
  flush();
}

/// The place of a line's label; none if it is not visible.
std::optional<Point2> labelPoint(const Style& style, const GroundLine& line,
                                 const std::vector<Vertex>& vertices) {
  if (vertices.empty()) return std::nullopt;
  if (line.is_area) {
    Point2 sum;
    for (const Vertex& vertex : vertices) {
      if (!vertex.is_visible) return std::nullopt;
      sum = sum + vertex.at;
    }
    return sum * (1.0 / static_cast<double>(vertices.size()));
  }
  const auto isLower = [](const Vertex& a, const Vertex& b) { return a.at.y < b.at.y; };
  if (line.ink == GroundInk::ring) {
    const Vertex& lowest = *std::max_element(vertices.begin(), vertices.end(), isLower);
    return lowest.is_visible ? std::optional(lowest.at) : std::nullopt;
  }
  if (line.ink == GroundInk::graticule) {  // inside the end nearer to the viewer
    const bool at_front = isLower(vertices.back(), vertices.front());
    const Vertex& end = at_front ? vertices.front() : vertices.back();
    const Vertex& other = at_front ? vertices.back() : vertices.front();
    const double size = length(other.at - end.at);
    if (!end.is_visible || size < 60 * style.unit) return std::nullopt;
    return end.at + (other.at - end.at) * (24 * style.unit / size);
  }
  const Vertex& middle = vertices[vertices.size() / 2];
  return middle.is_visible ? std::optional(middle.at) : std::nullopt;
}

/// Draws a text unless it meets another one or the picture's edge.
void drawIfFree(Canvas& canvas, const Style& style, const std::string& label, const Point2& at,
                const Ink& ink, Align align, std::vector<Rect>& taken) {
  const std::string text = shortenedText(canvas, label, style.small_px, style.name_px);
  const Rect extent = canvas.textBox(text, style.small_px);
  const double left = align == Align::center ? at.x - extent.width / 2 : at.x;
  const Rect covered{left, at.y - extent.height / 2, extent.width, extent.height};
  const bool is_inside = covered.x >= 0 && covered.y >= 0 &&
                         covered.x + covered.width <= canvas.size().width &&
                         covered.y + covered.height <= canvas.size().height;
  const auto hits = [&](const Rect& other) { return overlap(covered, other); };
  if (!is_inside || std::any_of(taken.begin(), taken.end(), hits)) return;
  taken.push_back(covered);
  canvas.textWithRim(text, at, style.small_px, ink, style.rimInk(), align);
}

}  // namespace

void drawGroundMarks(Canvas& canvas, const Style& style, const Projector& projector,
                     const Annotations& annotations, const HiddenTest& hidden, std::vector<Rect>& taken) {
  for (const GroundLine& line : annotations.ground_lines) {
    const LineLook look = lookOf(style, line.ink);
    const std::vector<Vertex> vertices = verticesOf(line, projector, hidden);
    if (line.is_area) fillArea(canvas, line, projector, look);
    drawVisible(canvas, style, vertices, look);
    const std::optional<Point2> at = line.label.empty() ? std::nullopt : labelPoint(style, line, vertices);
    if (at) drawIfFree(canvas, style, line.label, *at, look.text, Align::center, taken);
  }
  const LineLook look = lookOf(style, GroundInk::place);
  for (const GroundPoint& point : annotations.ground_points) {
    Point2 at;
    if (!projector.project(point.position_m, at) || (hidden && hidden(point.position_m))) continue;
    canvas.disc(at, kDot * style.unit, look.line);
    canvas.circle(at, kDot * style.unit, style.rimInk(0.9), style.unit);
    drawIfFree(canvas, style, point.label, at + Point2{kPlaceGap * style.unit, 0}, look.text, Align::left,
               taken);
  }
}

void drawScaleBar(Canvas& canvas, const Style& style, const Projector& projector, Units units,
                  const Point2& left, std::vector<Rect>& taken) {
  const Vec3d middle = (projector.box.lower_m + projector.box.upper_m) * 0.5;
  const Vec3d ground = projector.box.toDrawn({middle.x, middle.y, projector.box.lower_m.z});
  const Camera& camera = projector.camera;
  const Projected at = render::project(camera, projector.size, ground);
  const bool is_perspective = camera.projection == Projection::perspective;
  if (!at.in_front) return;
  const double half_height_m = camera.half_height * (is_perspective ? at.depth_m : 1);
  const double pixel_m = 2 * half_height_m / projector.size.height;
  const DisplayUnit unit = distanceUnit(units);
  // The largest of 1, 2, 5 times a power of ten that fits.
  const double most = kScaleBar * style.unit * pixel_m / unit.factor;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  const double value = most >= 5 * power ? 5 * power : (most >= 2 * power ? 2 * power : power);
  const double width = value * unit.factor / pixel_m;
  const double tick = 5 * style.unit;
  const Point2 right = left + Point2{width, 0};
  const std::vector<Point2> bar{left + Point2{0, -tick}, left, right, right + Point2{0, -tick}};
  canvas.outline(bar, style.rimInk(), 4 * style.unit, false);
  canvas.outline(bar, style.textInk(0.9), 1.8 * style.unit, false);
  const std::string text =
      roundDistanceText(value * unit.factor, units) + (is_perspective ? " in the middle" : "");
  const Point2 above = (left + right) * 0.5 + Point2{0, -12 * style.unit};
  canvas.textWithRim(text, above, style.small_px, style.textInk(), style.rimInk(), Align::center);
  const double text_width = std::max(width, canvas.textBox(text, style.small_px).width);
  taken.push_back({above.x - text_width / 2, above.y - style.small_px, text_width, 2.5 * style.small_px});
}

}  // namespace emscape::render
