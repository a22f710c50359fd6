/// Searching texts.
#pragma once

#include <string_view>

namespace emscape::view {

/// True if a text contains what is typed, in any script and whatever the case of its letters; blanks at the
/// ends of what is typed do not count.
bool isFound(std::string_view typed, std::string_view text);

}  // namespace emscape::view
