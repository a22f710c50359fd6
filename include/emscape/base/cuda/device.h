/// The GPU that this program uses, if there is one.
#pragma once

#include <cstddef>
#include <string>

namespace emscape {

/// A GPU, and whether it is usable.
struct Device {
  bool usable = false;
  std::string why_not;  ///< reason why it is not usable, as a phrase that follows a colon; empty if it is
  std::string name;     ///< product name, as the driver reports it
  std::size_t total_bytes = 0;
  std::size_t free_bytes = 0;  ///< at the time of the call
};

/// CUDA version and target architectures of this build: "CUDA 13.0 for 80-real, 90"; empty without CUDA.
std::string cudaOfBuild();

/// The GPU of the calling thread: the first one of the system, unless the program has chosen another. Later
/// calls query only free_bytes again.
Device findDevice();

/// Sets over how many GPUs of the system a field is shared out, from the next one that is made; 0: all. One
/// at the start of the program.
void setDeviceLimit(int devices);
/// That number. @throws Error (device) if the system has fewer GPUs
int deviceCount();

}  // namespace emscape
