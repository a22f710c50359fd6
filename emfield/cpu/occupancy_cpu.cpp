#include "base/math/simd.h"
#include "emfield/combine/occupancy.h"
#include "emfield/cpu/row.h"
#include "emscape/base/parallel.h"

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

EMSCAPE_SIMD_CLONES void isotropicRow(const OccupancyPass& pass, std::size_t voxel, const Row& row) {
  addRow<PatternKind::isotropic>(pass, voxel, row);
}
EMSCAPE_SIMD_CLONES void gaussianRow(const OccupancyPass& pass, std::size_t voxel, const Row& row) {
  addRow<PatternKind::gaussian>(pass, voxel, row);
}
EMSCAPE_SIMD_CLONES void separableRow(const OccupancyPass& pass, std::size_t voxel, const Row& row) {
  addRow<PatternKind::separable>(pass, voxel, row);
}
EMSCAPE_SIMD_CLONES void phasedArrayRow(const OccupancyPass& pass, std::size_t voxel, const Row& row) {
  addRow<PatternKind::phased_array>(pass, voxel, row);
}
EMSCAPE_SIMD_CLONES void gridRow(const OccupancyPass& pass, std::size_t voxel, const Row& row) {
  addRow<PatternKind::grid>(pass, voxel, row);
}

void addRow(const OccupancyPass& pass, std::size_t voxel, const Row& row) {
  switch (pass.beam.pattern.kind) {
    case PatternKind::isotropic:
      return isotropicRow(pass, voxel, row);
    case PatternKind::gaussian:
      return gaussianRow(pass, voxel, row);
    case PatternKind::separable:
      return separableRow(pass, voxel, row);
    case PatternKind::phased_array:
      return phasedArrayRow(pass, voxel, row);
    case PatternKind::grid:
      return gridRow(pass, voxel, row);
  }
}

}  // namespace

void occupancyCpu(const OccupancyPass& pass) {
  const Dims& dims = pass.dims;
  parallelFor(dims.y, 1, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int k = pass.first_row_k == nullptr ? 0 : pass.first_row_k[j]; k < dims.z; ++k) {
        const std::size_t column = static_cast<std::size_t>(j) * dims.x;
        const std::size_t voxel = static_cast<std::size_t>(k) * dims.x * dims.y + column;
        addRow(pass, voxel, {column, dims.x, pass.t_m[k]});
      }
    }
  });
}

}  // namespace emscape::emfield
