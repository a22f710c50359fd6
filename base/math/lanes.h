/// Vectors of numbers in lanes (the vector extensions of GCC and Clang). They are parameters by reference: as
/// values they have no calling convention on all processors.
#pragma once

#include <cstring>

namespace emscape {

template <class Vector>
inline void load(const void* numbers, Vector& vector) {
  std::memcpy(&vector, numbers, sizeof vector);
}
template <class Vector>
inline void store(const Vector& vector, void* numbers) {
  std::memcpy(numbers, &vector, sizeof vector);
}

}  // namespace emscape
