#include <algorithm>
#include <limits>
#include <vector>

#include "base/math/simd.h"
#include "emfield/channels/products.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"

namespace emscape::emfield {
namespace {

constexpr volume::ValueRange kNothing{std::numeric_limits<float>::infinity(),
                                      -std::numeric_limits<float>::infinity()};

// Separate simple loops, which g++ vectorises at full width.

EMSCAPE_SIMD_CLONES void decibelRow(const ProductScale& product, const float* accumulator, int count,
                                    float* values) {
  const ProductScale local = product;
#pragma omp simd
  for (int i = 0; i < count; ++i) values[i] = decibelsOf(local, accumulator[i]);
}

template <ProductForm form>
__attribute__((always_inline)) inline void valueRow(const ProductScale& product, const float* accumulator,
                                                    const float* second, int count, float* values) {
  ProductScale local = product;
  local.form = form;
#pragma omp simd
  for (int i = 0; i < count; ++i) values[i] = valueOf(local, accumulator[i], second[i]);
}

EMSCAPE_SIMD_CLONES void signalRatioRow(const ProductScale& product, const float* accumulator,
                                        const float* second, int count, float* values) {
  valueRow<ProductForm::signal_ratio>(product, accumulator, second, count, values);
}
EMSCAPE_SIMD_CLONES void ageRow(const ProductScale& product, const float* accumulator, int count,
                                float* values) {
  valueRow<ProductForm::age>(product, accumulator, accumulator, count, values);
}

/// Gives voxels below first_valid_k the floor.
EMSCAPE_SIMD_CLONES void maskRow(const std::uint16_t* first_valid_k, int k, float floor, int count,
                                 float* values) {
#pragma omp simd
  for (int i = 0; i < count; ++i) values[i] = k >= static_cast<int>(first_valid_k[i]) ? values[i] : floor;
}

EMSCAPE_SIMD_CLONES void widenRange(const float* values, int count, float floor, volume::ValueRange& range) {
  float lowest = range.min, highest = range.max;
#pragma omp simd reduction(min : lowest) reduction(max : highest)
  for (int i = 0; i < count; ++i) {
    const float for_lowest = values[i] > floor ? values[i] : kNothing.min;
    lowest = for_lowest < lowest ? for_lowest : lowest;
    highest = values[i] > highest ? values[i] : highest;
  }
  range = {lowest, highest};
}

/// All rows at one y.
volume::ValueRange fillRows(const ProductTask& task, int j) {
  const int count = task.dims.x;
  const std::uint16_t* first_valid_k =
      task.first_valid_k == nullptr ? nullptr : task.first_valid_k + static_cast<std::size_t>(j) * count;
  const int all_valid_k =
      first_valid_k == nullptr ? 0 : *std::max_element(first_valid_k, first_valid_k + count);
  volume::ValueRange range = kNothing;
  for (int k = 0; k < task.dims.z; ++k) {
    checkpoint();
    const std::size_t first = (static_cast<std::size_t>(k) * task.dims.y + j) * count;
    const float* accumulator = task.accumulator + first;
    float* values = task.values + first;
    switch (task.product.form) {
      case ProductForm::decibels:
        decibelRow(task.product, accumulator, count, values);
        break;
      case ProductForm::itself:
        std::copy_n(accumulator, count, values);
        break;
      case ProductForm::signal_ratio:
        signalRatioRow(task.product, accumulator, task.second + first, count, values);
        break;
      case ProductForm::age:
        ageRow(task.product, accumulator, count, values);
        break;
    }
    if (k < all_valid_k) maskRow(first_valid_k, k, task.product.floor, count, values);
    widenRange(values, count, task.product.floor, range);
  }
  return range.max > task.product.floor ? range : kNothing;
}

}  // namespace

volume::ValueRange productCpu(const ProductTask& task) {
  std::vector<volume::ValueRange> ranges(task.dims.y, kNothing);
  parallelFor(task.dims.y, 1, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) ranges[j] = fillRows(task, j);
  });
  volume::ValueRange total = kNothing;
  for (const volume::ValueRange& range : ranges) total.add(range);
  return total;
}

}  // namespace emscape::emfield
