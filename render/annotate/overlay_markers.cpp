/// Markers of emitters and platforms: positions, beams and labels.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "base/text/display_units.h"
#include "render/annotate/label_placement.h"
#include "render/annotate/marker_places.h"
#include "render/annotate/overlay_parts.h"

namespace emscape::render {
namespace {

// Lengths at 1200 x 900.
constexpr double kRadius = 8;         // of a symbol
constexpr double kSymbolPart = 0.15;  // of the distance between symbols, its maximum radius
constexpr double kMinRadius_px = 4;
constexpr double kBeamLength = 38;
constexpr double kLabelGap = 5, kLabelPadding = 4;
constexpr double kHiddenAlpha = 0.5;

struct PlacedMarker {
  const Marker* marker;
  Point2 projected;  ///< its position
  Point2 at;         ///< of the symbol: beside others of the same position
  double radius;     ///< of the symbol
  double depth;      ///< of the camera
  double alpha;
};

void drawStem(Canvas& canvas, const Style& style, const Projector& p, const PlacedMarker& placed) {
  const Marker& marker = *placed.marker;
  Point2 foot;
  if (!marker.ground_m) return;
  if (!p.project({marker.position_m.x, marker.position_m.y, *marker.ground_m}, foot)) return;
  Point2 top;
  if (!p.project(marker.position_m, top) || length(foot - top) < placed.radius) return;
  canvas.line(top, foot, style.rimInk(0.5 * placed.alpha), 3 * style.unit);
  canvas.line(top, foot, {colorOf(marker.kind, marker.side), 0.9 * placed.alpha}, 1.2 * style.unit);
  canvas.disc(foot, 2.5 * style.unit, {colorOf(marker.kind, marker.side), placed.alpha});
}

/// A short arrow in the direction of the beam. Its length is in pixels, shorter only where the beam points
/// towards the camera or away from it: it is not a range.
void drawBeam(Canvas& canvas, const Style& style, const Projector& p, const PlacedMarker& placed) {
  const Marker& marker = *placed.marker;
  if (!marker.beam || !marker.active) return;
  const double step_m = 1e-3 * p.box.drawnDiagonal_m();
  const auto pixelsAlong = [&](const Vec3d& drawn) {
    const Vec3d frame{drawn.x, drawn.y, drawn.z / p.box.vertical_exaggeration};
    Point2 tip;
    return p.project(marker.position_m + frame * (step_m / length(drawn)), tip) ? tip - placed.projected
                                                                                : Point2{};
  };
  const Point2 along =
      pixelsAlong({marker.beam->x, marker.beam->y, marker.beam->z * p.box.vertical_exaggeration});
  const double across = length(pixelsAlong(p.camera.right));
  const double foreshortening = across > 0 ? length(along) / across : 0;
  if (foreshortening < 0.15) return;
  const double part = placed.radius / (symbolSize(marker) * kRadius);
  const double head = 9 * part;
  const double size = placed.radius + (kBeamLength - kRadius) * part * std::clamp(foreshortening, 0.5, 1.0);
  const Point2 forward = along * (1 / length(along));
  const Point2 side{-forward.y, forward.x};
  const Point2 tip = placed.at + forward * size, neck = tip - forward * head;
  const Ink ink{colorOf(marker.kind, marker.side), 0.95 * placed.alpha};
  canvas.line(placed.at, neck, style.rimInk(0.55 * placed.alpha), 4 * style.unit);
  canvas.line(placed.at, neck, ink, 1.8 * style.unit);
  canvas.polygon({tip, neck + side * (0.45 * head), neck - side * (0.45 * head)}, ink);
}

/// Emitters first, then receivers and platforms.
int rankOf(const Marker& marker) {
  if (marker.kind == MarkerKind::platform) return 3;
  return marker.kind == MarkerKind::receiver ? 2 : 1;
}

/// Lines of a label, with their sizes.
struct LabelText {
  std::string name, detail;
  double width = 0, height = 0;
};

/// The second line of a label.
std::string detailOf(const Marker& marker, Units units) {
  if (!marker.height_m) return marker.detail;
  return marker.detail + (marker.detail.empty() ? "" : ", ") + heightText(*marker.height_m, units) +
         (marker.is_height_above_ground ? " above ground" : " above sea");
}

LabelText textOf(const Canvas& canvas, const Style& style, const Marker& marker, Units units) {
  LabelText text;
  if (marker.label.empty()) return text;
  text.name = shortenedText(canvas, marker.label, style.text_px, style.label_px);
  const Rect name = canvas.textBox(text.name, style.text_px);
  text.width = name.width;
  text.height = name.height;
  if (const std::string detail_text = detailOf(marker, units); !detail_text.empty()) {
    text.detail = shortenedText(canvas, detail_text, style.small_px, style.label_px);
    const Rect detail = canvas.textBox(text.detail, style.small_px);
    text.width = std::max(text.width, detail.width);
    text.height += detail.height;
  }
  text.width += 2 * kLabelPadding * style.unit;
  text.height += kLabelPadding * style.unit;
  return text;
}

void drawLabel(Canvas& canvas, const Style& style, const PlacedMarker& placed, const LabelText& text,
               const LabelPlace& place) {
  const Rect& rect = place.rect;
  const double padding = kLabelPadding * style.unit;
  const double alpha = placed.marker->active ? placed.alpha : 0.6 * placed.alpha;
  if (place.needs_line) {
    const Point2 end = nearestIn(rect, placed.at);
    canvas.line(placed.at, end, style.rimInk(0.6 * placed.alpha), 3 * style.unit);
    canvas.line(placed.at, end, style.mutedInk(0.9 * placed.alpha), style.unit);
  }
  canvas.rectangle(rect, style.rimInk(0.62 * placed.alpha), 3 * style.unit);
  double y = rect.y + padding / 2 + 0.6 * style.text_px;
  canvas.text(text.name, {rect.x + padding, y}, style.text_px, style.textInk(alpha));
  y += 0.6 * (style.text_px + style.small_px);
  if (!text.detail.empty())
    canvas.text(text.detail, {rect.x + padding, y}, style.small_px, style.mutedInk(alpha));
}

void drawLabels(Canvas& canvas, const Style& style, const std::vector<PlacedMarker>& placed, Units units,
                const std::vector<Rect>& taken) {
  std::vector<LabelText> texts;
  std::vector<LabelRequest> requests;
  for (const PlacedMarker& p : placed) {
    const LabelText& text = texts.emplace_back(textOf(canvas, style, *p.marker, units));
    requests.push_back(
        {p.at, p.radius, text.width, text.height, rankOf(*p.marker), p.depth, p.marker->moves});
  }
  const auto places = placeLabels(requests, canvas.size(), kLabelGap * style.unit, taken);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (places[i]) drawLabel(canvas, style, placed[i], texts[i], *places[i]);
  }
}

/// Moves symbols of one position, as those of one platform have, to a row about it.
void standSideBySide(std::vector<PlacedMarker>& placed, const Style& style) {
  const double gap = 2 * style.unit;
  std::map<std::array<double, 3>, std::vector<PlacedMarker*>> rows;
  for (PlacedMarker& p : placed) {
    const Vec3d& position_m = p.marker->position_m;
    rows[{position_m.x, position_m.y, position_m.z}].push_back(&p);
  }
  for (const auto& [position_m, row] : rows) {
    if (row.size() < 2) continue;
    double width = -gap;
    for (const PlacedMarker* p : row) width += 2 * p->radius + gap;
    double x = row.front()->at.x - width / 2;
    for (PlacedMarker* p : row) {
      p->at.x = x + p->radius;
      x += 2 * p->radius + gap;
    }
  }
}

/// Radius of a symbol without a side (pixels): less where there are so many that they would hide the field.
double radiusOf(const std::vector<PlacedMarker>& placed, const Style& style, ImageSize size) {
  constexpr double kMinArea = 0.02;  // of the picture
  const double full = kRadius * style.unit;
  if (placed.empty()) return full;
  Point2 lower{static_cast<double>(size.width), static_cast<double>(size.height)}, upper{0, 0};
  for (const PlacedMarker& p : placed) {
    lower = {std::min(lower.x, std::max(p.at.x, 0.0)), std::min(lower.y, std::max(p.at.y, 0.0))};
    upper = {std::max(upper.x, std::min(p.at.x, size.width * 1.0)),
             std::max(upper.y, std::min(p.at.y, size.height * 1.0))};
  }
  const double area = std::max(std::max(upper.x - lower.x, 0.0) * std::max(upper.y - lower.y, 0.0),
                               kMinArea * static_cast<double>(size.count()));
  const double spacing = std::sqrt(area / static_cast<double>(placed.size()));
  return std::clamp(kSymbolPart * spacing, std::min(kMinRadius_px, full), full);
}

/// The shown markers in front of the camera. @param radius  receives that of a symbol without a side
std::vector<PlacedMarker> placeMarkers(const std::vector<Marker>& markers, const Style& style,
                                       const Projector& projector, const HiddenTest& hidden, double& radius) {
  std::vector<PlacedMarker> placed;
  for (const Marker& marker : markers) {
    Point2 at;
    if (!marker.is_shown || !projector.project(marker.position_m, at)) continue;
    const double depth =
        dot(projector.box.toDrawn(marker.position_m) - projector.camera.eye_m, projector.camera.forward);
    placed.push_back({&marker, at, at, 0, depth, hidden && hidden(marker.position_m) ? kHiddenAlpha : 1.0});
  }
  radius = radiusOf(placed, style, projector.size);
  for (PlacedMarker& p : placed) p.radius = symbolSize(*p.marker) * radius;
  standSideBySide(placed, style);
  return placed;
}

}  // namespace

std::vector<std::optional<MarkerPlace>> markerPlaces(ImageSize size, const Camera& camera,
                                                     const SceneBox& box, const Annotations& annotations) {
  const Style style(size, annotations.theme, annotations.scale);
  std::vector<std::optional<MarkerPlace>> places(annotations.markers.size());
  double radius = 0;
  for (const PlacedMarker& p :
       placeMarkers(annotations.markers, style, Projector{camera, box, size}, HiddenTest(), radius))
    places[static_cast<std::size_t>(p.marker - annotations.markers.data())] = {p.at.x, p.at.y, p.radius};
  return places;
}

void drawMarkers(Canvas& canvas, const Style& style, const Projector& projector,
                 const std::vector<Marker>& markers, Units units, const HiddenTest& hidden,
                 const std::vector<Rect>& taken) {
  double radius = 0;
  const std::vector<PlacedMarker> placed = placeMarkers(markers, style, projector, hidden, radius);
  for (const PlacedMarker& p : placed) drawStem(canvas, style, projector, p);
  for (const PlacedMarker& p : placed) drawBeam(canvas, style, projector, p);
  drawLabels(canvas, style, placed, units, taken);
  for (const PlacedMarker& p : placed) drawMark(canvas, *p.marker, p.at, radius, p.alpha);
}

}  // namespace emscape::render
