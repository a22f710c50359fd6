/// Sections of the scenario format; refractivitySpec() and trackRowSpec() are in scenario/file/schema.h.
#pragma once

#include "scenario/file/schema.h"

namespace emscape::scenario {

const ObjectSpec& regionSpec();
const ObjectSpec& terrainSpec();
const ObjectSpec& atmosphereSpec();
const ObjectSpec& groundSpec();
const ObjectSpec& platformSpec();
const ObjectSpec& antennaSpec();
const ObjectSpec& scanSpec();
const ObjectSpec& radarReceiverSpec();
const ObjectSpec& emitterSpec();
const ObjectSpec& receiverSpec();
const ObjectSpec& targetSpec();
const ObjectSpec& bandSpec();
const ObjectSpec& outputSpec();

/// Latitude and longitude of a position.
KeySpec latitudeKey();
KeySpec longitudeKey();

}  // namespace emscape::scenario
