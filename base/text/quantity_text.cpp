#include "base/text/quantity_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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
  if (rest == text.c_str()) return std::nullopt;
  std::string suffix = rest;
  suffix.erase(0, std::min(suffix.find_first_not_of(' '), suffix.size()));
  suffix.erase(suffix.find_last_not_of(' ') + 1);
  if (suffix.empty()) return number * shown;
  if (suffix == unit) return number;
  if (!takesPrefix(unit)) return std::nullopt;
  for (const auto& [prefix, factor] : kPrefixes) {
    if (suffix == prefix + unit) return number * factor;
  }
  return std::nullopt;
}

}  // namespace emscape
