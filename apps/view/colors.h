/// Colours and opacities as the window adjusts them: simple changes to the transfer function of the start.
#pragma once

#include <optional>
#include <string>

#include "emscape/render/transfer_function.h"
#include "emscape/volume/value_range.h"

namespace emscape::view {

/// Changes to a transfer function; all empty: none.
struct ColorAdjustment {
  std::optional<volume::ValueRange> range;  ///< the interval of colours and opacities
  std::string color_map;                    ///< of render::colorMapNames(); empty: the function's own colours
  double opacity_factor = 1;                ///< of every point; opacities stay below 1

  bool empty() const { return !range && color_map.empty() && opacity_factor == 1; }
};

/// A function with the changes. Categorical functions stay as they are.
/// @throws Error (bad_input) for an unknown colour map or an empty range
render::TransferFunction adjusted(const render::TransferFunction& function,
                                  const ColorAdjustment& adjustment);

}  // namespace emscape::view
