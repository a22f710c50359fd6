/// The text of an exception for the user.
#pragma once

#include <exception>
#include <new>
#include <string>

namespace emscape {

/// what(), or a readable text for std::bad_alloc.
inline std::string failureText(const std::exception& failure) {
  return dynamic_cast<const std::bad_alloc*>(&failure) != nullptr ? "out of memory" : failure.what();
}

}  // namespace emscape
