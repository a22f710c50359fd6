/// The table of the scenario format.
#pragma once

#include "document/schema.h"

namespace emscape::scenario {

using document::KeySpec;
using document::ObjectSpec;
using document::ValueSpec;

/// Kinds of antenna in a scenario, in the order of the table's choices.
enum class AntennaForm { isotropic, gaussian, sinc, cosecant2, phased_array, file, cuts };
const char* toString(AntennaForm form);

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
const char* toString(RefractivityKind kind);

/// The section atmosphere.refractivity.
const ObjectSpec& refractivitySpec();
/// A row of a track file: the same table for its columns.
const ObjectSpec& trackRowSpec();

}  // namespace emscape::scenario
