// Occupancy against counts over fine time steps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "emfield/solver/beam_positions.h"
#include "emscape/base/units.h"
#include "tests/emfield/radar_duel.h"
#include "tests/emfield/scans.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/on_backends.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using scenario::AntennaPtr;
using scenario::IntervalKind;
using scenario::ScanKind;
using scenario::ScanSpec;
using scenario::Scenario;

constexpr double kBegin_s = 1.7, kThreshold_dbwm2 = -62;

/// testing::around() with the threshold of the counts.
std::shared_ptr<Scenario> countedAround(const AntennaPtr& antenna, const ScanSpec& scan) {
  auto scenario = around(antenna, scan);
  scenario->output.count_threshold_dbwm2 = kThreshold_dbwm2;
  return scenario;
}

class Occupancy : public test::OnBackends {
 protected:
  FieldSolver solverOf(const std::shared_ptr<Scenario>& scenario) {
    FieldOptions options;
    options.backend = GetParam();
    return FieldSolver(scenario, nullptr, options);
  }
  UnsetVector<float> valuesOf(FieldSolver& solver, const std::shared_ptr<Scenario>& scenario, double t_s) {
    solver.update(scenario::snapshotAt(scenario, nullptr, t_s));
    return solver.volumes().front().host()->values;
  }
  std::shared_ptr<Scenario> occupancyOf(const std::shared_ptr<Scenario>& scenario, double seconds) {
    auto copy = std::make_shared<Scenario>(*scenario);
    copy->output.quantities = {"occupancy"};
    copy->output.interval = {IntervalKind::mean, seconds, {}};
    return copy;
  }
  UnsetVector<float> over(const std::shared_ptr<Scenario>& scenario, double seconds) {
    const auto occupancy = occupancyOf(scenario, seconds);
    FieldSolver solver = solverOf(occupancy);
    return valuesOf(solver, occupancy, kBegin_s);
  }
  /// The share of equal steps at which the power density is above the threshold.
  std::vector<double> counted(const std::shared_ptr<Scenario>& scenario, double seconds, int steps) {
    FieldSolver solver = solverOf(scenario);
    std::vector<double> share;
    for (int n = 0; n < steps; ++n) {
      const UnsetVector<float> values = valuesOf(solver, scenario, kBegin_s + seconds * (n + 0.5) / steps);
      share.resize(values.size());
      for (std::size_t v = 0; v < values.size(); ++v) {
        if (static_cast<double>(values[v]) > kThreshold_dbwm2) share[v] += 1.0 / steps;
      }
    }
    return share;
  }
  void expectAsCounted(const std::shared_ptr<Scenario>& scenario, double seconds, int steps) {
    const std::vector<double> expected = counted(scenario, seconds, steps);
    const UnsetVector<float> found = over(scenario, seconds);
    ASSERT_EQ(found.size(), expected.size());
    int between = 0;
    for (std::size_t v = 0; v < found.size(); ++v) {
      if (v % (15 * 15) == 7 * 15 + 7) continue;  // straight above, where a pattern may have no one value
      EXPECT_NEAR(static_cast<double>(found[v]), expected[v], 0.005) << "voxel " << v;
      between += expected[v] > 0.01 && expected[v] < 0.99 ? 1 : 0;
    }
    EXPECT_GT(between, 50) << "the scenario must have shares between 0 and 1";
  }
};

TEST_P(Occupancy, TurnsEqualFineSteps) {
  for (const AntennaPtr& antenna :
       {scenario::makeGaussian(30, 4, 12, -35), scenario::makeCosecant2(30, 4, 5, 40, -35),
        scenario::makeSinc(30, 4, 12, -40), scenario::makePhasedArray(25, 24, 16, 0.5, 1, -45)}) {
    SCOPED_TRACE(antenna->description);
    expectAsCounted(countedAround(antenna, rotating(10, 4)), 6, 1800);
  }
}

TEST_P(Occupancy, PartsOfATurnEqualFineSteps) {
  const auto scenario = countedAround(scenario::makeGaussian(30, 8, 12, -35), rotating(-10, 3));
  expectAsCounted(scenario, 1.9, 1200);
  expectAsCounted(scenario, 8.3, 2400);
}

TEST_P(Occupancy, SectorsRastersAndDwellsEqualFineSteps) {
  const AntennaPtr antenna = scenario::makeGaussian(30, 8, 9, -35);
  for (const double seconds : {0.8, 3.7}) {
    SCOPED_TRACE(seconds);
    expectAsCounted(countedAround(antenna, sweeping(ScanKind::sector, 70, 60)), seconds, 1500);
    expectAsCounted(countedAround(antenna, sweeping(ScanKind::raster, 70, 60, 3)), seconds, 1500);
    expectAsCounted(countedAround(scenario::makePhasedArray(30, 16, 12, 0.5, 1, -40), dwelling()), seconds,
                    1480);
    expectAsCounted(countedAround(scenario::makeGaussian(30, 9, 9, -40), dwelling()), seconds, 1480);
  }
}

TEST_P(Occupancy, CountsBothRaysAndTheTimesOfActivity) {
  auto scenario = countedAround(scenario::makeGaussian(30, 8, 12, -35), rotating(10, 3));
  scenario->emitters.front().propagation.model = propagation::PropagationModel::two_ray;
  scenario->emitters.front().active_s = {{0, 2.5}, {4, 4.5}};
  expectAsCounted(scenario, 6, 2400);
}

TEST_P(Occupancy, FixedBeamEqualsActiveTime) {
  auto scenario = countedAround(scenario::makeIsotropic(30), ScanSpec{});
  scenario->emitters.front().active_s = {{0, 2.5}, {4, 4.5}};
  const UnsetVector<float> found = over(scenario, 6);
  EXPECT_NEAR(*std::max_element(found.begin(), found.end()), (0.8 + 0.5) / 6, 1e-5);
}

TEST_P(Occupancy, SeveralEmittersCountWhileAnyIsReceived) {
  auto first = countedAround(scenario::makeGaussian(30, 8, 12, -35), rotating(10, 3));
  auto second = countedAround(scenario::makeGaussian(30, 30, 12, -35), rotating(7, 3));
  auto both = std::make_shared<Scenario>(*first);
  both->emitters.push_back(second->emitters.front());
  both->emitters.back().name = "other";
  const UnsetVector<float> a = over(first, 60), b = over(second, 60), any = over(both, 60);
  for (std::size_t v = 0; v < any.size(); ++v) EXPECT_NEAR(any[v], a[v] + b[v] - a[v] * b[v], 1e-5f);
}

TEST_P(Occupancy, WholeTurnsAreConstantOverTime) {
  const auto scenario =
      occupancyOf(countedAround(scenario::makeGaussian(30, 4, 6, -35), rotating(10, 3)), 12);
  FieldSolver solver = solverOf(scenario);
  valuesOf(solver, scenario, 0);
  EXPECT_TRUE(solver.update(scenario::snapshotAt(scenario, nullptr, 1.3)).volumes.empty());
}

EMSCAPE_ON_BACKENDS(Occupancy);

TEST(OccupancyQuantity, NeedsAnInterval) {
  const auto scenario = countedAround(scenario::makeIsotropic(30), ScanSpec{});
  FieldOptions options;
  options.quantities = {"occupancy"};
  EXPECT_THAT(test::errorOf([&] { FieldSolver(scenario, nullptr, options); }),
              ::testing::HasSubstr("of kind mean"));
}

// Of positions beyond its reach, none is above the level.
TEST(PatternReach, HoldsAllDirectionsAboveALevel) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0, 1);
  PatternReaches reaches;
  for (const AntennaPtr& antenna :
       {scenario::makeGaussian(30, 4, 12, -35), scenario::makeCosecant2(30, 4, 5, 40, -35),
        scenario::makeSinc(30, 1.2, 3, -40), scenario::makePhasedArray(25, 24, 16, 0.5, 1, -45),
        scenario::readAntenna(test::shippedScenario("data/sector_450mhz.msi"))}) {
    for (const double elevation_deg : {0.0, 4.0, 60.0}) {
      SCOPED_TRACE(antenna->description);
      const PatternReach& reach = reaches.of(antenna, elevation_deg);
      EXPECT_EQ(&reach, &reaches.of(antenna, elevation_deg));
      Aim aim;
      aim.cos_elevation = static_cast<float>(std::cos(degToRad(elevation_deg)));
      aim.sin_elevation = static_cast<float>(std::sin(degToRad(elevation_deg)));
      int beyond = 0;
      for (int n = 0; n < 200000; ++n) {
        const double azimuth_rad = kPi * (2 * part(random) - 1), elevation_rad = kPi * (part(random) - 0.5);
        const Vec3d ray{std::cos(azimuth_rad) * std::cos(elevation_rad),
                        std::sin(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad)};
        const float amplitude =
            scenario::patternAmplitude(antenna->view(), turnedBy(aim, vecCast<float>(ray)), 0, 0);
        const double level_db = -70 * part(random);
        const double reach_rad = static_cast<double>(reach.towards(static_cast<float>(dbToRatio(level_db))));
        if (std::abs(azimuth_rad) <= reach_rad) continue;
        ++beyond;
        ASSERT_LE(static_cast<double>(amplitude * amplitude), dbToRatio(level_db))
            << radToDeg(azimuth_rad) << ", " << radToDeg(elevation_rad) << " deg, " << level_db << " dB";
      }
      EXPECT_GT(beyond, 100);
    }
  }
}

}  // namespace
}  // namespace emscape::emfield
