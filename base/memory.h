/// The host's memory.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "emscape/base/error.h"

namespace emscape {

/// Memory (bytes) that the process can still take without swapping: the system's available memory, within the
/// limits of the process's control group and address space. None if the system does not report it.
std::optional<std::size_t> availableMemory_bytes();

/// A task that needs memory.
struct MemoryNeed {
  std::string what;              ///< "the mesh of 600 tetrahedra"
  std::size_t needed_bytes = 0;  ///< upper bound
  std::string remedy;            ///< "fewer layers take less"
};

/// "WHAT needs up to 12 MiB of the host's memory, of which 3 MiB are free; REMEDY"
/// @param whose  "host's" or "GPU's"
std::string memoryShortage(const MemoryNeed& need, const char* whose, std::size_t free_bytes);

/// Checks a need for memory that may exceed availableMemory_bytes(), before the allocation.
/// @throws Error (other) with memoryShortage() if it does
void requireMemory(const MemoryNeed& need, const SourceLocation& location);

}  // namespace emscape
