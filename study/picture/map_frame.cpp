#include "study/picture/map_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/text/display_units.h"
#include "render/annotate/plot.h"

namespace emscape::study {
namespace {

using render::Align;
using render::Canvas;
using render::Ink;
using render::Point2;
using render::Rect;

constexpr int kGraticuleLines = 6;
constexpr Ink kPaper{{1, 1, 1}};
constexpr Ink kGraticule{{0.10F, 0.12F, 0.15F}, 0.35};
constexpr Ink kGraticuleRim{{1, 1, 1}, 0.25};

/// The part of a segment in a rectangle, by Liang and Barsky.
std::optional<std::pair<Point2, Point2>> clipped(const Point2& from, const Point2& to, const Rect& rect) {
  const Point2 along = to - from;
  double begin = 0, end = 1;
  const auto cut = [&](double step, double room) {  // part * step <= room
    if (step == 0) return room >= 0;
    (step < 0 ? begin : end) = step < 0 ? std::max(begin, room / step) : std::min(end, room / step);
    return begin <= end;
  };
  const bool is_seen = cut(-along.x, from.x - rect.x) && cut(along.x, rect.x + rect.width - from.x) &&
                       cut(-along.y, from.y - rect.y) && cut(along.y, rect.y + rect.height - from.y);
  if (!is_seen) return std::nullopt;
  return std::pair{from + along * begin, from + along * end};
}

bool isKnown(const Point2& point) {
  return std::isfinite(point.x) && std::isfinite(point.y);
}

/// The largest of 1, 2 or 5 times a power of ten up to a length.
double roundLength(double most) {
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= most) return factor * power;
  return power;
}

}  // namespace

MapFrame::MapFrame(const MapGrid& grid, const Rect& frame, const render::Style& style)
    : grid_(grid), plane_(grid), frame_(frame), style_(style) {}

Point2 MapFrame::at(const PlanePoint& point) const {
  return {frame_.x + (point.east_m - grid_.left_m) * pixelsPerMetre(),
          frame_.y + (grid_.top_m - point.north_m) * pixelsPerMetre()};
}

std::vector<Point2> MapFrame::at(const std::vector<GeoPoint>& positions) const {
  std::vector<Point2> points;
  for (const PlanePoint& point : plane_.pointsAt(positions)) points.push_back(at(point));
  return points;
}

void MapFrame::drawOutline(Canvas& canvas) const {
  std::vector<Point2> outline;
  for (const PlanePoint& point : plane_.outline()) outline.push_back(at(point));
  if (!outline.empty()) {
    canvas.outside(outline, frame_, kPaper);
    canvas.outline(outline, style_.mutedInk(0.6), style_.unit, true);
  }
  const double right = frame_.x + frame_.width, bottom = frame_.y + frame_.height;
  canvas.outline({{frame_.x, frame_.y}, {right, frame_.y}, {right, bottom}, {frame_.x, bottom}},
                 style_.mutedInk(), style_.unit, true);
}

void MapFrame::drawLine(Canvas& canvas, const std::vector<Point2>& points, const Ink& ink,
                        double width) const {
  std::vector<Point2> piece;
  const auto finish = [&] {
    if (piece.size() > 1) canvas.outline(piece, ink, width, false);
    piece.clear();
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto part = isKnown(points[i]) && isKnown(points[i + 1]) ? clipped(points[i], points[i + 1], frame_)
                                                                   : std::nullopt;
    if (!part) {
      finish();
      continue;
    }
    const bool goes_on = !piece.empty() && length(piece.back() - part->first) < 1e-6;
    if (!goes_on) finish();
    if (piece.empty()) piece.push_back(part->first);
    piece.push_back(part->second);
  }
  finish();
}

void MapFrame::drawGraticule(Canvas& canvas) const {
  const double bottom = frame_.y + frame_.height, gap = 4 * style_.unit;
  std::vector<Rect> taken;
  const auto drawText = [&](const std::string& text, const Point2& point, Align align) {
    const double width = canvas.textBox(text, style_.small_px).width, height = 1.3 * style_.small_px;
    const Rect box{point.x - (align == Align::right ? width : width / 2) - gap, point.y - height / 2,
                   width + 2 * gap, height};
    const auto hits = [&](const Rect& other) { return overlap(box, other); };
    if (std::any_of(taken.begin(), taken.end(), hits)) return;
    taken.push_back(box);
    canvas.text(text, point, style_.small_px, style_.textInk(), align);
  };
  for (const GraticuleLine& line : plane_.graticule(kGraticuleLines)) {
    std::vector<Point2> points;
    for (const PlanePoint& point : line.points) points.push_back(at(point));
    drawLine(canvas, points, kGraticuleRim, 2.4 * style_.unit);
    drawLine(canvas, points, kGraticule, 0.9 * style_.unit);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      if (!isKnown(points[i]) || !isKnown(points[i + 1])) continue;
      // Where it crosses the lower or the left edge.
      const Point2 from = points[i], along = points[i + 1] - points[i];
      const double part = line.is_meridian ? (bottom - from.y) / along.y : (frame_.x - from.x) / along.x;
      if (!(part >= 0 && part < 1)) continue;
      const Point2 edge = from + along * part;
      if (line.is_meridian) {
        if (edge.x < frame_.x || edge.x > frame_.x + frame_.width) continue;
        canvas.line(edge, {edge.x, bottom + 6 * style_.unit}, style_.mutedInk(), style_.unit);
        drawText(line.text, {edge.x, bottom + 18 * style_.unit}, Align::center);
      } else {
        if (edge.y < frame_.y || edge.y > bottom) continue;
        canvas.line({frame_.x - 6 * style_.unit, edge.y}, edge, style_.mutedInk(), style_.unit);
        drawText(line.text, {frame_.x - 10 * style_.unit, edge.y}, Align::right);
      }
    }
  }
}

double MapFrame::drawScaleBar(Canvas& canvas, double right, double y, double metres_per_metre,
                              Units units) const {
  const double pixels_per_m = pixelsPerMetre() / metres_per_metre;
  const double unit_m = distanceUnit(units).factor;
  const double bar_m = unit_m * roundLength(0.24 * frame_.width / pixels_per_m / unit_m);
  const double width = bar_m * pixels_per_m, height = 6 * style_.unit;
  const std::string text = roundDistanceText(bar_m, units);
  const double text_px = canvas.textBox(text, style_.small_px).width;
  const double left = right - text_px / 2 - width;
  canvas.rectangle({left, y - height / 2, width / 2, height}, style_.textInk());
  canvas.outline({{left, y - height / 2},
                  {left + width, y - height / 2},
                  {left + width, y + height / 2},
                  {left, y + height / 2}},
                 style_.textInk(), style_.unit, true);
  const double above = y - height / 2 - 9 * style_.unit;
  canvas.text("0", {left, above}, style_.small_px, style_.textInk(), Align::center);
  canvas.text(text, {left + width, above}, style_.small_px, style_.textInk(), Align::center);
  return left;
}

void MapFrame::drawNorthArrow(Canvas& canvas, const Point2& center, double north_rad) const {
  const double size = 15 * style_.unit;
  const Point2 ahead{std::sin(north_rad), -std::cos(north_rad)}, side{-ahead.y, ahead.x};
  const Point2 tip = center + ahead * size, tail = center - ahead * (0.55 * size);
  const Point2 notch = center - ahead * (0.25 * size);
  canvas.polygon({tip, tail + side * (0.55 * size), notch}, style_.textInk());
  canvas.outline({tip, tail - side * (0.55 * size), notch}, style_.textInk(), style_.unit, true);
  canvas.text("N", center - ahead * (1.15 * size), style_.small_px, style_.textInk(), Align::center,
              render::Weight::bold);
}

void MapFrame::drawFoot(Canvas& canvas, Units units, const std::string& remark) const {
  const double bottom = frame_.y + frame_.height, right = frame_.x + frame_.width;
  double end = right;
  if (!grid_.wkt.empty()) {
    const MapPlane::Scale scale = plane_.scale();
    drawNorthArrow(canvas, {right - 14 * style_.unit, bottom + 52 * style_.unit}, scale.north_rad);
    end = drawScaleBar(canvas, right - 44 * style_.unit, bottom + 62 * style_.unit, scale.metres_per_metre,
                       units);
  }
  std::string text =
      fmt::format("{}; pixels of {:g} m; latitudes and longitudes of WGS 84", plane_.name(), grid_.cell_m);
  if (!remark.empty()) text += "; " + remark;
  double y = bottom + 46 * style_.unit;
  const double room = end - frame_.x - 24 * style_.unit;
  for (const std::string& line : render::wrappedText(canvas, text, room, style_.small_px)) {
    canvas.text(line, {frame_.x, y}, style_.small_px, style_.mutedInk());
    y += 1.4 * style_.small_px;
  }
}

}  // namespace emscape::study
