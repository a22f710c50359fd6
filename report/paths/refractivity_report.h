/// Refractivity profiles, their ducts and trapped modes, as JSON and as a plot.
#pragma once

#include <string>
#include <vector>

#include "emscape/render/picture/image.h"
#include "emscape/scenario/model/scenario.h"
#include "propagation/parabolic_equation/air/refractivity_field.h"
#include "report/json.h"

namespace emscape::report {

/// Each profile with its ducts and the modes that they trap at the given frequencies (Hz).
Json profilesJson(const propagation::RefractivityField& field, const std::vector<double>& frequencies_hz);
/// The same for a scenario, with the ranges over the members of its ensemble.
Json refractivityJson(const propagation::Refractivity& refractivity,
                      const std::vector<double>& frequencies_hz);

/// Where the measured refractivity of a scenario comes from: "air.csv: 1 profile"; a sounding with station,
/// time and distance; empty: it is not measured.
std::string airSource(const scenario::Scenario& scenario);

/// Plots M and N over height, with the layers in which M decreases; for several profiles, the layers of the
/// first one.
/// @throws Error (other) naming the file
void plotRefractivity(const propagation::Refractivity& refractivity, const std::string& title,
                      render::ImageSize size, const std::string& file);

}  // namespace emscape::report
