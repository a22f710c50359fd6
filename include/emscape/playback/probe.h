/// What is under a point of a picture: where it is, what the volume holds there, and why.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/geo_frame.h"
#include "emscape/emfield/path_budget.h"
#include "emscape/render/camera.h"
#include "emscape/render/cut_plane.h"
#include "emscape/render/height_field.h"
#include "emscape/render/image.h"
#include "emscape/scenario/scenario.h"
#include "emscape/volume/dense_volume.h"

namespace emscape::playback {

/// A position that a picture shows.
struct PickedPoint {
  enum class On {
    ground,     ///< the ray meets the ground
    section,    ///< before that it meets a plane that cuts the volume, where there is a value
    strongest,  ///< neither; the largest value on its way through what the planes leave of the volume
    box         ///< there is no value either: where the ray enters the box
  };
  Vec3d position_m;  ///< frame metres
  On on = On::ground;
};

/// The position under a pixel.
/// @param camera, box  those of the picture; the vertical exaggeration of the box counts
/// @param x, y     pixel, may be fractions; (0, 0) is the centre of the first one
/// @param volume   that the picture shows; of categories no value is the strongest
/// @param ground   as it is drawn; null without one
/// @param planes   that cut the volume, and the ground where they are vertical
/// @return none where the ray passes the box by
std::optional<PickedPoint> pick(const render::Camera& camera, const render::SceneBox& box,
                                render::ImageSize size, double x, double y, const volume::DenseVolume& volume,
                                const render::HeightField* ground,
                                const std::vector<render::CutPlane>& planes = {});

/// The position of the ground under a pixel; parameters as for pick().
/// @return none where the ray passes the ground by
std::optional<Vec3d> pickGround(const render::Camera& camera, const render::SceneBox& box,
                                render::ImageSize size, double x, double y, const render::HeightField& ground,
                                const std::vector<render::CutPlane>& planes = {});
/// The position at a height (frame z, m) under a pixel, within the sides of the box.
/// @return none where there is none before the camera
std::optional<Vec3d> pickLevel(const render::Camera& camera, const render::SceneBox& box,
                               render::ImageSize size, double x, double y, double z_m);

/// A position above a point of the ground, where a receiver would stand: as drawn, the ground differs from
/// the terrain by some metres.
/// @param ground_m      frame metres; of PickedPoint::On::ground
/// @param height_agl_m  above the terrain; more where the voxel at that height is masked
/// @return `ground_m` where the terrain is not known
Vec3d aboveGround(const Vec3d& ground_m, double height_agl_m, const volume::DenseVolume& volume,
                  const scenario::Terrain* terrain);

/// What a volume holds at a position.
struct VolumeSample {
  enum class Kind {
    value,     ///< a value
    at_floor,  ///< no field: not above the volume's floor
    masked,    ///< the voxel is below the ground, or its field is not known
    outside    ///< the position is outside the volume's box
  };
  Kind kind = Kind::outside;
  float value = 0;  ///< of Kind::value and Kind::at_floor
  Dims voxel;       ///< index of the voxel that holds the position; not of Kind::outside
};

/// Trilinear between voxel centres that all hold a field; else the value of the voxel that holds the
/// position, as always for categories.
VolumeSample sampleVolume(const volume::DenseVolume& volume, const Vec3d& position_m);

/// What one emitter contributes at a position.
struct EmitterProbe {
  std::string emitter;
  std::optional<emfield::PathBudget> budget;
  std::string refusal;  ///< why there is no budget: missing terrain, or a position at the emitter
};

struct ProbeReading {
  Vec3d position_m;  ///< frame metres
  VolumeSample sample;
  /// "-63.2 dBW/m2", or why there is no value.
  std::string text;
  // Only of volumes that lie on the earth:
  std::optional<GeodeticPosition> position;
  std::optional<double> height_msl_m;
  std::optional<double> height_agl_m;  ///< none where the ground is not known
  /// One per emitter, as `emscape profile` gives it for the emitter's own model; empty without a scenario.
  std::vector<EmitterProbe> emitters;
};

/// Reads a position at the volume's time. Pure; some milliseconds, by the number of emitters.
/// @param scenario  whose emitters are asked; may be null
/// @param terrain   may be null: heights above ground are then not known, and paths run over a smooth earth
ProbeReading probe(const Vec3d& position_m, const volume::DenseVolume& volume,
                   const std::shared_ptr<const scenario::Scenario>& scenario,
                   const scenario::Terrain* terrain);

}  // namespace emscape::playback
