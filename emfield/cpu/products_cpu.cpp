#include <algorithm>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "base/simd.h"
#include "emfield/products.h"

namespace emscape::emfield {
namespace {

constexpr ValueRange kNothing{std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity()};

/// @param first_valid_k  of the row's columns; null: all are valid
EMSCAPE_SIMD_CLONES void productRow(const ProductScale& product, const float* accumulator,
                                    const std::uint16_t* first_valid_k, int k, int count, float* values,
                                    ValueRange& range) {
  const ProductScale local = product;
  float lowest = range.lowest, highest = range.highest;
#pragma omp simd reduction(min : lowest) reduction(max : highest)
  for (int i = 0; i < count; ++i) {
    const bool valid = first_valid_k == nullptr || k >= first_valid_k[i];
    const float value = valid ? productValue(local, accumulator[i]) : local.floor;
    values[i] = value;
    const bool counts = value > local.floor;
    lowest = counts && value < lowest ? value : lowest;
    highest = counts && value > highest ? value : highest;
  }
  range = {lowest, highest};
}

}  // namespace

ValueRange productCpu(const ProductTask& task) {
  std::vector<ValueRange> ranges(task.dims.y, kNothing);
  parallelFor(task.dims.y, 1, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const std::size_t column = static_cast<std::size_t>(j) * task.dims.x;
      for (int k = 0; k < task.dims.z; ++k) {
        const std::size_t first = (static_cast<std::size_t>(k) * task.dims.y + j) * task.dims.x;
        productRow(task.product, task.accumulator + first,
                   task.first_valid_k == nullptr ? nullptr : task.first_valid_k + column, k, task.dims.x,
                   task.values + first, ranges[j]);
      }
    }
  });
  ValueRange total = kNothing;
  for (const ValueRange& range : ranges) {
    total.lowest = std::min(total.lowest, range.lowest);
    total.highest = std::max(total.highest, range.highest);
  }
  return total;
}

}  // namespace emscape::emfield
