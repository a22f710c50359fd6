/// Refractivity for people and programs: what profiles trap, as JSON and as a plot.
#pragma once

#include <string>
#include <vector>

#include "apps/emscape/common/console.h"
#include "emscape/render/image.h"
#include "propagation/parabolic_equation/refractivity_field.h"

namespace emscape::app {

/// Each profile with its ducts, and the modes that they trap at frequencies (Hz).
Json profilesJson(const propagation::RefractivityField& field, const std::vector<double>& frequencies_hz);
/// The same of a scenario, with the ranges over the members of its ensemble.
Json refractivityJson(const propagation::Refractivity& refractivity,
                      const std::vector<double>& frequencies_hz);

/// M and N against height, with the layers in which M falls; of several profiles the first's layers.
/// @throws Error (other) naming the file
void plotRefractivity(const propagation::Refractivity& refractivity, const std::string& title,
                      render::ImageSize size, const std::string& file);

}  // namespace emscape::app
