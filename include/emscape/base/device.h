/// The GPU that computes, if there is one.
#pragma once

#include <cstddef>
#include <string>

namespace emscape {

/// A GPU that answers.
struct Device {
  bool usable = false;
  std::string why_not;  ///< where it is not: as half a sentence
  std::string name;     ///< of the product
  std::size_t total_bytes = 0;
  std::size_t free_bytes = 0;  ///< when it was asked
};

/// What of CUDA is in this build: "CUDA 13.0 for 80-real, 90"; empty for nothing.
std::string cudaOfBuild();

/// The first GPU of the system that this program can use. Cheap after the first call but for free_bytes.
Device findDevice();

}  // namespace emscape
