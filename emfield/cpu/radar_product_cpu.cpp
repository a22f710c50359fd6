#include <vector>

#include "base/parallel.h"
#include "emfield/radar_product.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

template <PatternKind kind>
void addRows(const RadarPass& pass, int begin, int end) {
  for (int j = begin; j < end; ++j) {
    for (int k = pass.first_row_k == nullptr ? 0 : pass.first_row_k[j]; k < pass.dims.z; ++k) {
      const std::size_t first = static_cast<std::size_t>(j) * pass.dims.x;
      for (int i = 0; i < pass.dims.x; ++i) addEcho<kind>(pass, first + i, k);
    }
  }
}

}  // namespace

void radarCpu(const RadarPass& pass) {
  parallelFor(pass.dims.y, 1, [&](int begin, int end) {
    switch (pass.beam.pattern.kind) {
      case PatternKind::isotropic:
        return addRows<PatternKind::isotropic>(pass, begin, end);
      case PatternKind::gaussian:
        return addRows<PatternKind::gaussian>(pass, begin, end);
      case PatternKind::separable:
        return addRows<PatternKind::separable>(pass, begin, end);
      case PatternKind::phased_array:
        return addRows<PatternKind::phased_array>(pass, begin, end);
      case PatternKind::grid:
        return addRows<PatternKind::grid>(pass, begin, end);
    }
  });
}

}  // namespace emscape::emfield
