#include "emfield/cpu/radar_of_arcs.h"

#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

template <PatternKind kind>
void addRow(const RadarPass& pass, int j, int k) {
  const std::size_t column = static_cast<std::size_t>(j) * pass.dims.x;
  const bool is_age = pass.task.measure == RadarMeasure::detection_age;
  for (int i = 0; i < pass.dims.x; ++i) {
    if (is_age) {
      addEcho<kind, true, true, true>(pass, column + i, k);
    } else {
      addEcho<kind>(pass, column + i, k);
    }
  }
}

void addRowOfAnyPattern(const RadarPass& pass, int j, int k) {
  switch (pass.beam.pattern.kind) {
    case PatternKind::isotropic:
      return addRow<PatternKind::isotropic>(pass, j, k);
    case PatternKind::gaussian:
      return addRow<PatternKind::gaussian>(pass, j, k);
    case PatternKind::separable:
      return addRow<PatternKind::separable>(pass, j, k);
    case PatternKind::phased_array:
      return addRow<PatternKind::phased_array>(pass, j, k);
    case PatternKind::grid:
      return addRow<PatternKind::grid>(pass, j, k);
  }
}

}  // namespace

void radarOfArcsCpu(const RadarPass& pass) {
  parallelFor(pass.dims.y, 1, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int k = pass.first_row_k == nullptr ? 0 : pass.first_row_k[j]; k < pass.dims.z; ++k)
        addRowOfAnyPattern(pass, j, k);
    }
  });
}

}  // namespace emscape::emfield
