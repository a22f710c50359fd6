/// Reads the bytes of a file in order, with bounds checks. Internal to the module.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include "emscape/base/error.h"

namespace emscape::volume {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "the files of this module are read and written in memory order");

class ByteReader {
 public:
  /// @param file  name for messages; the bytes must outlive the reader
  ByteReader(std::string file, const std::uint8_t* bytes, std::uint64_t size)
      : file_(std::move(file)), bytes_(bytes), size_(size) {}

  std::uint64_t position() const { return position_; }
  std::uint64_t size() const { return size_; }
  std::uint64_t left() const { return size_ - position_; }
  const std::string& file() const { return file_; }
  const std::uint8_t* here() const { return bytes_ + position_; }

  /// Skips `count` bytes and returns a pointer to them. @param what  names them in the message
  const std::uint8_t* take(std::uint64_t count, const char* what) {
    if (count > left()) {
      fail(std::string(what) + " needs " + std::to_string(count) + " bytes at offset " +
           std::to_string(position_) + ", the file has " + std::to_string(left()) + " left");
    }
    const std::uint8_t* begin = here();
    position_ += count;
    return begin;
  }

  template <class Value>
  Value value(const char* what) {
    static_assert(std::is_trivially_copyable_v<Value>, "read by copying bytes");
    Value result;
    std::memcpy(&result, take(sizeof(Value), what), sizeof(Value));
    return result;
  }

  /// A text preceded by its length in 32 bits.
  std::string text(const char* what) {
    const auto length = value<std::uint32_t>(what);
    const std::uint8_t* begin = take(length, what);
    return {reinterpret_cast<const char*>(begin), length};
  }

  void seek(std::uint64_t position, const char* what) {
    if (position > size_) {
      fail(std::string(what) + " at offset " + std::to_string(position) + ", the file has " +
           std::to_string(size_) + " bytes");
    }
    position_ = position;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::bad_input, {file_}, "truncated or damaged: " + what);
  }

 private:
  std::string file_;
  const std::uint8_t* bytes_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;
};

}  // namespace emscape::volume
