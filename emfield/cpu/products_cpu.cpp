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

/// One row: from the accumulator in place to values, masked where k lies below first_valid_k.
template <bool decibels>
inline void fillRow(const ProductScale& product, const float* accumulator, const std::uint16_t* first_valid_k,
                    int k, int count, float* values, ValueRange& range) {
  const ProductScale local = product;
  float lowest = range.lowest, highest = range.highest;
#pragma omp simd reduction(min : lowest) reduction(max : highest)
  for (int i = 0; i < count; ++i) {
    const float made = decibels ? decibelsOf(local, accumulator[i]) : accumulator[i];
    const float value = k >= static_cast<int>(first_valid_k[i]) ? made : local.floor;
    values[i] = value;
    const float for_lowest = value > local.floor ? value : kNothing.lowest;
    const float for_highest = value > local.floor ? value : kNothing.highest;
    lowest = for_lowest < lowest ? for_lowest : lowest;
    highest = for_highest > highest ? for_highest : highest;
  }
  range = {lowest, highest};
}

EMSCAPE_SIMD_CLONES void decibelRow(const ProductScale& product, const float* accumulator,
                                    const std::uint16_t* first_valid_k, int k, int count, float* values,
                                    ValueRange& range) {
  fillRow<true>(product, accumulator, first_valid_k, k, count, values, range);
}
EMSCAPE_SIMD_CLONES void plainRow(const ProductScale& product, const float* accumulator,
                                  const std::uint16_t* first_valid_k, int k, int count, float* values,
                                  ValueRange& range) {
  fillRow<false>(product, accumulator, first_valid_k, k, count, values, range);
}

}  // namespace

ValueRange productCpu(const ProductTask& task) {
  std::vector<ValueRange> ranges(task.dims.y, kNothing);
  const std::vector<std::uint16_t> all_valid(task.first_valid_k == nullptr ? task.dims.x : 0, 0);
  const auto row = task.product.decibels ? decibelRow : plainRow;
  parallelFor(task.dims.y, 1, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const std::uint16_t* first_valid_k =
          task.first_valid_k == nullptr ? all_valid.data()
                                        : task.first_valid_k + static_cast<std::size_t>(j) * task.dims.x;
      for (int k = 0; k < task.dims.z; ++k) {
        const std::size_t first = (static_cast<std::size_t>(k) * task.dims.y + j) * task.dims.x;
        row(task.product, task.accumulator + first, first_valid_k, k, task.dims.x, task.values + first,
            ranges[j]);
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
