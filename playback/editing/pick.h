/// Positions in space under the pixels of a picture.
#pragma once

#include <optional>
#include <vector>

#include "emscape/base/vec.h"
#include "emscape/render/picture/image.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/cut_plane.h"
#include "emscape/render/scene/height_field.h"
#include "emscape/scenario/terrain/terrain.h"
#include "emscape/volume/dense_volume.h"

namespace emscape::playback {

/// A position that a picture shows.
struct PickedPoint {
  enum class On {
    ground,     ///< the ray meets the ground
    section,    ///< before the ground, a cutting plane at a point with a value
    surface,    ///< before the ground, the isosurface
    strongest,  ///< otherwise, the largest value along the ray in the part of the volume that the planes keep
    box         ///< if there is no value: where the ray enters the box
  };
  Vec3d position_m;  ///< frame metres
  On on = On::ground;
};

/// The position under a pixel.
/// @param camera, box  of the picture, with the vertical exaggeration of the box
/// @param x, y     pixel coordinates, may be fractional; (0, 0) is the centre of the first pixel
/// @param volume   shown by the picture; categories have no largest value
/// @param ground   as drawn; null if there is none
/// @param planes   cutting the volume and the ground
/// @param iso_value  of the isosurface; none: there is none
/// @return none if the ray misses the box
std::optional<PickedPoint> pick(const render::Camera& camera, const render::SceneBox& box,
                                render::ImageSize size, double x, double y, const volume::DenseVolume& volume,
                                const render::HeightField* ground,
                                const std::vector<render::CutPlane>& planes = {},
                                std::optional<double> iso_value = std::nullopt);

/// The position of the ground under a pixel; parameters as for pick().
/// @return none if the ray misses the ground
std::optional<Vec3d> pickGround(const render::Camera& camera, const render::SceneBox& box,
                                render::ImageSize size, double x, double y, const render::HeightField& ground,
                                const std::vector<render::CutPlane>& planes = {});
/// The position at a height (frame z, m) under a pixel, within the sides of the box.
/// @return none if there is none in front of the camera
std::optional<Vec3d> pickLevel(const render::Camera& camera, const render::SceneBox& box,
                               render::ImageSize size, double x, double y, double z_m);

/// The position of a receiver above a point of the ground. The drawn ground differs from the terrain by some
/// metres.
/// @param ground_m      frame metres; of PickedPoint::On::ground
/// @param height_agl_m  above the terrain, or above mean sea level without; more if the voxel there is masked
/// @return `ground_m` over missing terrain
Vec3d aboveGround(const Vec3d& ground_m, double height_agl_m, const volume::DenseVolume& volume,
                  const scenario::Terrain* terrain);

}  // namespace emscape::playback
