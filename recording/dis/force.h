/// Forces of entities (SISO-REF-010, UID 6) and sides.
#pragma once

#include <array>
#include <cstdint>

#include "emscape/base/side.h"

namespace emscape::interop::dis {

/// Sides of the forces from 0 (other) on.
constexpr std::array kSideOfForce{Side::unknown, Side::friendly, Side::hostile, Side::neutral};

constexpr Side sideOf(std::uint8_t force) {
  return force < kSideOfForce.size() ? kSideOfForce[force] : Side::unknown;
}

constexpr std::uint8_t forceOf(Side side) {
  std::uint8_t force = 0;
  while (kSideOfForce[force] != side) ++force;
  return force;
}

}  // namespace emscape::interop::dis
