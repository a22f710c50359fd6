#include "render/cells/tile_projection.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/cells/tile_lanes.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // compiles the rest once for each kind of vector register
#include <hwy/highway.h>
//
#include "render/cells/integral/integral_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emscape::render {
namespace HWY_NAMESPACE {
namespace {

#if HWY_CAP_GE256
/// A tile; the lanes of a group are neighbouring pixels of a row.
class TileInLanes {
 public:
  TileInLanes(const TileTask& task, const LaneTransferView& transfer, const PixelBox& pixels, bool sort_rays)
      : task_(task),
        pixels_(pixels),
        sort_rays_(sort_rays),
        integrals_(kTile * kGroups, IntegralLanes(transfer)) {
    for (int y = pixels.first_y; y < pixels.end_y; ++y) {
      for (int x = pixels.first_x; x < pixels.end_x; ++x) {
        const PixelRay ray(task, x, y);
        const int row = y - pixels.first_y, group = (x - pixels.first_x) / kLanes;
        const int lane = (x - pixels.first_x) % kLanes;
        x_[group].of[lane] = ray.x;
        y_[row] = ray.y;
        length_[row][group].of[lane] = ray.length;
        end_depth_[row][group].of[lane] = ray.end_depth;
        integral(row, group).reset(lane);
        if (!open_[row][group]) ++open_groups_;
        open_[row][group] = true;
      }
    }
  }
  /// Whether further cells do not matter: all rays are opaque, and need not be checked for their order.
  bool isDone() const { return open_groups_ == 0 && !sort_rays_; }

  void add(const TileCell& cell) {
    const PixelBox box = common(cell.pixels, pixels_);
    const int first = (box.first_x - pixels_.first_x) / kLanes;
    const int last = (box.end_x - 1 - pixels_.first_x) / kLanes;
    for (int row = box.first_y - pixels_.first_y; row < box.end_y - pixels_.first_y; ++row) {
      for (int group = first; group <= last; ++group) {
        if (!open_[row][group] && !sort_rays_) continue;
        if (task_.camera.orthographic) {
          addRow<true>(cell, row, group);
        } else {
          addRow<false>(cell, row, group);
        }
      }
    }
  }

  void write(const TileCells& cells, Image& image) const {
    for (int y = pixels_.first_y; y < pixels_.end_y; ++y) {
      for (int x = pixels_.first_x; x < pixels_.end_x; ++x) {
        const int row = y - pixels_.first_y, group = (x - pixels_.first_x) / kLanes;
        const int lane = (x - pixels_.first_x) % kLanes;
        image.at(x, y) = integral(row, group).color(lane);
        if (wrong_[row][group].of[lane] > 0) {
          RayIntegral sorted(task_.transfer, task_.psi);
          compositeSorted(task_, cells, x, y, sorted);
          image.at(x, y) = sorted.color();
        }
      }
    }
  }

 private:
  static constexpr int kTile = TileGrid::kTile, kGroups = kTile / kLanes;

  IntegralLanes& integral(int row, int group) {
    return integrals_[static_cast<std::size_t>(row * kGroups + group)];
  }
  const IntegralLanes& integral(int row, int group) const {
    return integrals_[static_cast<std::size_t>(row * kGroups + group)];
  }

  /// See TileCell::meets() and addSegment().
  template <bool kParallel>
  HWY_INLINE void addRow(const TileCell& cell, int row, int group) {
    const D zero = hn::Zero(kD), x = x_[group]();
    const double y = y_[row];
    const auto at = [&](double of_x, double constant)
                        HWY_ATTR { return hn::MulAdd(hn::Set(kD, of_x), x, hn::Set(kD, constant)); };
    const auto nearness = [&](const PlaneFunction& plane)
                              HWY_ATTR { return at(plane.of_x, plane.of_y * y + plane.constant); };
    D enter = hn::Set(kD, HUGE_VAL), leave = nearness(cell.nearness[3]);
    for (int n = 0; n < cell.entries; ++n) enter = hn::Min(enter, nearness(cell.nearness[n]));
    for (int n = cell.entries; n < 3; ++n) leave = hn::Max(leave, nearness(cell.nearness[n]));
    M met = hn::Gt(enter, leave);
    if (!kParallel) met = hn::And(met, hn::Gt(leave, zero));
    if (hn::AllFalse(kD, met)) return;

    D begin, end, front, slope;
    if (kParallel) {
      begin = hn::Max(zero, hn::Neg(enter));
      end = hn::Neg(leave);
      front = at(cell.gradient.x, cell.gradient.y * y + cell.eye_value);
      slope = hn::Set(kD, cell.gradient.z);
    } else {
      const D one = hn::Set(kD, 1.0);
      begin = one / enter;
      end = one / leave;
      front = hn::Set(kD, cell.eye_value);
      slope = at(cell.gradient.x, cell.gradient.y * y + cell.gradient.z);
    }
    end = hn::Min(end, end_depth_[row][group]());
    IntegralLanes& integral_here = integral(row, group);
    const D least = hn::Set(kD, task_.through);
    met = hn::And(met, hn::Gt(end, begin));
    const M open = hn::Ge(integral_here.through(), least);
    if (sort_rays_) {
      const D middle = hn::Set(kD, 0.5) * (begin + end), last = last_[row][group]();
      const M is_wrong = hn::And(met, hn::Lt(middle, last));
      wrong_[row][group] = hn::IfThenElse(is_wrong, hn::Set(kD, 1.0), wrong_[row][group]());
      last_[row][group] = hn::IfThenElse(hn::And(met, open), middle, last);
    }
    if (!open_[row][group]) return;
    met = hn::And(met, open);
    integral_here.add(met, hn::MulAdd(begin, slope, front), hn::MulAdd(end, slope, front),
                      (end - begin) * length_[row][group]());
    if (hn::AllTrue(kD, hn::Lt(integral_here.through(), least))) {
      open_[row][group] = false;
      --open_groups_;
    }
  }

  const TileTask& task_;
  const PixelBox pixels_;
  const bool sort_rays_;
  std::vector<IntegralLanes> integrals_;
  Reals x_[kGroups], length_[kTile][kGroups], end_depth_[kTile][kGroups];
  Reals last_[kTile][kGroups];   ///< depth in the middle of the last segment
  Reals wrong_[kTile][kGroups];  ///< 1: the ray met a cell in the wrong order
  double y_[kTile] = {};
  bool open_[kTile][kGroups] = {};
  int open_groups_ = 0;
};

void compositeLanes(const TileTask& task, const LaneTransferView& transfer, const TileCells& cells,
                    Image& image) {
  constexpr int kAhead = 6;  // prefetch: cells and points are scattered in memory
  TileInLanes tile(task, transfer, cells.pixels, cells.sort_rays);
  for (const int* rank = cells.begin; rank < cells.end && !tile.isDone(); ++rank) {
    if (cells.end - rank > 2 * kAhead) {
      hwy::Prefetch(&task.cells[rank[2 * kAhead]]);
      for (const std::int32_t corner : task.cells[rank[kAhead]].corners) hwy::Prefetch(&task.points[corner]);
    }
    tile.add(TileCell(task, *rank));
  }
  tile.write(cells, image);
}
#else
void compositeLanes(const TileTask& task, const LaneTransferView&, const TileCells& cells, Image& image) {
  compositeTile(task, cells, image);
}
#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace emscape::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace emscape::render {

HWY_EXPORT(compositeLanes);

void compositeTileInLanes(const TileTask& task, const LaneTransferView& transfer, const TileCells& cells,
                          Image& image) {
  HWY_DYNAMIC_DISPATCH(compositeLanes)(task, transfer, cells, image);
}

}  // namespace emscape::render
#endif
