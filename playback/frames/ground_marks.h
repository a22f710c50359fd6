/// Lines and points on the ground that tell where it is.
#pragma once

#include <vector>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/playback/frames/inputs.h"
#include "emscape/playback/view/view_state.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/scene/height_field.h"
#include "emscape/volume/grid.h"
#include "scenario/map/coast.h"
#include "scenario/map/places.h"

namespace emscape::playback {

/// Puts lines on the ground of a grid: cuts them at the sides of the box, and divides them so that they
/// follow the ground. For one thread; the ground and the scene must live as long as it.
class GroundMarks {
 public:
  /// @param ground  as drawn; null: lines are at the surface of the scene, without one at the bottom of the
  /// box
  GroundMarks(const volume::Grid& grid, const render::HeightField* ground, const LoadedScenario* scene);

  void addGraticule(PositionFormat format);
  /// @param lakes  also the shores of lakes
  void addCoast(const scenario::Coast& coast, bool lakes);
  void addPlaces(const std::vector<scenario::Place>& places);
  /// Rings about the markers of the emitters that are named.
  void addRings(const std::vector<RangeRings>& rings, const std::vector<render::Marker>& markers,
                Units units);

  std::vector<render::GroundLine> lines;
  std::vector<render::GroundPoint> points;

 private:
  Vec3d onGround(double x_m, double y_m) const;
  bool isInside(const Vec3d& at_m) const;
  std::vector<Vec3d> localOf(const std::vector<GeodeticPosition>& positions) const;
  /// @param like  its ink, and the label of its longest part
  void addLine(const std::vector<Vec3d>& line_m, const render::GroundLine& like);
  void addArea(std::vector<Vec3d> ring_m, const render::GroundLine& like);
  /// Adds the end of a leg to a line, after as many points as it needs.
  void addLeg(std::vector<Vec3d>& line_m, const Vec3d& from_m, const Vec3d& to_m) const;

  const volume::Grid grid_;
  const render::HeightField* const ground_;
  const LoadedScenario* const scene_;
  const GeoFrame frame_;
  const Vec3d lower_, upper_;
};

}  // namespace emscape::playback
