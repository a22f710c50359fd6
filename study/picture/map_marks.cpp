#include "study/picture/map_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "emscape/base/error.h"
#include "scenario/map/places.h"
#include "study/picture/map_plane.h"

namespace emscape::study {
namespace {

/// @throws Error (usage)
void checkRings(const MapStudy& study) {
  const std::vector<scenario::Emitter>& emitters = study.scenarios.front()->emitters;
  for (const playback::RangeRings& rings : study.view.range_rings) {
    std::string known;
    bool is_known = false;
    for (const scenario::Emitter& emitter : emitters) {
      known += (known.empty() ? "" : ", ") + ("'" + emitter.name + "'");
      is_known = is_known || emitter.name == rings.emitter;
    }
    if (!is_known)
      throw Error(ErrorCode::usage, fmt::format("range rings: there is no emitter '{}'; the scenario has {}",
                                                rings.emitter, known.empty() ? "none" : known));
  }
}

}  // namespace

playback::MarkedPlane markedPlane(const MapGrid& grid) {
  constexpr int kParts = 96;  // of a line across the map, which may be curved
  const auto plane = std::make_shared<const MapPlane>(grid);
  playback::MarkedPlane marked;
  marked.lower_m = {grid.left_m, grid.top_m - grid.height * grid.cell_m, 0};
  marked.upper_m = {grid.left_m + grid.width * grid.cell_m, grid.top_m, 0};
  if (grid.area) marked.box = grid.area->box;
  marked.at = [plane](const std::vector<GeodeticPosition>& positions) {
    std::vector<GeoPoint> geo_points;
    for (const GeodeticPosition& position : positions)
      geo_points.push_back({position.latitude_deg, position.longitude_deg});
    std::vector<Vec3d> points;
    for (const PlanePoint& point : plane->pointsAt(geo_points))
      points.push_back({point.east_m, point.north_m, 0});
    return points;
  };
  marked.onGround = [](double x_m, double y_m) { return Vec3d{x_m, y_m, 0}; };
  marked.parts = kParts;
  return marked;
}

MapMarks::MapMarks(const MapStudy& study) : study_(study) {
  checkRings(study);
  if (study.view.places.empty()) return;
  const playback::MarkedPlane map = markedPlane(*study.grid);
  playback::GroundMarks marks(map);
  for (const std::string& file : study.view.places) {
    const std::vector<scenario::Place> places = scenario::readPlaces(file);
    playback::tellPlacesOutside(file, places, map, &study.scenarios.front()->region);
    marks.addPlaces(places);
  }
  place_lines_ = std::move(marks.lines);
  place_points_ = std::move(marks.points);
}

void MapMarks::addTo(MapPictureOptions& options, const scenario::Snapshot& snapshot) const {
  options.units = study_.view.units;
  options.field_unit = study_.view.field_unit;
  options.lines = place_lines_;
  options.points = place_points_;
  if (study_.view.range_rings.empty()) return;
  std::vector<playback::RingCenter> centers;
  for (std::size_t e = 0; e < snapshot.emitters.size(); ++e)
    centers.push_back({snapshot.scenario->emitters[e].name, snapshot.emitters[e].position});
  playback::GroundMarks marks(markedPlane(*study_.grid));
  marks.addRings(study_.view.range_rings, centers, options.units);
  options.lines.insert(options.lines.end(), marks.lines.begin(), marks.lines.end());
}

scenario::MapColors drapeOf(const MapGrid& squares, const std::string& name,
                            const scenario::Terrain* terrain) {
  std::vector<GeodeticPosition> positions;
  std::vector<std::size_t> squares_of;
  for (std::size_t p = 0; p < squares.pixels(); ++p) {
    const auto [latitude_deg, longitude_deg] = squares.positions[p];
    if (std::isnan(latitude_deg)) continue;
    positions.push_back({latitude_deg, longitude_deg, 0});
    squares_of.push_back(p);
  }
  const scenario::MapColors read = scenario::drapeColors(name, terrain, positions);
  scenario::MapColors colors(squares.pixels(), 0);
  for (std::size_t n = 0; n < squares_of.size(); ++n) colors[squares_of[n]] = read[n];
  return colors;
}

std::string descriptionOf(const Map& map, Units units) {
  return map.height ? map.subject + " at " + describe(*map.height, units) : map.subject;
}

}  // namespace emscape::study
