/// Limit of sparseness for conversion to a dense volume. Internal to the module.
#pragma once

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// A file of another program may be so sparse that the box of its active voxels is very large. Beyond
/// kAlwaysDense voxels at least one in kSparsest must be active; else the file is probably damaged.
/// @throws Error (bad_input) at `location`
inline void checkSparseness(const Dims& dims, std::uint64_t active, const SourceLocation& location) {
  constexpr long long kAlwaysDense = 1LL << 27;
  constexpr std::uint64_t kSparsest = 1000;
  checkDims(dims, location);
  if (dims.count() > kAlwaysDense && static_cast<std::uint64_t>(dims.count()) / kSparsest > active) {
    throw Error(ErrorCode::bad_input, location,
                "the box of the active voxels holds " + std::to_string(dims.count()) +
                    " voxels, of which only " + std::to_string(active) +
                    " are active: too sparse to be made dense");
  }
}

}  // namespace emscape::volume
