/// A map as a picture: colours over the shaded ground, with legend, axes and emitters.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emscape/base/units.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/picture/image.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/scenario/terrain/land_cover.h"
#include "emscape/study/maps/map.h"
#include "scenario/map/map_image.h"
#include "study/picture/map_plane.h"

namespace emscape::study {

/// An emitter on the map, or a platform with a side and without an emitter.
struct MapMarker {
  double latitude_deg = 0, longitude_deg = 0;
  std::string label;
  render::MarkerKind kind = render::MarkerKind::platform;
  render::Affiliation side = render::Affiliation::none;
  std::string sidc;  ///< as render::Marker::sidc
};

struct MapPictureOptions {
  int width = 1200;  ///< pixels; the height follows from the map
  std::string title, subtitle;
  std::vector<MapMarker> markers;
  int refinement = 1;               ///< squares of the ground along a pixel of the map
  std::vector<float> ground_msl_m;  ///< of these squares, for shading; empty: none
  /// Of a map without ground: the squares of water (1), and the shores, with NaN behind each line; empty:
  /// unknown.
  std::vector<std::uint8_t> water;
  std::vector<GeoPoint> shores;
  scenario::MapColors drape;  ///< colours of the squares, instead of the ground; empty: none
  std::vector<render::Category>
      ground_classes;  ///< names and colours of the drape's, for a legend below the map
  /// Marks in metres of the plane (marksOf()).
  std::vector<render::GroundLine> lines;
  std::vector<render::GroundPoint> points;
  Units units = Units::metric;
  FieldUnit field_unit = FieldUnit::stored;
};

/// The active emitters of an instant, and the platforms that have a side but no emitter.
std::vector<MapMarker> markersOf(const scenario::Snapshot& snapshot);

/// Squares of the ground along a pixel with which a picture of this width has as much relief as it can show.
int refinementOf(const MapGrid& grid, int picture_width);

/// Heights of the ground below the pixels (m); NaN where there is none.
std::vector<float> groundOf(const MapGrid& grid, const scenario::Terrain& terrain);

/// Sets water and shores of the installed coast lines (scenario::Coast), if there are any.
/// @param squares  the grid of the ground's squares
void addCoast(const MapGrid& grid, const MapGrid& squares, MapPictureOptions& options);

render::Image8 drawMap(const MapGrid& grid, const Map& map, const MapPictureOptions& options);

}  // namespace emscape::study
