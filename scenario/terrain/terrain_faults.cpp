#include "scenario/terrain/terrain_faults.h"

#include <algorithm>

#include "scenario/terrain/file_names.h"

namespace emscape::scenario {

TerrainSpec surfaceOf(const TerrainSpec& spec) {
  TerrainSpec surface;
  surface.files = spec.surface_files;
  surface.locations = spec.surface_locations;
  surface.keys = spec.surface_keys;
  surface.vertical_datum = spec.vertical_datum;
  return surface;
}

std::vector<Error> faultsOfFiles(const TerrainSpec& spec, const GeoBox& box) {
  std::vector<Error> faults;
  const auto collect = [&faults](const auto& read) {
    try {
      read();
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_input) throw;
      const auto isSame = [&error](const Error& other) { return other.message() == error.message(); };
      if (std::none_of(faults.begin(), faults.end(), isSame)) faults.push_back(error);
    }
  };
  const auto locationOf = [](const std::vector<SourceLocation>& locations, std::size_t k) {
    return std::vector<SourceLocation>{k < locations.size() ? locations[k] : SourceLocation{}};
  };
  const TerrainSpec surface = surfaceOf(spec);
  for (const TerrainSpec* const of : {&spec, &surface}) {
    for (std::size_t k = 0; k < of->files.size(); ++k) {
      TerrainSpec one;
      one.files = {of->files[k]};
      one.locations = locationOf(of->locations, k);
      one.keys = {keysOf(*of, k)};
      one.vertical_datum = of->vertical_datum;
      collect([&] { Terrain::load(one, box); });
    }
  }
  for (std::size_t k = 0; k < spec.land_cover.files.size(); ++k) {
    LandCoverSpec one = spec.land_cover;
    one.files = {spec.land_cover.files[k]};
    one.locations = locationOf(spec.land_cover.locations, k);
    collect([&] { LandCover(one, box); });
  }
  return faults;
}

}  // namespace emscape::scenario
