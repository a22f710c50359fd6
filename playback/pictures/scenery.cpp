#include "playback/pictures/scenery.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/geodesy/position_text.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "playback/frames/ground.h"

namespace emscape::playback {
namespace {

/// With as few digits as give the coordinate, at most four decimals or seconds.
std::string shortCoordinate(double degrees, bool is_latitude, PositionFormat format) {
  static const std::vector<double> kSexagesimal{1, 1.0 / 60, 1.0 / 3600},
      kDecimal{1, 0.1, 0.01, 0.001, 0.0001};
  const std::vector<double>& steps = format == PositionFormat::dms ? kSexagesimal : kDecimal;
  const auto fits = [degrees](double step_deg) {
    return std::abs(degrees / step_deg - std::round(degrees / step_deg)) < 1e-6;
  };
  const auto step = std::find_if(steps.begin(), steps.end(), fits);
  return coordinateText(degrees, is_latitude, format, step == steps.end() ? steps.back() : *step);
}

}  // namespace

bool Scenery::update(const ViewState& view, const LoadedScenario* scene, const volume::Grid& grid) {
  const bool is_other_place =
      !grid_ || *grid_ != grid || (scene == nullptr) != !scene_ ||
      (scene_ &&
       (scene_->terrain != scene->terrain || scene_->scenario->ground.kind != scene->scenario->ground.kind ||
        scene_->scenario->ground.surface_msl_m != scene->scenario->ground.surface_msl_m));
  scene_ = scene != nullptr ? std::optional(*scene) : std::nullopt;
  if (is_other_place) {
    grid_ = grid;
    has_ground_ =
        scene != nullptr && grid.georeferenced && (scene->terrain || drawsSmoothEarth(*scene, grid));
    reads_coast_ = false;
    coast_.reset();
    ground_.reset();
    marked_.reset();
    for (PlacesOfFile& of_file : places_) of_file.is_told_outside = false;
  }
  updateCoast(view);
  const bool is_other_ground = updateGround(view);
  updatePlaces(view.places);
  updateMarks(view);
  return is_other_ground;
}

void Scenery::updateCoast(const ViewState& view) {
  const bool reads =
      grid_->georeferenced && view.coast != Shown::off && (has_ground_ || view.coast == Shown::on);
  if (reads == reads_coast_) return;
  reads_coast_ = reads;
  coast_ = reads ? scenario::Coast::installed(boxOf(*grid_)) : nullptr;
  ground_.reset();
  marked_.reset();
}

bool Scenery::updateGround(const ViewState& view) {
  const bool is_light = view.theme == render::Theme::light;
  const bool draws = has_ground_ && view.show_terrain;
  if (!draws) {
    const bool was_drawn = drawn_ != nullptr;
    drawn_.reset();
    if (was_drawn) marked_.reset();
    return was_drawn;
  }
  const bool is_fine = !view.drape.empty();
  const bool is_other = !ground_ || is_fine != is_fine_;
  if (is_other) {
    Ground ground = groundOf(*scene_, *grid_, coast_.get(), is_fine);
    ground_ = std::move(ground.field);
    is_sea_by_heights_ = ground.is_sea_by_heights;
    is_fine_ = is_fine;
    marked_.reset();
  }
  if (!is_other && drawn_ && drawn_->light == is_light && drape_ == view.drape) return false;
  if (!drawn_) marked_.reset();  // marks lie on the ground that is drawn
  auto drawn = std::make_shared<render::HeightField>(*ground_);
  drawn->light = is_light;
  if (!is_other && drawn_ && drape_ == view.drape) {
    drawn->colors = drawn_->colors;
  } else {
    ground_classes_.clear();
    try {
      if (is_fine)
        ground_classes_ = drape(*drawn, view.drape, scene_ ? scene_->terrain.get() : nullptr, *grid_);
    } catch (const Error& error) {
      fault_ = error;
    }
  }
  drape_ = view.drape;
  drawn_ = std::move(drawn);
  return true;
}

void Scenery::updatePlaces(const std::vector<std::string>& files) {
  if (files == place_files_) return;
  place_files_ = files;
  places_.clear();
  marked_.reset();
  for (const std::string& file : files) {
    try {
      places_.push_back({file, scenario::readPlaces(file)});
    } catch (const Error& error) {
      fault_ = error;
    }
  }
}

void Scenery::updateMarks(const ViewState& view) {
  if (marked_ && marked_->graticule == view.graticule && marked_->positions == view.positions &&
      marked_->coast == view.coast)
    return;
  marked_ = view;
  lines_.clear();
  points_.clear();
  if (!grid_->georeferenced) return;
  const MarkedPlane plane = markedPlane(*grid_, drawn_.get(), scene());
  GroundMarks marks(plane);
  const bool is_smooth = scene_ && !scene_->terrain;
  if (coast_ && (view.coast == Shown::on || !is_sea_by_heights_))
    marks.addCoast(*coast_, view.coast == Shown::on);
  if (view.graticule == Shown::on || (view.graticule == Shown::automatic && is_smooth && drawn_))
    marks.addGraticule(view.positions);
  for (PlacesOfFile& of_file : places_) {
    marks.addPlaces(of_file.places);
    if (std::exchange(of_file.is_told_outside, true)) continue;
    tellPlacesOutside(of_file.file, of_file.places, plane, scene_ ? &scene_->scenario->region : nullptr);
  }
  lines_ = std::move(marks.lines);
  points_ = std::move(marks.points);
}

std::optional<Error> Scenery::takeFault() {
  std::optional<Error> fault = std::move(fault_);
  fault_.reset();
  return fault;
}

void Scenery::annotate(render::Annotations& annotations, const ViewState& view,
                       const std::vector<render::Marker>& markers) const {
  annotations.compass = view.show_compass;
  annotations.scale_bar = view.show_scale_bar;
  annotations.units = view.units;
  annotations.ground_lines = lines_;
  annotations.ground_points = points_;
  annotations.ground_classes = drawn_ ? ground_classes_ : std::vector<render::Category>{};
  annotations.origin_latitude.clear();
  annotations.origin_longitude.clear();
  if (!grid_ || !grid_->georeferenced) return;
  const FrameOrigin& origin = grid_->frame;
  if (view.positions == PositionFormat::mgrs) {
    annotations.origin_latitude = annotations.origin_longitude =
        positionText(origin.latitude_deg, origin.longitude_deg, view.positions);
  } else {
    annotations.origin_latitude = shortCoordinate(origin.latitude_deg, true, view.positions);
    annotations.origin_longitude =
        shortCoordinate(wrapLongitude_deg(origin.longitude_deg), false, view.positions);
  }
  if (view.range_rings.empty()) return;
  GroundMarks rings(markedPlane(*grid_, drawn_.get(), scene()));
  rings.addRings(view.range_rings, ringCenters(markers, origin), view.units);
  std::move(rings.lines.begin(), rings.lines.end(), std::back_inserter(annotations.ground_lines));
}

}  // namespace emscape::playback
