/// Range of validity of a propagation model: one table per model, from which its checks, messages and
/// documentation are derived.
///
/// A model's header lists its limits as named constants, and all of them in one table:
///
///     constexpr ModelLimit kP528Frequency{"frequency", "MHz", 1e6, 100, 30000, Beyond::warned, "..."};
///     constexpr const ModelLimit* kP528Limits[] = {&kP528Frequency, ...};
///
/// docs/models.md contains the output of limitsTable() for every model; a test compares them.
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "emscape/base/host_device.h"

namespace emscape::propagation {

/// For parameters that have no upper limit.
constexpr double kNoLimit = HUGE_VAL;

/// Treatment of a value outside its limits.
enum class Beyond {
  warned,           ///< computed without change; the result has a warning
  clamped,          ///< computed with the nearest allowed value; the result has a warning
  clamped_quietly,  ///< computed with the nearest allowed value, without a warning: the difference is
                    ///< negligible
  refused,          ///< no result: NaN in loops, an error where input comes in
};

/// One parameter's limits. Values are given and compared in SI units (m, Hz, rad, K, ...) and shown in
/// `unit`.
struct ModelLimit {
  std::string_view parameter;  ///< name in messages and tables: "frequency"
  std::string_view unit;       ///< unit in messages and tables: "MHz"; empty for dimensionless numbers
  double si_per_unit;          ///< SI units in one `unit`: 1e6
  double min;                  ///< in `unit`
  double max;                  ///< in `unit`
  Beyond beyond;
  std::string_view remark;  ///< reason or consequence; may be empty

  /// False for NaN. Host only; host/device functions call holds<limit>().
  constexpr bool holds(double value_si) const {
    return value_si >= min * si_per_unit && value_si <= max * si_per_unit;
  }
};

/// limit.holds(value), for host and device: device code can use constants, but not host objects.
template <const ModelLimit& limit>
EMSCAPE_HD constexpr bool holds(double value_si) {
  constexpr double min = limit.min * limit.si_per_unit;
  constexpr double max = limit.max * limit.si_per_unit;
  return value_si >= min && value_si <= max;
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
