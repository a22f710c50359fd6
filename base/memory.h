/// The host's memory.
#pragma once

#include <cstddef>
#include <optional>

namespace emscape {

/// Memory (bytes) that the process can still take without swapping: the system's available memory, within the
/// limits of the process's control group and address space. None if the system does not report it.
std::optional<std::size_t> availableMemory_bytes();

}  // namespace emscape
