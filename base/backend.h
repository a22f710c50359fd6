/// Which processor does the work: what was asked for, and what that comes to on this machine.
#pragma once

#include <cstddef>
#include <string>

#include "base/device.h"

namespace emscape {

enum class Backend {
  automatic,  ///< a wish: the GPU if there is one that can, else the CPU
  cpu,
  cuda
};

/// "auto", "cpu" or "cuda".
const char* toString(Backend backend);
/// @throws Error (usage) for any other name
Backend parseBackend(const std::string& name);

/// A wish come true.
struct BackendChoice {
  Backend backend = Backend::cpu;  ///< cpu or cuda
  std::string device = "cpu";      ///< for reports: "cpu", or the name of the GPU
  std::string note;                ///< where the wish left it open: in a line, what was taken and why
};

/// @param device        what findDevice() found
/// @param needed_bytes  of its memory that must be free
/// @throws Error (device) if cuda is asked for and the device cannot do it
BackendChoice resolveBackend(Backend wish, const Device& device, std::size_t needed_bytes = 0);

/// Asks findDevice(), unless the CPU is asked for.
BackendChoice resolveBackend(Backend wish, std::size_t needed_bytes = 0);

}  // namespace emscape
