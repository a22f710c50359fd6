/// Arithmetic of premultiplied colours. Single source for host and device.
#pragma once

#include <cstdint>

#include "base/math/device_math.h"
#include "emscape/base/host_device.h"
#include "emscape/render/picture/image.h"

namespace emscape::render {

EMSCAPE_HD inline Rgba operator+(const Rgba& p, const Rgba& q) {
  return {p.r + q.r, p.g + q.g, p.b + q.b, p.a + q.a};
}
EMSCAPE_HD inline Rgba operator*(const Rgba& p, float s) {
  return {p.r * s, p.g * s, p.b * s, p.a * s};
}
/// p * s + q.
EMSCAPE_HD inline Rgba addScaled(const Rgba& p, float s, const Rgba& q) {
  return {multiplyAdd(p.r, s, q.r), multiplyAdd(p.g, s, q.g), multiplyAdd(p.b, s, q.b),
          multiplyAdd(p.a, s, q.a)};
}
/// `front` over `back`.
EMSCAPE_HD inline Rgba over(const Rgba& front, const Rgba& back) {
  return addScaled(back, 1.0F - front.a, front);
}

/// One level of 0..255, rounded to nearest; values outside 0..1 are clamped, NaN is 0.
EMSCAPE_HD inline std::uint8_t quantized(float value) {
#if defined(__CUDA_ARCH__)
  return static_cast<std::uint8_t>(__saturatef(value) * 255.0F + 0.5F);  // clamped by the instruction before
#else
  const float level = value * 255.0F + 0.5F;
  return level > 0.0F ? static_cast<std::uint8_t>(level < 255.0F ? level : 255.0F) : std::uint8_t{0};
#endif
}

}  // namespace emscape::render
