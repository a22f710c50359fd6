#include "emscape/render/annotate/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "emscape/base/parallel.h"
#include "render/annotate/overlay_parts.h"
#include "render/cast/rgba.h"
#include "render/picture/bytes_over.h"

namespace emscape::render {
namespace {

// Lengths at 1200 x 900.
constexpr double kMargin = 26;
constexpr double kTitle = 23;
constexpr double kCompassRadius = 40;
/// Width kept free for the legend; the same for all, so that the scene stays where it is when another
/// quantity is shown. Wider legends reach over the scene.
constexpr double kLegendRoom = 180;
constexpr double kMaxLegendRoom = 0.4;  // of the picture's width
constexpr double kMinUnit = 0.62;
constexpr double kMaxOfSize = 3;       // unit that a scale may cause, in that of the picture's size
constexpr double kNamePart = 1.0 / 3;  // maximum width of a name, of the picture's
constexpr double kMinName = 160;
constexpr double kLabelPart = 0.4;  // maximum width of a label
constexpr double kMinText_px = 12, kMinSmall_px = 11;
constexpr double kThumbnail_px = 360;  // smaller pictures have smaller texts

/// Composites a cast picture over the drawing; the only quantisation of the cast picture.
void drawCast(Canvas& canvas, const Image& cast) {
  canvas.changeRows([&](int y, std::uint32_t* row) {
    const Rgba* pixels = &cast.pixels[static_cast<std::size_t>(y) * cast.size.width];
    for (int x = 0; x < cast.size.width; ++x) {
      const auto part = [drawn = row[x]](int shift) { return static_cast<float>(drawn >> shift & 0xFFU); };
      const Rgba behind = Rgba{part(16), part(8), part(0), part(24)} * (1.0F / 255.0F);
      const Rgba pixel = over(pixels[x], behind);
      row[x] = std::uint32_t{quantized(pixel.a)} << 24 | std::uint32_t{quantized(pixel.r)} << 16 |
               std::uint32_t{quantized(pixel.g)} << 8 | std::uint32_t{quantized(pixel.b)};
    }
  });
}

/// The same for a quantised picture.
void drawCast(Canvas& canvas, const Image8& cast) {
  canvas.changeRows([&](int y, std::uint32_t* row) {
    const std::uint8_t* pixels = &cast.rgba[static_cast<std::size_t>(y) * cast.size.width * 4];
    for (int x = 0; x < cast.size.width; ++x) {
      std::uint32_t rgba = 0;
      std::memcpy(&rgba, pixels + 4 * x, 4);
      row[x] = bytesOver(redAndBlueSwapped(rgba), row[x]);
    }
  });
}

/// A line of the header: a name at the left, shortened where it would reach the time at the right.
void drawHeaderLine(Canvas& canvas, const Style& style, double y, const std::string& name,
                    const std::string& time, double size_px, const Ink& ink, Weight weight) {
  const double left = kMargin * style.unit;
  const double right = canvas.size().width - left;
  const double time_px = time.empty() ? 0 : canvas.textBox(time, size_px, weight).width + size_px;
  canvas.textWithRim(shortenedText(canvas, name, size_px, right - left - time_px, weight), {left, y}, size_px,
                     ink, style.rimInk(), Align::left, weight);
  canvas.textWithRim(time, {right, y}, size_px, ink, style.rimInk(), Align::right, weight);
}

void drawTexts(Canvas& canvas, const Style& style, const Annotations& annotations) {
  const double top = (kMargin + 0.3 * kTitle) * style.unit;
  const double second = top + 1.25 * kTitle * style.unit;
  drawHeaderLine(canvas, style, top, annotations.title, annotations.time, kTitle * style.unit,
                 style.textInk(), Weight::bold);
  drawHeaderLine(canvas, style, second, annotations.subtitle, annotations.time_utc, style.text_px,
                 style.mutedInk(), Weight::normal);
}

/// The line at the bottom. Labels stay off the whole line, as its text changes with the state of the picture.
void drawFooter(Canvas& canvas, const Style& style, const SceneBox& box, const Annotations& annotations,
                std::vector<Rect>& taken) {
  const double bottom = canvas.size().height - 0.7 * kMargin * style.unit;
  const double left = kMargin * style.unit;
  std::string text;
  if (box.vertical_exaggeration != 1) text = fmt::format("heights × {:g}", box.vertical_exaggeration);
  if (!annotations.note.empty()) text += (text.empty() ? "" : "   ·   ") + annotations.note;
  canvas.textWithRim(shortenedText(canvas, text, style.small_px, canvas.size().width - 2 * left),
                     {left, bottom}, style.small_px, style.mutedInk(), style.rimInk());
  const double height = 1.2 * style.small_px;
  taken.push_back({0, bottom - height / 2, static_cast<double>(canvas.size().width), height});
}

void drawBehind(Canvas& canvas, const Style& style, const Projector& projector,
                const Annotations& annotations) {
  canvas.gradient(style.background_top, style.background_bottom);
  if (annotations.axes) drawFarEdges(canvas, style, projector);
}

/// The markers in the columns that are seen.
std::vector<Marker> seenMarkers(const Annotations& annotations, const Projector& projector) {
  std::vector<Marker> seen;
  for (const Marker& marker : annotations.markers) {
    Point2 at;
    const bool is_seen = !projector.project(marker.position_m, at) ||
                         (at.x >= annotations.first_column && at.x < *annotations.end_column);
    if (is_seen) seen.push_back(marker);
  }
  return seen;
}

void drawInFront(Canvas& canvas, const Style& style, const Projector& projector,
                 const Annotations& annotations, const HiddenTest& hidden) {
  std::vector<Rect> taken;
  drawFooter(canvas, style, projector.box, annotations, taken);
  if (annotations.legend) {
    const double width = legendWidth(style, *annotations.legend);
    taken.push_back({canvas.size().width - width, 0, width, static_cast<double>(canvas.size().height)});
  }
  if (!annotations.title.empty() || !annotations.time.empty())
    taken.push_back({0, 0, static_cast<double>(canvas.size().width), headerHeight(style)});
  const double reach = (kMargin + kCompassRadius + 10) * style.unit;
  const Point2 compass{reach, canvas.size().height - reach - 14 * style.unit};
  drawGroundClasses(canvas, style, annotations.ground_classes, compass.y - reach, taken);
  const bool has_compass = annotations.georeferenced && annotations.compass;
  if (has_compass) taken.push_back({compass.x - reach / 2, compass.y - reach / 2, reach, reach});
  if (annotations.axes) drawNearEdges(canvas, style, projector, annotations, taken);
  std::vector<Marker> seen;
  if (annotations.end_column) {  // axes are the same on both sides
    const double first = annotations.first_column, end = *annotations.end_column;
    const double height = canvas.size().height;
    taken.push_back({0, 0, first, height});
    taken.push_back({end, 0, canvas.size().width - end, height});
    seen = seenMarkers(annotations, projector);
  }
  const std::vector<Marker>& markers = annotations.end_column ? seen : annotations.markers;
  if (has_compass) drawCompass(canvas, style, projector.camera, compass, kCompassRadius * style.unit);
  drawPlanes(canvas, style, projector, annotations, taken);
  if (annotations.georeferenced && annotations.scale_bar) {
    const double left = (annotations.compass ? 2 * (kMargin + kCompassRadius) + 20 : kMargin) * style.unit;
    const Point2 at{left, canvas.size().height - (kMargin + 30) * style.unit};
    drawScaleBar(canvas, style, projector, annotations.units, at, taken);
  }
  const auto project = [&](const Vec3d& at_m) {
    Point2 at;
    return projector.project(at_m, at) ? std::optional(at) : std::nullopt;
  };
  std::vector<Point2> symbols;
  for (const Marker& marker : markers) {
    if (const std::optional<Point2> at = project(marker.position_m)) symbols.push_back(*at);
  }
  drawGroundMarks(canvas, style, project, annotations.ground_lines, annotations.ground_points, symbols,
                  hidden, taken);
  if (annotations.legend) drawLegend(canvas, style, *annotations.legend);
  drawTracks(canvas, style, projector, annotations.tracks, hidden);
  drawMarkers(canvas, style, projector, markers, annotations.units, hidden, taken);
  drawTexts(canvas, style, annotations);
}

template <class AnyImage>
Image8 composed(const AnyImage& cast, const Camera& camera, const SceneBox& box,
                const Annotations& annotations, const HiddenTest& hidden) {
  const Style style(cast.size, annotations.theme, annotations.scale);
  const Projector projector{camera, box, cast.size};
  Canvas canvas(cast.size);
  drawBehind(canvas, style, projector, annotations);
  drawCast(canvas, cast);
  drawInFront(canvas, style, projector, annotations, hidden);
  return canvas.pixels();
}

/// Draws the two layers, which are independent of each other.
template <class Draw>
void drawLayer(std::vector<std::uint32_t>& pixels, ImageSize size, const Draw& draw) {
  pixels.assign(static_cast<std::size_t>(size.count()), 0);
  Canvas canvas(size, pixels.data());
  draw(canvas);
}

}  // namespace

Theme parseTheme(const std::string& name) {
  return parseName<Theme>("theme", name);
}

Style::Style(ImageSize size, Theme theme, double scale) {
  const double by_size = std::min(size.width / 1200.0, size.height / 900.0);
  unit = std::max({kMinUnit, by_size, std::min(scale, kMaxOfSize * by_size)});
  const double legible = std::min(1.0, std::min(size.width, size.height) / kThumbnail_px);
  text_px = std::max(text_px * unit, kMinText_px * legible);
  small_px = std::max(small_px * unit, kMinSmall_px * legible);
  name_px = std::max(kNamePart * size.width, kMinName * unit);
  label_px = std::max(kLabelPart * size.width, kMinName * unit);
  if (theme == Theme::dark) {
    background_top = parseColor("#10141b");
    background_bottom = parseColor("#1d242f");
    text = parseColor("#f2f4f7");
    muted = parseColor("#a9b3c0");
    rim = parseColor("#0b0e13");
  } else {
    background_top = parseColor("#fbfcfd");
    background_bottom = parseColor("#e3e8ee");
    text = parseColor("#14181f");
    muted = parseColor("#4d5866");
    rim = parseColor("#fbfcfd");
  }
}

bool Projector::project(const Vec3d& frame_m, Point2& point) const {
  const Projected projected = render::project(camera, size, box.toDrawn(frame_m));
  point = {projected.x + 0.5, projected.y + 0.5};
  return projected.in_front;
}

double headerHeight(const Style& style) {
  return (kMargin + 2.4 * kTitle) * style.unit;
}

FrameMargins overlayMargins(ImageSize size, const Annotations& annotations) {
  const Style style(size, annotations.theme, annotations.scale);
  const double axis_px = annotations.axes ? 52 * style.unit : 0;
  const double side_px = 20 * style.unit + axis_px;
  const bool has_texts = !annotations.title.empty() || !annotations.time.empty();
  FrameMargins margins;
  margins.left = side_px / size.width;
  margins.right = (annotations.legend || annotations.reserves_legend
                       ? std::min(kLegendRoom * style.unit, kMaxLegendRoom * size.width) + 0.3 * axis_px
                       : side_px) /
                  size.width;
  margins.top = (has_texts ? headerHeight(style) : side_px) / size.height;
  margins.bottom = (1.1 * kMargin * style.unit + axis_px) / size.height;
  return margins;
}

void drawLayers(OverlayLayers& layers, ImageSize size, const Camera& camera, const SceneBox& box,
                const Annotations& annotations, const HiddenTest& hidden) {
  const Style style(size, annotations.theme, annotations.scale);
  const Projector projector{camera, box, size};
  layers.size = size;
  parallelFor(2, 1, [&](int begin, int end) {
    for (int layer = begin; layer < end; ++layer) {
      if (layer == 0) {
        drawLayer(layers.behind, size,
                  [&](Canvas& canvas) { drawBehind(canvas, style, projector, annotations); });
      } else {
        drawLayer(layers.front, size,
                  [&](Canvas& canvas) { drawInFront(canvas, style, projector, annotations, hidden); });
      }
    }
  });
}

Image8 compose(const Image& cast, const Camera& camera, const SceneBox& box, const Annotations& annotations,
               const HiddenTest& hidden) {
  return composed(cast, camera, box, annotations, hidden);
}

Image8 compose(const Image8& cast, const Camera& camera, const SceneBox& box, const Annotations& annotations,
               const HiddenTest& hidden) {
  return composed(cast, camera, box, annotations, hidden);
}

void joinParts(const Image8& left, int column, const std::array<std::string, 2>& captions,
               const Annotations& annotations, Image8& picture) {
  const ImageSize size = picture.size;
  for (int y = 0; y < size.height; ++y) {
    const std::size_t begin = 4 * static_cast<std::size_t>(y) * size.width;
    std::memcpy(&picture.rgba[begin], &left.rgba[begin], 4 * static_cast<std::size_t>(column));
  }
  Canvas canvas(size);
  drawCast(canvas, picture);
  const Style style(size, annotations.theme, annotations.scale);
  const double x = column;
  const double bottom = size.height;
  canvas.line({x, 0}, {x, bottom}, style.rimInk(), 4 * style.unit);
  canvas.line({x, 0}, {x, bottom}, style.textInk(), 1.5 * style.unit);
  canvas.disc({x, bottom / 2}, 6 * style.unit, style.textInk());
  const double gap = 12 * style.unit;
  const double y = headerHeight(style) + style.text_px;
  const double legend_px = annotations.legend ? legendWidth(style, *annotations.legend) : 0;
  const double room[] = {x - 2 * gap, size.width - legend_px - x - 2 * gap};
  for (const int part : {0, 1}) {
    const std::string text = shortenedText(canvas, captions[static_cast<std::size_t>(part)], style.text_px,
                                           room[part], Weight::bold);
    canvas.textWithRim(text, {part == 0 ? x - gap : x + gap, y}, style.text_px, style.textInk(),
                       style.rimInk(), part == 0 ? Align::right : Align::left, Weight::bold);
  }
  picture = canvas.pixels();
}

}  // namespace emscape::render
