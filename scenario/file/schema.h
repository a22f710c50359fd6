/// The table of the scenario format.
#pragma once

#include <array>

#include "document/schema.h"
#include "emscape/base/enum_names.h"

namespace emscape::scenario {

using emscape::toString;

using document::KeySpec;
using document::ObjectSpec;
using document::ValueSpec;

/// Kinds of antenna in a scenario, in the order of the table's choices.
enum class AntennaForm { isotropic, gaussian, sinc, cosecant2, phased_array, file, cuts };
constexpr auto namesOf(AntennaForm) {
  return std::array{"isotropic", "gaussian", "sinc", "cosecant2", "phased_array", "file", "cuts"};
}

/// The whole file.
const ObjectSpec& scenarioSpec();
/// Kinds of refractivity in a scenario, in the order of the table's choices.
enum class RefractivityKind {
  standard,
  linear,
  evaporation_duct,
  surface_duct,
  trilinear,
  profile,
  soundings,
  bulk
};
constexpr auto namesOf(RefractivityKind) {
  return std::array{"standard",  "linear",  "evaporation_duct", "surface_duct",
                    "trilinear", "profile", "soundings",        "bulk"};
}

/// The section atmosphere.refractivity.
const ObjectSpec& refractivitySpec();
/// A row of a track file: the same table for its columns.
const ObjectSpec& trackRowSpec();

}  // namespace emscape::scenario
