/// Markers of emitters and platforms: positions, beams and names.
#include <algorithm>
#include <array>
#include <cmath>

#include "emscape/base/units.h"
#include "render/annotate/overlay_parts.h"

namespace emscape::render {
namespace {

constexpr double kRadius = 8;         // of a symbol, at 1200 x 900
constexpr double kBeamLength = 0.14;  // in diagonals of the drawn box
constexpr double kHiddenAlpha = 0.5;

void drawStem(Canvas& canvas, const Style& style, const Projector& p, const Marker& marker, const Point2& at,
              double alpha) {
  if (!marker.ground_m) return;
  Point2 foot;
  if (!p.project({marker.position_m.x, marker.position_m.y, *marker.ground_m}, foot)) return;
  if (length(foot - at) < kRadius * style.unit) return;
  canvas.line(at, foot, style.rimInk(0.5 * alpha), 3 * style.unit);
  canvas.line(at, foot, {colorOf(marker.kind), 0.9 * alpha}, 1.2 * style.unit);
  canvas.disc(foot, 2.5 * style.unit, {colorOf(marker.kind), alpha});
}

void drawBeam(Canvas& canvas, const Style& style, const Projector& p, const Marker& marker, const Point2& at,
              double alpha, std::vector<Rect>& taken) {
  if (!marker.beam || !marker.active) return;
  const double reach_m = kBeamLength * p.box.drawnDiagonal_m();
  const Vec3d drawn{marker.beam->x, marker.beam->y, marker.beam->z * p.box.vertical_exaggeration};
  Point2 tip;
  if (!p.project(marker.position_m + *marker.beam * (reach_m / length(drawn)), tip)) return;
  const Point2 along = tip - at;
  const double size = length(along);
  if (size < 2 * kRadius * style.unit) return;  // towards the camera or away
  const Ink ink{colorOf(marker.kind), 0.95 * alpha};
  const Point2 forward = along * (1 / size);
  const Point2 side{-forward.y, forward.x};
  const double head = 9 * style.unit;
  const Point2 neck = tip - forward * head;
  for (double d = 0; d < size; d += head) {
    const Point2 center = at + forward * d;
    taken.push_back({center.x - head / 2, center.y - head / 2, head, head});
  }
  canvas.line(at, neck, style.rimInk(0.55 * alpha), 4 * style.unit);
  canvas.line(at, neck, ink, 1.8 * style.unit);
  canvas.polygon({tip, neck + side * (0.45 * head), neck - side * (0.45 * head)}, ink);
}

/// Tries positions for a name, best first: beside, above, below, then further out.
Rect placeLabel(const Point2& at, const Rect& extent, double gap, ImageSize size,
                const std::vector<Rect>& taken) {
  Rect best{at.x + gap, at.y - extent.height / 2, extent.width, extent.height};
  for (double reach : {1.0, 2.2, 3.6, 6.0}) {
    const double d = gap * reach;
    const std::array<Point2, 8> corners{{{at.x + d, at.y - extent.height / 2},
                                         {at.x - d - extent.width, at.y - extent.height / 2},
                                         {at.x - extent.width / 2, at.y - d - extent.height},
                                         {at.x - extent.width / 2, at.y + d},
                                         {at.x + 0.7 * d, at.y - 0.7 * d - extent.height},
                                         {at.x - 0.7 * d - extent.width, at.y - 0.7 * d - extent.height},
                                         {at.x + 0.7 * d, at.y + 0.7 * d},
                                         {at.x - 0.7 * d - extent.width, at.y + 0.7 * d}}};
    for (const Point2& corner : corners) {
      const Rect candidate{corner.x, corner.y, extent.width, extent.height};
      const bool inside = candidate.x >= 0 && candidate.y >= 0 &&
                          candidate.x + candidate.width <= size.width &&
                          candidate.y + candidate.height <= size.height;
      const auto hits = [&](const Rect& other) { return overlap(candidate, other); };
      if (inside && std::none_of(taken.begin(), taken.end(), hits)) return candidate;
    }
  }
  return best;
}

struct PlacedMarker {
  const Marker* marker;
  Point2 at;
  double alpha;
};

void drawLabel(Canvas& canvas, const Style& style, const PlacedMarker& placed, std::vector<Rect>& taken) {
  if (placed.marker->label.empty()) return;
  const std::string label = shortenedText(canvas, placed.marker->label, style.text_px, style.name_px);
  Rect extent = canvas.textBox(label, style.text_px);
  const double padding = 4 * style.unit;
  extent.width += 2 * padding;
  extent.height += padding;
  const Rect rect = placeLabel(placed.at, extent, 1.6 * kRadius * style.unit, canvas.size(), taken);
  taken.push_back(rect);
  canvas.rectangle(rect, style.rimInk(0.62 * placed.alpha), 3 * style.unit);
  canvas.text(label, {rect.x + padding, rect.y + rect.height / 2}, style.text_px,
              style.textInk(placed.marker->active ? placed.alpha : 0.6 * placed.alpha));
}

}  // namespace

void drawMarkers(Canvas& canvas, const Style& style, const Projector& projector,
                 const std::vector<Marker>& markers, const HiddenTest& hidden, std::vector<Rect>& taken) {
  std::vector<PlacedMarker> placed;
  for (const Marker& marker : markers) {
    Point2 at;
    if (!projector.project(marker.position_m, at)) continue;
    const double alpha = hidden && hidden(marker.position_m) ? kHiddenAlpha : 1.0;
    placed.push_back({&marker, at, alpha});
    const double reach = 1.3 * kRadius * style.unit;
    taken.push_back({at.x - reach, at.y - reach, 2 * reach, 2 * reach});
  }
  for (const PlacedMarker& p : placed) drawStem(canvas, style, projector, *p.marker, p.at, p.alpha);
  for (const PlacedMarker& p : placed) drawBeam(canvas, style, projector, *p.marker, p.at, p.alpha, taken);
  for (const PlacedMarker& p : placed) {
    drawSymbol(canvas, p.marker->kind, p.marker->active, p.at, kRadius * style.unit, p.alpha);
  }
  for (const PlacedMarker& p : placed) drawLabel(canvas, style, p, taken);
}

}  // namespace emscape::render
