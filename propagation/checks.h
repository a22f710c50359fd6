/// Faults of a model's inputs.
#pragma once

#include <string>
#include <vector>

#include "propagation/inputs.h"
#include "propagation/limits.h"

namespace emscape::propagation {

/// Origin of a value, from which messages derive its line in the scenario.
enum class InputOrigin { frequency, ground, settings };

struct InputFault {
  InputOrigin origin = InputOrigin::frequency;
  bool is_refused = false;  ///< the model cannot compute; otherwise a warning
  std::string message;
};
using InputFaults = std::vector<InputFault>;

/// Adds a fault if a value (SI) is outside a limit.
inline void checkInput(const ModelLimit& limit, double value_si, InputOrigin origin, InputFaults& faults) {
  if (limit.holds(value_si)) return;
  faults.push_back({origin, limit.beyond == Beyond::refused, outsideMessage(limit, value_si)});
}

/// Adds a warning for each end of the paths whose height over the smooth surface is outside a limit (m).
/// No voxel is below the surface: only the upper limit is checked at the far end.
std::vector<std::string> smoothHeightWarnings(const ModelLimit& limit, const PathInputs& inputs);

}  // namespace emscape::propagation
