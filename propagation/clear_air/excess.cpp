#include "propagation/clear_air/excess.h"

#include "base/math/simd.h"
#include "propagation/p1812/excess.h"
#include "propagation/p452/excess.h"

namespace emscape::propagation {
namespace {

template <class Model>
inline unsigned fillColumn(const ClearAirExcess<Model>& excess, const ExcessColumn& column,
                           const ExcessScratch& scratch, float* excess_db) {
  const unsigned warnings = excess.begin(column, scratch, excess_db);
  if (warnings != 0) return warnings;
  return excess.fill(column, scratch, {0, column.count, scratch.other_db}, excess_db);
}

EMSCAPE_SIMD_CLONES unsigned fillP1812(const P1812Excess& excess, const ExcessColumn& column,
                                       const ExcessScratch& scratch, float* excess_db) {
  return fillColumn(excess, column, scratch, excess_db);
}
EMSCAPE_SIMD_CLONES unsigned fillP452(const P452Excess& excess, const ExcessColumn& column,
                                      const ExcessScratch& scratch, float* excess_db) {
  return fillColumn(excess, column, scratch, excess_db);
}

}  // namespace

template <>
unsigned P1812Excess::operator()(const ExcessColumn& column, const ExcessScratch& scratch,
                                 float* excess_db) const {
  return fillP1812(*this, column, scratch, excess_db);
}
template <>
unsigned P452Excess::operator()(const ExcessColumn& column, const ExcessScratch& scratch,
                                float* excess_db) const {
  return fillP452(*this, column, scratch, excess_db);
}

}  // namespace emscape::propagation
