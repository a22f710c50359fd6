#include "propagation/p1812/excess.h"

#include "base/math/simd.h"

namespace emscape::propagation {
namespace {

EMSCAPE_SIMD_CLONES unsigned fillP1812(const P1812Excess& excess, const ExcessColumn& column,
                                       const ExcessScratch& scratch, float* excess_db) {
  return excess.fillColumn(column, scratch, excess_db);
}

}  // namespace

template <>
unsigned P1812Excess::operator()(const ExcessColumn& column, const ExcessScratch& scratch,
                                 float* excess_db) const {
  return fillP1812(*this, column, scratch, excess_db);
}

}  // namespace emscape::propagation
