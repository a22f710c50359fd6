/// Lines and points on the ground that tell where it is.
#pragma once

#include <functional>
#include <string>
#include <utility>
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

/// A rectangle of a plane on which marks are drawn: the frame of a grid, or the projection of a map.
struct MarkedPlane {
  Vec3d lower_m, upper_m;  ///< opposite corners
  scenario::GeoBox box;    ///< that contains it
  /// Points of the plane at positions; NaN without an image.
  std::function<std::vector<Vec3d>(const std::vector<GeodeticPosition>&)> at;
  /// The point on the ground, which may be of a height.
  std::function<Vec3d(double x_m, double y_m)> onGround;
  int parts = 1;  ///< into which a line across the plane is divided so that it follows the ground
};
/// @param ground  as drawn; null: lines are at the surface of the scene, without one at the bottom of the
/// box. Ground and scene must live as long as the plane
MarkedPlane markedPlane(const volume::Grid& grid, const render::HeightField* ground,
                        const LoadedScenario* scene);

/// A centre of range rings.
struct RingCenter {
  std::string name;
  GeodeticPosition position;
};
/// The emitters' positions, by their labels.
std::vector<RingCenter> ringCenters(const std::vector<render::Marker>& markers, const FrameOrigin& frame);

/// Puts lines on a plane: cuts them at its sides, and divides them. For one thread.
class GroundMarks {
 public:
  explicit GroundMarks(MarkedPlane plane) : plane_(std::move(plane)) {}

  void addGraticule(PositionFormat format);
  /// @param lakes  also the shores of lakes
  void addCoast(const scenario::Coast& coast, bool lakes);
  void addPlaces(const std::vector<scenario::Place>& places);
  /// Rings about the centres that are named.
  void addRings(const std::vector<RangeRings>& rings, const std::vector<RingCenter>& centers, Units units);

  std::vector<render::GroundLine> lines;
  std::vector<render::GroundPoint> points;

 private:
  bool isInside(const Vec3d& at_m) const;
  /// @param like  its ink, and the label of its longest part
  void addLine(const std::vector<Vec3d>& line_m, const render::GroundLine& like);
  void addArea(std::vector<Vec3d> ring_m, const render::GroundLine& like);
  /// Adds the end of a leg to a line, after as many points as it needs.
  void addLeg(std::vector<Vec3d>& line_m, const Vec3d& from_m, const Vec3d& to_m) const;

  const MarkedPlane plane_;
};

/// Tells which places of a file are outside of a plane, and not drawn: up to three names, nearest first; a
/// warning if none is drawn, else an information. Nothing if all are drawn, at least in part.
/// @param region  for a likely mistake; null: none is looked for
void tellPlacesOutside(const std::string& file, const std::vector<scenario::Place>& places,
                       const MarkedPlane& plane, const scenario::Region* region);

}  // namespace emscape::playback
