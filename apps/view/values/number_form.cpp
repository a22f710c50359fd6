#include "apps/view/values/number_form.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <optional>

#include "base/text/quantity_text.h"
#include "emscape/base/error.h"
#include "emscape/render/annotate/legend.h"

namespace emscape::view {
namespace {

std::string withoutSpaces(std::string text) {
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

/// "dBW/m²", "dbw/m2" and "dBW / m2" are the same.
std::string plainUnit(const std::string& unit) {
  std::string plain;
  for (const char c : render::unitText(unit)) {
    if (c != ' ') plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return plain;
}

/// Reads a value of a field in any unit in which it is shown.
std::optional<double> fieldValueOf(const std::string& text, const std::string& unit, FieldUnit shown) {
  char* rest = nullptr;
  const double number = std::strtod(text.c_str(), &rest);
  if (rest == text.c_str() || !std::isfinite(number)) return std::nullopt;
  const std::string typed = plainUnit(rest);
  for (const FieldUnit each : {shown, FieldUnit::stored, FieldUnit::dbm, FieldUnit::v_per_m}) {
    const render::FieldScale scale = render::fieldScale(unit, each);
    if (!typed.empty() && typed != plainUnit(scale.unit)) continue;
    const double stored = scale.stored(number);
    return std::isfinite(stored) ? std::optional(stored) : std::nullopt;
  }
  return std::nullopt;
}

/// The units that are read for a unit; of values of a field those in which they can be shown.
std::string unitsOf(const std::string& unit) {
  std::string units;
  for (const FieldUnit each : {FieldUnit::stored, FieldUnit::dbm, FieldUnit::v_per_m}) {
    const std::string shown = render::fieldScale(unit, each).unit;
    if (each == FieldUnit::stored || shown != unit)
      units += (units.empty() ? "" : ", ") + render::unitText(shown);
  }
  return units == render::unitText(unit) ? readUnits(unit) : units;
}

}  // namespace

std::string NumberForm::textOf(double value) const {
  const render::FieldScale scale = render::fieldScale(unit, field_unit);
  const bool is_field = scale.unit != unit;
  const double shown = is_field ? scale.shown(value) : value / shown_factor;
  const std::string of = is_field ? scale.unit : shown_unit.empty() ? unit : shown_unit;
  const std::string signs = render::unitText(unitSigns(of));
  const bool is_close = signs.empty() || signs == "°";
  return before + (decimals < 0 ? fmt::format("{:.5g}", shown) : fmt::format("{:.{}f}", shown, decimals)) +
         (is_close ? "" : " ") + signs + after;
}

double NumberForm::valueOf(const std::string& text) const {
  std::string number = withoutSpaces(text);
  const std::string prefix = withoutSpaces(before), suffix = withoutSpaces(after);
  if (!prefix.empty() && number.compare(0, prefix.size(), prefix) == 0) number.erase(0, prefix.size());
  if (!suffix.empty() && number.size() > suffix.size() &&
      number.compare(number.size() - suffix.size(), suffix.size(), suffix) == 0)
    number.resize(number.size() - suffix.size());
  number = withoutSpaces(number);
  if (read) return read(number);
  const auto read_number = [this](const std::string& of) {
    const std::optional<double> value = parseQuantity(of, unit, shown_factor);
    const bool is_of_field = render::fieldScale(unit, field_unit).unit != unit || !value;
    return is_of_field ? fieldValueOf(of, unit, field_unit) : value;
  };
  const std::optional<double> value = read_number(number);
  const std::string name = prefix.empty() ? "" : prefix + ": ";
  if (!value) {
    throw Error(ErrorCode::bad_input, name + quantityFault(number, unitsOf(unit), [&](auto& other) {
                                        return bool(read_number(other));
                                      }));
  }
  if (*value >= min && *value <= max) return *value;
  NumberForm plain = *this;
  plain.before = plain.after = "";
  throw Error(ErrorCode::bad_input, fmt::format("{}{}: expected {} to {}", name, plain.textOf(*value),
                                                plain.textOf(min), plain.textOf(max)));
}

}  // namespace emscape::view
