#include "emfield/excess/fill_excess.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <type_traits>
#include <vector>

#include "base/math/simd.h"
#include "emfield/excess/surface_diffraction.h"
#include "emfield/ground/read_cover.h"
#include "emfield/ground/read_posts.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"

namespace emscape::emfield {
namespace {

using propagation::kMissingTerrain;

/// Neighbouring columns, so that results are written in runs.
constexpr int kBlock = 16;

/// Sets the codes of some columns in all layers. @param excess_db  kBlock values per layer
EMSCAPE_SIMD_CLONES void setCodes(const float* excess_db, int layers, int count, std::size_t column_count,
                                  ExcessCode* codes) {
  for (int k = 0; k < layers; ++k, excess_db += kBlock, codes += column_count) {
#pragma omp simd
    for (int i = 0; i < count; ++i) codes[i] = excessCode(excess_db[i]);
  }
}

/// PostReader of a model.
template <class Model>
struct ProfileReader {
  int operator()(const Station& station, const GroundPosts& ground, const FastInverse& path, double* range_m,
                 float* height_msl_m) const {
    constexpr bool at_crossings = propagation::ReadsCrossings<Model>::value;
    return readProfileCpu(station, ground, path, at_crossings, range_m, height_msl_m);
  }
  void readCover(const Station& station, const GroundPosts& ground, const FastInverse& path,
                 const double* range_m, const float* ground_msl_m, int count, float* cover_m) const {
    readCoverCpu(station, ground, path, classes, range_m, ground_msl_m, count, cover_m);
  }

  const ClassCovers& classes;
};

/// Fills the columns whose paths need not be read whole, where there is a search for that.
/// @return for each column whether it is left; empty: all are
template <class Model>
std::vector<char> fillBySearch(const ExcessTask<Model>& task, const TerrainBounds* bounds,
                               const ExcessOutput& out) {
  if constexpr (std::is_same_v<Model, propagation::DiffractionExcess>) {
    if (bounds != nullptr && bounds->isUsable() && task.grid.columns.of_surface != nullptr)
      return fillSurfaceDiffraction(task, *bounds, out);
  }
  return {};
}

template <class Model>
unsigned fill(const ExcessTask<Model>& task, const TerrainBounds* bounds, const ExcessOutput& out) {
  const ExcessGrid& grid = task.grid;
  const std::vector<char> is_left = fillBySearch(task, bounds, out);
  const ClassCovers classes(task.ground.terrain.cover);
  const ProfileReader<Model> reader{classes};
  const auto isLeft = [&](std::size_t column) {
    return (is_left.empty() || is_left[column] != 0) && grid.part.contains(grid.dims, column);
  };
  const int columns = static_cast<int>(grid.column_count);
  std::atomic<unsigned> all_warnings{0};
  std::atomic<int> filled_columns{0};
  parallelFor((columns + kBlock - 1) / kBlock, 4, [&](int begin, int end) {
    UnsetVector<double> memory(ExcessScratch::bytes(task.posts(), grid.layers) / sizeof(double) + 1);
    const ExcessScratch scratch = ExcessScratch::in(memory.data(), task.posts(), grid.layers);
    std::vector<float> excess_db(static_cast<std::size_t>(grid.layers) * kBlock);
    unsigned warnings = 0;
    for (int block = begin; block < end; ++block) {
      const int first = block * kBlock, count = std::min(kBlock, columns - first);
      int left[kBlock], left_count = 0;
      for (int i = 0; i < count; ++i) {
        if (isLeft(static_cast<std::size_t>(first + i))) left[left_count++] = i;
      }
      for (int n = 0; n < left_count; ++n) {
        const int i = left[n];
        const auto column = static_cast<std::size_t>(first + i);
        checkpoint();
        const auto setAll = [&](float db) { std::fill_n(scratch.excess_db, grid.layers, db); };
        unsigned of_column = 0;
        if (grid.isLeftOut(column)) {
          setAll(0);
        } else if (Model::kNeedsTerrain && grid.isWithoutGround(column)) {
          setAll(NAN);
          of_column = kMissingTerrain;
        } else {
          of_column = task.fillColumn(column, scratch, reader, out.reflected, out.mechanisms);
        }
        if (of_column & kMissingTerrain) out.markUnknown(column);
        warnings |= of_column;
        for (int k = 0; k < grid.layers; ++k) {
          excess_db[static_cast<std::size_t>(k) * kBlock + i] = scratch.excess_db[k];
        }
      }
      if (left_count == count && out.excess.codes != nullptr) {
        setCodes(excess_db.data(), grid.layers, count, grid.column_count, out.excess.codes + first);
      } else {
        for (int k = 0; left_count > 0 && k < grid.layers; ++k) {
          const std::size_t row = static_cast<std::size_t>(k) * grid.column_count + first;
          for (int n = 0; n < left_count; ++n)
            out.excess.set(row + left[n], excess_db[static_cast<std::size_t>(k) * kBlock + left[n]]);
        }
      }
      reportDone(static_cast<double>(filled_columns += count) / columns);
    }
    all_warnings |= warnings;
  });
  return all_warnings;
}

}  // namespace

EMSCAPE_SIMD_CLONES void heightsMslCpu(const GridColumn& column, const float* t_m, int count,
                                       float* height_msl_m) {
  const GridColumn of = column;
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    height_msl_m[k] = static_cast<float>(heightMsl_m(of, static_cast<double>(t_m[k])));
  }
}

EMSCAPE_SIMD_CLONES void addAirCpu(const AirLoss& air, float range_m, const GridColumn& column,
                                   const float* t_m, int count, float* excess_db) {
  const AirLoss of_air = air;
  const GridColumn of = column;
  const propagation::AirColumn above(of_air, range_m);
  const auto heightOf = [&](int k) {
    return static_cast<float>(heightMsl_m(of, static_cast<double>(t_m[k])));
  };
  if (of_air.level_rain > 0) {
    for (int k = 0; k < count; ++k) excess_db[k] += above.lossDb(heightOf(k));
    return;
  }
#pragma omp simd
  for (int k = 0; k < count; ++k) excess_db[k] += above.gasesDb(heightOf(k));
}

ExcessGrid excessGrid(const GridColumns& columns, const scenario::Terrain* terrain) {
  ExcessGrid grid;
  grid.columns = columns.view();
  grid.column_count = columns.count();
  grid.t_m = columns.t_m.data();
  grid.layers = static_cast<int>(columns.t_m.size());
  grid.dims = columns.dims;
  grid.tilted = columns.tilted;
  grid.every_height = columns.every_height;
  if (!columns.first_valid_k.empty()) grid.first_valid_k = columns.first_valid_k.data();
  if (columns.tilted) {
    // The ground track of a segment is at most as long as the distance between posts.
    constexpr double kMaxTrack_m = 100;
    const double track_m = std::min(postSpacing_m(terrain), kMaxTrack_m);
    grid.segments = std::clamp(static_cast<int>(std::ceil(2 * tiltOf(columns) / track_m)), 1, grid.layers);
  } else if (!columns.ground_msl_m.empty()) {
    grid.ground_msl_m = columns.ground_msl_m.data();
  }
  return grid;
}

unsigned fillExcessCpu(const EmitterExcess& excess, const Station& station, const ExcessGrid& grid,
                       const GroundPosts& ground, const TerrainBounds* bounds, const ExcessOutput& out) {
  return std::visit(
      [&](const auto& m) {
        using Model = std::decay_t<decltype(m)>;
        ExcessTask<Model> task{m, excess.air, station, grid, ground, excess.terminal};
        task.ground.is_raised = excess.is_raised && ground.terrain.hasCover();
        task.ground.has_clutter = excess.has_clutter;
        const bool is_bounded =
            bounds != nullptr && (!task.ground.is_raised || bounds->highestCover_m() != nullptr);
        return fill(task, is_bounded ? bounds : nullptr, out);
      },
      excess.model);
}

}  // namespace emscape::emfield
