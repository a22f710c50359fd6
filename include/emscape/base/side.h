/// Sides of a battlefield.
#pragma once

#include <array>

namespace emscape {

/// Side of a platform, as the standard identities of MIL-STD-2525 and APP-6.
enum class Side { friendly, hostile, neutral, unknown };
constexpr auto namesOf(Side) {
  return std::array{"friend", "hostile", "neutral", "unknown"};
}

}  // namespace emscape
