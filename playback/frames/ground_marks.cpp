#include "playback/frames/ground_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/geodesy/position_text.h"
#include "base/text/display_units.h"
#include "emscape/base/log.h"
#include "emscape/base/units.h"
#include "playback/frames/ground.h"
#include "scenario/file/far_outside.h"

namespace emscape::playback {
namespace {

using render::GroundInk;
using render::GroundLine;

/// Points of a line that crosses the ground, so that it follows hills, or curves.
constexpr int kPointsOnTerrain = 96, kPointsOnSmoothEarth = 20;
constexpr int kLinesAcross = 5;  // about so many lines of a graticule
constexpr int kMaxRings = 12;
constexpr int kRingCorners = 120;

/// The smallest usual step of at least a distance (deg).
double graticuleStep(double least_deg, PositionFormat format) {
  static const std::vector<double> kWhole{1, 2, 5, 10, 15, 30};
  const auto first = [least_deg](const std::vector<double>& steps, double unit_deg) -> std::optional<double> {
    for (const double step : steps) {
      if (step * unit_deg >= least_deg) return step * unit_deg;
    }
    return std::nullopt;
  };
  if (format == PositionFormat::dms) {
    for (const double unit_deg : {1.0 / 3600, 1.0 / 60}) {
      if (const auto step = first(kWhole, unit_deg)) return *step;
    }
  } else {
    for (const double unit_deg : {0.0001, 0.001, 0.01, 0.1}) {
      if (const auto step = first({1, 2, 5}, unit_deg)) return *step;
    }
  }
  return first(kWhole, 1).value_or(30);
}

/// Clips a leg to a rectangle. @return false if nothing is left
bool clip(const Vec3d& lower, const Vec3d& upper, Vec3d& from, Vec3d& to) {
  double begin = 0, end = 1;
  const Vec3d leg = to - from;
  const auto cut = [&](double at, double along, double least, double most) {
    if (along == 0) return at >= least && at <= most;
    const double a = (least - at) / along, b = (most - at) / along;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
    return begin <= end;
  };
  if (!cut(from.x, leg.x, lower.x, upper.x) || !cut(from.y, leg.y, lower.y, upper.y)) return false;
  to = from + leg * end;
  from = from + leg * begin;
  return true;
}

/// The part of a polygon on one side of a line parallel to an axis.
template <class Coordinate>
std::vector<Vec3d> cutPolygon(const std::vector<Vec3d>& ring, Coordinate coordinate, double at,
                              bool keeps_above) {
  std::vector<Vec3d> kept;
  const auto isKept = [&](const Vec3d& p) { return (coordinate(p) >= at) == keeps_above; };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if (isKept(a)) kept.push_back(a);
    if (isKept(a) != isKept(b))
      kept.push_back(a + (b - a) * ((at - coordinate(a)) / (coordinate(b) - coordinate(a))));
  }
  return kept;
}

}  // namespace

MarkedPlane markedPlane(const volume::Grid& grid, const render::HeightField* ground,
                        const LoadedScenario* scene) {
  const GeoFrame frame(grid.frame);
  const Vec3d lower_m = grid.lower_m();
  const bool is_smooth = scene == nullptr || !scene->terrain;
  return {lower_m,
          grid.upper_m(),
          boxOf(grid),
          [frame](const std::vector<GeodeticPosition>& positions) {
            std::vector<Vec3d> local;
            local.reserve(positions.size());
            for (const GeodeticPosition& position : positions) local.push_back(frame.toLocal(position));
            return local;
          },
          [=](double x_m, double y_m) -> Vec3d {
            if (ground != nullptr) return {x_m, y_m, heightAt_m(*ground, x_m, y_m)};
            const double z_m = scene != nullptr ? groundHeight(*scene, frame, x_m, y_m).z_m : lower_m.z;
            return {x_m, y_m, std::max(z_m, lower_m.z)};
          },
          is_smooth ? kPointsOnSmoothEarth : kPointsOnTerrain};
}

std::vector<RingCenter> ringCenters(const std::vector<render::Marker>& markers, const FrameOrigin& frame) {
  const GeoFrame geo_frame(frame);
  std::vector<RingCenter> centers;
  for (const render::Marker& marker : markers)
    if (marker.is_shown) centers.push_back({marker.label, geo_frame.toGeodetic(marker.position_m)});
  return centers;
}

bool GroundMarks::isInside(const Vec3d& at_m) const {
  return at_m.x >= plane_.lower_m.x && at_m.x <= plane_.upper_m.x && at_m.y >= plane_.lower_m.y &&
         at_m.y <= plane_.upper_m.y;
}

void GroundMarks::addLeg(std::vector<Vec3d>& line_m, const Vec3d& from_m, const Vec3d& to_m) const {
  const Vec3d size_m = plane_.upper_m - plane_.lower_m;
  const double longest_m = std::max(size_m.x, size_m.y) / plane_.parts;
  const int parts =
      std::max(1, static_cast<int>(std::ceil(std::hypot(to_m.x - from_m.x, to_m.y - from_m.y) / longest_m)));
  for (int part = line_m.empty() ? 0 : 1; part <= parts; ++part) {
    const Vec3d at = from_m + (to_m - from_m) * (static_cast<double>(part) / parts);
    line_m.push_back(plane_.onGround(at.x, at.y));
  }
}

void GroundMarks::addLine(const std::vector<Vec3d>& line_m, const GroundLine& like) {
  const std::size_t first = lines.size();
  GroundLine line{like.ink, {}, ""};
  const auto flush = [&] {
    if (line.points_m.size() > 1) lines.push_back(line);
    line.points_m.clear();
  };
  for (std::size_t i = 0; i + 1 < line_m.size(); ++i) {
    Vec3d from = line_m[i], to = line_m[i + 1];
    if (std::isnan(from.x + to.x) || !clip(plane_.lower_m, plane_.upper_m, from, to)) {
      flush();
      continue;
    }
    if (!isInside(line_m[i])) flush();
    addLeg(line.points_m, from, to);
    if (!isInside(line_m[i + 1])) flush();
  }
  flush();
  const auto hasFewerPoints = [](const GroundLine& a, const GroundLine& b) {
    return a.points_m.size() < b.points_m.size();
  };
  const auto longest =
      std::max_element(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.end(), hasFewerPoints);
  if (longest != lines.end()) longest->label = like.label;
}

void GroundMarks::addArea(std::vector<Vec3d> ring_m, const GroundLine& like) {
  const auto east = [](const Vec3d& p) { return p.x; };
  const auto north = [](const Vec3d& p) { return p.y; };
  const auto hasNoImage = [](const Vec3d& p) { return std::isnan(p.x); };
  if (std::any_of(ring_m.begin(), ring_m.end(), hasNoImage)) return;
  ring_m = cutPolygon(ring_m, east, plane_.lower_m.x, true);
  ring_m = cutPolygon(ring_m, east, plane_.upper_m.x, false);
  ring_m = cutPolygon(ring_m, north, plane_.lower_m.y, true);
  ring_m = cutPolygon(ring_m, north, plane_.upper_m.y, false);
  if (ring_m.size() < 3) return;
  GroundLine area = like;
  area.is_area = true;
  for (std::size_t i = 0; i < ring_m.size(); ++i)
    addLeg(area.points_m, ring_m[i], ring_m[(i + 1) % ring_m.size()]);
  lines.push_back(std::move(area));
}

void GroundMarks::addGraticule(PositionFormat format) {
  const scenario::GeoBox& box = plane_.box;
  const double lat_step_deg = graticuleStep((box.north_deg - box.south_deg) / kLinesAcross, format);
  const double lon_step_deg = graticuleStep((box.east_deg - box.west_deg) / kLinesAcross, format);
  const auto addLines = [&](bool is_latitude, double first_deg, double last_deg, double step_deg,
                            double begin_deg, double end_deg) {
    for (double n = std::ceil(first_deg / step_deg); n * step_deg <= last_deg; ++n) {
      std::vector<GeodeticPosition> line;
      constexpr int kParts = 20;
      for (int i = 0; i <= kParts; ++i) {
        const double along_deg = begin_deg + (end_deg - begin_deg) * i / kParts;
        line.push_back(is_latitude ? GeodeticPosition{n * step_deg, along_deg, 0}
                                   : GeodeticPosition{along_deg, n * step_deg, 0});
      }
      const double shown_deg = is_latitude ? n * step_deg : wrapLongitude_deg(n * step_deg);
      addLine(plane_.at(line),
              {GroundInk::graticule,
               {},
               coordinateText(shown_deg, is_latitude, format, is_latitude ? lat_step_deg : lon_step_deg)});
    }
  };
  addLines(true, box.south_deg, box.north_deg, lat_step_deg, box.west_deg, box.east_deg);
  addLines(false, box.west_deg, box.east_deg, lon_step_deg, box.south_deg, box.north_deg);
}

void GroundMarks::addCoast(const scenario::Coast& coast, bool lakes) {
  for (const scenario::CoastLine& line : coast.lines()) {
    if (line.level == 1 || lakes) addLine(plane_.at(line.points), {GroundInk::coast, {}, ""});
  }
}

void GroundMarks::addPlaces(const std::vector<scenario::Place>& places) {
  for (const scenario::Place& place : places) {
    const GroundLine like{GroundInk::place, {}, place.name};
    bool is_first = true;
    for (const std::vector<GeodeticPosition>& part : place.parts) {
      const std::vector<Vec3d> at = plane_.at(part);
      if (place.kind == scenario::Place::Kind::line) addLine(at, like);
      if (place.kind == scenario::Place::Kind::area && is_first) addArea(at, like);
      if (place.kind == scenario::Place::Kind::area && !is_first) addLine(at, {GroundInk::place, {}, ""});
      is_first = false;
      if (place.kind != scenario::Place::Kind::point) continue;
      for (const Vec3d& point : at) {
        const Vec3d ground = plane_.onGround(point.x, point.y);
        if (isInside(point) && !std::isnan(ground.z)) points.push_back({ground, place.name});
      }
    }
  }
}

void GroundMarks::addRings(const std::vector<RangeRings>& rings, const std::vector<RingCenter>& centers,
                           Units units) {
  for (const RangeRings& ring : rings) {
    const auto found = std::find_if(centers.begin(), centers.end(),
                                    [&](const RingCenter& of) { return of.name == ring.emitter; });
    if (found == centers.end()) continue;
    const GeodeticPosition& center = found->position;
    const Vec3d at = plane_.at({center}).front();
    const double farthest_m = std::hypot(std::max(plane_.upper_m.x - at.x, at.x - plane_.lower_m.x),
                                         std::max(plane_.upper_m.y - at.y, at.y - plane_.lower_m.y));
    if (std::isnan(farthest_m)) continue;
    const int most =
        std::min(static_cast<int>(farthest_m / ring.spacing_m), ring.count > 0 ? ring.count : kMaxRings);
    for (int n = 1; n <= most; ++n) {
      std::vector<GeodeticPosition> circle;
      for (int corner = 0; corner <= kRingCorners; ++corner) {
        circle.push_back(geodesicDirect(center.latitude_deg, center.longitude_deg,
                                        2 * kPi * corner / kRingCorners, n * ring.spacing_m));
      }
      addLine(plane_.at(circle), {GroundInk::ring, {}, roundDistanceText(n * ring.spacing_m, units)});
    }
  }
}

void tellPlacesOutside(const std::string& file, const std::vector<scenario::Place>& places,
                       const MarkedPlane& plane, const scenario::Region* region) {
  constexpr std::size_t kMaxNamed = 3;
  std::string mistake;
  std::vector<std::pair<double, const scenario::Place*>> outside;  // with the distance (m) from the plane
  for (const scenario::Place& place : places) {
    Vec3d lowest{HUGE_VAL, HUGE_VAL, 0}, highest{-HUGE_VAL, -HUGE_VAL, 0};
    for (const std::vector<GeodeticPosition>& part : place.parts) {
      for (const Vec3d& at : plane.at(part)) {
        lowest = {std::min(lowest.x, at.x), std::min(lowest.y, at.y), 0};
        highest = {std::max(highest.x, at.x), std::max(highest.y, at.y), 0};
      }
    }
    const double distance_m =
        std::hypot(std::max({0.0, plane.lower_m.x - highest.x, lowest.x - plane.upper_m.x}),
                   std::max({0.0, plane.lower_m.y - highest.y, lowest.y - plane.upper_m.y}));
    if (distance_m > 0) outside.emplace_back(distance_m, &place);
  }
  if (outside.empty()) return;
  std::sort(outside.begin(), outside.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  if (outside.size() == places.size()) {
    for (const scenario::Place& place : places) {
      for (const std::vector<GeodeticPosition>& part : place.parts) {
        for (const GeodeticPosition& position : part) {
          if (mistake.empty() && region != nullptr)
            mistake = scenario::mistakenPlaceText(*region, position.latitude_deg, position.longitude_deg);
        }
      }
    }
    logWarning(fmt::format("{}: none of its places is in the area, so that none is drawn{}", file,
                           mistake.empty() ? "" : "; " + mistake));
    return;
  }
  std::string names;
  for (std::size_t n = 0; n < std::min(outside.size(), kMaxNamed); ++n) {
    const auto& [distance_m, place] = outside[n];
    names += n == 0 ? "" : "; ";
    names += place->name.empty() ? "one without a name" : "'" + place->name + "'";
    if (std::isfinite(distance_m)) names += ", " + distanceText(distance_m, Units::metric) + " away";
  }
  logInfo(fmt::format("{}: {} of {} places {} outside of the area, and not drawn: {}{}", file, outside.size(),
                      places.size(), outside.size() == 1 ? "is" : "are", names,
                      outside.size() > kMaxNamed ? "; ..." : ""));
}

}  // namespace emscape::playback
