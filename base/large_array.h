/// Large amounts of memory and bytes: they are handled in parts, between which the work can be stopped.
#pragma once

#include <algorithm>
#include <cstddef>

#include "emscape/base/work.h"

namespace emscape {

/// Items of an array that are handled between two checkpoints.
template <class Array>
inline constexpr std::size_t kItemsAtOnce = (std::size_t{4} << 20) / sizeof(typename Array::value_type);

/// Gives an array a size, with checkpoints: a gigabyte of new memory takes a second.
/// @param value  of new items, if given
/// @throws Stopped
template <class Array, class... Value>
void resizeInParts(Array& array, std::size_t size, const Value&... value) {
  array.reserve(size);
  while (array.size() < size) {
    if (array.size() > 0) checkpoint();
    array.resize(std::min(size, array.size() + kItemsAtOnce<Array>), value...);
  }
  array.resize(size, value...);
}

/// Makes an array a copy of another one, with checkpoints. @throws Stopped
template <class Array>
void copyInParts(const Array& from, Array& to) {
  to.clear();
  to.reserve(from.size());
  while (to.size() < from.size()) {
    checkpoint();
    const auto next = from.begin() + static_cast<std::ptrdiff_t>(to.size());
    to.insert(to.end(), next,
              next + static_cast<std::ptrdiff_t>(std::min(kItemsAtOnce<Array>, from.size() - to.size())));
  }
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
