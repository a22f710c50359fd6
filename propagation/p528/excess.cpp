#include "propagation/p528/excess.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "emscape/base/parallel.h"
#include "propagation/p528/p528.h"
#include "propagation/p528/point_table.h"

namespace emscape::propagation {
namespace {

constexpr int kHeights = 48;
constexpr int kRanges = 256;
}  // namespace

// By bisection.
double p528RangeAt(double position, double horizon_m, double steep_m, double farthest_ratio) {
  constexpr int kBisections = 45;
  double nearer_m = 0, farther_m = farthest_ratio * horizon_m;
  for (int i = 0; i < kBisections; ++i) {
    const double middle_m = (nearer_m + farther_m) / 2;
    (P528Excess::positionOf(middle_m, horizon_m, steep_m, farthest_ratio) < position ? nearer_m : farther_m) =
        middle_m;
  }
  return nearer_m;
}

P528Excess p528Excess(const PathInputs& inputs, std::vector<float>& tables) {
  const EmitterInputs& emitter = inputs.emitter;
  const PathExtent& extent = inputs.extent;
  const double surface_msl_m = inputs.surface_msl_m;
  const double tx_m = inputs.site.height_msl_m - surface_msl_m;
  const auto allowed = [](double height_m) { return std::clamp(height_m, kP528Height.min, kP528Height.max); };
  P528Excess result;
  result.height_count = kHeights;
  result.range_count = kRanges;
  result.surface_msl_m = surface_msl_m;
  const double lowest_root = std::sqrt(allowed(extent.lowest_msl_m - surface_msl_m));
  const double highest_root = std::sqrt(allowed(extent.highest_msl_m - surface_msl_m));
  const double step_root = std::max(highest_root - lowest_root, 0.01) / (kHeights - 1);
  result.lowest_root = static_cast<float>(lowest_root);
  result.heights_per_root = static_cast<float>(1 / step_root);

  const auto atmosphere = std::make_shared<const P528Atmosphere>(emitter.frequency_hz);
  const bool vertical = emitter.polarization != Polarization::horizontal;
  std::vector<P528Curve> curves;
  for (int h = 0; h < kHeights; ++h) {
    const double root = lowest_root + h * step_root;
    curves.emplace_back(atmosphere, emitter.frequency_hz, allowed(tx_m), allowed(root * root), vertical);
  }
  result.farthest_ratio = static_cast<float>(std::max(1.1, extent.farthest_m / curves.front().horizon_m()));

  tables.resize(static_cast<std::size_t>(kHeights) * (kRanges + 2));
  float* const horizons_m = tables.data();
  float* const steep_m = horizons_m + kHeights;
  float* const excess = steep_m + kHeights;
  parallelFor(kHeights, 1, [&](int begin, int end) {
    for (int h = begin; h < end; ++h) {
      const double root = lowest_root + h * step_root;
      horizons_m[h] = static_cast<float>(curves[h].horizon_m());
      steep_m[h] = static_cast<float>(kP528SteepRatio * (allowed(tx_m) + allowed(root * root)));
      for (int r = 0; r < kRanges; ++r) {
        const double range_m =
            p528RangeAt(static_cast<double>(r) / (kRanges - 1), curves[h].horizon_m(),
                        static_cast<double>(steep_m[h]), static_cast<double>(result.farthest_ratio));
        const P528Loss loss = curves[h].at(range_m, emitter.settings.p528.time_percent);
        excess[static_cast<std::size_t>(h) * kRanges + r] =
            static_cast<float>(loss.loss_db - loss.free_space_db);
      }
    }
  });
  result.tables = tables.data();
  return result;
}

P528Excess p528ExcessAt(const PathInputs& inputs, const PathPoints& points, std::vector<float>& tables) {
  const auto allowed = [&](double height_msl_m) {
    return std::clamp(height_msl_m - inputs.surface_msl_m, kP528Height.min, kP528Height.max);
  };
  const std::size_t positions = points.range_m.size();
  P528Excess result;
  result.surface_msl_m = inputs.surface_msl_m;
  result.position_count = positions;
  tables.assign(positions * points.above_base_m.size(), 0);
  double lowest_m = HUGE_VAL, highest_m = -HUGE_VAL, farthest_m = 1;
  for (std::size_t p = 0; p < positions; ++p) {
    if (std::isnan(points.range_m[p])) continue;
    lowest_m = std::min(lowest_m, points.base_msl_m[p]);
    highest_m = std::max(highest_m, points.base_msl_m[p]);
    farthest_m = std::max(farthest_m, points.range_m[p]);
  }
  result.tables = tables.data();
  if (!(lowest_m <= highest_m)) return result;  // all are left out
  P528PointTable table(inputs.emitter, allowed(inputs.site.height_msl_m),
                       allowed(lowest_m + static_cast<double>(points.above_base_m.front())),
                       allowed(highest_m + static_cast<double>(points.above_base_m.back())), farthest_m);
  for (std::size_t k = 0; k < points.above_base_m.size(); ++k) {
    const auto above_m = static_cast<double>(points.above_base_m[k]);
    table.fill(
        positions,
        [&](std::size_t p) {
          return P528PointTable::Point{points.range_m[p], allowed(points.base_msl_m[p] + above_m)};
        },
        tables.data() + k * positions);
  }
  return result;
}

}  // namespace emscape::propagation
