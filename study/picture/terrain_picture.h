/// Elevation files as a picture.
#pragma once

#include <string>
#include <vector>

#include "emscape/render/picture/image.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::study {

/// What colours the ground.
enum class TerrainContent { sources, land_cover };

/// Distance of the posts (m), the larger of both directions.
double postSpacing_m(const scenario::TerrainFileInfo& file);

/// The shaded ground, coloured by file, with voids and ground without a file.
/// @param content  the sources of the ground, or its land cover
/// @param box    the area
/// @param width  pixels
/// @throws Error (usage) if the area is too large
render::Image8 drawTerrain(const std::vector<scenario::TerrainFileInfo>& files,
                           const scenario::Terrain& terrain, TerrainContent content,
                           const scenario::GeoBox& box, const std::string& title, int width);

}  // namespace emscape::study
