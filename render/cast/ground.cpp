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
struct Palette {
  TintPoint land[4];
  Rgba water, shore;
  float wall_light, wall_rise;
  float relief;  ///< part of the hill shade
};
constexpr Palette kDark{{{0.0F, {0.29F, 0.35F, 0.28F, 1.0F}},
                         {0.3F, {0.40F, 0.42F, 0.32F, 1.0F}},
                         {0.65F, {0.52F, 0.47F, 0.39F, 1.0F}},
                         {1.0F, {0.74F, 0.72F, 0.69F, 1.0F}}},
                        {0.12F, 0.20F, 0.30F, 1.0F},
                        {0.27F, 0.42F, 0.53F, 1.0F},
                        0.14F,
                        0.16F,
                        1.0F};
constexpr Palette kLight{{{0.0F, {0.70F, 0.77F, 0.66F, 1.0F}},
                          {0.3F, {0.80F, 0.81F, 0.68F, 1.0F}},
                          {0.65F, {0.84F, 0.78F, 0.68F, 1.0F}},
                          {1.0F, {0.95F, 0.94F, 0.92F, 1.0F}}},
                         {0.66F, 0.78F, 0.87F, 1.0F},
                         {0.47F, 0.64F, 0.77F, 1.0F},
                         0.52F,
                         0.16F,
                         0.65F};
/// Range of heights that has all tints at least: hills of a plain are no mountains.
constexpr double kMinTintRange_m = 250;

Rgba mixed(const Rgba& a, const Rgba& b, float part) {
  return a * (1.0F - part) + b * part;
}

Rgba tintOf(const Palette& palette, float relative_height) {
  const TintPoint* const begin = std::begin(palette.land);
  const TintPoint* const end = std::end(palette.land);
  const TintPoint* above =
      std::find_if(begin, end, [&](const TintPoint& p) { return p.at >= relative_height; });
  if (above == begin) return above->color;
  if (above == end) return std::prev(above)->color;
  const TintPoint* below = above - 1;
  return mixed(below->color, above->color, (relative_height - below->at) / (above->at - below->at));
}

/// Light falls from the north-west, as on maps.
float hillShade(float slope_x, float slope_y) {
  const Vec3f light = normalized(Vec3f{-1.0F, 1.0F, 1.3F});
  const float lit = dot(normalized(Vec3f{-slope_x, -slope_y, 1.0F}), light);
  const float relative = std::max(0.0F, lit) / light.z;  // 1 on level ground
  return std::min(1.3F, 0.32F + 0.68F * relative);
}

/// A colour 0xAABBGGRR over another one.
Rgba painted(std::uint32_t color, const Rgba& behind) {
  const auto channel = [color](int shift) { return static_cast<float>(color >> shift & 0xFFU) / 255.0F; };
  return mixed(behind, {channel(0), channel(8), channel(16), 1.0F}, channel(24));
}

constexpr std::size_t kNoPost = std::numeric_limits<std::size_t>::max();

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
  const auto isComplete = [posts](std::size_t count) {
    return count == 0 || static_cast<long long>(count) == posts;
  };
  if (!isComplete(field.kinds.size()) || !isComplete(field.colors.size())) {
    throw Error(ErrorCode::bad_input, fmt::format("height field of {} posts holds {} kinds and {} colours",
                                                  posts, field.kinds.size(), field.colors.size()));
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
  const std::vector<std::size_t> posts = crop(field, grid);
  shade(field, posts, grid, box);
  buildHierarchy();
}

std::vector<std::size_t> GroundSurface::crop(const HeightField& field, const volume::Grid& grid) {
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
  std::vector<std::size_t> posts(heights_.size(), kNoPost);
  float lowest = std::numeric_limits<float>::infinity();
  float highest = -lowest;
  for (int j = 0; j < y.count; ++j) {
    const int from_row = heldPost(y.first + j, field.rows);
    for (int i = 0; i < x.count; ++i) {
      const int from_column = heldPost(x.first + i, field.columns);
      if (from_row < 0 || from_column < 0) continue;
      const std::size_t from = static_cast<std::size_t>(from_row) * field.columns + from_column;
      const float height_m = field.heights_m[from];
      if (!std::isfinite(height_m)) continue;
      posts[static_cast<std::size_t>(j) * x.count + i] = from;
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
  return posts;
}

void GroundSurface::shade(const HeightField& field, const std::vector<std::size_t>& posts,
                          const volume::Grid& grid, const SceneBox& box) {
  const int columns = view_.columns;
  const int rows = view_.rows;
  const Palette& palette = field.light ? kLight : kDark;
  view_.wall_light = palette.wall_light;
  view_.wall_rise = palette.wall_rise;
  colors_.resize(heights_.size());
  // A post's spacing and a voxel's height, both as drawn.
  const double post_x_m = grid.spacing_m.x / view_.scale_x;
  const double post_y_m = grid.spacing_m.y / view_.scale_y;
  const double voxel_z_m = grid.spacing_m.z * box.vertical_exaggeration;
  const auto at = [&](int i, int j) {
    return static_cast<std::size_t>(std::clamp(j, 0, rows - 1)) * columns + std::clamp(i, 0, columns - 1);
  };
  const auto isWater = [&](std::size_t post) {
    return !field.kinds.empty() && posts[post] != kNoPost && field.kinds[posts[post]] == GroundKind::water;
  };
  float lowest = std::numeric_limits<float>::infinity();
  for (std::size_t post = 0; post < heights_.size(); ++post) {
    if (!isWater(post) && heights_[post] < lowest) lowest = heights_[post];
  }
  const float range = std::max(static_cast<float>(view_.upper.z) - lowest,
                               static_cast<float>(kMinTintRange_m / grid.spacing_m.z));
  const auto slope = [](float before, float after, double spacing) {
    const float rise = after - before;
    return rise == rise ? static_cast<float>(rise / (2 * spacing)) : 0.0F;
  };
  /// 1 at the shore, 1/2 one post further out.
  const auto nearShore = [&](int i, int j) {
    for (int reach = 1; reach <= 2; ++reach) {
      for (int step = -reach; step <= reach; ++step) {
        for (const std::size_t post : {at(i + step, j - reach), at(i + step, j + reach),
                                       at(i - reach, j + step), at(i + reach, j + step)}) {
          if (posts[post] != kNoPost && !isWater(post)) return 1.0F / static_cast<float>(reach);
        }
      }
    }
    return 0.0F;
  };
  parallelFor(rows, kGroundGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int i = 0; i < columns; ++i) {
        const std::size_t post = at(i, j);
        const float relative = (heights_[post] - lowest) / range;
        Rgba color = isWater(post) ? mixed(palette.water, palette.shore, nearShore(i, j))
                                   : tintOf(palette, relative == relative ? relative : 0.0F);
        if (!field.colors.empty() && posts[post] != kNoPost)
          color = painted(field.colors[posts[post]], color);
        const float slope_x = slope(heights_[at(i - 1, j)], heights_[at(i + 1, j)], post_x_m / voxel_z_m);
        const float slope_y = slope(heights_[at(i, j - 1)], heights_[at(i, j + 1)], post_y_m / voxel_z_m);
        color = color * (1.0F + palette.relief * (hillShade(slope_x, slope_y) - 1.0F));
        colors_[post] = {std::min(color.r, 1.0F), std::min(color.g, 1.0F), std::min(color.b, 1.0F), 1.0F};
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
