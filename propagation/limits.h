/// Where a propagation model holds: one table a model, from which its check, its message and its
/// documentation come.
///
/// A model's header lists its limits as named constants, and all of them in one table:
///
///     constexpr ModelLimit kP528Frequency{"frequency", "MHz", 1e6, 100, 30000, Beyond::warned, "..."};
///     constexpr const ModelLimit* kP528Limits[] = {&kP528Frequency, ...};
///
/// docs/models.md holds limitsTable() of every model word for word; a test compares.
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "emscape/base/host_device.h"

namespace emscape::propagation {

/// For parameters that have no upper limit.
constexpr double kNoLimit = HUGE_VAL;

/// What becomes of a value outside its limits.
enum class Beyond {
  warned,   ///< computed all the same; the result carries a warning
  clamped,  ///< computed with the nearest value that is allowed; the result carries a warning
  refused,  ///< no result: NaN in loops, an error where input comes in
};

/// One parameter's limits. Values are given and compared in SI units (m, Hz, rad, K, ...) and shown in
/// `unit`.
struct ModelLimit {
  std::string_view parameter;  ///< as messages and tables name it: "frequency"
  std::string_view unit;       ///< as messages and tables show it: "MHz"; empty for pure numbers
  double si_per_unit;          ///< SI units in one `unit`: 1e6
  double least;                ///< in `unit`
  double most;                 ///< in `unit`
  Beyond beyond;
  std::string_view remark;  ///< why, or what it means; may be empty

  /// NaN is never within. On the host; functions for both sides call holds<limit>().
  constexpr bool holds(double value_si) const {
    return value_si >= least * si_per_unit && value_si <= most * si_per_unit;
  }
};

/// limit.holds(value), for host and device: device code knows constants, not the objects that hold them.
template <const ModelLimit& limit>
EMSCAPE_HD constexpr bool holds(double value_si) {
  constexpr double least = limit.least * limit.si_per_unit;
  constexpr double most = limit.most * limit.si_per_unit;
  return value_si >= least && value_si <= most;
}

/// "frequency outside 20..20000 MHz: refused".
std::string outsideMessage(const ModelLimit& limit);
/// "frequency 15 MHz is outside 20..20000 MHz: refused", for a value in SI units.
std::string outsideMessage(const ModelLimit& limit, double value_si);

/// The table of a model's limits, in Markdown.
/// @param limits  `count` pointers
std::string limitsTable(const ModelLimit* const* limits, int count);
template <int kCount>
std::string limitsTable(const ModelLimit* const (&limits)[kCount]) {
  return limitsTable(limits, kCount);
}

}  // namespace emscape::propagation
