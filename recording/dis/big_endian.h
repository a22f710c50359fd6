/// Numbers in network byte order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "emscape/base/vec.h"

namespace emscape::interop::dis {

/// Reads numbers one after another. Beyond the end they are 0 and the reader is not sound.
class BigEndianReader {
 public:
  BigEndianReader(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size) {}

  bool isSound() const { return is_sound_; }
  std::size_t offset() const { return at_; }
  std::size_t left() const { return size_ - at_; }
  void skip(std::size_t count) { take(count); }

  std::uint8_t u8() { return static_cast<std::uint8_t>(whole(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(whole(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(whole(4)); }
  std::uint64_t u64() { return whole(8); }
  float f32() {
    const std::uint32_t bits = u32();
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  double f64() {
    const std::uint64_t bits = u64();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  Vec3d floats() {
    const double x = f32(), y = f32(), z = f32();
    return {x, y, z};
  }
  Vec3d doubles() {
    const double x = f64(), y = f64(), z = f64();
    return {x, y, z};
  }

 private:
  const std::uint8_t* take(std::size_t count) {
    if (count > left()) {
      is_sound_ = false;
      at_ = size_;
      return nullptr;
    }
    at_ += count;
    return bytes_ + (at_ - count);
  }
  std::uint64_t whole(std::size_t count) {
    const std::uint8_t* const bytes = take(count);
    std::uint64_t value = 0;
    for (std::size_t i = 0; bytes != nullptr && i < count; ++i) value = (value << 8) | bytes[i];
    return value;
  }

  const std::uint8_t* bytes_;
  std::size_t size_, at_ = 0;
  bool is_sound_ = true;
};

/// Appends numbers.
class BigEndianWriter {
 public:
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  std::vector<std::uint8_t>& bytes() { return bytes_; }

  void u8(std::uint64_t value) { whole(value, 1); }
  void u16(std::uint64_t value) { whole(value, 2); }
  void u32(std::uint64_t value) { whole(value, 4); }
  void u64(std::uint64_t value) { whole(value, 8); }
  void f32(double value) {
    const auto narrow = static_cast<float>(value);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &narrow, sizeof bits);
    u32(bits);
  }
  void f64(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    u64(bits);
  }
  void floats(const Vec3d& v) {
    f32(v.x);
    f32(v.y);
    f32(v.z);
  }
  void doubles(const Vec3d& v) {
    f64(v.x);
    f64(v.y);
    f64(v.z);
  }
  void zeros(std::size_t count) { bytes_.resize(bytes_.size() + count); }

 private:
  void whole(std::uint64_t value, int count) {
    for (int i = count - 1; i >= 0; --i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  std::vector<std::uint8_t> bytes_;
};

}  // namespace emscape::interop::dis
