/// Large amounts of memory and bytes: they are handled in parts, between which the work can be stopped.
#pragma once

#include <algorithm>
#include <cstddef>

#include "emscape/base/work.h"

namespace emscape {

/// Gives an array a size, with checkpoints: a gigabyte of new memory takes a second.
/// @throws Stopped
template <class Array>
void resizeInParts(Array& array, std::size_t size) {
  constexpr std::size_t kBytesAtOnce = std::size_t{4} << 20;
  constexpr std::size_t kItemsAtOnce = kBytesAtOnce / sizeof(typename Array::value_type);
  array.reserve(size);
  while (array.size() < size) {
    if (array.size() > 0) checkpoint();
    array.resize(std::min(size, array.size() + kItemsAtOnce));
  }
  array.resize(size);
}

/// Checkpoints of reading and writing, each after many bytes: small files, such as the records of what is
/// finished, are read and written whole also when the work is stopped.
class ByteCheckpoints {
 public:
  static constexpr std::size_t kBytes = std::size_t{8} << 20;

  /// @throws Stopped
  void add(std::size_t bytes) {
    since_ += bytes;
    if (since_ < kBytes) return;
    since_ = 0;
    checkpoint();
  }

 private:
  std::size_t since_ = 0;
};

}  // namespace emscape
