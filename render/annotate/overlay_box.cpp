/// The volume's box: edges, ticks and axis titles; the compass.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/text/display_units.h"
#include "emscape/base/units.h"
#include "render/annotate/overlay_parts.h"

namespace emscape::render {
namespace {

constexpr double kTick = 6;  // lengths at 1200 x 900
constexpr double kTickToLabel = 6;
constexpr double kTitleBeyondLabels = 13;
constexpr double kPixelsPerEdgeTick = 85;
constexpr double kNumberGap = 9;

/// An edge of the box along one axis; the other two coordinates are at their lower (0) or upper (1) ends.
struct Edge {
  int axis = 0;
  std::array<int, 3> end{};  // unused for its own axis
};

double component(const Vec3d& v, int axis) {
  return axis == 0 ? v.x : (axis == 1 ? v.y : v.z);
}
void setComponent(Vec3d& v, int axis, double value) {
  (axis == 0 ? v.x : (axis == 1 ? v.y : v.z)) = value;
}

std::vector<Edge> allEdges() {
  std::vector<Edge> edges;
  for (int axis = 0; axis < 3; ++axis) {
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) {
        Edge edge;
        edge.axis = axis;
        edge.end[static_cast<std::size_t>((axis + 1) % 3)] = a;
        edge.end[static_cast<std::size_t>((axis + 2) % 3)] = b;
        edges.push_back(edge);
      }
    }
  }
  return edges;
}

/// The point of an edge at which its own coordinate is `value`.
Vec3d pointOf(const Edge& edge, const SceneBox& box, double value) {
  Vec3d point;
  for (int axis = 0; axis < 3; ++axis) {
    const bool upper = edge.end[static_cast<std::size_t>(axis)] != 0;
    setComponent(point, axis, axis == edge.axis ? value : component(upper ? box.upper_m : box.lower_m, axis));
  }
  return point;
}

bool facesCamera(const Camera& camera, const SceneBox& box, int axis, int end) {
  const double sign = end != 0 ? 1.0 : -1.0;
  if (camera.projection == Projection::orthographic) return -component(camera.forward, axis) * sign > 0;
  return (component(camera.eye_m, axis) - component(end != 0 ? box.drawnUpper_m() : box.lower_m, axis)) *
             sign >
         0;
}

/// Number of an edge's two faces that face the camera: 0 behind the volume, 1 on its silhouette, 2 in front
/// of it.
int seenFaces(const Projector& p, const Edge& edge) {
  int seen = 0;
  for (int other : {(edge.axis + 1) % 3, (edge.axis + 2) % 3}) {
    seen += facesCamera(p.camera, p.box, other, edge.end[static_cast<std::size_t>(other)]) ? 1 : 0;
  }
  return seen;
}

bool ends(const Projector& p, const Edge& edge, Point2& a, Point2& b) {
  return p.project(pointOf(edge, p.box, component(p.box.lower_m, edge.axis)), a) &&
         p.project(pointOf(edge, p.box, component(p.box.upper_m, edge.axis)), b);
}

/// The edge with the ticks of an axis. For horizontal axes on the ground, where positions are read, if
/// possible on the silhouette, and the lowest in the picture; for the vertical axis the leftmost of the
/// silhouette.
bool labelledEdge(const Projector& p, int axis, Edge& chosen) {
  constexpr double kOnSilhouette = 1e9;
  double best = -1e300;
  for (const Edge& edge : allEdges()) {
    const int seen = seenFaces(p, edge);
    if (edge.axis != axis || (axis == 2 ? seen != 1 : edge.end[2] != 0)) continue;
    Point2 a;
    Point2 b;
    if (!ends(p, edge, a, b)) continue;
    const double score = axis == 2 ? -(a.x + b.x) : a.y + b.y + (seen == 1 ? kOnSilhouette : 0);
    if (score > best) {
      best = score;
      chosen = edge;
    }
  }
  return best > -1e300;
}

struct AxisWords {
  std::string title;
  double scale = 1;  // frame metres per unit of the label
};
AxisWords wordsOf(int axis, const SceneBox& box, const Annotations& annotations) {
  if (!annotations.georeferenced) return {axis == 0 ? "x" : (axis == 1 ? "y" : "z"), 1};
  if (axis == 2) {
    constexpr double kLow_m = 3000;
    const bool in_km = annotations.units == Units::metric && box.upper_m.z > kLow_m;
    const DisplayUnit unit = in_km ? distanceUnit(annotations.units) : heightUnit(annotations.units);
    return {std::string("altitude, ") + unit.name, unit.factor};
  }
  const DisplayUnit unit = distanceUnit(annotations.units);
  const std::string& origin = axis == 0 ? annotations.origin_longitude : annotations.origin_latitude;
  const std::string of = origin.empty() ? "" : " of " + origin;
  return {std::string(unit.name) + (axis == 0 ? " east" : " north") + of, unit.factor};
}

/// The unit vector in the picture that points away from the box at an edge.
Point2 outwardOf(const Point2& a, const Point2& b, const Point2& center) {
  const Point2 along = b - a;
  const double size = std::max(length(along), 1e-9);
  Point2 outward{along.y / size, -along.x / size};
  const Point2 middle = (a + b) * 0.5;
  if ((middle.x - center.x) * outward.x + (middle.y - center.y) * outward.y < 0) outward = outward * -1.0;
  return outward;
}

/// Rectangle covered by a text at a point.
Rect rectOf(const Point2& at, const Rect& extent, Align align) {
  const double shift = align == Align::left ? 0.0 : (align == Align::center ? 0.5 : 1.0);
  return {at.x - shift * extent.width, at.y - extent.height / 2, extent.width, extent.height};
}

/// A tick of an axis and its number.
struct AxisTick {
  Point2 at, label;
  std::string text;
  Rect covered;
  bool is_free = true;  ///< false: two axes meet there, and the other one has its number there
};

std::vector<AxisTick> ticksOf(const Canvas& canvas, const Style& style, const Projector& p, const Edge& edge,
                              double scale, int count, const Point2& outward, Align align,
                              const std::vector<Rect>& taken) {
  const std::vector<double> values = roundTicks(component(p.box.lower_m, edge.axis) / scale,
                                                component(p.box.upper_m, edge.axis) / scale, count);
  const double step = values.size() > 1 ? values[1] - values[0] : 1;
  std::vector<AxisTick> ticks;
  for (const double value : values) {
    AxisTick tick;
    p.project(pointOf(edge, p.box, value * scale), tick.at);
    tick.text = tickText(value, step);
    const Rect extent = canvas.textBox(tick.text, style.small_px);
    tick.label =
        tick.at + outward * ((kTick + kTickToLabel) * style.unit + std::abs(outward.y) * extent.height * 0.4);
    tick.covered = rectOf(tick.label, extent, align);
    const double gap = kNumberGap * style.unit;
    const Rect with_gap{tick.covered.x - gap, tick.covered.y, tick.covered.width + 2 * gap,
                        tick.covered.height};
    tick.is_free =
        std::none_of(taken.begin(), taken.end(), [&](const Rect& other) { return overlap(with_gap, other); });
    ticks.push_back(tick);
  }
  return ticks;
}

void drawAxis(Canvas& canvas, const Style& style, const Projector& p, int axis,
              const Annotations& annotations, std::vector<Rect>& taken) {
  Edge edge;
  Point2 a;
  Point2 b;
  Point2 center;
  if (!labelledEdge(p, axis, edge) || !ends(p, edge, a, b)) return;
  if (!p.project((p.box.lower_m + p.box.upper_m) * 0.5, center)) return;
  const double edge_px = length(b - a);
  if (edge_px < 40 * style.unit) return;  // seen end on
  const Point2 outward = outwardOf(a, b, center);
  const AxisWords words = wordsOf(axis, p.box, annotations);
  const Align align = outward.x > 0.35 ? Align::left : (outward.x < -0.35 ? Align::right : Align::center);
  const std::vector<AxisTick> ticks = [&] {
    // One number alone would not give the scale.
    const int count = std::max(2, static_cast<int>(edge_px / (kPixelsPerEdgeTick * style.unit)));
    std::vector<AxisTick> of_axis;
    for (int more = 0; more <= 3; ++more) {
      of_axis = ticksOf(canvas, style, p, edge, words.scale, count + more, outward, align, taken);
      const auto is_free = [](const AxisTick& tick) { return tick.is_free; };
      if (std::count_if(of_axis.begin(), of_axis.end(), is_free) > 1) break;
    }
    return of_axis;
  }();
  double widest = 0;
  std::optional<Rect> last_number;  // numbers of an axis seen nearly end on would be stacked
  for (const AxisTick& tick : ticks) {
    widest = std::max(widest,
                      std::abs(outward.x) * tick.covered.width + std::abs(outward.y) * tick.covered.height);
    canvas.line(tick.at, tick.at + outward * (kTick * style.unit), style.textInk(0.8), 1.2 * style.unit);
    const bool meets_last = last_number && overlap(tick.covered, *last_number);
    if (!tick.is_free || meets_last) continue;
    last_number = tick.covered;
    taken.push_back(tick.covered);
    canvas.textWithRim(tick.text, tick.label, style.small_px, style.textInk(0.92), style.rimInk(), align);
  }
  double angle = std::atan2(b.y - a.y, b.x - a.x);
  if (angle > kPi / 2 + 0.01) angle -= kPi;
  if (angle < -kPi / 2 + 0.01) angle += kPi;
  if (axis == 2) angle = -kPi / 2;
  const Point2 middle =
      (a + b) * 0.5 + outward * ((kTick + kTickToLabel + kTitleBeyondLabels) * style.unit + widest);
  const Rect title = canvas.textBox(words.title, style.small_px);
  // Squares along the text, as the rectangle around an oblique text would also cover what is beside it.
  const Point2 direction{std::cos(angle), std::sin(angle)};
  const double side = 0.8 * title.height;
  const int parts = std::max(1, static_cast<int>(std::ceil(title.width / side)));
  std::vector<Rect> squares;
  for (int i = 0; i < parts; ++i) {
    const Point2 at = middle + direction * (((i + 0.5) / parts - 0.5) * title.width);
    squares.push_back({at.x - side / 2, at.y - side / 2, side, side});
  }
  const bool meets_text = std::any_of(squares.begin(), squares.end(), [&](const Rect& square) {
    return std::any_of(taken.begin(), taken.end(), [&](const Rect& other) { return overlap(square, other); });
  });
  if (meets_text) return;
  canvas.textWithRim(words.title, middle, style.small_px, style.mutedInk(), style.rimInk(), Align::center,
                     Weight::normal, angle);
  taken.insert(taken.end(), squares.begin(), squares.end());
}

}  // namespace

void drawFarEdges(Canvas& canvas, const Style& style, const Projector& projector) {
  for (const Edge& edge : allEdges()) {
    Point2 a;
    Point2 b;
    if (seenFaces(projector, edge) != 0 || !ends(projector, edge, a, b)) continue;
    canvas.line(a, b, style.mutedInk(0.45), style.unit);
  }
}

void drawNearEdges(Canvas& canvas, const Style& style, const Projector& projector,
                   const Annotations& annotations, std::vector<Rect>& taken) {
  for (const Edge& edge : allEdges()) {
    Point2 a;
    Point2 b;
    const int seen = seenFaces(projector, edge);
    if (seen == 0 || !ends(projector, edge, a, b)) continue;
    canvas.line(a, b, style.mutedInk(seen == 1 ? 0.75 : 0.35), style.unit);
  }
  for (int axis = 0; axis < 3; ++axis) drawAxis(canvas, style, projector, axis, annotations, taken);
}

void drawCompass(Canvas& canvas, const Style& style, const Camera& camera, const Point2& center,
                 double radius) {
  // Projection of a point of the ground plane, east and north in radii, by an orthographic camera with the
  // same axes. A low camera sees the rose from somewhat above, so that its letters stay apart.
  constexpr double kMinTilt = 0.42;
  const double tilt = std::hypot(camera.up.x, camera.up.y);
  Point2 up{camera.up.x, camera.up.y};
  if (tilt < kMinTilt) {
    const double ahead = std::hypot(camera.forward.x, camera.forward.y);
    up = Point2{camera.forward.x, camera.forward.y} * ((camera.forward.z > 0 ? -kMinTilt : kMinTilt) / ahead);
  }
  const auto at = [&](double east, double north) {
    return center +
           Point2{east * camera.right.x + north * camera.right.y, -(east * up.x + north * up.y)} * radius;
  };
  std::vector<Point2> ring;
  for (int i = 0; i < 72; ++i)
    ring.push_back(at(0.72 * std::sin(i * kPi / 36), 0.72 * std::cos(i * kPi / 36)));
  canvas.polygon(ring, style.rimInk(0.45));
  canvas.outline(ring, style.mutedInk(0.9), 1.2 * style.unit, true);
  const Rgb red = parseColor("#e5534b");
  canvas.polygon({at(0, 0.66), at(0.15, 0), at(-0.15, 0)}, {red, 1});
  canvas.polygon({at(0, -0.66), at(0.15, 0), at(-0.15, 0)}, style.mutedInk(0.9));
  constexpr double kLetters = 1.02;
  canvas.textWithRim("N", at(0, kLetters), style.small_px, style.textInk(), style.rimInk(), Align::center,
                     Weight::bold);
  canvas.textWithRim("E", at(kLetters, 0), style.small_px, style.mutedInk(), style.rimInk(), Align::center);
  canvas.textWithRim("S", at(0, -kLetters), style.small_px, style.mutedInk(), style.rimInk(), Align::center);
  canvas.textWithRim("W", at(-kLetters, 0), style.small_px, style.mutedInk(), style.rimInk(), Align::center);
}

}  // namespace emscape::render
