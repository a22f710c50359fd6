/// Begin and end of the values of a document in its text.
#pragma once

#include <cstddef>
#include <string_view>

#include "document/document.h"

namespace emscape::document {

/// Bytes [begin, end) of a text.
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The text of a value with everything in it, without the comment that follows it.
/// @pre the value is not null
/// @throws Error (bad_input), without a location, if an anchor or an alias hides it
Span spanOf(std::string_view text, const DocumentNode& node);

/// The value of a key; for a null that is not written, the empty span after the colon.
Span valueSpanOf(std::string_view text, const MapEntry& entry);

/// The byte after the colon of a key.
std::size_t afterColon(std::string_view text, const MapEntry& entry);

/// True if a map or list is written in brackets.
bool isFlow(std::string_view text, const DocumentNode& node);

}  // namespace emscape::document
