#include "study/maps/least_heights.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/volume/dense_volume.h"

namespace emscape::study {
namespace {

constexpr int kFirstSteps = 64, kLaterSteps = 16;
/// Number of voxels at a time, which limits the memory.
constexpr int kMaxVoxels = 1 << 25;

/// Some rows of a map.
class Strip {
 public:
  Strip(const MapGrid& grid, int first_row, int rows) {
    surface_.width = grid.width;
    surface_.height = rows;
    const auto begin = grid.positions.begin() + static_cast<std::ptrdiff_t>(first_row) * grid.width;
    surface_.positions.assign(begin, begin + static_cast<std::ptrdiff_t>(rows) * grid.width);
    surface_.offsets_m.assign(surface_.positions.size(), 0.0f);
    found_m_.assign(surface_.positions.size(), NAN);
  }

  bool hasPositions() const {
    return std::any_of(surface_.positions.begin(), surface_.positions.end(),
                       [](const auto& position) { return !std::isnan(position.latitude_deg); });
  }

  /// The positions, with this number of steps of height above their offsets.
  const emfield::Surface& surfaceOf(double step_m, int steps) {
    surface_.heights_m.clear();
    for (int k = 0; k <= steps; ++k) surface_.heights_m.push_back(k * step_m);
    return surface_;
  }

  /// Searches the threshold above each position's offset, and sets the offset to the step below it. Positions
  /// that do not reach it, or reach it at the first height, are left out from now on.
  /// @param volume  over surfaceOf(step_m, steps)
  void search(double step_m, int steps, double threshold, const volume::DenseVolume& volume) {
    const std::size_t positions = surface_.positions.size();
    parallelFor(static_cast<int>(positions), 4096, [&](int begin, int end) {
      for (int p = begin; p < end; ++p) {
        if (std::isnan(surface_.positions[p].latitude_deg)) continue;
        int k = volume.first_valid_k.empty() ? 0 : volume.first_valid_k[p];
        while (k <= steps && !(static_cast<double>(volume.values[k * positions + p]) >= threshold)) ++k;
        const bool is_found = k <= steps;
        if (is_found) {
          found_m_[p] = surface_.offsets_m[p] + static_cast<float>(k * step_m);
          surface_.offsets_m[p] += static_cast<float>((k - 1) * step_m);
        }
        if (!is_found || k == 0) surface_.positions[p].latitude_deg = NAN;
      }
    });
  }

  /// Adds what is known of each position over all heights: exact, or bound if some emitters are unknown.
  /// @param volume, partly_unknown  as in search(), as FieldSolver::partlyUnknown()
  void addKnown(int steps, const volume::DenseVolume& volume, const std::vector<std::uint8_t>& partly_unknown,
                std::vector<PixelAnswer>& known) const {
    const std::size_t positions = surface_.positions.size();
    for (std::size_t p = 0; p < positions; ++p) {
      bool has_value = false;
      std::size_t k = volume.first_valid_k.empty() ? 0 : volume.first_valid_k[p];
      for (; !has_value && k <= static_cast<std::size_t>(steps); ++k)
        has_value = !std::isnan(volume.values[k * positions + p]);
      const bool is_inside = !std::isnan(surface_.positions[p].latitude_deg);
      const bool is_bound = !partly_unknown.empty() && partly_unknown[p] != 0;
      known.push_back(!is_inside   ? PixelAnswer::none
                      : !has_value ? PixelAnswer::unknown
                      : is_bound   ? PixelAnswer::bound
                                   : PixelAnswer::exact);
    }
  }

  const std::vector<float>& found_m() const { return found_m_; }

 private:
  emfield::Surface surface_;
  std::vector<float> found_m_;
};

}  // namespace

LeastHeights::LeastHeights(const MapGrid& grid, std::vector<double> thresholds,
                           const emfield::FieldOptions& options)
    : grid_(grid), thresholds_(std::move(thresholds)), options_(options) {
  options_.allow_missing_terrain = options_.keep_partly_unknown = true;
}

std::vector<std::vector<float>> LeastHeights::compute(
    const std::shared_ptr<const scenario::Scenario>& scenario, const scenario::TerrainPtr& terrain,
    double time_s) {
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), time_s);
  const int rows_at_once = std::max(1, kMaxVoxels / (grid_.width * (kFirstSteps + 1)));
  const bool is_kept = rows_at_once >= grid_.height;
  const auto solve = [&](const emfield::Surface& surface, std::optional<emfield::FieldSolver>& solver) {
    if (!solver) {
      emfield::FieldOptions on_surface = options_;
      on_surface.surface = std::make_shared<const emfield::Surface>(surface);
      solver.emplace(scenario, terrain, on_surface);
    }
    solver->update(snapshot, terrain);
    return solver->volumes().front().host();
  };
  std::vector<std::vector<float>> heights_m(thresholds_.size());
  known_.clear();
  for (int row = 0; row < grid_.height; row += rows_at_once) {
    Strip all(grid_, row, std::min(rows_at_once, grid_.height - row));
    std::shared_ptr<const volume::DenseVolume> first;
    constexpr double kFirstStep_m = kHighestSearched_m / kFirstSteps;
    if (all.hasPositions()) {
      std::optional<emfield::FieldSolver> own;
      std::optional<emfield::FieldSolver>& solver = is_kept ? first_steps_ : own;
      first = solve(all.surfaceOf(kFirstStep_m, kFirstSteps), solver);
      all.addKnown(kFirstSteps, *first, solver->partlyUnknown(0), known_);
    } else {
      known_.resize(known_.size() + all.found_m().size(), PixelAnswer::none);
    }
    for (std::size_t t = 0; t < thresholds_.size(); ++t) {
      Strip strip = all;
      if (first) strip.search(kFirstStep_m, kFirstSteps, thresholds_[t], *first);
      for (double step_m = kFirstStep_m; strip.hasPositions() && step_m > kMinHeightAccuracy_m;) {
        step_m /= kLaterSteps;
        std::optional<emfield::FieldSolver> own;
        const auto volume = solve(strip.surfaceOf(step_m, kLaterSteps), own);
        strip.search(step_m, kLaterSteps, thresholds_[t], *volume);
      }
      heights_m[t].insert(heights_m[t].end(), strip.found_m().begin(), strip.found_m().end());
    }
  }
  return heights_m;
}

PixelAnswer LeastHeights::answer(std::size_t position, float height_m) const {
  const PixelAnswer known = known_[position];
  if (!std::isnan(height_m)) return known;
  return known == PixelAnswer::exact   ? PixelAnswer::none
         : known == PixelAnswer::bound ? PixelAnswer::unknown
                                       : known;
}

}  // namespace emscape::study
