/// The host's memory.
#pragma once

#include <cstddef>
#include <optional>

namespace emscape {

/// Memory (bytes) that the process can still take without swapping: what the system calls available, within
/// the limits of the process's control group and address space. None where the system does not say.
std::optional<std::size_t> availableMemory_bytes();

}  // namespace emscape
