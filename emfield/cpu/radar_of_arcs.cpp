#include "emfield/cpu/radar_of_arcs.h"

#include "emscape/base/parallel.h"
#include "emscape/base/work.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

template <PatternKind kind>
void addRow(const RadarPass& pass, int j, int k) {
  const std::size_t column = static_cast<std::size_t>(j) * pass.dims.x;
  for (int i = 0; i < pass.dims.x; ++i) addEcho<kind>(pass, column + i, k);
}

}  // namespace

void radarOfArcsCpu(const RadarPass& pass) {
  parallelFor(pass.dims.y, 1, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int k = pass.first_row_k == nullptr ? 0 : pass.first_row_k[j]; k < pass.dims.z; ++k) {
        checkpoint();
        onPattern(pass.beam.pattern, [&](auto kind) { addRow<kind>(pass, j, k); });
      }
    }
  });
}

}  // namespace emscape::emfield
