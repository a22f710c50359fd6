#include "emfield/link/path_section.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "emfield/excess/emitter_excess.h"
#include "emfield/geometry/emitter_geometry.h"
#include "emscape/base/units.h"
#include "propagation/parabolic_equation/air/path_air.h"
#include "propagation/parabolic_equation/plan.h"

namespace emscape::emfield {
namespace {

std::vector<PathSection::Level> airOf(const propagation::RefractivityProfile& profile, double lowest_m,
                                      double top_m) {
  std::vector<PathSection::Level> levels{{lowest_m, profile.at(lowest_m)}};
  for (const propagation::RefractivityLevel& level : profile.levels) {
    if (level.height_msl_m > lowest_m && level.height_msl_m < top_m)
      levels.push_back({level.height_msl_m, level.m_units});
  }
  levels.push_back({top_m, profile.at(top_m)});
  return levels;
}

}  // namespace

PathSection pathSection(const scenario::Snapshot& snapshot, int emitter, propagation::PropagationModel model,
                        const PathProfile& profile, const scenario::Terrain* terrain, int ranges,
                        int heights) {
  const scenario::Scenario& scenario = *snapshot.scenario;
  scenario::Emitter by_model = scenario.emitters[static_cast<std::size_t>(emitter)];
  by_model.propagation.model = model;
  // losses between isotropic antennas
  by_model.propagation.parabolic_equation.source = propagation::PeRadiator::isotropic;
  const scenario::EmitterState& state = snapshot.emitters[static_cast<std::size_t>(emitter)];
  const Station station = makeStation(state.position, state.height_msl_m, scenario.atmosphere);
  const propagation::RefractivityAlongPath air =
      propagation::pathAir(scenario.atmosphere, station, profile.azimuth_rad);
  const auto [lowest, highest] =
      std::minmax_element(profile.ground_msl_m.begin(), profile.ground_msl_m.end());
  const auto lowest_m = static_cast<double>(*lowest);
  const double highest_m = std::max({static_cast<double>(*highest), profile.begin.height_msl_m,
                                     profile.end.height_msl_m, propagation::trappingTop_m(air)});
  constexpr double kRoom = 1.5, kMinHeight_m = 50;
  const double top_msl_m = lowest_m + std::max(kRoom * (highest_m - lowest_m), kMinHeight_m);

  PathSection section;
  Surface surface;
  surface.reference = HeightReference::mean_sea_level;
  surface.width = ranges;
  surface.height = 1;
  for (int i = 0; i < ranges; ++i) {
    section.ranges_m.push_back(profile.range_m * (i + 1) / ranges);
    const GeodeticPosition position =
        geodesicDirect(state.position.latitude_deg, state.position.longitude_deg, profile.azimuth_rad,
                       section.ranges_m.back());
    surface.positions.push_back({position.latitude_deg, position.longitude_deg});
  }
  for (int k = 0; k < heights; ++k) {
    section.heights_msl_m.push_back(lowest_m + (top_msl_m - lowest_m) * (k + 0.5) / heights);
  }
  surface.heights_m = section.heights_msl_m;
  const GridColumns columns = makeGridColumns(surface, terrain);
  section.ground_msl_m = columns.ground_msl_m;
  section.ground_msl_m.resize(static_cast<std::size_t>(ranges));

  EmitterGeometry geometry;
  EmitterGeometry::Times times;
  geometry.compute(state, scenario, by_model, columns, terrain, times);
  const ExcessView excess = geometry.view().excess;
  const double wavelength = wavelength_m(by_model.frequency_hz);
  for (int k = 0; k < heights; ++k) {
    for (int i = 0; i < ranges; ++i) {
      const double height_m = section.heights_msl_m[static_cast<std::size_t>(k)];
      const bool is_below = height_m < static_cast<double>(section.ground_msl_m[static_cast<std::size_t>(i)]);
      const double slant_m =
          std::hypot(section.ranges_m[static_cast<std::size_t>(i)], height_m - state.height_msl_m);
      const auto voxel =
          static_cast<std::size_t>(k) * static_cast<std::size_t>(ranges) + static_cast<std::size_t>(i);
      section.loss_db.push_back(is_below
                                    ? std::numeric_limits<float>::quiet_NaN()
                                    : static_cast<float>(20 * std::log10(4 * kPi * slant_m / wavelength)) +
                                          (excess.isEmpty() ? 0.0f : excess.db[voxel]));
    }
  }
  section.air = airOf(air.at(0), lowest_m, top_msl_m);
  return section;
}

}  // namespace emscape::emfield
