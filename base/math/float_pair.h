/// Two neighbouring elements of an array, read at once: half as many look-ups for a vector loop that gathers
/// both.
#pragma once

#include <cstdint>

#include "base/math/fast_math.h"
#include "emscape/base/host_device.h"

namespace emscape {

struct FloatPair {
  float first, second;
};

EMSCAPE_HD inline FloatPair floatPair(const float* numbers) {
#ifdef __CUDA_ARCH__
  return {numbers[0], numbers[1]};
#else
  using Pair [[gnu::may_alias, gnu::aligned(4)]] = std::uint64_t;
  const std::uint64_t pair = *reinterpret_cast<const Pair*>(numbers);
  return {fast_math_detail::floatOf(static_cast<std::uint32_t>(pair)),
          fast_math_detail::floatOf(static_cast<std::uint32_t>(pair >> 32))};
#endif
}

}  // namespace emscape
