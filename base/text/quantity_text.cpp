#include "base/text/quantity_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace emscape {
namespace {

constexpr std::array<std::pair<const char*, double>, 8> kPrefixes{
    {{"T", 1e12}, {"G", 1e9}, {"M", 1e6}, {"k", 1e3}, {"", 1}, {"m", 1e-3}, {"u", 1e-6}, {"n", 1e-9}}};

bool takesPrefix(const std::string& unit) {
  return unit == "W" || unit == "Hz";
}

/// number * factor + offset is in the unit `of`.
struct OtherUnit {
  const char *of, *unit;
  double factor, offset = 0;
};
constexpr std::array<OtherUnit, 29> kOtherUnits{{
    {"m", "km", 1e3},
    {"m", "cm", 1e-2},
    {"m", "mm", 1e-3},
    {"m", "ft", 0.3048},
    {"m", "NM", 1852},
    {"m", "nm", 1852},
    {"m", "mi", 1609.344},
    {"m/s", "km/h", 1 / 3.6},
    {"m/s", "kt", 1852. / 3600},
    {"m/s", "kn", 1852. / 3600},
    {"s", "ms", 1e-3},
    {"s", "us", 1e-6},
    {"s", "µs", 1e-6},
    {"s", "ns", 1e-9},
    {"s", "min", 60},
    {"s", "h", 3600},
    {"K", "°C", 1, 273.15},
    {"K", "C", 1, 273.15},
    {"dBm", "dBW", 1, 30},
    {"dBi", "dB", 1},
    {"dBi", "dBd", 1, 2.15},
    {"hPa", "mbar", 1},
    {"hPa", "Pa", 1e-2},
    {"hPa", "kPa", 10},
    {"percent", "%", 1},
    {"rpm", "Hz", 60},
    {"rpm", "°/s", 1. / 6},
    {"rpm", "deg/s", 1. / 6},
    {"rpm", "1/min", 1},
}};

/// 10 log10(value in the unit `of`) + offset_db.
struct DecibelUnit {
  const char *of, *unit;
  double offset_db;
};
constexpr std::array<DecibelUnit, 4> kDecibelUnits{
    {{"W", "dBW", 0}, {"W", "dBm", 30}, {"m2", "dBsm", 0}, {"m2", "dBm2", 0}}};

/// ASCII letters in lower case.
std::string lowered(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

std::string withoutBlanks(std::string text) {
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

double rounded(double value, int digits) {
  return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
}

std::string numberText(double value, int digits) {
  // Six digits would write 1000000 as 1e+06.
  constexpr double kMaxPlain = 1e10;
  const double shown = rounded(value, digits);
  return std::abs(shown) < kMaxPlain && shown == std::round(shown) ? fmt::format("{:.0f}", shown + 0.0)
                                                                   : fmt::format("{:.{}g}", value, digits);
}

std::string withUnit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

}  // namespace

PrefixedUnit prefixedUnit(double value, const std::string& unit, int digits) {
  const double size = std::abs(rounded(value, digits));
  if (!takesPrefix(unit) || size == 0 || !std::isfinite(size)) return {unit, 1};
  for (const auto& [prefix, factor] : kPrefixes) {
    if (size >= factor) return {prefix + unit, factor};
  }
  return {kPrefixes.back().first + unit, kPrefixes.back().second};
}

std::string unitSigns(const std::string& unit) {
  std::string text = unit == "deg" ? "°" : unit == "percent" ? "%" : unit;
  if (text.compare(0, 4, "deg/") == 0) text = "°" + text.substr(3);
  for (const auto& [plain, sign] : {std::pair{"m2", "m²"}, std::pair{"m3", "m³"}}) {
    if (const std::size_t at = text.find(plain); at != std::string::npos) text.replace(at, 2, sign);
  }
  return text;
}

std::string readUnits(const std::string& unit) {
  if (unit.empty()) return "";
  std::string text = unitSigns(unit);
  const auto add = [&](const std::string& other) { text += ", " + unitSigns(other); };
  if (takesPrefix(unit)) {
    for (auto prefix = kPrefixes.rbegin(); prefix != kPrefixes.rend(); ++prefix) {
      const bool is_usual = prefix->second > 1 || (unit == "W" && prefix->second == 1e-3);
      if (is_usual) add(prefix->first + unit);
    }
  }
  for (const OtherUnit& other : kOtherUnits) {
    const auto first = std::find_if(kOtherUnits.begin(), kOtherUnits.end(), [&](const OtherUnit& each) {
      return std::string(each.of) == other.of && each.factor == other.factor && each.offset == other.offset;
    });
    if (unit == other.of && first->unit == other.unit) add(other.unit);
  }
  for (const DecibelUnit& other : kDecibelUnits) {
    if (unit == other.of && std::string(other.unit) != "dBm2") add(other.unit);
  }
  return text;
}

std::string quantityFault(const std::string& text, const std::string& units,
                          const std::function<bool(const std::string&)>& isRead) {
  if (const std::size_t comma = text.find(','); comma != std::string::npos) {
    std::string other = text;
    other[comma] = '.';
    std::string whole = text;  // the comma may divide thousands
    whole.erase(comma, 1);
    const std::size_t digits_end = std::min(text.size(), text.find_first_not_of("0123456789", comma + 1));
    if (digits_end == comma + 4 && isRead(whole))
      return fmt::format("'{}': {} or {}? A comma has no meaning", text, whole, other);
    if (isRead(other)) return fmt::format("'{}': a decimal point is needed, {}", text, other);
  }
  std::string joined;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool divides = text[i] == ' ' && i > 0 && i + 1 < text.size() &&
                         std::isdigit(static_cast<unsigned char>(text[i - 1])) != 0 &&
                         std::isdigit(static_cast<unsigned char>(text[i + 1])) != 0;
    if (!divides) joined += text[i];
  }
  if (joined != text && isRead(joined)) return fmt::format("'{}': a number has no blanks, {}", text, joined);
  char* rest = nullptr;
  const double number = std::strtod(text.c_str(), &rest);
  const bool has_digits = text.find_first_of("0123456789") < static_cast<std::size_t>(rest - text.c_str());
  if (has_digits && std::isinf(number)) return fmt::format("'{}' is too large", text);
  const std::string suffix = withoutBlanks(rest);
  const bool has_unit =
      has_digits && !suffix.empty() && suffix.find_first_of("0123456789") == std::string::npos;
  if (has_unit && !units.empty())
    return fmt::format("'{}': '{}' is not one of the units {}", text, suffix, units);
  return fmt::format("'{}' is not a number{}", text, units.empty() ? "" : "; units: " + units);
}

std::string quantityText(double value, const std::string& unit, int digits) {
  const PrefixedUnit prefixed = prefixedUnit(value, unit, digits);
  return withUnit(numberText(value / prefixed.factor, digits), prefixed.unit);
}

std::string rangeText(double minimum, double maximum, const std::string& unit, int digits) {
  const PrefixedUnit lower = prefixedUnit(minimum, unit, digits), upper = prefixedUnit(maximum, unit, digits);
  const bool says_unit_twice = lower.unit != upper.unit && minimum != 0;
  return withUnit(numberText(minimum / lower.factor, digits), says_unit_twice ? lower.unit : "") + " to " +
         quantityText(maximum, unit, digits);
}

std::optional<double> parseQuantity(const std::string& text, const std::string& unit, double shown) {
  char* rest = nullptr;
  const double number = std::strtod(text.c_str(), &rest);
  if (rest == text.c_str() || !std::isfinite(number)) return std::nullopt;
  const std::string suffix = withoutBlanks(rest);
  if (suffix.empty()) return number * shown;
  if (suffix == unit || suffix == unitSigns(unit)) return number;
  if (takesPrefix(unit)) {
    for (const auto& [prefix, factor] : kPrefixes) {
      if (suffix == prefix + unit) return number * factor;
    }
  }
  for (const OtherUnit& other : kOtherUnits) {
    if (unit == other.of && suffix == other.unit) return number * other.factor + other.offset;
  }
  for (const DecibelUnit& other : kDecibelUnits) {
    if (unit == other.of && lowered(suffix) == lowered(other.unit))
      return std::pow(10, (number - other.offset_db) / 10);
  }
  // Typed without attention to the case: 300 mhz is 300 MHz, but 5 mw is not 5 MW.
  const std::string lower = lowered(suffix);
  if (unit == "Hz" && lower == "mhz") return number * 1e6;
  for (const auto& [prefix, factor] : kPrefixes) {
    const std::string name = prefix;
    const bool is_known = takesPrefix(unit) && name != "M" && name != "m" && lower == lowered(prefix + unit);
    if (is_known) return number * factor;
  }
  for (const OtherUnit& other : kOtherUnits) {
    if (unit == other.of && lower == lowered(other.unit)) return number * other.factor + other.offset;
  }
  return lower == lowered(unit) ? std::optional(number) : std::nullopt;
}

}  // namespace emscape
