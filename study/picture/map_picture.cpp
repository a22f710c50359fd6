#include "study/picture/map_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "emscape/base/parallel.h"
#include "emscape/base/work.h"
#include "emscape/playback/frames/scene.h"
#include "render/annotate/hatching.h"
#include "render/annotate/label_placement.h"
#include "render/annotate/overlay_parts.h"
#include "scenario/map/coast.h"
#include "scenario/terrain/sea.h"
#include "study/maps/contour_lines.h"
#include "study/picture/map_colors.h"
#include "study/picture/map_frame.h"
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
        legend_(legendOf(map, options.units, options.field_unit)),
        style_({options.width, options.width * 3 / 4}, render::Theme::light),
        relief_{grid.width * options.refinement, grid.height * options.refinement,
                grid.cell_m / options.refinement, options.ground_msl_m},
        sea_(options.water.empty()
                 ? scenario::seaByHeights(relief_.width, relief_.height, relief_.ground_msl_m)
                 : options.water) {
    if (map.floor) {
      if (!hasNoValue()) legend_.note.clear();
    } else if (hasNoValue())
      legend_.note += std::string(legend_.note.empty() ? "no colour: " : ", or ") + "no value";
    const double left = 84 * style_.unit, top = 96 * style_.unit;
    const double room =
        options.width - left - std::max(190 * style_.unit, render::legendWidth(style_, legend_));
    constexpr double kTallest = 10;  // widths
    scale_ = std::min(room / grid.width, kTallest * options.width / grid.height);
    rect_ = {left, top, scale_ * grid.width, scale_ * grid.height};
    size_ = {options.width,
             static_cast<int>(std::max({top + rect_.height + MapFrame::footHeight(style_), 420 * style_.unit,
                                        render::legendHeight(style_, legend_)}) +
                              groundClassRows() * groundClassHeight())};
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
    const auto shown = shownMarkers(frame);
    std::vector<Rect> taken;
    drawMarks(canvas, frame, shown, taken);
    const std::size_t nameless = drawMarkers(canvas, shown, taken);
    frame.drawFoot(canvas, options_.units,
                   nameless == 0 ? "" : fmt::format("{} names have no room", nameless));
    render::drawLegend(canvas, style_, legend_);
    drawGroundClasses(canvas);
    drawTitle(canvas);
    canvas.text(options_.subtitle, {rect_.x, 64 * style_.unit}, style_.text_px, style_.mutedInk());
    return canvas.pixels();
  }

 private:
  /// True if a pixel of the area has no value and is not hatched.
  bool hasNoValue() const {
    for (std::size_t p = 0; p < map_.values.size(); ++p)
      if (std::isnan(map_.values[p]) && !isLeftOut(p) && !isUnknown(map_, p)) return true;
    return false;
  }

  bool isLeftOut(std::size_t p) const { return std::isnan(grid_.positions[p].latitude_deg); }

  double groundClassHeight() const { return 24 * style_.unit; }
  double groundClassWidth() const { return 190 * style_.unit; }
  int groundClassColumns() const {
    return std::max(1, static_cast<int>((options_.width - rect_.x) / groundClassWidth()));
  }
  /// Rows of the legend of the ground's classes, with its heading.
  int groundClassRows() const {
    if (options_.ground_classes.empty()) return 0;
    const int count = static_cast<int>(options_.ground_classes.size()), columns = groundClassColumns();
    return 1 + (count + columns - 1) / columns;
  }

  /// A legend at the lower edge.
  void drawGroundClasses(Canvas& canvas) const {
    if (options_.ground_classes.empty()) return;
    const double height = groundClassHeight(), side = 14 * style_.unit;
    double y = size_.height - (groundClassRows() - 0.5) * height - 6 * style_.unit;
    canvas.text("Ground: land cover", {rect_.x, y}, style_.small_px, style_.textInk(), Align::left,
                Weight::bold);
    for (std::size_t n = 0; n < options_.ground_classes.size(); ++n) {
      const int column = static_cast<int>(n) % groundClassColumns();
      if (column == 0) y += height;
      const double x = rect_.x + column * groundClassWidth();
      const render::Category& of = options_.ground_classes[n];
      canvas.rectangle({x, y - side / 2, side, side}, {of.color.value_or(Rgb{}), 1}, 3 * style_.unit);
      const double room = groundClassWidth() - side - 16 * style_.unit;
      canvas.text(render::shortenedText(canvas, of.name, style_.small_px, room),
                  {x + side + 8 * style_.unit, y}, style_.small_px, style_.textInk());
    }
  }

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
      Rgb color;
      bool is_hatched = false;
      for (int x = 0; x < size_.width; ++x) {
        const int i = static_cast<int>(std::floor((x + 0.5 - rect_.x) / square));
        if (i < 0 || i >= relief_.width) continue;
        const std::size_t post = static_cast<std::size_t>(j) * relief_.width + i;
        if (i != last) {
          const std::size_t p = shownAt(i / parts, j / parts);
          color = colorAt(p, post, shades[post]);
          is_hatched = isUnknown(map_, p);
        }
        last = i;
        row[x] = encoded(is_hatched ? hatched(color, x, y) : color);
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

  /// @param post  square of the relief
  Rgb colorAt(std::size_t p, std::size_t post, float shade) const {
    if (isLeftOut(p)) return {1, 1, 1};
    const std::optional<Rgb> of_value = colorOf(map_, legend_, map_.values[p]);
    const std::uint32_t image = options_.drape.empty() ? 0 : options_.drape[post];
    if ((image >> 24) == 0)
      return of_value ? shadedColor(*of_value, shade) : groundColor(shade, sea_[post] != 0);
    const Rgb drawn{static_cast<float>(image & 255U) / 255, static_cast<float>(image >> 8 & 255U) / 255,
                    static_cast<float>(image >> 16 & 255U) / 255};
    return of_value ? drapedColor(*of_value, drawn) : drawn;
  }

  Rgb hatched(const Rgb& color, int x, int y) const {
    const auto part = static_cast<float>(render::kHatchInk.alpha * render::hatchAt(x, y, style_.unit));
    const Rgb& ink = render::kHatchInk.color;
    return {color.r + part * (ink.r - color.r), color.g + part * (ink.g - color.g),
            color.b + part * (ink.b - color.b)};
  }

  static std::uint32_t encoded(const Rgb& color) {
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

  /// Places and range rings, on the map. @param taken  receives the boxes of their names
  void drawMarks(Canvas& canvas, const MapFrame& frame,
                 const std::vector<std::pair<const MapMarker*, Point2>>& shown,
                 std::vector<Rect>& taken) const {
    const double right = rect_.x + rect_.width, bottom = rect_.y + rect_.height;
    const std::vector<Rect> around{{0, 0, static_cast<double>(size_.width), rect_.y},
                                   {0, bottom, static_cast<double>(size_.width), size_.height - bottom},
                                   {0, 0, rect_.x, static_cast<double>(size_.height)},
                                   {right, 0, size_.width - right, static_cast<double>(size_.height)}};
    taken = around;
    std::vector<Point2> symbols;
    for (const auto& [marker, at] : shown) symbols.push_back(at);
    render::drawGroundMarks(
        canvas, style_,
        [&](const Vec3d& at) {
          return std::optional(frame.at(PlanePoint{at.x, at.y}));
        },
        options_.lines, options_.points, symbols, {}, taken);
    taken.erase(taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(around.size()));
  }

  /// The markers on the map, and their points.
  std::vector<std::pair<const MapMarker*, Point2>> shownMarkers(const MapFrame& frame) const {
    std::vector<GeoPoint> positions;
    for (const MapMarker& marker : options_.markers)
      positions.push_back({marker.latitude_deg, marker.longitude_deg});
    const std::vector<Point2> points = frame.at(positions);
    std::vector<std::pair<const MapMarker*, Point2>> shown;
    for (std::size_t m = 0; m < points.size(); ++m) {
      const bool is_inside = points[m].x >= rect_.x && points[m].x <= rect_.x + rect_.width &&
                             points[m].y >= rect_.y && points[m].y <= rect_.y + rect_.height;
      if (is_inside) shown.emplace_back(&options_.markers[m], points[m]);
    }
    return shown;
  }

  /// Symbols, names, and lines between them. @param taken  what names avoid, in the picture
  /// @return the number of names that have no room
  std::size_t drawMarkers(Canvas& canvas, const std::vector<std::pair<const MapMarker*, Point2>>& shown,
                          const std::vector<Rect>& taken) const {
    constexpr double kRadius = 7.5, kGap = 4;
    const double radius = kRadius * style_.unit;
    double reach = 1;  // of the largest symbol, in radii
    for (const auto& [marker, at] : shown)
      reach = std::max(reach, render::symbolSize(symbolOf(*marker)) - 0.2);
    const Point2 corner{rect_.x, rect_.y};
    std::vector<std::string> names;
    std::vector<render::LabelRequest> requests;
    for (const auto& [marker, at] : shown) {
      names.push_back(render::shortenedText(canvas, marker->label, style_.small_px,
                                            std::min(style_.name_px, 0.6 * rect_.width)));
      requests.push_back({at - corner, reach * radius, canvas.textBox(names.back(), style_.small_px).width,
                          1.2 * style_.small_px});
    }
    std::vector<Rect> taken_on_map;
    for (const Rect& rect : taken)
      taken_on_map.push_back({rect.x - corner.x, rect.y - corner.y, rect.width, rect.height});
    const auto places =
        render::placeLabels(requests, {static_cast<int>(rect_.width), static_cast<int>(rect_.height)},
                            kGap * style_.unit, taken_on_map);
    for (std::size_t m = 0; m < shown.size(); ++m) {
      if (!places[m] || !places[m]->needs_line) continue;
      const Point2 &at = shown[m].second, end = render::nearestIn(places[m]->rect, at - corner) + corner;
      canvas.line(at, end, kNameRim, 3 * style_.unit);
      canvas.line(at, end, kNameInk, style_.unit);
    }
    for (const auto& [marker, at] : shown) render::drawMark(canvas, symbolOf(*marker), at, radius);
    for (std::size_t m = 0; m < shown.size(); ++m) {
      if (!places[m]) continue;
      const Rect& name = places[m]->rect;
      canvas.textWithRim(names[m], corner + Point2{name.x, name.y + name.height / 2}, style_.small_px,
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

/// Of a closed shore: the longer side of its box; of a part of a shore infinity.
double extent_m(const scenario::CoastLine& line) {
  const GeodeticPosition &first = line.points.front(), &last = line.points.back();
  if (first.latitude_deg != last.latitude_deg || first.longitude_deg != last.longitude_deg) return INFINITY;
  const auto [south, north] =
      std::minmax_element(line.points.begin(), line.points.end(),
                          [](const auto& a, const auto& b) { return a.latitude_deg < b.latitude_deg; });
  const auto [west, east] =
      std::minmax_element(line.points.begin(), line.points.end(),
                          [](const auto& a, const auto& b) { return a.longitude_deg < b.longitude_deg; });
  constexpr double kDegree_m = 111.2e3;
  return kDegree_m *
         std::max(north->latitude_deg - south->latitude_deg,
                  (east->longitude_deg - west->longitude_deg) * std::cos(degToRad(first.latitude_deg)));
}

}  // namespace

std::vector<MapMarker> markersOf(const scenario::Snapshot& snapshot) {
  const std::vector<scenario::Platform>& platforms = snapshot.scenario->platforms;
  std::vector<MapMarker> markers;
  std::vector<bool> has_emitter(platforms.size());
  const auto add = [&](std::size_t p, const std::string& label, render::MarkerKind kind) {
    if (!snapshot.platforms[p].present) return;
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
    if (!has_emitter[p] && playback::isDrawnWithoutEmitters(*snapshot.scenario, p))
      add(p, platforms[p].name, render::MarkerKind::platform);
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
  const MapPlane plane(squares);
  options.water = scenario::waterOnGrid(
      *coast, squares.width, squares.height,
      [&](const std::vector<GeodeticPosition>& shore) {
        std::vector<GeoPoint> points;
        points.reserve(shore.size());
        for (const GeodeticPosition& position : shore)
          points.push_back({position.latitude_deg, position.longitude_deg});
        std::vector<scenario::GridPlace> places;
        places.reserve(shore.size());
        for (const PlanePoint& at : plane.pointsAt(points))
          places.push_back({(at.east_m - squares.left_m) / squares.cell_m - 0.5,
                            (squares.top_m - at.north_m) / squares.cell_m - 0.5});
        return places;
      },
      [&](int column, int row) {
        const auto [latitude_deg, longitude_deg] =
            squares.positions[static_cast<std::size_t>(row) * squares.width + column];
        return GeodeticPosition{latitude_deg, longitude_deg, 0};
      });
  for (std::size_t p = 0; p < squares.pixels(); ++p)
    if (std::isnan(squares.positions[p].latitude_deg)) options.water[p] = 0;
  constexpr double kSeen_px = 12;  // of a lake, so that it is no sliver
  const double squares_px = 0.75 * options.width / squares.width;
  const int seen = static_cast<int>(std::ceil(kSeen_px / squares_px));
  dropSmallWater(options.water, squares.width, squares.height, seen);
  for (const scenario::CoastLine& line : coast->lines()) {
    if (line.level > 1 && extent_m(line) < seen * squares.cell_m) continue;
    for (const GeodeticPosition& point : line.points)
      options.shores.push_back({point.latitude_deg, point.longitude_deg});
    options.shores.push_back({NAN, NAN});
  }
}

render::Image8 drawMap(const MapGrid& grid, const Map& map, const MapPictureOptions& options) {
  const WorkPart part("drawing the map", 0, 0);
  return MapPicture(grid, map, options).draw();
}

}  // namespace emscape::study
