#include "propagation/limits.h"

#include <fmt/core.h>

namespace emscape::propagation {
namespace {

std::string_view toString(Beyond beyond) {
  switch (beyond) {
    case Beyond::warned:
      return "computed, with a warning";
    case Beyond::clamped:
      return "taken as the nearest allowed value, with a warning";
    case Beyond::refused:
      return "refused";
  }
  return "";
}

/// With a space before it, if there is one.
std::string unitOf(const ModelLimit& limit) {
  return limit.unit.empty() ? "" : fmt::format(" {}", limit.unit);
}

std::string rangeOf(const ModelLimit& limit) {
  return fmt::format("outside {:.6g}..{:.6g}{}: {}", limit.min, limit.max, unitOf(limit),
                     toString(limit.beyond));
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
  std::string table = "| parameter | unit | least | most | outside | remark |\n|---|---|---|---|---|---|\n";
  for (int i = 0; i < count; ++i) {
    const ModelLimit& limit = *limits[i];
    table += fmt::format("| {} | {} | {:.6g} | {:.6g} | {} | {} |\n", limit.parameter, limit.unit, limit.min,
                         limit.max, toString(limit.beyond), limit.remark);
  }
  return table;
}

}  // namespace emscape::propagation
