/// Excess of the model `p452` over columns.
#pragma once

#include "propagation/clear_air/excess.h"
#include "propagation/p452/p452.h"

namespace emscape::propagation {

using P452Excess = ClearAirExcess<P452Model<float>>;
template <>
unsigned P452Excess::operator()(const ExcessColumn&, const ExcessScratch&, float* excess_db) const;

}  // namespace emscape::propagation
