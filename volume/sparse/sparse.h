/// Limits of the conversion of sparse grids to dense volumes. Internal to the module.
#pragma once

#include <string>

#include "base/memory.h"
#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// A file of another program may be so sparse that the box of its active voxels is very large, or have large
/// tiles of one value. Beyond kAlwaysDense voxels at least one in kSparsest must be stored; else the file is
/// probably damaged.
/// @param stored  number of active voxels and tiles with a value in the file
/// @throws Error (bad_input) at `location`
inline void checkSparseness(const Dims& dims, std::uint64_t stored, const SourceLocation& location) {
  constexpr long long kAlwaysDense = 1LL << 27;
  constexpr std::uint64_t kSparsest = 1000;
  checkDims(dims, location);
  if (dims.count() > kAlwaysDense && static_cast<std::uint64_t>(dims.count()) / kSparsest > stored) {
    throw Error(ErrorCode::bad_input, location,
                "the box of the active voxels holds " + std::to_string(dims.count()) +
                    " voxels, but the file stores only " + std::to_string(stored) +
                    " values for them: too sparse to be made dense");
  }
}

/// Checks that there is memory for the values of a dense volume, however small the file is.
/// @throws Error (other) at `location`
inline void requireDenseMemory(const Dims& dims, const SourceLocation& location) {
  checkDims(dims, location);
  requireMemory({"a dense volume of " + std::to_string(dims.x) + " x " + std::to_string(dims.y) + " x " +
                     std::to_string(dims.z) + " voxels",
                 sizeof(float) * static_cast<std::size_t>(dims.count()), "a coarser grid takes less"},
                location);
}

}  // namespace emscape::volume
