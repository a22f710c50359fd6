#include "emfield/models/model_limits.h"

#include <fmt/core.h>

namespace emscape::emfield {
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

}  // namespace

std::string outsideMessage(const ModelLimit& limit, double value_si) {
  const std::string unit = limit.unit.empty() ? "" : fmt::format(" {}", limit.unit);
  return fmt::format("{} {:.6g}{} is outside {:.6g}..{:.6g}{}: {}", limit.parameter,
                     value_si / limit.si_per_unit, unit, limit.least, limit.most, unit,
                     toString(limit.beyond));
}

std::string limitsTable(const ModelLimit* const* limits, int count) {
  std::string table = "| parameter | unit | least | most | outside | remark |\n|---|---|---|---|---|---|\n";
  for (int i = 0; i < count; ++i) {
    const ModelLimit& limit = *limits[i];
    table += fmt::format("| {} | {} | {:.6g} | {:.6g} | {} | {} |\n", limit.parameter, limit.unit,
                         limit.least, limit.most, toString(limit.beyond), limit.remark);
  }
  return table;
}

}  // namespace emscape::emfield
