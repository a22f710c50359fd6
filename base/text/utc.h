/// UTC times as text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace emscape {

/// Milliseconds from 1970-01-01T00:00:00Z to an ISO 8601 time "YYYY-MM-DDTHH:MM:SS[.fraction]Z", with a blank
/// for the T and an offset from UTC ("+02:00", "+0200", "+02") for the Z as well (years 1..9999, no leap
/// seconds, the fraction truncated to milliseconds); empty if the text is not such a time.
std::optional<std::int64_t> parseUtc_ms(const std::string& text);

/// The number of such a text that is out of range: "month 13 is outside 1 to 12". Empty if there is none or
/// the text has another form.
std::string utcFault(const std::string& text);

/// ISO 8601 text, with milliseconds, of a time in milliseconds from 1970-01-01T00:00:00Z.
std::string utcText(std::int64_t time_ms);

}  // namespace emscape
