#include "emscape/base/unset_vector.h"

#include <sys/mman.h>

#include <cstdlib>

namespace emscape {

void* allocateUnset(std::size_t bytes) {
  constexpr std::size_t kLargePage = std::size_t{2} << 20, kAlignment = 64;
  const bool is_large = bytes >= 2 * kLargePage;
  const std::size_t unit = is_large ? kLargePage : kAlignment;
  if (bytes > static_cast<std::size_t>(-1) - unit) throw std::bad_alloc();
  const std::size_t rounded = (bytes + unit - 1) / unit * unit;
  void* const memory = std::aligned_alloc(unit, rounded > 0 ? rounded : unit);
  if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  if (is_large) static_cast<void>(madvise(memory, rounded, MADV_HUGEPAGE));  // also valid without
#endif
  return memory;
}

void freeUnset(void* memory) {
  std::free(memory);
}

}  // namespace emscape
