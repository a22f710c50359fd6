// The row loops of the CPU against the plain single-source function, voxel by voxel.

#include "emfield/combine/combine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "emfield/geometry/emitter_geometry.h"
#include "emscape/emfield/solver/field_solver.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/files.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using scenario::PatternKind;

float plainPowerDensity(const EmitterBeam& beam, std::size_t column, float t_m) {
  return onPattern(beam.pattern, [&](auto kind) { return powerDensity_wm2<kind>(beam, column, t_m); });
}

struct NamedAntenna {
  const char* name;
  scenario::AntennaPtr antenna;
};

std::vector<NamedAntenna> antennas() {
  return {{"isotropic", scenario::makeIsotropic(3)},
          {"narrow gaussian", scenario::makeGaussian(40, 2, 3, -40)},
          {"wide gaussian", scenario::makeGaussian(10, 120, 60, -20)},
          {"gaussian without side lobes", scenario::makeGaussian(30, 4, 4, -200)},
          {"cosecant squared", scenario::makeCosecant2(34, 2, 5, 40, -40)},
          {"sinc", scenario::makeSinc(30, 6, 6, -50)},
          {"array", scenario::makePhasedArray(30, 16, 16, 0.5, 1)},
          {"measured", scenario::readAntenna(test::shippedScenario("data/sector_450mhz.msi"))}};
}

TEST(Combine, RowsEqualPlainFunction) {
  auto scenario = emptyScenario(FrameKind::altitude, 40, 5, {37e3, 23e3, 5000}, {150, 13, 7});
  const volume::Grid grid = gridOf(scenario->region);
  const GridColumns columns = makeGridColumns(grid, nullptr);
  for (const NamedAntenna& entry : antennas()) {
    for (double azimuth_deg : {3.0, 91.0, 178.0, 264.5}) {
      SCOPED_TRACE(::testing::Message() << entry.name << " towards " << azimuth_deg);
      scenario->platforms.clear();
      scenario->emitters.clear();
      scenario::Emitter emitter = plainEmitter("a", 0);
      emitter.antenna = entry.antenna;
      emitter.scan.azimuth_deg = azimuth_deg;
      emitter.scan.elevation_deg = 2;
      emitter.propagation.model = propagation::PropagationModel::horizon;
      addEmitter(*scenario, {40.02, 5.03, 300}, emitter);
      scenario->platforms[0].attitude = {10, 3, -2};
      const scenario::EmitterState state = scenario::snapshotAt(scenario, nullptr, 0).emitters[0];
      EmitterGeometry geometry;
      EmitterGeometry::Times times;
      geometry.compute(state, *scenario, emitter, columns, nullptr, times);

      CombineEmitter combined;
      combined.beam.geometry = geometry.view();
      combined.beam.pattern = entry.antenna->view();
      combined.beam.forward = vecCast<float>(state.beam.forward);
      combined.beam.right = vecCast<float>(state.beam.right);
      combined.beam.up = vecCast<float>(state.beam.up);
      combined.beam.eirp_over_4pi_w = 1000;
      combined.shares = {{0, 1.0f}};
      std::vector<float> sum(static_cast<std::size_t>(grid.dims.count()));
      CombineTask task;
      task.dims = grid.dims;
      task.t_m = columns.t_m.data();
      task.emitters = {combined};
      task.reductions = {Reduction::sum};
      task.accumulators = {{sum.data(), nullptr}};
      task.initial = {{}};
      combineCpu(task);
      for (int k = 0; k < grid.dims.z; ++k) {
        for (int column = 0; column < grid.dims.x * grid.dims.y; ++column) {
          const float plain = plainPowerDensity(combined.beam, column, columns.t_m[k]);
          const float row = sum[static_cast<std::size_t>(k) * grid.dims.x * grid.dims.y + column];
          // Fused multiply-adds round differently: the amplitude differs by a few parts in a million of its
          // maximum.
          const float boresight =
              powerDensity_wm2<PatternKind::isotropic>(combined.beam, column, columns.t_m[k]);
          const float amplitude_error = 5e-6f * std::sqrt(boresight);
          ASSERT_NEAR(std::sqrt(row), std::sqrt(plain), amplitude_error)
              << "column " << column << ", layer " << k;
        }
      }
    }
  }
}

}  // namespace
}  // namespace emscape::emfield
