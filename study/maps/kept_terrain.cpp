#include "study/maps/kept_terrain.h"

#include <utility>

namespace emscape::study {

KeptTerrain::KeptTerrain(MapArea area, std::shared_ptr<const scenario::Scenario> scenario,
                         scenario::TerrainPtr terrain)
    : area_(std::move(area)), scenario_(std::move(scenario)), terrain_(std::move(terrain)) {}

scenario::GeoBox KeptTerrain::boxOf(const scenario::Scenario& scenario) const {
  return area_ ? terrainBoxOf(scenario, *area_) : scenario::terrainBox(scenario);
}

bool KeptTerrain::fits(const scenario::Scenario& scenario) const {
  return scenario_ != nullptr && scenario.terrain == scenario_->terrain &&
         (!scenario.terrain || boxOf(scenario) == boxOf(*scenario_));
}

const scenario::TerrainPtr& KeptTerrain::of(const std::shared_ptr<const scenario::Scenario>& scenario) {
  if (!fits(*scenario)) {
    terrain_ = area_ ? loadTerrain(*scenario, *area_) : scenario::loadTerrain(*scenario);
    scenario_ = scenario;
  }
  return terrain_;
}

}  // namespace emscape::study
