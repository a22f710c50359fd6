// Free space and the radar equation through the whole pipeline, against published figures: the values are
// read from voxels.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "emscape/base/units.h"
#include "emscape/emfield/solver/field_solver.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/files.h"
#include "tests/support/reference_data.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;

constexpr double kSpacing_m = 1000;

struct FreeSpaceRow {
  double frequency_hz, distance_m, eirp_dbw, loss_db, power_density_dbwm2, field_dbuvm, received_dbw;
};

std::vector<std::vector<std::string>> csvRows(const std::string& file) {
  std::ifstream in(file);
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::stringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    rows.push_back(cells);
  }
  return rows;
}

class FreeSpaceTable : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string file = test::sourceFile("tests/data/reference/radar/freespace_conversions_derived.csv");
    for (const auto& cells : csvRows(file)) {
      rows_.push_back({std::stod(cells[0]) * 1e6, std::stod(cells[1]) * 1e3, std::stod(cells[2]),
                       std::stod(cells[3]), std::stod(cells[4]), std::stod(cells[5]), std::stod(cells[6])});
    }
    ASSERT_FALSE(rows_.empty());
  }

  /// One radiating antenna; the three quantities of the table.
  std::vector<volume::Volume> volumesFor(const FreeSpaceRow& row, scenario::AntennaPtr antenna,
                                         double azimuth_deg) {
    auto scenario = lineOfVoxels(100e3, kSpacing_m);
    scenario::Emitter emitter = plainEmitter("source", 0);
    emitter.frequency_hz = row.frequency_hz;
    emitter.antenna = antenna;
    emitter.power_w = dbToRatio(row.eirp_dbw - antenna->gain_dbi);
    emitter.scan.azimuth_deg = azimuth_deg;
    addEmitter(*scenario, middleOf(*scenario), emitter);
    scenario->receivers.emplace_back();
    scenario->output.quantities = {"power_density_dbwm2", "field_strength_dbuvm", "received_power_dbm"};
    SolvedField solver(scenario);
    return solver.volumes();
  }

  void expectTable(const scenario::AntennaPtr& antenna, double azimuth_deg, double pattern_db) {
    for (const FreeSpaceRow& row : rows_) {
      SCOPED_TRACE(::testing::Message() << row.frequency_hz << " Hz, " << row.distance_m << " m");
      const auto volumes = volumesFor(row, antenna, azimuth_deg);
      EXPECT_NEAR(valueEast(*volumes[0].host(), row.distance_m), row.power_density_dbwm2 + pattern_db, 1e-4);
      EXPECT_NEAR(valueEast(*volumes[1].host(), row.distance_m), row.field_dbuvm + pattern_db, 1e-4);
      EXPECT_NEAR(valueEast(*volumes[2].host(), row.distance_m), row.received_dbw + 30 + pattern_db, 1e-4);
      EXPECT_NEAR(row.eirp_dbw + pattern_db - (valueEast(*volumes[2].host(), row.distance_m) - 30),
                  row.loss_db, 1e-4);
    }
  }

  std::vector<FreeSpaceRow> rows_;
};

TEST_F(FreeSpaceTable, HoldsForAnIsotropicAntenna) {
  expectTable(scenario::makeIsotropic(), 0, 0);
}

TEST_F(FreeSpaceTable, HoldsOnTheAxisOfABeam) {
  expectTable(scenario::makeGaussian(30, 4, 6, -60), 90, 0);
}

TEST_F(FreeSpaceTable, HoldsAtTheHalfPowerAngleOfABeam) {
  expectTable(scenario::makeGaussian(30, 4, 6, -60), 88, 10 * std::log10(0.5));
}

TEST_F(FreeSpaceTable, HoldsOffTheAxisByTheBeamsWidth) {
  expectTable(scenario::makeGaussian(30, 4, 6, -60), 94, 4 * 10 * std::log10(0.5));
}

TEST_F(FreeSpaceTable, HoldsForASincApertureOffItsAxis) {
  // sinc^2 at the half-power angle is one half by the definition of the beamwidth.
  expectTable(scenario::makeSinc(28, 8, 8, -60), 94, 10 * std::log10(0.5));
}

class RadarEquation : public ::testing::Test {
 protected:
  /// Signal-to-noise (dB) at a range, read from the voxel there.
  static double snrAt(double range_m, double frequency_hz, double power_w, double pulse_s, double gain_db,
                      double rcs_m2, double loss_db) {
    auto scenario = lineOfVoxels(range_m, range_m);
    scenario::Emitter radar = plainEmitter("radar", 0);
    radar.kind = scenario::EmitterKind::radar;
    radar.frequency_hz = frequency_hz;
    radar.power_w = power_w;
    radar.antenna = scenario::makeIsotropic(gain_db);
    radar.losses_db = loss_db / 2;
    radar.receiver.losses_db = loss_db / 2;
    radar.receiver.bandwidth_hz = 1 / pulse_s;
    radar.receiver.target_rcs_m2 = rcs_m2;
    addEmitter(*scenario, middleOf(*scenario), radar);
    scenario->output.quantities = {"snr_db"};
    return valueEast(*solve(scenario), range_m);
  }
};

TEST_F(RadarEquation, AgreesWithPublishedWorkedExamples) {
  const std::string name = "reference/radar/radar_equation_worked_examples.csv";
  const auto file = test::referenceFile(name);
  if (!file) GTEST_SKIP() << test::notInRepository(name);
  // Five significant digits of the expected range or power.
  constexpr double kTolerance_db = 5e-4;
  for (const auto& cells : csvRows(*file)) {
    SCOPED_TRACE(cells[0]);
    const bool is_range = cells[1] == "max range";
    const double expected = std::stod(cells[11]);
    const double range_m = is_range ? expected : std::stod(cells[10]);
    const double power_w = is_range ? std::stod(cells[3]) : expected;
    EXPECT_NEAR(snrAt(range_m, std::stod(cells[2]) * 1e9, power_w, std::stod(cells[4]), std::stod(cells[5]),
                      std::stod(cells[6]), std::stod(cells[7])),
                std::stod(cells[9]), kTolerance_db);
  }
}

TEST_F(RadarEquation, FallsByFortyDecibelsADecade) {
  const double near_db = snrAt(1e4, 3e9, 1e5, 1e-6, 30, 5, 3);
  EXPECT_NEAR(near_db - snrAt(1e5, 3e9, 1e5, 1e-6, 30, 5, 3), 40, 1e-4);
}

TEST_F(RadarEquation, CountsLossesTwiceIfTheReceiverHasTheSame) {
  EXPECT_NEAR(snrAt(1e4, 3e9, 1e5, 1e-6, 30, 5, 0) - snrAt(1e4, 3e9, 1e5, 1e-6, 30, 5, 6), 6, 1e-4);
}

TEST(FreeSpace, PowersAddAndDecibelsDoNot) {
  auto scenario = lineOfVoxels(10e3, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("a", 0));
  const float one = valueEast(*solve(scenario), 5e3);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("b", 0));
  EXPECT_NEAR(valueEast(*solve(scenario), 5e3) - one, 10 * std::log10(2.0), 1e-4);
  scenario->output.combine = scenario::CombineMode::max;
  EXPECT_NEAR(valueEast(*solve(scenario), 5e3), one, 1e-4);
}

TEST(FreeSpace, StaysFiniteAtTheEmitterItself) {
  auto scenario = lineOfVoxels(10e3, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("a", 0));
  const auto volume = solve(scenario);
  EXPECT_NEAR(valueEast(*volume, 0), 30 - 10 * std::log10(4 * kPi), 1e-3) << "as at one metre";
  for (float value : volume->values) EXPECT_TRUE(std::isfinite(value));
}

TEST(FreeSpace, AltitudeFrameEqualsTangentPlane) {
  // The same points, reached through either frame: GeographicLib moves them from one to the other.
  const Vec3d size_m{80e3, 80e3, 8000};
  auto flat = emptyScenario(FrameKind::altitude, 68.2, 179.9, size_m, {16, 16, 8});
  const GeodeticPosition site{68.3, -179.8, 900};
  addEmitter(*flat, site, plainEmitter("a", 0));
  const auto volume = solve(flat);
  const GeoFrame frame(volume->grid.frame);
  for (int j = 0; j < 16; j += 3) {
    for (int i = 0; i < 16; i += 3) {
      const Vec3d ecef = toEcef(frame.toGeodetic(volume->grid.center_m(i, j, 5)));
      const double distance_m = length(ecef - toEcef(site));
      EXPECT_NEAR(valueAt(*volume, i, j, 5), 30 - 10 * std::log10(4 * kPi * distance_m * distance_m), 1e-4);
    }
  }
}

TEST(FreeSpace, AnEmitterFarOutsideTheVolumeAndOneAtThePoleAreRight) {
  auto scenario = emptyScenario(FrameKind::altitude, 89.5, 20, {60e3, 60e3, 4000}, {12, 12, 4});
  scenario->output.combine = scenario::CombineMode::per_emitter;
  const GeodeticPosition far{86.0, -100, 5000}, pole{90, 0, 3000};
  addEmitter(*scenario, far, plainEmitter("far", 0));
  addEmitter(*scenario, pole, plainEmitter("pole", 0));
  SolvedField solver(scenario);
  ASSERT_EQ(solver.volumes().size(), 2u);
  const GeoFrame frame(solver.grid().frame);
  const GeodeticPosition sites[] = {far, pole};
  for (int e = 0; e < 2; ++e) {
    for (int i = 0; i < 12; ++i) {
      const Vec3d ecef = toEcef(frame.toGeodetic(solver.grid().center_m(i, 11 - i, 2)));
      const double distance_m = length(ecef - toEcef(sites[e]));
      EXPECT_NEAR(valueAt(*solver.volumes()[e].host(), i, 11 - i, 2),
                  30 - 10 * std::log10(4 * kPi * distance_m * distance_m), 1e-4);
    }
  }
}

}  // namespace
}  // namespace emscape::emfield
