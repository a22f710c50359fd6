#include "emfield/cpu/apply_excess.h"

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

EMSCAPE_SIMD_CLONES void applyCodes(const ExcessCode* codes, int count, float* row) {
#pragma omp simd
  for (int i = 0; i < count; ++i) row[i] *= excessFactor(codes[i]);
}

EMSCAPE_SIMD_CLONES void applyDecibels(const float* excess_db, int count, float* row) {
#pragma omp simd
  for (int i = 0; i < count; ++i) row[i] *= excessFactor(excess_db[i]);
}

}  // namespace

void applyExcess(const ExcessView& excess, std::size_t first, int count, float* row) {
  if (excess.db != nullptr) {
    applyDecibels(excess.db + first, count, row);
  } else if (excess.codes != nullptr) {
    applyCodes(excess.codes + first, count, row);
  }
}

}  // namespace emscape::emfield
