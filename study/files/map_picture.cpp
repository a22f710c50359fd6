#include "study/files/map_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "emscape/base/parallel.h"
#include "emscape/playback/frames/scene.h"
#include "render/annotate/canvas.h"
#include "render/annotate/overlay_parts.h"
#include "study/files/map_colors.h"

namespace emscape::study {
namespace {

using render::Align;
using render::Canvas;
using render::Ink;
using render::Point2;
using render::Rect;
using render::Rgb;
using render::Weight;

constexpr double kMapOpacity = 0.72;  ///< of the colours over the ground

/// Slope of three posts at distances of cell_m: central if all are known, one-sided at an edge, else NaN.
float slopeOf(float before, float here, float after, float cell_m) {
  if (std::isnan(before)) return (after - here) / cell_m;
  if (std::isnan(after)) return (here - before) / cell_m;
  return (after - before) / (2 * cell_m);
}

/// Lambert's shading, from the north-west at an elevation of 45 degrees. 0..1; 0.7 where the slope is
/// unknown.
std::vector<float> shadesOf(const MapGrid& grid, const std::vector<float>& ground_msl_m) {
  std::vector<float> shades(grid.pixels(), 0.7f);
  if (ground_msl_m.empty()) return shades;
  const auto groundAt = [&](int i, int j) {
    const bool is_inside = i >= 0 && i < grid.width && j >= 0 && j < grid.height;
    return is_inside ? ground_msl_m[static_cast<std::size_t>(j) * grid.width + i] : NAN;
  };
  const auto cell_m = static_cast<float>(grid.cell_m);
  parallelFor(grid.height, 16, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int i = 0; i < grid.width; ++i) {
        const std::size_t p = static_cast<std::size_t>(j) * grid.width + i;
        const float here = ground_msl_m[p];
        const float east = slopeOf(groundAt(i - 1, j), here, groundAt(i + 1, j), cell_m);
        const float south = slopeOf(groundAt(i, j - 1), here, groundAt(i, j + 1), cell_m);
        const float toward = (0.5f * (east + south) + 0.7071f) / std::sqrt(1 + east * east + south * south);
        if (!std::isnan(toward)) shades[p] = std::clamp(0.25f + 0.75f * toward, 0.05f, 1.0f);
      }
    }
  });
  return shades;
}

class MapPicture {
 public:
  MapPicture(const MapGrid& grid, const Map& map, const MapPictureOptions& options)
      : grid_(grid),
        map_(map),
        options_(options),
        legend_(legendOf(map)),
        style_({options.width, options.width * 3 / 4}, render::Theme::light),
        left_(84 * style_.unit),
        top_(96 * style_.unit) {
    if (hasUnknown()) legend_.note += legend_.note.empty() ? "no colour: no value" : ", or no value";
    const double room =
        options.width - left_ - std::max(190 * style_.unit, render::legendWidth(style_, legend_));
    scale_ = room / grid.width;
    const double height = scale_ * grid.height;
    size_ = {options.width, static_cast<int>(std::max({top_ + height + 76 * style_.unit, 420 * style_.unit,
                                                       render::legendHeight(style_, legend_)}))};
  }

  render::Image8 draw() {
    Canvas canvas(size_);
    canvas.rectangle({0, 0, static_cast<double>(size_.width), static_cast<double>(size_.height)},
                     {{1, 1, 1}});
    drawPixels(canvas);
    drawAxes(canvas);
    drawMarkers(canvas);
    render::drawLegend(canvas, style_, legend_);
    drawTitle(canvas);
    canvas.text(options_.subtitle, {left_, 64 * style_.unit}, style_.text_px, style_.mutedInk());
    return canvas.pixels();
  }

 private:
  /// True if a pixel of the area has no value.
  bool hasUnknown() const {
    for (std::size_t p = 0; p < map_.values.size(); ++p)
      if (std::isnan(map_.values[p]) && !std::isnan(grid_.positions[p].latitude_deg)) return true;
    return false;
  }

  /// As large as the picture's width allows.
  void drawTitle(Canvas& canvas) const {
    double size_px = 1.35 * style_.text_px;
    const double room = options_.width - left_ - 16 * style_.unit;
    const double width = canvas.textBox(options_.title, size_px, Weight::bold).width;
    if (width > room) size_px *= room / width;
    canvas.text(options_.title, {left_, 34 * style_.unit}, size_px, style_.textInk(), Align::left,
                Weight::bold);
  }

  void drawPixels(Canvas& canvas) const {
    const std::vector<float> shades = shadesOf(grid_, options_.ground_msl_m);
    canvas.changeRows([&](int y, std::uint32_t* row) {
      const int j = static_cast<int>(std::floor((y + 0.5 - top_) / scale_));
      if (j < 0 || j >= grid_.height) return;
      for (int x = 0; x < size_.width; ++x) {
        const int i = static_cast<int>(std::floor((x + 0.5 - left_) / scale_));
        if (i < 0 || i >= grid_.width) continue;
        row[x] = pixelAt(static_cast<std::size_t>(j) * grid_.width + i, shades);
      }
    });
  }

  std::uint32_t pixelAt(std::size_t p, const std::vector<float>& shades) const {
    const float value = map_.values[p];
    const double shade = 0.25 + 0.7 * static_cast<double>(shades[p]);
    const bool is_left_out = std::isnan(grid_.positions[p].latitude_deg);
    Rgb color{static_cast<float>(shade), static_cast<float>(shade), static_cast<float>(shade)};
    if (is_left_out) color = {1, 1, 1};
    if (const std::optional<Rgb> over_ground = colorOf(map_, legend_, value)) {
      const Rgb over = *over_ground;
      // Multiplied by the shade, so that hills are visible.
      const auto mix = [&](float ground, float colour) {
        return static_cast<float>((1 - kMapOpacity) * static_cast<double>(ground) +
                                  kMapOpacity * static_cast<double>(colour) * (0.45 + 0.6 * shade));
      };
      color = {mix(color.r, over.r), mix(color.g, over.g), mix(color.b, over.b)};
    }
    const auto level = [](float part) {
      return static_cast<std::uint32_t>(std::lround(255 * std::clamp(part, 0.0f, 1.0f)));
    };
    return 0xff000000u | level(color.r) << 16 | level(color.g) << 8 | level(color.b);
  }

  /// Kilometres of the projection.
  void drawAxes(Canvas& canvas) const {
    const double right = left_ + scale_ * grid_.width, bottom = top_ + scale_ * grid_.height;
    canvas.outline({{left_, top_}, {right, top_}, {right, bottom}, {left_, bottom}}, style_.mutedInk(),
                   style_.unit, true);
    const double pixels_per_km = scale_ / grid_.cell_m * 1000;
    const double east_km = grid_.left_m / 1000, north_km = grid_.top_m / 1000;
    const double step = stepOf(render::roundTicks(east_km, east_km + (right - left_) / pixels_per_km, 8));
    for (const double tick : render::roundTicks(east_km, east_km + (right - left_) / pixels_per_km, 8)) {
      const double x = left_ + (tick - east_km) * pixels_per_km;
      canvas.line({x, bottom}, {x, bottom + 6 * style_.unit}, style_.mutedInk(), style_.unit);
      canvas.text(render::tickText(tick, step), {x, bottom + 18 * style_.unit}, style_.small_px,
                  style_.textInk(), Align::center);
    }
    const double south_km = north_km - (bottom - top_) / pixels_per_km;
    const double step_y = stepOf(render::roundTicks(south_km, north_km, 8));
    for (const double tick : render::roundTicks(south_km, north_km, 8)) {
      const double y = top_ + (north_km - tick) * pixels_per_km;
      canvas.line({left_ - 6 * style_.unit, y}, {left_, y}, style_.mutedInk(), style_.unit);
      canvas.text(render::tickText(tick, step_y), {left_ - 10 * style_.unit, y}, style_.small_px,
                  style_.textInk(), Align::right);
    }
    canvas.text(fmt::format("east, north in km of {}; pixels of {} m", grid_.crs, grid_.cell_m),
                {left_, bottom + 48 * style_.unit}, style_.small_px, style_.mutedInk());
  }
  static double stepOf(const std::vector<double>& ticks) {
    return ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
  }

  void drawMarkers(Canvas& canvas) const {
    std::vector<std::pair<Point2, const MapMarker*>> positions;
    std::vector<Rect> taken;  // by markers and labels
    for (const MapMarker& marker : options_.markers) {
      const long long pixel = grid_.pixelAt(marker.latitude_deg, marker.longitude_deg);
      if (pixel < 0) continue;
      const Point2 at{left_ + (static_cast<double>(pixel % grid_.width) + 0.5) * scale_,
                      top_ + (static_cast<double>(pixel / grid_.width) + 0.5) * scale_};
      taken.push_back(
          {at.x - 6.5 * style_.unit, at.y - 6.5 * style_.unit, 13 * style_.unit, 13 * style_.unit});
      positions.push_back({at, &marker});
    }
    for (const auto& [at, marker] : positions) {
      canvas.disc(at, 6.5 * style_.unit, {{0.1f, 0.12f, 0.15f}});
      canvas.disc(at, 4.6 * style_.unit, {render::colorOf(marker->kind)});
    }
    for (const auto& [at, marker] : positions) {
      const Rect box = labelBox(canvas.textBox(marker->label, style_.small_px), at, taken);
      taken.push_back(box);
      canvas.textWithRim(marker->label, {box.x, box.y + box.height / 2}, style_.small_px,
                         {{0.05f, 0.06f, 0.08f}}, {{1, 1, 1}, 0.85});
    }
  }

  /// Position of a marker's label: right of it, else left, above or below, where it is inside the map and
  /// overlaps nothing; else where it overlaps least.
  Rect labelBox(const Rect& text, const Point2& at, const std::vector<Rect>& taken) const {
    const double gap = 10 * style_.unit, width = text.width, height = 1.2 * style_.small_px;
    const Rect candidates[] = {{at.x + gap, at.y - height / 2, width, height},
                               {at.x - gap - width, at.y - height / 2, width, height},
                               {at.x - width / 2, at.y - gap - height, width, height},
                               {at.x - width / 2, at.y + gap, width, height}};
    const Rect map{left_, top_, scale_ * grid_.width, scale_ * grid_.height};
    const auto common = [](const Rect& a, const Rect& b) {
      const double x = std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x);
      const double y = std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y);
      return std::max(x, 0.0) * std::max(y, 0.0);
    };
    const auto hidden = [&](const Rect& box) {
      double area = width * height - common(box, map);
      for (const Rect& other : taken) area += common(box, other);
      return area;
    };
    Rect best = candidates[0];
    double least = hidden(best);
    for (const Rect& candidate : candidates) {
      const double area = hidden(candidate);
      if (area + 1 > least) continue;
      best = candidate;
      least = area;
    }
    return best;
  }

  const MapGrid& grid_;
  const Map& map_;
  const MapPictureOptions& options_;
  render::Legend legend_;
  render::Style style_;
  double left_, top_;  ///< of the map in the picture
  double scale_ = 1;   ///< pixels of the picture in one of the map
  render::ImageSize size_;
};

}  // namespace

std::vector<MapMarker> markersOf(const scenario::Snapshot& snapshot) {
  std::vector<MapMarker> markers;
  for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
    const scenario::EmitterState& state = snapshot.emitters[e];
    const scenario::Emitter& emitter = snapshot.scenario->emitters[e];
    if (!state.active) continue;
    markers.push_back({state.position.latitude_deg, state.position.longitude_deg, emitter.name,
                       playback::markerKindOf(emitter.kind)});
  }
  return markers;
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

render::Image8 drawMap(const MapGrid& grid, const Map& map, const MapPictureOptions& options) {
  return MapPicture(grid, map, options).draw();
}

}  // namespace emscape::study
