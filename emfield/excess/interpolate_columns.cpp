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
  std::vector<int> at;        ///< their indices, ascending
  std::vector<int> below;     ///< per index: the last line before or at it, but not the last of all
  std::vector<float> weight;  ///< per index: of the line after `below`, 0..1
  std::vector<char> is_line;  ///< per index

  PartLines(int count, int step) {
    for (int i = 0; i < count - 1; i += step) at.push_back(i);
    at.push_back(count - 1);
    for (int i = 0, line = 0; i < count; ++i) {
      while (line + 2 < static_cast<int>(at.size()) && at[line + 1] <= i) ++line;
      below.push_back(line);
      weight.push_back(at.size() < 2
                           ? 0.0f
                           : static_cast<float>(i - at[line]) / static_cast<float>(at[line + 1] - at[line]));
      is_line.push_back(i % step == 0 || i == count - 1 ? 1 : 0);
    }
  }
  int after(int i) const { return std::min(below[i] + 1, static_cast<int>(at.size()) - 1); }
};

__attribute__((always_inline)) inline float between(float a, float b, float weight) {
  const float mixed = a + weight * (b - a);
  const float nearer = weight < 0.5f ? a : b;
  return std::fabs(mixed) < HUGE_VALF ? mixed : nearer;  // false for NaN
}

EMSCAPE_SIMD_CLONES void mixRows(const float* a, const float* b, float weight, int count, float* out) {
#pragma omp simd
  for (int i = 0; i < count; ++i) out[i] = between(a[i], b[i], weight);
}

EMSCAPE_SIMD_CLONES void storeCodes(const float* values, int count, ExcessCode* codes) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float rounded = values[i] + (values[i] < 0 ? -0.5f : 0.5f);
    codes[i] = values[i] == values[i] ? static_cast<ExcessCode>(static_cast<int>(rounded)) : kUnknownExcess;
  }
}

/// Fills one layer.
/// @param valueAt(x, y)       of a column of the part
/// @param store(y, values)    takes a row
template <class ValueAt, class Store>
void fillLayer(const PartLines& columns, const PartLines& rows, const ValueAt& valueAt, const Store& store) {
  const int width = static_cast<int>(columns.below.size()), height = static_cast<int>(rows.below.size());
  std::vector<float> lines(columns.at.size()), low(width), high(width), out(width);
  const auto read = [&](int y, std::vector<float>& row) {
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i] = valueAt(columns.at[i], y);
    for (int x = 0; x < width; ++x)
      row[x] = between(lines[columns.below[x]], lines[columns.after(x)], columns.weight[x]);
  };
  int of_low = -1;
  for (int y = 0; y < height; ++y) {
    if (rows.below[y] != of_low) {
      if (of_low >= 0 && rows.below[y] == of_low + 1) {
        std::swap(low, high);
      } else {
        read(rows.at[rows.below[y]], low);
      }
      of_low = rows.below[y];
      read(rows.at[rows.after(y)], high);
    }
    mixRows(low.data(), high.data(), rows.weight[y], width, out.data());
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
    if (!rows.is_line[y]) {
      std::copy_n(values, width, row);
      return;
    }
    for (int x = 0; x < width; ++x) {
      if (!columns.is_line[x]) row[x] = values[x];
    }
  };
  fillLayer(
      columns, rows, [&](int x, int y) { return out.shadow_edge_m[indexOf(x, y)]; },
      [&](int y, const float* edges_m) { storeOthers(y, edges_m, out.shadow_edge_m + indexOf(0, y)); });
  if (out.excess.codes == nullptr) return;
  parallelFor(grid.layers, 1, [&](int begin, int end) {
    std::vector<ExcessCode> codes(width);
    for (int k = begin; k < end; ++k) {
      const auto valueAt = [&](int x, int y) {
        const std::size_t column = indexOf(x, y);
        if (grid.isLeftOut(column)) return NAN;
        const int above = std::min(std::max(k, grid.firstValid(column)), grid.layers - 1);
        const ExcessCode code =
            out.excess.codes[static_cast<std::size_t>(above) * grid.column_count + column];
        return code == kUnknownExcess ? NAN : static_cast<float>(code);
      };
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
