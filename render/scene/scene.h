/// A scene as set, and the data that the host derives from it on demand.
#pragma once

#include <memory>
#include <optional>

#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/height_field.h"
#include "emscape/render/scene/render_settings.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/volume/dense_volume.h"
#include "emscape/volume/volume.h"
#include "render/cast/ground.h"
#include "render/cast/raycast.h"
#include "render/cast/transfer_table.h"

namespace emscape::render {

/// Everything except the values of the volume. For one thread.
class Scene {
 public:
  /// Revision counters, one per input. Dependents compare them to find what must be derived again.
  struct Versions {
    unsigned table = 0;   ///< the transfer function's table
    unsigned levels = 0;  ///< the result of skipRule()
    unsigned ground = 0;
    unsigned map = 0;   ///< height and opacity of the map layer
    unsigned view = 0;  ///< the camera, the ground, or its cuts by planes
  };

  void setVolume(const volume::Grid& grid, const volume::VolumeInfo& info);
  /// @throws Error (bad_input) for an impossible field
  void setHeightField(std::shared_ptr<const HeightField> height_field);
  void setTransferFunction(const TransferFunction& function);
  void setCamera(const Camera& camera);
  /// @throws Error (bad_input) for a value out of its range
  void setSettings(const RenderSettings& settings);

  const RenderSettings& settings() const { return settings_; }
  const TransferFunction& transferFunction() const { return function_; }
  const Camera& camera() const { return camera_; }
  /// True if the volume has indices.
  bool categorical() const { return categorical_; }
  /// @throws Error (other) if no volume is set, as all functions below
  const volume::Grid& grid() const;
  double isoValue() const;
  SceneBox box() const;
  /// Whether the ground, a plane or a section hides a position. @param values  of the sections; null: they do
  /// not matter
  bool isHidden(const Vec3d& frame_m, const volume::Volume* values = nullptr);

  /// Prepares missing data. The functions below must be called after it.
  void prepare();
  const Versions& versions() const { return versions_; }
  const TransferTable& table() const { return *table_; }
  SkipRule skipRule() const;
  const std::optional<GroundSurface>& ground() const { return ground_; }
  /// The inputs of a cast, except `volume`, `skip` and `volume_highest_f`, which depend on the values of the
  /// volume and its bricks.
  RaycastTask task(ImageSize size) const;
  /// True if planes cut the volume.
  bool isCut() const;
  /// True if the map layer is painted on the ground.
  bool isMapped() const { return ground_ && settings_.map_height_agl_m; }
  /// True if rays with only transparent samples are transparent.
  bool transparentShowsNothing() const;

 private:
  void dropGround();
  CutView cutView() const;
  bool isBehindSection(const CutView& cut, const Ray& ray, double distance,
                       const volume::Volume& values) const;
  void prepareGround();

  std::optional<volume::Grid> grid_;
  bool categorical_ = false, is_difference_ = false;
  float floor_ = 0;
  std::shared_ptr<const HeightField> height_field_;
  TransferFunction function_;
  Camera camera_;
  RenderSettings settings_;

  // Prepared from the above; empty: to be prepared.
  std::optional<GroundSurface> ground_;
  std::optional<TransferTable> table_;
  Versions versions_;
};

}  // namespace emscape::render
