/// Mechanism that determines the loss at a position: a propagation model, or a part of one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "emscape/base/host_device.h"
#include "emscape/propagation/settings.h"

namespace emscape::propagation {

/// The mechanisms of parabolic_equation, followed by the other models, each as a whole.
enum class Mechanism : std::uint8_t {
  parabolic_equation,
  diffraction,
  two_ray,
  extended_optics,  ///< along a ray from the top of the parabolic equation's domain
  troposcatter,
  floor,  ///< the lowest field of the parabolic equation
  free_space,
  horizon,
  itm,
  p528,
  p1812,
  p452
};

/// The mechanism of a model as a whole.
Mechanism mechanismOf(PropagationModel model);

/// Names by value: "parabolic_equation", ...
std::vector<std::string> mechanismNames();

/// Output of the mechanism of each height of a column.
struct MechanismStore {
  std::uint8_t* lowest = nullptr;  ///< null: not needed
  std::size_t stride = 0;          ///< from one height to the next

  EMSCAPE_HD void set(int k, Mechanism mechanism) const {
    if (lowest != nullptr)
      lowest[static_cast<std::size_t>(k) * stride] = static_cast<std::uint8_t>(mechanism);
  }
};

}  // namespace emscape::propagation
