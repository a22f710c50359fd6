/// A limit on the process's address space (ulimit -v).
#pragma once

#include <cstddef>
#include <optional>

namespace emscape {

/// None without a limit.
std::optional<std::size_t> addressLimit_bytes();

inline bool hasAddressLimit() {
  return addressLimit_bytes().has_value();
}

/// Where there is one, all threads share one store of malloc(), of which each would otherwise reserve 64 MiB
/// for its own. To be called before threads start.
void spareAddresses();

}  // namespace emscape
