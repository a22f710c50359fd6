/// Compositing of premultiplied pixels of four bytes. Single source for host and device.
#pragma once

#include <cstdint>

#include "emscape/base/host_device.h"

namespace emscape::render {

/// `front` over `back`: each byte is rounded to nearest and clamped. Alpha is the highest byte; the order of
/// the others is arbitrary but equal in both.
EMSCAPE_HD inline std::uint32_t bytesOver(std::uint32_t front, std::uint32_t back) {
  constexpr std::uint32_t kPair = 0x00FF00FFU;  // two bytes, each with room for carries
  const std::uint32_t clear = 255 - (front >> 24);
  const auto pairOver = [clear](std::uint32_t front_pair, std::uint32_t back_pair) {
    std::uint32_t seen = back_pair * clear + 0x00800080U;
    seen = (seen + (seen >> 8 & kPair)) >> 8 & kPair;  // divided by 255
    const std::uint32_t sum = front_pair + seen;
    return (sum | (sum >> 8 & 0x00010001U) * 255) & kPair;
  };
  return pairOver(front & kPair, back & kPair) | pairOver(front >> 8 & kPair, back >> 8 & kPair) << 8;
}

/// Converts 0xAARRGGBB to 0xAABBGGRR, which is r g b a in memory, and back.
EMSCAPE_HD inline std::uint32_t redAndBlueSwapped(std::uint32_t pixel) {
  return (pixel & 0xFF00FF00U) | (pixel >> 16 & 0xFFU) | (pixel & 0xFFU) << 16;
}

}  // namespace emscape::render
