#include "base/limits/address_limit.h"

#include <malloc.h>
#include <sys/resource.h>

namespace emscape {

std::optional<std::size_t> addressLimit_bytes() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return limit.rlim_cur;
}

void spareAddresses() {
  if (hasAddressLimit()) mallopt(M_ARENA_MAX, 1);
}

}  // namespace emscape
