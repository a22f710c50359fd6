#include "base/math/simd.h"
#include "emfield/combine/occupancy.h"
#include "emfield/cpu/row.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

/// @param voxel  index of the row's first voxel
template <PatternKind kind>
__attribute__((always_inline)) inline void addRow(const OccupancyPass& pass, std::size_t voxel,
                                                  const Row& row) {
  for (int i = 0; i < row.count; ++i) {
    float& value = pass.accumulator[voxel + i];
    value = withOccupancy(occupancyAt<kind>(pass, voxel + i, row.column + i, row.t_m), value);
  }
}

template <PatternKind kind>
EMSCAPE_SIMD_CLONES void addRowOfKind(const OccupancyPass& pass, std::size_t voxel, const Row& row) {
  addRow<kind>(pass, voxel, row);
}

}  // namespace

void occupancyCpu(const OccupancyPass& pass) {
  const Dims& dims = pass.dims;
  parallelFor(dims.y, 1, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int k = pass.first_row_k == nullptr ? 0 : pass.first_row_k[j]; k < dims.z; ++k) {
        checkpoint();
        const std::size_t column = static_cast<std::size_t>(j) * dims.x;
        const std::size_t voxel = static_cast<std::size_t>(k) * dims.x * dims.y + column;
        const Row row{column, dims.x, pass.t_m[k]};
        onPattern(pass.beam.pattern, [&](auto kind) { addRowOfKind<kind>(pass, voxel, row); });
      }
    }
  });
}

}  // namespace emscape::emfield
