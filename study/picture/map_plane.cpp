#include "study/picture/map_plane.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/units.h"
#include "emscape/render/annotate/legend.h"
#include "scenario/terrain/transformation.h"
#include "study/maps/gdal_support.h"

namespace emscape::study {
namespace {

/// Transforms points one by one; those without an image become NaN.
void transform(const gdal::Transformation& transformation, std::vector<double>& x, std::vector<double>& y) {
  const scenario::GdalMessages messages;
  std::vector<int> done(x.size());
  OCTTransformEx(transformation.get(), static_cast<int>(x.size()), x.data(), y.data(), nullptr, done.data());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (done[i] == 0 || !std::isfinite(x[i]) || !std::isfinite(y[i])) x[i] = y[i] = NAN;
  }
}

/// Of a graticule (deg).
double stepOf(double span_deg, int count) {
  const double raw = span_deg / count;
  if (raw > 5) {
    for (const double step : {10.0, 15.0, 30.0, 45.0})
      if (step >= raw * 0.999) return step;
    return 90;
  }
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw * 0.999) return factor * power;
  return 10 * power;
}

}  // namespace

std::vector<DegreeTick> degreeTicks(double lowest_deg, double highest_deg, int count, bool is_meridian) {
  std::vector<DegreeTick> ticks;
  if (!(highest_deg > lowest_deg)) return ticks;
  const double step = stepOf(highest_deg - lowest_deg, count);
  for (double n = std::ceil(lowest_deg / step - 1e-9); n * step <= highest_deg + 1e-9 * step; ++n) {
    const double degrees = is_meridian ? wrapLongitude_deg(n * step) : n * step;
    const std::string number = render::tickText(std::abs(degrees), step) + "°";
    const bool has_side =
        std::abs(degrees) > step / 2 && !(is_meridian && 180 - std::abs(degrees) < step / 2);
    const char* const side = is_meridian ? (degrees < 0 ? "W" : "E") : (degrees < 0 ? "S" : "N");
    ticks.push_back({n * step, has_side ? number + side : number});
  }
  return ticks;
}

MapPlane::MapPlane(const MapGrid& grid) : grid_(grid) {
  if (!grid.wkt.empty())
    to_plane_ = scenario::transformationBetween(scenario::wgs84Reference(), referenceOf(grid));
}

std::vector<PlanePoint> MapPlane::pointsAt(const std::vector<GeoPoint>& positions) const {
  if (grid_.wkt.empty()) return std::vector<PlanePoint>(positions.size(), PlanePoint{NAN, NAN});
  std::vector<double> x, y;
  for (const GeoPoint& position : positions) {
    x.push_back(position.longitude_deg);
    y.push_back(position.latitude_deg);
  }
  transform(to_plane_, x, y);
  std::vector<PlanePoint> points;
  for (std::size_t i = 0; i < x.size(); ++i) points.push_back({x[i], y[i]});
  return points;
}

std::vector<GeoPoint> MapPlane::positionsAt(const std::vector<PlanePoint>& points) const {
  if (grid_.wkt.empty()) return std::vector<GeoPoint>(points.size(), GeoPoint{NAN, NAN});
  std::vector<double> x, y;
  for (const PlanePoint& point : points) {
    x.push_back(point.east_m);
    y.push_back(point.north_m);
  }
  transform(scenario::transformationBetween(referenceOf(grid_), scenario::wgs84Reference()), x, y);
  std::vector<GeoPoint> positions;
  for (std::size_t i = 0; i < x.size(); ++i) positions.push_back({y[i], x[i]});
  return positions;
}

std::vector<PlanePoint> MapPlane::outline() const {
  constexpr int kPerSide = 32, kAround = 180;
  if (!grid_.area) return {};
  const scenario::GeoBox& box = grid_.area->box;
  if (box.east_deg - box.west_deg >= 360) return {};
  std::vector<GeoPoint> border;
  if (const auto& circle = grid_.area->circle) {
    for (int n = 0; n < kAround; ++n) {
      const GeodeticPosition on = geodesicDirect(circle->latitude_deg, circle->longitude_deg,
                                                 2 * kPi * n / kAround, circle->radius_m);
      border.push_back({on.latitude_deg, on.longitude_deg});
    }
  } else {
    const std::array<GeoPoint, 5> corners{{{box.south_deg, box.west_deg},
                                           {box.south_deg, box.east_deg},
                                           {box.north_deg, box.east_deg},
                                           {box.north_deg, box.west_deg},
                                           {box.south_deg, box.west_deg}}};
    for (std::size_t side = 0; side + 1 < corners.size(); ++side) {
      const GeoPoint &from = corners[side], &to = corners[side + 1];
      for (int n = 0; n < kPerSide; ++n) {
        const double part = static_cast<double>(n) / kPerSide;
        border.push_back({from.latitude_deg + part * (to.latitude_deg - from.latitude_deg),
                          from.longitude_deg + part * (to.longitude_deg - from.longitude_deg)});
      }
    }
  }
  std::vector<PlanePoint> points = pointsAt(border);
  const bool has_all = std::none_of(points.begin(), points.end(),
                                    [](const PlanePoint& point) { return std::isnan(point.east_m); });
  return has_all ? points : std::vector<PlanePoint>();
}

bool MapPlane::isInFrame(const PlanePoint& point) const {
  return point.east_m >= grid_.left_m && point.east_m <= grid_.left_m + grid_.width * grid_.cell_m &&
         point.north_m <= grid_.top_m && point.north_m >= grid_.top_m - grid_.height * grid_.cell_m;
}

std::vector<GraticuleLine> MapPlane::graticule(int count) const {
  constexpr int kPerSide = 24, kPieces = 48;
  std::vector<PlanePoint> border{middle()};
  for (int n = 0; n <= kPerSide; ++n) {
    const double x = static_cast<double>(grid_.width) * n / kPerSide;
    const double y = static_cast<double>(grid_.height) * n / kPerSide;
    for (const PlanePoint& point : {at(x, 0), at(x, grid_.height), at(0, y), at(grid_.width, y)})
      border.push_back(point);
  }
  const std::vector<GeoPoint> positions = positionsAt(border);
  const double middle_deg = positions.front().longitude_deg;
  double south_deg = INFINITY, north_deg = -INFINITY, west_deg = INFINITY, east_deg = -INFINITY;
  for (const GeoPoint& position : positions) {
    if (std::isnan(position.latitude_deg)) return {};
    const double longitude_deg = middle_deg + std::remainder(position.longitude_deg - middle_deg, 360.0);
    south_deg = std::min(south_deg, position.latitude_deg);
    north_deg = std::max(north_deg, position.latitude_deg);
    west_deg = std::min(west_deg, longitude_deg);
    east_deg = std::max(east_deg, longitude_deg);
  }
  const std::vector<PlanePoint> poles = pointsAt({{-90, middle_deg}, {90, middle_deg}});
  if (isInFrame(poles[0])) south_deg = -90;
  if (isInFrame(poles[1])) north_deg = 90;
  if (isInFrame(poles[0]) || isInFrame(poles[1])) {
    west_deg = middle_deg - 179.999;
    east_deg = middle_deg + 180;
  }
  std::vector<GraticuleLine> lines;
  const auto addLines = [&](bool is_meridian, double lowest, double highest, double begin, double end) {
    for (const DegreeTick& tick : degreeTicks(lowest, highest, count, is_meridian)) {
      std::vector<GeoPoint> along;
      for (int n = 0; n <= kPieces; ++n) {
        const double other = begin + (end - begin) * n / kPieces;
        along.push_back(is_meridian ? GeoPoint{other, tick.degrees} : GeoPoint{tick.degrees, other});
      }
      lines.push_back({is_meridian, tick.text, pointsAt(along)});
    }
  };
  addLines(true, west_deg, east_deg, south_deg, north_deg);
  addLines(false, south_deg, north_deg, west_deg, east_deg);
  return lines;
}

MapPlane::Scale MapPlane::scale() const {
  const PlanePoint from = middle();
  const double reach_m = grid_.width * grid_.cell_m / 100;
  const std::vector<GeoPoint> at =
      positionsAt({from, {from.east_m + reach_m, from.north_m}, {from.east_m, from.north_m + reach_m}});
  if (std::any_of(at.begin(), at.end(), [](const GeoPoint& point) { return std::isnan(point.latitude_deg); }))
    return {};
  const auto toward = [&](std::size_t n) {
    return geodesicInverse(at[0].latitude_deg, at[0].longitude_deg, at[n].latitude_deg, at[n].longitude_deg);
  };
  return {toward(1).distance_m / reach_m, -toward(2).azimuth_rad};
}

std::string MapPlane::name() const {
  if (grid_.wkt.empty()) return grid_.crs;
  if (grid_.crs == "local") return "local projection, azimuthal equidistant about the middle";
  const gdal::SpatialReference reference = referenceOf(grid_);
  const char* const words = OSRGetName(reference.get());
  return words == nullptr ? grid_.crs : fmt::format("{} ({})", grid_.crs, words);
}

}  // namespace emscape::study
