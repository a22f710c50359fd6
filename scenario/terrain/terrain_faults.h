/// Faults of the files of a terrain.
#pragma once

#include <vector>

#include "emscape/base/error.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::scenario {

/// The surface model of a terrain as a terrain of its own.
TerrainSpec surfaceOf(const TerrainSpec& spec);

/// What is wrong with each file that Terrain::load() reads, where it stops at the first: every file is read
/// alone. @throws Error of another kind than bad_input
std::vector<Error> faultsOfFiles(const TerrainSpec& spec, const GeoBox& box);

}  // namespace emscape::scenario
