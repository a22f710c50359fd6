#include "propagation/limits.h"

#include <fmt/core.h>

namespace emscape::propagation {
namespace {

/// Consequence of a value beyond its limit, in a message.
std::string_view consequenceOf(Beyond beyond) {
  switch (beyond) {
    case Beyond::warned:
      return "computed, with a warning";
    case Beyond::clamped:
    case Beyond::clamped_quietly:
      return "the nearest allowed value is used";
    case Beyond::refused:
      return "refused";
  }
  return "";
}

/// Consequence in the table of limits.
std::string inTable(Beyond beyond) {
  return std::string(consequenceOf(beyond)) + (beyond == Beyond::clamped ? ", with a warning" : "");
}

/// The unit, preceded by a space if there is one.
std::string unitOf(const ModelLimit& limit) {
  return limit.unit.empty() ? "" : fmt::format(" {}", limit.unit);
}

std::string rangeOf(const ModelLimit& limit) {
  return fmt::format("outside {:.6g}..{:.6g}{}: {}", limit.min, limit.max, unitOf(limit),
                     consequenceOf(limit.beyond));
}

}  // namespace

std::string outsideMessage(const ModelLimit& limit) {
  return fmt::format("{} {}", limit.parameter, rangeOf(limit));
}

std::string outsideMessage(const ModelLimit& limit, double value_si) {
  return fmt::format("{} {:.6g}{} is {}", limit.parameter, value_si / limit.si_per_unit, unitOf(limit),
                     rangeOf(limit));
}

std::string limitsTable(const ModelLimit* const* limits, int count) {
  std::string table = "| parameter | unit | min | max | outside | remark |\n|---|---|---|---|---|---|\n";
  for (int i = 0; i < count; ++i) {
    const ModelLimit& limit = *limits[i];
    table += fmt::format("| {} | {} | {:.6g} | {:.6g} | {} | {} |\n", limit.parameter, limit.unit, limit.min,
                         limit.max, inTable(limit.beyond), limit.remark);
  }
  return table;
}

}  // namespace emscape::propagation
