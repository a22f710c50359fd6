#include "emfield/excess/interpolate_columns.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/math/simd.h"
#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

/// The lines of the part in one direction.
struct PartLines {
  std::vector<int> at;              ///< their indices, ascending
  std::vector<LinesAround> around;  ///< per index

  PartLines(int count, int step) {
    for (int i = 0; i < count; ++i) {
      around.emplace_back(i, count, step);
      if (around.back().is_line) at.push_back(i);
    }
    step_ = step;
  }
  /// Numbers of the lines below and after an index, in `at`.
  int below(int i) const { return around[i].below / step_; }
  int after(int i) const { return below(i) + (around[i].after > around[i].below ? 1 : 0); }
  bool isLine(int i) const { return around[i].is_line; }
  int count() const { return static_cast<int>(around.size()); }

 private:
  int step_;
};

EMSCAPE_SIMD_CLONES void mixRows(const float* a, const float* b, float weight, int count, float* out) {
#pragma omp simd
  for (int i = 0; i < count; ++i) out[i] = between(a[i], b[i], weight);
}

EMSCAPE_SIMD_CLONES void storeCodes(const float* values, int count, ExcessCode* codes) {
#pragma omp simd
  for (int i = 0; i < count; ++i) codes[i] = codeBetween(values[i]);
}

/// Fills one layer.
/// @param valueAt(x, y)       of a column of the part
/// @param store(y, values)    takes a row
template <class ValueAt, class Store>
void fillLayer(const PartLines& columns, const PartLines& rows, const ValueAt& valueAt, const Store& store) {
  const int width = columns.count(), height = rows.count();
  std::vector<float> lines(columns.at.size()), low(width), high(width), out(width);
  const auto read = [&](int y, std::vector<float>& row) {
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i] = valueAt(columns.at[i], y);
    for (int x = 0; x < width; ++x)
      row[x] = between(lines[columns.below(x)], lines[columns.after(x)], columns.around[x].weight);
  };
  int of_low = -1;
  for (int y = 0; y < height; ++y) {
    if (rows.below(y) != of_low) {
      if (of_low >= 0 && rows.below(y) == of_low + 1) {
        std::swap(low, high);
      } else {
        read(rows.around[y].below, low);
      }
      of_low = rows.below(y);
      read(rows.around[y].after, high);
    }
    mixRows(low.data(), high.data(), rows.around[y].weight, width, out.data());
    store(y, out.data());
  }
}

}  // namespace

void interpolateColumnsCpu(const ExcessGrid& grid, const ExcessOutput& out) {
  const PartLines columns(grid.dims.x, grid.part.step), rows(grid.dims.y, grid.part.step);
  const int width = grid.dims.x;
  const auto indexOf = [width](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
  // Copies what the part does not contain.
  const auto storeOthers = [&](int y, const auto* values, auto* row) {
    if (!rows.isLine(y)) {
      std::copy_n(values, width, row);
      return;
    }
    for (int x = 0; x < width; ++x) {
      if (!columns.isLine(x)) row[x] = values[x];
    }
  };
  fillLayer(
      columns, rows, [&](int x, int y) { return out.shadow_edge_m[indexOf(x, y)]; },
      [&](int y, const float* edges_m) { storeOthers(y, edges_m, out.shadow_edge_m + indexOf(0, y)); });
  if (out.excess.codes == nullptr) return;
  parallelFor(grid.layers, 1, [&](int begin, int end) {
    std::vector<ExcessCode> codes(width);
    for (int k = begin; k < end; ++k) {
      const auto valueAt = [&](int x, int y) { return PartColumn(grid, out.excess.codes, indexOf(x, y))(k); };
      // The rows of the part are read in layers above this one, too: only others are written.
      fillLayer(columns, rows, valueAt, [&](int y, const float* values) {
        storeCodes(values, width, codes.data());
        storeOthers(y, codes.data(),
                    out.excess.codes + static_cast<std::size_t>(k) * grid.column_count + indexOf(0, y));
      });
    }
  });
}

}  // namespace emscape::emfield
