#include "study/picture/map_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "emscape/base/parallel.h"
#include "emscape/playback/frames/scene.h"
#include "render/annotate/overlay_parts.h"
#include "scenario/map/coast.h"
#include "study/maps/contour_lines.h"
#include "study/picture/map_colors.h"
#include "study/picture/map_frame.h"
#include "study/picture/map_labels.h"
#include "study/picture/map_relief.h"

namespace emscape::study {
namespace {

using render::Align;
using render::Canvas;
using render::Ink;
using render::Point2;
using render::Rect;
using render::Rgb;
using render::Weight;

constexpr Ink kCoast{{0.10F, 0.28F, 0.50F}};
constexpr Ink kNameInk{{0.05F, 0.06F, 0.08F}};
constexpr Ink kNameRim{{1, 1, 1}, 0.85};

class MapPicture {
 public:
  MapPicture(const MapGrid& grid, const Map& map, const MapPictureOptions& options)
      : grid_(grid),
        map_(map),
        options_(options),
        legend_(legendOf(map)),
        style_({options.width, options.width * 3 / 4}, render::Theme::light),
        relief_{grid.width * options.refinement, grid.height * options.refinement,
                grid.cell_m / options.refinement, options.ground_msl_m},
        sea_(options.water.empty() ? seaOf(relief_) : options.water) {
    const std::string unknown = hasUnknown() ? "no value" : "";
    if (!unknown.empty()) legend_.note += (legend_.note.empty() ? "no colour: " : ", or ") + unknown;
    const double left = 84 * style_.unit, top = 96 * style_.unit;
    const double room =
        options.width - left - std::max(190 * style_.unit, render::legendWidth(style_, legend_));
    scale_ = room / grid.width;
    rect_ = {left, top, room, scale_ * grid.height};
    size_ = {options.width,
             static_cast<int>(std::max({top + rect_.height + MapFrame::footHeight(style_), 420 * style_.unit,
                                        render::legendHeight(style_, legend_)}))};
  }

  render::Image8 draw() {
    Canvas canvas(size_);
    canvas.rectangle({0, 0, static_cast<double>(size_.width), static_cast<double>(size_.height)},
                     {{1, 1, 1}});
    drawPixels(canvas);
    const MapFrame frame(grid_, rect_, style_);
    drawShore(canvas, frame);
    frame.drawGraticule(canvas);
    frame.drawOutline(canvas);
    const std::size_t nameless = drawMarkers(canvas, frame);
    frame.drawFoot(canvas, nameless == 0 ? "" : fmt::format("{} names have no room", nameless));
    render::drawLegend(canvas, style_, legend_);
    drawTitle(canvas);
    canvas.text(options_.subtitle, {rect_.x, 64 * style_.unit}, style_.text_px, style_.mutedInk());
    return canvas.pixels();
  }

 private:
  /// True if a pixel of the area has no value.
  bool hasUnknown() const {
    for (std::size_t p = 0; p < map_.values.size(); ++p)
      if (std::isnan(map_.values[p]) && !isLeftOut(p)) return true;
    return false;
  }

  bool isLeftOut(std::size_t p) const { return std::isnan(grid_.positions[p].latitude_deg); }

  /// As large as the picture's width allows.
  void drawTitle(Canvas& canvas) const {
    double size_px = 1.35 * style_.text_px;
    const double room = options_.width - rect_.x - 16 * style_.unit;
    const double width = canvas.textBox(options_.title, size_px, Weight::bold).width;
    if (width > room) size_px *= room / width;
    canvas.text(options_.title, {rect_.x, 34 * style_.unit}, size_px, style_.textInk(), Align::left,
                Weight::bold);
  }

  void drawPixels(Canvas& canvas) const {
    const std::vector<float> shades = shadesOf(relief_);
    const int parts = options_.refinement;
    const double square = scale_ / parts;
    canvas.changeRows([&](int y, std::uint32_t* row) {
      const int j = static_cast<int>(std::floor((y + 0.5 - rect_.y) / square));
      if (j < 0 || j >= relief_.height) return;
      int last = -1;
      std::uint32_t color = 0;
      for (int x = 0; x < size_.width; ++x) {
        const int i = static_cast<int>(std::floor((x + 0.5 - rect_.x) / square));
        if (i < 0 || i >= relief_.width) continue;
        const std::size_t post = static_cast<std::size_t>(j) * relief_.width + i;
        if (i != last) color = pixelAt(shownAt(i / parts, j / parts), shades[post], sea_[post] != 0);
        last = i;
        row[x] = color;
      }
    });
  }

  /// The pixel, or one beside it if it is left out: at the area's border, which is drawn exactly (MapFrame),
  /// the colours go on.
  std::size_t shownAt(int i, int j) const {
    const auto index = [&](int x, int y) { return static_cast<std::size_t>(y) * grid_.width + x; };
    const std::size_t here = index(i, j);
    if (!isLeftOut(here)) return here;
    constexpr int kBeside[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    for (const auto& step : kBeside) {
      const int x = i + step[0], y = j + step[1];
      if (x < 0 || x >= grid_.width || y < 0 || y >= grid_.height) continue;
      if (!isLeftOut(index(x, y))) return index(x, y);
    }
    return here;
  }

  std::uint32_t pixelAt(std::size_t p, float shade, bool is_sea) const {
    const std::optional<Rgb> of_value = colorOf(map_, legend_, map_.values[p]);
    const Rgb color = isLeftOut(p) ? Rgb{1, 1, 1}
                      : of_value   ? shadedColor(*of_value, shade)
                                   : groundColor(shade, is_sea);
    const auto level = [](float part) {
      return static_cast<std::uint32_t>(std::lround(255 * std::clamp(part, 0.0F, 1.0F)));
    };
    return 0xff000000U | level(color.r) << 16 | level(color.g) << 8 | level(color.b);
  }

  /// The line between sea and land.
  void drawShore(Canvas& canvas, const MapFrame& frame) const {
    if (!options_.shores.empty())
      frame.drawLine(canvas, frame.at(options_.shores), kCoast, 1.3 * style_.unit);
    if (!options_.water.empty() || std::find(sea_.begin(), sea_.end(), 1) == sea_.end()) return;
    const std::vector<float> levels(sea_.begin(), sea_.end());
    const double square = scale_ / options_.refinement;
    for (const GridLine& line : contourLines(levels, relief_.width, relief_.height, 0.5F)) {
      std::vector<Point2> points;
      for (const GridPoint& point : line)
        points.push_back({rect_.x + (point.x + 0.5) * square, rect_.y + (point.y + 0.5) * square});
      frame.drawLine(canvas, points, kCoast, 1.3 * style_.unit);
    }
  }

  /// @return the number of names that have no room
  std::size_t drawMarkers(Canvas& canvas, const MapFrame& frame) const {
    constexpr double kRadius = 7.5;
    const double radius = kRadius * style_.unit;
    std::vector<GeoPoint> positions;
    for (const MapMarker& marker : options_.markers)
      positions.push_back({marker.latitude_deg, marker.longitude_deg});
    const std::vector<Point2> points = frame.at(positions);
    std::vector<const MapMarker*> shown;
    std::vector<Point2> at;
    std::vector<std::string> names;
    std::vector<Rect> extents;
    for (std::size_t m = 0; m < points.size(); ++m) {
      const bool is_inside = points[m].x >= rect_.x && points[m].x <= rect_.x + rect_.width &&
                             points[m].y >= rect_.y && points[m].y <= rect_.y + rect_.height;
      if (!is_inside) continue;
      shown.push_back(&options_.markers[m]);
      at.push_back(points[m]);
      names.push_back(render::shortenedText(canvas, shown.back()->label, style_.small_px,
                                            std::min(style_.name_px, 0.6 * rect_.width)));
      extents.push_back({0, 0, canvas.textBox(names.back(), style_.small_px).width, 1.2 * style_.small_px});
    }
    double reach = 1;  // of the largest symbol, in radii
    for (const MapMarker* marker : shown)
      reach = std::max(reach, render::symbolSize(symbolOf(*marker)) - 0.2);
    const auto places = placeLabels(at, reach * radius, extents, rect_);
    for (std::size_t m = 0; m < shown.size(); ++m) {
      if (places[m]) drawLeader(canvas, at[m], *places[m], 2 * reach * radius);
    }
    for (std::size_t m = 0; m < shown.size(); ++m)
      render::drawMark(canvas, symbolOf(*shown[m]), at[m], radius);
    for (std::size_t m = 0; m < shown.size(); ++m) {
      if (!places[m]) continue;
      canvas.textWithRim(names[m], {places[m]->x, places[m]->y + places[m]->height / 2}, style_.small_px,
                         kNameInk, kNameRim);
    }
    return static_cast<std::size_t>(std::count(places.begin(), places.end(), std::nullopt));
  }

  static render::Marker symbolOf(const MapMarker& marker) {
    render::Marker symbol;
    symbol.kind = marker.kind;
    symbol.side = marker.side;
    symbol.sidc = marker.sidc;
    return symbol;
  }

  /// From a symbol to a name that is not beside it.
  void drawLeader(Canvas& canvas, const Point2& at, const Rect& name, double beside) const {
    const Point2 end{std::clamp(at.x, name.x, name.x + name.width),
                     std::clamp(at.y, name.y, name.y + name.height)};
    if (length(end - at) <= beside) return;
    canvas.line(at, end, kNameRim, 3 * style_.unit);
    canvas.line(at, end, kNameInk, style_.unit);
  }

  const MapGrid& grid_;
  const Map& map_;
  const MapPictureOptions& options_;
  render::Legend legend_;
  render::Style style_;
  Relief relief_;
  std::vector<std::uint8_t> sea_;  ///< of the relief's squares
  Rect rect_;                      ///< of the map in the picture
  double scale_ = 1;               ///< pixels of the picture in one of the map
  render::ImageSize size_;
};

}  // namespace

std::vector<MapMarker> markersOf(const scenario::Snapshot& snapshot) {
  const std::vector<scenario::Platform>& platforms = snapshot.scenario->platforms;
  std::vector<MapMarker> markers;
  std::vector<bool> has_emitter(platforms.size());
  const auto add = [&](std::size_t p, const std::string& label, render::MarkerKind kind) {
    const GeodeticPosition& position = snapshot.platforms[p].position;
    markers.push_back({position.latitude_deg, position.longitude_deg, label, kind,
                       playback::affiliationOf(platforms[p].side), platforms[p].sidc});
  };
  for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
    const scenario::Emitter& emitter = snapshot.scenario->emitters[e];
    const auto platform = static_cast<std::size_t>(emitter.platform);
    has_emitter[platform] = true;
    if (snapshot.emitters[e].active) add(platform, emitter.name, playback::markerKindOf(emitter.kind));
  }
  for (std::size_t p = 0; p < platforms.size(); ++p) {
    if (!has_emitter[p] && platforms[p].side) add(p, platforms[p].name, render::MarkerKind::platform);
  }
  return markers;
}

int refinementOf(const MapGrid& grid, int picture_width) {
  constexpr double kSquare_px = 2;  // a smaller one is not seen
  return std::clamp(static_cast<int>(picture_width / kSquare_px / std::max(grid.width, grid.height)), 1, 16);
}

std::vector<float> groundOf(const MapGrid& grid, const scenario::Terrain& terrain) {
  std::vector<float> heights(grid.pixels(), NAN);
  parallelFor(static_cast<int>(grid.pixels()), 4096, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      const auto [latitude_deg, longitude_deg] = grid.positions[p];
      if (std::isnan(latitude_deg)) continue;
      heights[p] = static_cast<float>(terrain.heightMsl_m(latitude_deg, longitude_deg));
    }
  });
  return heights;
}

void addCoast(const MapGrid& grid, const MapGrid& squares, MapPictureOptions& options) {
  const auto coast = grid.area ? scenario::Coast::installed(grid.area->box) : nullptr;
  if (coast == nullptr) return;
  options.water.assign(squares.pixels(), 0);
  parallelFor(static_cast<int>(squares.pixels()), 4096, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      const auto [latitude_deg, longitude_deg] = squares.positions[p];
      if (!std::isnan(latitude_deg)) options.water[p] = coast->isWater(latitude_deg, longitude_deg) ? 1 : 0;
    }
  });
  for (const scenario::CoastLine& line : coast->lines()) {
    for (const GeodeticPosition& point : line.points)
      options.shores.push_back({point.latitude_deg, point.longitude_deg});
    options.shores.push_back({NAN, NAN});
  }
}

render::Image8 drawMap(const MapGrid& grid, const Map& map, const MapPictureOptions& options) {
  return MapPicture(grid, map, options).draw();
}

}  // namespace emscape::study
