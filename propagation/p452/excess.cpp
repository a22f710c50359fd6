#include "propagation/p452/excess.h"

#include "base/math/simd.h"

namespace emscape::propagation {
namespace {

EMSCAPE_SIMD_CLONES unsigned fillP452(const P452Excess& excess, const ExcessColumn& column,
                                      const ExcessScratch& scratch, float* excess_db) {
  return excess.fillColumn(column, scratch, excess_db);
}

}  // namespace

template <>
unsigned P452Excess::operator()(const ExcessColumn& column, const ExcessScratch& scratch,
                                float* excess_db) const {
  return fillP452(*this, column, scratch, excess_db);
}

}  // namespace emscape::propagation
