/// Characters of UTF-8 text.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace emscape {

/// Bytes of the UTF-8 sequence that begins at `text[0]`; 0 if none begins there (RFC 3629: no overlong forms,
/// no surrogates).
/// @param text  not empty
std::size_t utf8SequenceLength(std::string_view text);

/// The code point of one sequence, of the length that utf8SequenceLength() tells.
char32_t codePointOf(std::string_view sequence);

/// The first control character (U+0000..001F, such as tabs and line ends, and U+007F..009F) or noncharacter
/// (U+FDD0..FDEF, and the last two of each plane) of UTF-8 text.
std::optional<char32_t> firstUnprintable(std::string_view text);

/// UTF-8 text that XML 1.0 can contain: bytes that are not UTF-8 and characters that XML does not allow
/// become U+FFFD.
std::string xmlCharacters(std::string_view text);

}  // namespace emscape
