#include "emfield/geometry/clutter_map.h"

#include <algorithm>
#include <cmath>

#include "emfield/clutter/clutter_reach.h"
#include "emfield/excess/emitter_excess.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "propagation/air/gases.h"
#include "propagation/air/rain.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

constexpr int kMaxRanges = 2048;

ClutterGrid clutterGrid(const scenario::Scenario& scenario, const scenario::Emitter& radar,
                        const Station& station, const propagation::PathExtent* extent) {
  const double reach = clutterReach_m(scenario.region, station), cell_m = radar.clutter->range_cell_m;
  int steps = ClutterGrid::kMaxSteps;
  while (steps > 1 && cell_m / steps < reach / kMaxRanges) steps -= 2;
  const double step_m = std::max(cell_m / steps, reach / kMaxRanges);
  double farthest_m = reach;
  if (extent != nullptr) {
    const double highest_m = std::max(std::abs(extent->highest_msl_m - station.height_msl_m),
                                      std::abs(extent->lowest_msl_m - station.height_msl_m));
    farthest_m = std::max(farthest_m, std::hypot(extent->farthest_m, highest_m));
  }
  ClutterGrid grid;
  grid.azimuths = clutterAzimuths(*radar.antenna);
  grid.ranges = static_cast<int>(std::ceil(farthest_m / step_m)) + 1 + steps / 2;
  grid.step_m = static_cast<float>(step_m);
  grid.steps_of_cell = steps;
  grid.part_of_step = steps > 1 ? 1 : static_cast<float>(cell_m / step_m);
  const double repeat_m = radar.waveform ? radar.waveform->unambiguousRange_m() : 0;
  if (repeat_m > 0 && repeat_m < reach) {
    // Range cells that are longer hold each surface once, not in several trips.
    grid.part_of_step *= static_cast<float>(std::min(1.0, repeat_m / cell_m));
    grid.trips = {static_cast<float>(repeat_m), static_cast<int>(std::ceil(reach / repeat_m)),
                  static_cast<float>(reach)};
  }
  return grid;
}

}  // namespace

double airLossAtSea_db_per_m(const scenario::Scenario& scenario, const scenario::Emitter& radar) {
  const propagation::EmitterInputs inputs = emitterInputs(scenario, radar);
  const propagation::Atmosphere& air = scenario.atmosphere;
  double db_per_km = 0;
  if (propagation::hasGases(inputs)) {
    db_per_km +=
        propagation::gasAttenuation(
            radar.frequency_hz, propagation::AirState{air.pressure_hpa, air.temperature_k, air.vapour_g_m3})
            .total_db_per_km();
  }
  if (air.rain_mm_h > 0) {
    const double tilt_rad = std::asin(std::sqrt(1 - horizontalPart(radar.polarization)));
    db_per_km += propagation::rainCoefficients(radar.frequency_hz, 0, tilt_rad)
                     .specificAttenuation_db_per_km(air.rain_mm_h);
  }
  return db_per_km / 1000;
}

std::optional<ClutterMapTask> clutterMapTask(const scenario::Scenario& scenario,
                                             const scenario::Emitter& radar, const Station& station,
                                             const propagation::PathExtent* extent) {
  if (!hasClutterMap(radar)) return std::nullopt;
  const scenario::Clutter& clutter = *radar.clutter;
  ClutterMapTask task;
  task.station = station;
  task.surface.has_land = clutter.land_gamma_db.has_value();
  task.surface.has_sea = clutter.sea_state.has_value();
  task.surface.gamma = task.surface.has_land ? dbToRatio(*clutter.land_gamma_db) : 0;
  task.surface.by_cover = clutter.land_by_cover;
  for (std::size_t kind = 0; kind < std::size(task.surface.gamma_of_kind); ++kind)
    task.surface.gamma_of_kind[kind] =
        dbToRatio(scenario::landGammaDb(static_cast<scenario::LandKind>(kind), radar.frequency_hz));
  task.surface.sea_state = clutter.sea_state.value_or(0);
  task.surface.frequency_ghz = radar.frequency_hz / 1e9;
  task.surface.horizontal_part = horizontalPart(radar.polarization);
  task.grid = clutterGrid(scenario, radar, station, extent);
  task.power = clutterBeamOf(radar.antenna)->beside;
  task.air_db_per_m = static_cast<float>(airLossAtSea_db_per_m(scenario, radar));
  return task;
}

bool hasClutterMap(const scenario::Emitter& radar) {
  return radar.clutter && radar.clutter->hasSurface();
}

ClutterMapInputs clutterMapInputs(const scenario::Emitter& radar) {
  if (!hasClutterMap(radar)) return {};
  return {radar.clutter->land_gamma_db,
          radar.clutter->land_by_cover,
          radar.clutter->sea_state,
          radar.clutter->range_cell_m,
          radar.waveform ? radar.waveform->unambiguousRange_m() : 0,
          radar.antenna};
}

std::size_t clutterMapBytes(const scenario::Emitter& radar) {
  return hasClutterMap(radar) ? static_cast<std::size_t>(clutterAzimuths(*radar.antenna)) *
                                    (kMaxRanges + 1 + ClutterGrid::kMaxSteps / 2) * sizeof(ClutterCell)
                              : 0;
}

std::vector<double> clutterPostRanges(const ClutterGrid& grid, double post_spacing_m) {
  return postRanges(static_cast<double>(grid.step_m) * grid.ranges, post_spacing_m);
}

void fillClutterMapCpu(const ClutterMapTask& task, ClutterCell* cells) {
  parallelFor(task.grid.azimuths, 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) task(i, cells + static_cast<std::size_t>(i) * task.grid.ranges);
  });
  constexpr int kTogether = 16;  // cells of some cache lines
  parallelFor(task.grid.ranges, kTogether, [&](int begin, int end) {
    for (int range = begin; range < end; ++range) task.weighBeside(range, cells);
  });
}

}  // namespace emscape::emfield
