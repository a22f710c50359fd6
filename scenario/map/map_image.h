/// A picture of the ground, such as a chart or a satellite image, with its position on the earth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::scenario {

/// Name of a drape that is the land cover of the terrain in place of an image.
constexpr const char* kLandCoverDrape = "land-cover";

/// Colours of an image at positions: 0xAABBGGRR, 0 outside of the image.
using MapColors = std::vector<std::uint32_t>;

/// Reads a GeoTIFF or MBTiles of one grey or coloured band, or of red, green, blue and perhaps opacity, 8
/// bits each.
/// @param positions  about evenly distributed; their number determines the resolution at which the image is
/// read. Heights are not used; longitudes are in -180..180
/// @throws Error (bad_input) that names the file and the reason, also for an image without a position on the
/// earth
MapColors readMapColors(const std::string& file, const std::vector<GeodeticPosition>& positions);

/// Colours of the land cover at positions; 0 where no class is known.
/// @throws Error (bad_input) if the terrain has none (null: there is no terrain)
MapColors landCoverColors(const Terrain* terrain, const std::vector<GeodeticPosition>& positions);
/// Those of kLandCoverDrape, or of a file.
MapColors drapeColors(const std::string& name, const Terrain* terrain,
                      const std::vector<GeodeticPosition>& positions);

}  // namespace emscape::scenario
