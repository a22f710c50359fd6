#include "render/cast/ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "emscape/base/error.h"
#include "emscape/base/parallel.h"

namespace emscape::render {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kMaxPosts = 1 << 28;
/// Thickness of the block below the lower of ground and box, relative to the box's height.
constexpr double kPlinth = 0.025;
/// Hatching lines of a pit across the longer side of the ground.
constexpr float kHatchLines = 90;
constexpr int kGroundGrain = 16;

/// Muted colours, so that the field is prominent: lowland, slopes, heights, summits.
struct TintPoint {
  float at;
  Rgba color;
};
constexpr TintPoint kTints[] = {{0.0F, {0.33F, 0.37F, 0.34F, 1.0F}},
                                {0.35F, {0.44F, 0.45F, 0.38F, 1.0F}},
                                {0.7F, {0.56F, 0.52F, 0.45F, 1.0F}},
                                {1.0F, {0.74F, 0.72F, 0.69F, 1.0F}}};

Rgba tintOf(float relative_height) {
  const TintPoint* above = std::find_if(std::begin(kTints), std::end(kTints),
                                        [&](const TintPoint& p) { return p.at >= relative_height; });
  if (above == std::begin(kTints)) return above->color;
  if (above == std::end(kTints)) return std::prev(above)->color;
  const TintPoint* below = above - 1;
  const float part = (relative_height - below->at) / (above->at - below->at);
  return below->color * (1.0F - part) + above->color * part;
}

/// Light falls from the north-west, as on maps.
float hillShade(float slope_x, float slope_y) {
  const Vec3f light = normalized(Vec3f{-1.0F, 1.0F, 1.3F});
  const float lit = dot(normalized(Vec3f{-slope_x, -slope_y, 1.0F}), light);
  const float relative = std::max(0.0F, lit) / light.z;  // 1 on level ground
  return std::min(1.3F, 0.32F + 0.68F * relative);
}

void check(const HeightField& field) {
  if (field.columns < 2 || field.rows < 2 || !(field.spacing_x_m > 0) || !(field.spacing_y_m > 0)) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format(
            "height field of {} x {} posts, {} x {} m apart: expected at least 2 x 2 and a spacing above 0",
            field.columns, field.rows, field.spacing_x_m, field.spacing_y_m));
  }
  const long long posts = static_cast<long long>(field.columns) * field.rows;
  if (posts != static_cast<long long>(field.heights_m.size())) {
    throw Error(ErrorCode::bad_input, fmt::format("height field of {} x {} posts holds {} heights",
                                                  field.columns, field.rows, field.heights_m.size()));
  }
}

/// Posts of a field, by index, that cover a box along one axis.
struct PostRange {
  int first, count;
};
PostRange cover(double first_m, double spacing_m, double lower_m, double upper_m) {
  const double first = std::floor((lower_m - first_m) / spacing_m);
  const double last = std::max(first + 1, std::ceil((upper_m - first_m) / spacing_m));
  if (std::abs(first) > 1e9 || last - first >= kMaxPosts) {
    throw Error(ErrorCode::bad_input,
                fmt::format("height field with posts {} m apart is too fine for a box of {} m", spacing_m,
                            upper_m - lower_m));
  }
  return {static_cast<int>(first), static_cast<int>(last - first) + 1};
}

/// The post used beyond the edge: that of the edge for one spacing, none further out (-1).
int heldPost(int post, int count) {
  if (post < -1 || post > count) return -1;
  return std::clamp(post, 0, count - 1);
}

}  // namespace

GroundSurface::GroundSurface(const HeightField& field, const volume::Grid& grid, const SceneBox& box) {
  check(field);
  crop(field, grid);
  shade(grid, box);
  buildHierarchy();
}

void GroundSurface::crop(const HeightField& field, const volume::Grid& grid) {
  const Vec3d lower = grid.lower_m();
  const Vec3d upper = grid.upper_m();
  const PostRange x = cover(field.first_x_m, field.spacing_x_m, lower.x, upper.x);
  const PostRange y = cover(field.first_y_m, field.spacing_y_m, lower.y, upper.y);
  if (static_cast<double>(x.count) * y.count > kMaxPosts) {
    throw Error(ErrorCode::bad_input,
                fmt::format("ground of {} x {} posts below the volume: at most {} are drawn", x.count,
                            y.count, kMaxPosts));
  }
  view_.columns = x.count;
  view_.rows = y.count;
  view_.scale_x = grid.spacing_m.x / field.spacing_x_m;
  view_.scale_y = grid.spacing_m.y / field.spacing_y_m;
  view_.first_x = (field.first_x_m + x.first * field.spacing_x_m - grid.first_center_m.x) / grid.spacing_m.x;
  view_.first_y = (field.first_y_m + y.first * field.spacing_y_m - grid.first_center_m.y) / grid.spacing_m.y;
  heights_.resize(static_cast<std::size_t>(x.count) * y.count, kNaN);
  float lowest = std::numeric_limits<float>::infinity();
  float highest = -lowest;
  for (int j = 0; j < y.count; ++j) {
    const int from_row = heldPost(y.first + j, field.rows);
    for (int i = 0; i < x.count; ++i) {
      const int from_column = heldPost(x.first + i, field.columns);
      if (from_row < 0 || from_column < 0) continue;
      const float height_m =
          field.heights_m[static_cast<std::size_t>(from_row) * field.columns + from_column];
      if (!std::isfinite(height_m)) continue;
      const float z = static_cast<float>((height_m - grid.first_center_m.z) / grid.spacing_m.z);
      heights_[static_cast<std::size_t>(j) * x.count + i] = z;
      lowest = std::min(lowest, z);
      highest = std::max(highest, z);
    }
  }
  const double bottom = std::min(-0.5, static_cast<double>(lowest));
  const double base = bottom - kPlinth * grid.dims.z;
  view_.lower = {-0.5, -0.5, base};
  view_.upper = {grid.dims.x - 0.5, grid.dims.y - 0.5, std::max(static_cast<double>(highest), bottom) + 1e-3};
  view_.hatch_period = static_cast<float>(std::max(x.count, y.count)) / kHatchLines;
}

void GroundSurface::shade(const volume::Grid& grid, const SceneBox& box) {
  const int columns = view_.columns;
  const int rows = view_.rows;
  colors_.resize(heights_.size());
  // A post's spacing and a voxel's height, both as drawn.
  const double post_x_m = grid.spacing_m.x / view_.scale_x;
  const double post_y_m = grid.spacing_m.y / view_.scale_y;
  const double voxel_z_m = grid.spacing_m.z * box.vertical_exaggeration;
  float lowest = std::numeric_limits<float>::infinity();
  for (float z : heights_) lowest = z < lowest ? z : lowest;
  const float range = std::max(static_cast<float>(view_.upper.z) - lowest, 1e-6F);
  const auto height = [&](int i, int j) {
    return heights_[static_cast<std::size_t>(std::clamp(j, 0, rows - 1)) * columns +
                    std::clamp(i, 0, columns - 1)];
  };
  const auto slope = [](float before, float after, double spacing) {
    const float rise = after - before;
    return rise == rise ? static_cast<float>(rise / (2 * spacing)) : 0.0F;
  };
  parallelFor(rows, kGroundGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int i = 0; i < columns; ++i) {
        const float slope_x = slope(height(i - 1, j), height(i + 1, j), post_x_m / voxel_z_m);
        const float slope_y = slope(height(i, j - 1), height(i, j + 1), post_y_m / voxel_z_m);
        const float relative = (height(i, j) - lowest) / range;
        Rgba color = tintOf(relative == relative ? relative : 0.0F) * hillShade(slope_x, slope_y);
        color.a = 1.0F;
        colors_[static_cast<std::size_t>(j) * columns + i] = color;
      }
    }
  });
}

void GroundSurface::buildHierarchy() {
  int columns = view_.columns - 1;
  int rows = view_.rows - 1;
  const float pit = static_cast<float>(view_.lower.z) + GroundView::kRounding;
  std::vector<float> cells(static_cast<std::size_t>(columns) * rows);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const float* post = &heights_[static_cast<std::size_t>(j) * view_.columns + i];
      const float sum = post[0] + post[1] + post[view_.columns] + post[view_.columns + 1];
      cells[static_cast<std::size_t>(j) * columns + i] =
          sum == sum ? std::max({post[0], post[1], post[view_.columns], post[view_.columns + 1]}) : pit;
    }
  }
  while (true) {
    view_.level_columns[highest_.size()] = columns;
    highest_.push_back(std::move(cells));
    if ((columns == 1 && rows == 1) || static_cast<int>(highest_.size()) == GroundView::kMaxLevels) break;
    const std::vector<float>& finer = highest_.back();
    const int coarse_columns = (columns + 1) / 2;
    const int coarse_rows = (rows + 1) / 2;
    cells.assign(static_cast<std::size_t>(coarse_columns) * coarse_rows, pit);
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        float& coarse = cells[static_cast<std::size_t>(j / 2) * coarse_columns + i / 2];
        coarse = std::max(coarse, finer[static_cast<std::size_t>(j) * columns + i]);
      }
    }
    columns = coarse_columns;
    rows = coarse_rows;
  }
}

GroundView GroundSurface::view() const {
  GroundView view = view_;
  view.heights = heights_.data();
  view.colors = colors_.data();
  view.levels = static_cast<int>(highest_.size());
  for (int level = 0; level < view.levels; ++level) {
    view.highest[level] = highest_[static_cast<std::size_t>(level)].data();
  }
  return view;
}

}  // namespace emscape::render
