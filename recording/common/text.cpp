#include "recording/common/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "base/text/utc.h"
#include "base/text/utf8.h"

namespace emscape::interop {
namespace {

constexpr std::size_t kLongestName = 150;

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto isBlank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> numberIn(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string printableText(std::string_view text) {
  std::string value(text);
  for (char& c : value) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  }
  value = xmlCharacters(value);
  if (value.size() > kLongestName) value = xmlCharacters(value.substr(0, kLongestName));
  return value;
}

std::vector<std::string> wordsOf(std::string_view line, const std::vector<std::string_view>& comments) {
  std::vector<std::string> words;
  std::size_t at = 0;
  while (at < line.size()) {
    if (line[at] == ' ' || line[at] == '\t' || line[at] == '\r') {
      ++at;
      continue;
    }
    const std::string_view rest = line.substr(at);
    const bool is_comment = std::any_of(comments.begin(), comments.end(), [&](std::string_view begin) {
      return rest.substr(0, begin.size()) == begin;
    });
    if (is_comment) break;
    if (rest.front() == '"') {
      const std::size_t end = std::min(rest.find('"', 1), rest.size());
      words.emplace_back(rest.substr(1, end - 1));
      at += std::min(end + 1, rest.size());
    } else {
      const std::size_t end = std::min(rest.find_first_of(" \t\r"), rest.size());
      words.emplace_back(rest.substr(0, end));
      at += end;
    }
  }
  return words;
}

std::optional<double> utcSeconds(std::string_view text) {
  text = trimmed(text);
  double offset_s = 0;
  std::string utc(text);
  if (utc.size() < 19) return std::nullopt;
  const std::size_t sign = utc.find_first_of("+-", 19);
  if (sign != std::string::npos) {
    std::string digits = utc.substr(sign + 1);
    digits.erase(std::remove(digits.begin(), digits.end(), ':'), digits.end());
    const bool is_sound = (digits.size() == 2 || digits.size() == 4) &&
                          digits.find_first_not_of("0123456789") == std::string::npos;
    if (!is_sound) return std::nullopt;
    digits.resize(4, '0');
    offset_s = 3600 * std::stoi(digits.substr(0, 2)) + 60 * std::stoi(digits.substr(2, 2));
    if (utc[sign] == '-') offset_s = -offset_s;
    utc.resize(sign);
  }
  if (utc.back() != 'Z') utc += 'Z';
  const auto time_ms = parseUtc_ms(utc);
  if (!time_ms) return std::nullopt;
  return static_cast<double>(*time_ms) / 1000 - offset_s;
}

std::string utcTextOf(double utc_s) {
  return utcText(std::llround(utc_s * 1000));
}

int monthOf(std::string_view name) {
  constexpr std::array kMonths{"jan", "feb", "mar", "apr", "may", "jun",
                               "jul", "aug", "sep", "oct", "nov", "dec"};
  const std::string begin = lowerCase(std::string(name.substr(0, 3)));
  const auto* const found = std::find(kMonths.begin(), kMonths.end(), begin);
  return found == kMonths.end() ? 0 : static_cast<int>(found - kMonths.begin()) + 1;
}

double secondsOfDate(int year, int month, int day) {
  // Days of the proleptic Gregorian calendar; years begin in March.
  const int y = year - (month <= 2 ? 1 : 0);
  const int era = (y >= 0 ? y : y - 399) / 400;
  const int year_of_era = y - era * 400;
  const int day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const int day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return 86400.0 * (static_cast<double>(era) * 146097 + day_of_era - 719468);
}

}  // namespace emscape::interop
