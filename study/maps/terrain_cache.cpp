#include "study/maps/terrain_cache.h"

#include <utility>

namespace emscape::study {

TerrainCache::TerrainCache(MapArea area, std::shared_ptr<const scenario::Scenario> scenario,
                           scenario::TerrainPtr terrain)
    : area_(std::move(area)), scenario_(std::move(scenario)), terrain_(std::move(terrain)) {}

scenario::GeoBox TerrainCache::boxOf(const scenario::Scenario& scenario) const {
  return area_ ? terrainBoxOf(scenario, *area_) : scenario::terrainBox(scenario);
}

bool TerrainCache::fits(const scenario::Scenario& scenario) const {
  return scenario_ != nullptr && scenario.terrain == scenario_->terrain &&
         (!scenario.terrain || boxOf(scenario) == boxOf(*scenario_));
}

const scenario::TerrainPtr& TerrainCache::of(const std::shared_ptr<const scenario::Scenario>& scenario) {
  if (!fits(*scenario)) {
    terrain_ = area_ ? loadTerrain(*scenario, *area_) : scenario::loadTerrain(*scenario);
    scenario_ = scenario;
  }
  return terrain_;
}

}  // namespace emscape::study
