/// A scene as it was set, and what the host derives from it when it is needed.
#pragma once

#include <memory>
#include <optional>

#include "emscape/render/camera.h"
#include "emscape/render/height_field.h"
#include "emscape/render/render_settings.h"
#include "emscape/render/transfer_function.h"
#include "emscape/volume/dense_volume.h"
#include "render/ground.h"
#include "render/raycast.h"
#include "render/transfer_table.h"

namespace emscape::render {

/// Everything but the values of the volume. For use by one thread.
class Scene {
 public:
  /// Revision counters, one per input. Dependents compare them to decide what to derive again.
  struct Versions {
    unsigned table = 0;   ///< the transfer function's table
    unsigned levels = 0;  ///< what skipRule() says
    unsigned ground = 0;
    unsigned view = 0;  ///< the camera, or the ground, or what planes cut off of it
  };

  /// @param floor  value of voxels that hold no field
  void setVolume(const volume::Grid& grid, bool categorical, float floor);
  /// @throws Error (bad_input) for an impossible field
  void setHeightField(std::shared_ptr<const HeightField> height_field);
  void setTransferFunction(const TransferFunction& function);
  void setCamera(const Camera& camera);
  /// @throws Error (bad_input) for a value out of its range
  void setSettings(const RenderSettings& settings);

  const RenderSettings& settings() const { return settings_; }
  const TransferFunction& transferFunction() const { return function_; }
  const Camera& camera() const { return camera_; }
  /// The volume holds indices.
  bool categorical() const { return categorical_; }
  /// @throws Error (other) if no volume is set, as all below
  const volume::Grid& grid() const;
  double isoValue() const;
  SceneBox box() const;
  bool isHidden(const Vec3d& frame_m);

  /// Prepares what is missing; the functions below are for after that.
  void prepare();
  const Versions& versions() const { return versions_; }
  const TransferTable& table() const { return *table_; }
  SkipRule skipRule() const;
  const std::optional<GroundSurface>& ground() const { return ground_; }
  /// To be cast with the values of the volume and its bricks: `volume`, `skip` and `volume_highest_f` are
  /// left open.
  RaycastTask task(ImageSize size) const;
  /// Whether planes cut the volume.
  bool isCut() const;
  /// Whether rays that meet transparent samples alone are transparent.
  bool transparentShowsNothing() const;

 private:
  void dropGround();
  CutView cutView() const;
  void prepareGround();

  std::optional<volume::Grid> grid_;
  bool categorical_ = false;
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
