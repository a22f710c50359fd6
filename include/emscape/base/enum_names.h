/// Names of the values of an enumeration, as in files, on the command line and in messages: written once,
/// beside it.
///
///     enum class Polarity { north, south };
///     constexpr auto namesOf(Polarity) { return std::array{"north", "south"}; }
///     using emscape::toString;
#pragma once

#include <cstddef>
#include <string>
#include <type_traits>

#include "emscape/base/error.h"

namespace emscape {

/// @param value  of an enumeration that has namesOf() and whose values count from 0
template <class Enum>
constexpr auto toString(Enum value) -> std::decay_t<decltype(namesOf(value)[0])> {
  return namesOf(value)[static_cast<std::size_t>(value)];
}

/// @param what  noun of the value for the message
/// @throws Error (usage) that lists the allowed names
template <class Enum>
Enum parseName(const char* what, const std::string& name) {
  std::string allowed;
  std::size_t index = 0;
  for (const char* known : namesOf(Enum())) {
    if (name == known) return static_cast<Enum>(index);
    allowed += (index++ == 0 ? "" : ", ") + std::string(known);
  }
  throw Error(ErrorCode::usage, "unknown " + std::string(what) + " '" + name + "': expected " + allowed);
}

}  // namespace emscape
