/// Texts and numbers in recordings.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace emscape::interop {

/// Without blanks, tabs and line ends around it.
std::string_view trimmed(std::string_view text);

/// The number that a text is, blanks around it apart; none for another text, infinities and NaN.
std::optional<double> numberIn(std::string_view text);

/// ASCII letters in lower case.
std::string lowerCase(std::string text);

/// @param is_beginning  the last character may be cut
bool isUtf8(std::string_view text, bool is_beginning = false);
/// The encoding that an XML file states at its beginning; empty: none.
std::string declaredEncoding(std::string_view text);
/// A text in another encoding as UTF-8. Bytes without a meaning in it are taken as Latin-1, so that different
/// texts stay different; so is all of a text in an encoding that the system does not know.
/// @param encoding  empty: none is stated
/// @param told  receives, in words, what was taken as Latin-1, with the remedy; may be null
std::string utf8Of(std::string_view text, const std::string& encoding, std::string* told = nullptr);

/// A text that can be a name: control characters are blanks, at most 150 bytes.
std::string printableText(std::string_view text);

/// The words of a line. Blanks and tabs separate them; a text in double quotes is one word.
/// @param comments  beginnings of comments, outside of quotes
std::vector<std::string> wordsOf(std::string_view line, const std::vector<std::string_view>& comments = {});

}  // namespace emscape::interop
