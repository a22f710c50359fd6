/// The terrain of several scenarios that are computed one after another.
#pragma once

#include <memory>
#include <optional>

#include "emscape/scenario/terrain/terrain.h"
#include "emscape/study/maps/area.h"

namespace emscape::study {

/// Keeps the terrain of a scenario while the next ones need the same files and the same box. For one thread.
class TerrainCache {
 public:
  /// Loads terrain in scenario::terrainBox() of each scenario.
  TerrainCache() = default;
  /// Loads terrain in terrainBoxOf() of each scenario and an area.
  /// @param scenario,terrain  loaded before
  TerrainCache(MapArea area, std::shared_ptr<const scenario::Scenario> scenario,
               scenario::TerrainPtr terrain);

  /// True if a scenario needs the terrain that is kept.
  bool fits(const scenario::Scenario& scenario) const;
  /// The terrain of a scenario, which depends only on the scenario; null if it names none. Loaded unless it
  /// fits. @throws Error (bad_input) naming the file
  const scenario::TerrainPtr& of(const std::shared_ptr<const scenario::Scenario>& scenario);

 private:
  scenario::GeoBox boxOf(const scenario::Scenario& scenario) const;

  std::optional<MapArea> area_;
  std::shared_ptr<const scenario::Scenario> scenario_;  ///< of terrain_; null: nothing is loaded
  scenario::TerrainPtr terrain_;
};

}  // namespace emscape::study
