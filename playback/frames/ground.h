/// The ground of a scene: heights, sea and land, and the picture on it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/playback/frames/inputs.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/render/scene/height_field.h"
#include "emscape/scenario/terrain/land_cover.h"
#include "emscape/volume/grid.h"
#include "scenario/map/coast.h"

namespace emscape::playback {

/// Height of the surface of a scene at a position of the frame: the terrain (NaN over a hole), else the
/// smooth earth.
struct GroundHeight {
  double z_m = 0;    ///< in the frame
  double msl_m = 0;  ///< above mean sea level
};
GroundHeight groundHeight(const LoadedScenario& scene, const GeoFrame& frame, double x_m, double y_m);

/// Latitudes and longitudes that a grid covers.
scenario::GeoBox boxOf(const volume::Grid& grid);

struct Ground {
  std::shared_ptr<render::HeightField> field;
  bool is_sea_by_heights = false;  ///< terrain that is a sea by its heights
};

/// The ground of a scene below a grid, with heights and kinds.
///
/// Terrain is water where it is flat at sea level over at least about thirty posts, and, if there are coasts,
/// some of them are water by these. Where no terrain is such a sea, posts below 2 m that are water by the
/// coasts are water. The smooth earth is water by the coasts; without them everywhere or nowhere, as the
/// scenario's ground.
/// @param coast  null: none
/// @param fine   as many posts as possible, for a picture on the ground
Ground groundOf(const LoadedScenario& scene, const volume::Grid& grid, const scenario::Coast* coast,
                bool fine);

/// True if the surface of a scene without terrain is drawn: it is not far below the volume.
bool drawsSmoothEarth(const LoadedScenario& scene, const volume::Grid& grid);

/// The classes of land cover at positions, the most frequent first.
std::vector<render::Category> groundClassesOf(const scenario::LandCover& cover,
                                              const std::vector<GeodeticPosition>& positions);

/// Lays a picture on the ground. @throws Error (bad_input) as scenario::drapeColors()
/// @param terrain  null: none
/// @return the classes on it, of land cover
std::vector<render::Category> drape(render::HeightField& ground, const std::string& name,
                                    const scenario::Terrain* terrain, const volume::Grid& grid);

}  // namespace emscape::playback
