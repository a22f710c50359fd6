/// Predefined opacity curves for an editor of transfer functions.
#pragma once

#include <string>
#include <vector>

#include "emscape/render/transfer/transfer_function.h"

namespace emscape::playback {

struct OpacityPreset {
  const char* name;
  const char* help;
};
/// ramp, late ramp, threshold, shell, bands, opaque.
const std::vector<OpacityPreset>& opacityPresets();

/// The points of a preset, from `lowest` to `highest`.
/// @param at  position of a threshold or a shell; clamped to the inner part of the interval
/// @throws Error (bad_input) for an unknown name, which lists them
std::vector<render::TransferFunction::OpacityPoint> opacityPreset(const std::string& name, double lowest,
                                                                  double highest, double at);

}  // namespace emscape::playback
