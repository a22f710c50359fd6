/// Lines and points on the ground, and the scale bar.
#include <algorithm>
#include <cmath>

#include "base/text/display_units.h"
#include "render/annotate/overlay_parts.h"

namespace emscape::render {
namespace {

constexpr double kDot = 3.2;  // radius, lengths at 1200 x 900
constexpr double kPlaceGap = 7;
constexpr double kSymbol = 11;     // half the size of an emitter's symbol
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

std::vector<Vertex> verticesOf(const GroundLine& line, const GroundProjection& project,
                               const HiddenTest& hidden) {
  std::vector<Vertex> vertices;
  for (const Vec3d& point_m : line.points_m) {
    const bool is_known = std::isfinite(point_m.z);  // no hole of the ground
    const std::optional<Point2> at = is_known ? project(point_m) : std::nullopt;
    vertices.push_back({at.value_or(Point2{}), at && !(hidden && hidden(point_m))});
  }
  if (line.is_area && !vertices.empty()) vertices.push_back(vertices.front());
  return vertices;
}

void fillArea(Canvas& canvas, const GroundLine& line, const GroundProjection& project, const LineLook& look) {
  std::vector<Point2> corners;
  for (const Vec3d& point_m : line.points_m) {
    if (!std::isfinite(point_m.z)) continue;
    const std::optional<Point2> at = project(point_m);
    if (!at) return;
    corners.push_back(*at);
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

/// Places for a line's label, the best first; none if they are not visible.
std::vector<Point2> labelPoints(const Style& style, const GroundLine& line,
                                const std::vector<Vertex>& vertices) {
  if (vertices.empty()) return {};
  const auto visible = [](const Vertex& vertex) {
    return vertex.is_visible ? std::vector<Point2>{vertex.at} : std::vector<Point2>{};
  };
  if (line.is_area) {
    Point2 sum;
    for (const Vertex& vertex : vertices) {
      if (!vertex.is_visible) return {};
      sum = sum + vertex.at;
    }
    return {sum * (1.0 / static_cast<double>(vertices.size()))};
  }
  const auto isLower = [](const Vertex& a, const Vertex& b) { return a.at.y < b.at.y; };
  if (line.ink == GroundInk::ring) {
    const auto [highest, lowest] = std::minmax_element(vertices.begin(), vertices.end(), isLower);
    std::vector<Point2> points = visible(*lowest);
    if (highest->is_visible) points.push_back(highest->at);
    return points;
  }
  if (line.ink == GroundInk::graticule) {  // inside the end nearer to the viewer
    const bool at_front = isLower(vertices.back(), vertices.front());
    const Vertex& end = at_front ? vertices.front() : vertices.back();
    const Vertex& other = at_front ? vertices.back() : vertices.front();
    const double size = length(other.at - end.at);
    if (!end.is_visible || size < 60 * style.unit) return {};
    return {end.at + (other.at - end.at) * (24 * style.unit / size)};
  }
  std::vector<Point2> points;
  for (const double part : {0.5, 0.33, 0.67, 0.2, 0.8}) {
    const Vertex& vertex = vertices[static_cast<std::size_t>(part * static_cast<double>(vertices.size()))];
    if (vertex.is_visible) points.push_back(vertex.at);
  }
  return points;
}

/// Draws a text unless it meets another one or the picture's edge. @return true if it was drawn
bool drawIfFree(Canvas& canvas, const Style& style, const std::string& label, const Point2& at,
                const Ink& ink, Align align, std::vector<Rect>& taken) {
  const std::string text = shortenedText(canvas, label, style.small_px, style.name_px);
  const Rect extent = canvas.textBox(text, style.small_px);
  const double left = align == Align::center ? at.x - extent.width / 2 : at.x;
  const Rect covered{left, at.y - extent.height / 2, extent.width, extent.height};
  const bool is_inside = covered.x >= 0 && covered.y >= 0 &&
                         covered.x + covered.width <= canvas.size().width &&
                         covered.y + covered.height <= canvas.size().height;
  const auto hits = [&](const Rect& other) { return overlap(covered, other); };
  if (!is_inside || std::any_of(taken.begin(), taken.end(), hits)) return false;
  taken.push_back(covered);
  canvas.textWithRim(text, at, style.small_px, ink, style.rimInk(), align);
  return true;
}

/// The name of a point: beside it, above or below.
void drawPointName(Canvas& canvas, const Style& style, const std::string& name, const Point2& at,
                   const Ink& ink, std::vector<Rect>& taken) {
  if (name.empty()) return;
  const Rect extent =
      canvas.textBox(shortenedText(canvas, name, style.small_px, style.name_px), style.small_px);
  const double gap = kPlaceGap * style.unit;
  const double rise = gap + extent.height / 2;
  for (const Point2& left : {Point2{gap, 0}, Point2{-gap - extent.width, 0}, Point2{-extent.width / 2, -rise},
                             Point2{-extent.width / 2, rise}}) {
    if (drawIfFree(canvas, style, name, at + left, ink, Align::left, taken)) return;
  }
}

}  // namespace

void drawGroundMarks(Canvas& canvas, const Style& style, const GroundProjection& project,
                     const std::vector<GroundLine>& lines, const std::vector<GroundPoint>& points,
                     const std::vector<Point2>& symbols, const HiddenTest& hidden, std::vector<Rect>& taken) {
  const auto first_symbol = static_cast<std::ptrdiff_t>(taken.size());
  const double reach = kSymbol * style.unit;
  for (const Point2& at : symbols) taken.push_back({at.x - reach, at.y - reach, 2 * reach, 2 * reach});
  const auto end_of_symbols = static_cast<std::ptrdiff_t>(taken.size());
  for (const GroundLine& line : lines) {
    const LineLook look = lookOf(style, line.ink);
    const std::vector<Vertex> vertices = verticesOf(line, project, hidden);
    if (line.is_area) fillArea(canvas, line, project, look);
    drawVisible(canvas, style, vertices, look);
    if (line.label.empty()) continue;
    for (const Point2& at : labelPoints(style, line, vertices)) {
      if (drawIfFree(canvas, style, line.label, at, look.text, Align::center, taken)) break;
    }
  }
  const LineLook look = lookOf(style, GroundInk::place);
  for (const GroundPoint& point : points) {
    const std::optional<Point2> at = project(point.position_m);
    if (!at || (hidden && hidden(point.position_m))) continue;
    canvas.disc(*at, kDot * style.unit, look.line);
    canvas.circle(*at, kDot * style.unit, style.rimInk(0.9), style.unit);
    drawPointName(canvas, style, point.label, *at, look.text, taken);
  }
  taken.erase(taken.begin() + first_symbol, taken.begin() + end_of_symbols);
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
