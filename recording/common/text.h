/// Texts, numbers and times in recordings.
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

/// A text that can be a name: control characters are blanks, at most 150 bytes.
std::string printableText(std::string_view text);

/// The words of a line. Blanks and tabs separate them; a text in double quotes is one word.
/// @param comments  beginnings of comments, outside of quotes
std::vector<std::string> wordsOf(std::string_view line, const std::vector<std::string_view>& comments = {});

/// Seconds from 1970-01-01T00:00:00Z to an ISO 8601 time with a Z, an offset (+02:00) or none, which is UTC.
std::optional<double> utcSeconds(std::string_view text);

/// The date and time of seconds from 1970 as ISO 8601 with milliseconds.
std::string utcTextOf(double utc_s);

/// Number of a month by the first three letters of its English name, 1..12; 0 for another text.
int monthOf(std::string_view name);

/// Seconds from 1970 to a UTC date. @param month  1..12
double secondsOfDate(int year, int month, int day);

}  // namespace emscape::interop
