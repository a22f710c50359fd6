/// Vectors without initialization, for large arrays that are written before they are read.
#pragma once

#include <cstddef>
#include <limits>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace emscape {

/// Allocates uninitialized memory. Large blocks use huge pages where the system has them, which saves most
/// page faults.
/// @throws std::bad_alloc
void* allocateUnset(std::size_t bytes);
void freeUnset(void* memory);

/// Leaves new elements uninitialized, so that the threads that fill a large array touch its memory first.
template <class T>
struct UnsetAllocator {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  using value_type = T;

  UnsetAllocator() = default;
  template <class U>
  UnsetAllocator(const UnsetAllocator<U>&) {}

  T* allocate(std::size_t count) {
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_alloc();
    return static_cast<T*>(allocateUnset(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t) { freeUnset(memory); }
  template <class U>
  void construct(U*) {}
  template <class U, class... Args>
  void construct(U* at, Args&&... args) {
    ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
  }
};

template <class A, class B>
bool operator==(const UnsetAllocator<A>&, const UnsetAllocator<B>&) {
  return true;
}
template <class A, class B>
bool operator!=(const UnsetAllocator<A>&, const UnsetAllocator<B>&) {
  return false;
}

/// A vector whose new elements are uninitialized.
template <class T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace emscape
