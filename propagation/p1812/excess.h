/// Excess of the model `p1812` over columns.
#pragma once

#include "propagation/clear_air/excess.h"
#include "propagation/p1812/p1812.h"

namespace emscape::propagation {

using P1812Excess = ClearAirExcess<P1812Model<float>>;
template <>
unsigned P1812Excess::operator()(const ExcessColumn&, const ExcessScratch&, float* excess_db) const;

}  // namespace emscape::propagation
