/// Intersection of rays with the ground: plain data with a hierarchy of largest heights, single source for
/// host and device.
///
/// The ground is a solid block from its heights down to a base plane, inside the volume's box. At an unknown
/// post the block has a hatched pit down to the base. Its sides are drawn plain.
#pragma once

#include <vector>

#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/height_field.h"
#include "emscape/volume/grid.h"
#include "render/cast/rgba.h"

namespace emscape::render {

/// Intersection of a ray with the ground.
struct GroundHit {
  bool found = false;
  bool is_surface = false;  ///< a point of the terrain or smooth earth; else a side, a cut or a pit
  double distance = 0;      ///< along the ray
  Rgba color;
};

/// Positions are in the volume's index space; *post space* counts x and y in posts.
struct GroundView {
  static constexpr int kMaxLevels = 16;
  /// Tolerance of distances (voxels): points within this distance of the surface or the base are on it.
  static constexpr float kRounding = 1e-3F;

  const float* heights = nullptr;  ///< columns * rows posts, index space z; NaN: unknown. Null: no ground
  const Rgba* colors = nullptr;    ///< shaded colour of each post
  const float* highest[kMaxLevels] =
      {};  ///< level 0: largest height of each cell; level n: of 2^n x 2^n cells
  int level_columns[kMaxLevels] = {};
  int levels = 0;
  int columns = 0, rows = 0;
  double scale_x = 1, scale_y = 1;  ///< posts per voxel
  double first_x = 0, first_y = 0;  ///< index space position of post (0, 0)
  Vec3d lower, upper;               ///< of the block, index space; lower.z is the base
  float hatch_period = 8;           ///< posts between the lines of a pit's hatching
  float wall_light = 0.14F,
        wall_rise = 0.16F;  ///< brightness of the sides at the base, and what the top adds

  /// The first point of the block on a ray between two distances.
  EMSCAPE_HD GroundHit firstHit(const Vec3d& origin, const Vec3d& direction, double begin, double end) const;
  /// Colour of the block's inside, visible at a cut. @param z  index space
  EMSCAPE_HD Rgba cutColor(float z) const { return wallColor(z, 1.0F, 0.0F); }

 private:
  struct PostRay;  // the ray in post space from `begin` on
  /// @param hit  its distance is counted from the ray's entry into the block
  EMSCAPE_HD bool hitsCell(const PostRay& ray, int i, int j, float enter, float leave, GroundHit& hit) const;
  EMSCAPE_HD Rgba surfaceColor(int i, int j, float x, float y) const;
  EMSCAPE_HD Rgba wallColor(float z, float x, float y) const;
  EMSCAPE_HD Rgba pitColor(float x, float y) const;
};

/// The ground of a scene, prepared: shaded posts and the hierarchy.
class GroundSurface {
 public:
  /// @throws Error (bad_input) if the field is malformed (sizes, spacing, number of heights)
  GroundSurface(const HeightField& field, const volume::Grid& grid, const SceneBox& box);

  GroundView view() const;
  /// The levels of GroundView::highest.
  const std::vector<float>& level(int level) const { return highest_[static_cast<std::size_t>(level)]; }

 private:
  /// @return for each post that of the field from which it is, or kNoPost
  std::vector<std::size_t> crop(const HeightField& field, const volume::Grid& grid);
  void shade(const HeightField& field, const std::vector<std::size_t>& posts, const volume::Grid& grid,
             const SceneBox& box);
  void buildHierarchy();

  GroundView view_;
  std::vector<float> heights_;
  std::vector<Rgba> colors_;
  std::vector<std::vector<float>> highest_;
};

}  // namespace emscape::render

#include "render/cast/ground_impl.h"
