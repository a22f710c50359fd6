// Fields over an interval against fine time steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "emfield/excess/model_check.h"
#include "emfield/solver/interval_beam.h"
#include "emscape/base/units.h"
#include "emscape/scenario/model/poses.h"
#include "scenario/scan/scan_sweep.h"
#include "tests/emfield/radar_duel.h"
#include "tests/emfield/scans.h"
#include "tests/support/on_backends.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using scenario::AntennaPtr;
using scenario::Emitter;
using scenario::IntervalKind;
using scenario::ScanKind;
using scenario::ScanSpec;
using scenario::Scenario;

constexpr double kBegin_s = 1.7;

class Intervals : public test::OnBackends {
 protected:
  UnsetVector<float> valuesOf(FieldSolver& solver, const std::shared_ptr<Scenario>& scenario, double t_s) {
    solver.update(scenario::snapshotAt(scenario, nullptr, t_s));
    return solver.volumes().front().host()->values;
  }
  FieldSolver solverOf(const std::shared_ptr<Scenario>& scenario) {
    FieldOptions options;
    options.backend = GetParam();
    return FieldSolver(scenario, nullptr, options);
  }
  UnsetVector<float> overInterval(const std::shared_ptr<Scenario>& scenario, IntervalKind kind,
                                  double seconds) {
    auto copy = std::make_shared<Scenario>(*scenario);
    copy->output.interval = {kind, seconds, {}};
    FieldSolver solver = solverOf(copy);
    return valuesOf(solver, copy, kBegin_s);
  }
  /// The largest and the mean (dB) of the instants between equal steps, both ends among them.
  struct Instants {
    std::vector<double> largest_db, mean_db;
  };
  Instants byInstants(const std::shared_ptr<Scenario>& scenario, double seconds, double step_s) {
    const int steps = static_cast<int>(std::ceil(seconds / step_s));
    FieldSolver solver = solverOf(scenario);
    std::vector<double> largest, sum;
    for (int n = 0; n <= steps; ++n) {
      const UnsetVector<float> values = valuesOf(solver, scenario, kBegin_s + seconds * n / steps);
      const double weight = (n == 0 || n == steps ? 0.5 : 1) / steps;
      largest.resize(values.size());
      sum.resize(values.size());
      for (std::size_t v = 0; v < values.size(); ++v) {
        const double power = dbToRatio(static_cast<double>(values[v]));
        largest[v] = std::max(largest[v], power);
        sum[v] += weight * power;
      }
    }
    for (double& value : largest) value = ratioToDb(value);
    for (double& value : sum) value = ratioToDb(value);
    return {largest, sum};
  }
  void expectAsByInstants(const std::shared_ptr<Scenario>& scenario, double seconds, double step_s,
                          double tolerance_db = 0.1, double depth_db = 30) {
    const Instants expected = byInstants(scenario, seconds, step_s);
    expectNear(scenario, overInterval(scenario, IntervalKind::max_hold, seconds), expected.largest_db,
               tolerance_db, "largest", depth_db);
    expectNear(scenario, overInterval(scenario, IntervalKind::mean, seconds), expected.mean_db, tolerance_db,
               "mean", depth_db);
  }
  /// Down to depth_db below the beam's maximum at each voxel.
  void expectNear(const std::shared_ptr<Scenario>& scenario, const UnsetVector<float>& found,
                  const std::vector<double>& expected, double tolerance_db, const char* what,
                  double depth_db = 30) {
    auto isotropic = std::make_shared<Scenario>(*scenario);
    isotropic->emitters.front().antenna =
        scenario::makeIsotropic(scenario->emitters.front().antenna->gain_dbi);
    isotropic->emitters.front().active_s.clear();
    FieldSolver solver = solverOf(isotropic);
    const UnsetVector<float> boresight = valuesOf(solver, isotropic, 0);
    const std::vector<double> boresight_db(boresight.begin(), boresight.end());
    ASSERT_EQ(found.size(), expected.size());
    double worst_db = 0;
    std::size_t where = 0;
    for (std::size_t v = 0; v < found.size(); ++v) {
      if (v % (15 * 15) == 7 * 15 + 7) continue;  // straight above, where a pattern may have no one value
      if (expected[v] < boresight_db[v] - depth_db) continue;
      const double difference = std::abs(static_cast<double>(found[v]) - expected[v]);
      if (!(difference <= worst_db)) worst_db = difference, where = v;
    }
    EXPECT_LE(worst_db, tolerance_db)
        << what << ", voxel " << where << ": " << found[where] << " for " << expected[where];
  }
};

// A step turns a beam by a twentieth of its width.
TEST_P(Intervals, SLOW_OneTurnEqualsFineSteps) {
  const double beamwidth_deg = 4;
  for (const AntennaPtr& antenna : {
           scenario::makeGaussian(30, beamwidth_deg, 6, -35),
           scenario::makeCosecant2(30, beamwidth_deg, 5, 40, -35),
           scenario::makeSinc(30, beamwidth_deg, 6, -40),
           scenario::makePhasedArray(25, 24, 16, 0.5, 1, -45),
       }) {
    for (const double elevation_deg : {0.0, 12.0}) {
      SCOPED_TRACE(antenna->description + " at " + std::to_string(elevation_deg));
      const auto scenario = around(antenna, rotating(10, elevation_deg));
      expectAsByInstants(scenario, 6, beamwidth_deg / 20 / 60);
    }
  }
}

TEST_P(Intervals, PartsOfATurnEqualFineSteps) {
  const auto scenario = around(scenario::makeGaussian(30, 4, 6, -35), rotating(-10, 3));
  expectAsByInstants(scenario, 1.9, 0.2 / 60);
  expectAsByInstants(scenario, 8.3, 0.2 / 60);
}

TEST_P(Intervals, SLOW_SectorsAndRastersEqualFineSteps) {
  const AntennaPtr antenna = scenario::makeGaussian(30, 4, 5, -35);
  for (const double seconds : {0.8, 3.7, 9.1}) {
    SCOPED_TRACE(seconds);
    expectAsByInstants(around(antenna, sweeping(ScanKind::sector, 70, 60)), seconds, 0.2 / 60);
  }
  // The beam leaves the end of a bar between two steps.
  expectAsByInstants(around(antenna, sweeping(ScanKind::raster, 70, 60, 3)), 3.7, 0.02 / 60, 0.2);
}

TEST_P(Intervals, SLOW_DwellsEqualFineSteps) {
  for (const double seconds : {0.25, 1.0, 3.6}) {
    SCOPED_TRACE(seconds);
    const auto array = around(scenario::makePhasedArray(25, 16, 12, 0.5, 1, -40), dwelling());
    expectAsByInstants(array, seconds, 0.005, 0.1, 20);
    expectAsByInstants(array, seconds, 0.005, 0.5, 30);
    expectAsByInstants(around(scenario::makeGaussian(25, 5, 5, -40), dwelling()), seconds, 0.005);
  }
}

TEST_P(Intervals, CountTheTimesOfActivity) {
  auto scenario = around(scenario::makeGaussian(30, 4, 6, -35), rotating(10));
  scenario->emitters.front().active_s = {{0, 2.5}, {4, 4.5}};
  const auto largest = overInterval(scenario, IntervalKind::max_hold, 6);
  const auto mean = overInterval(scenario, IntervalKind::mean, 6);
  const Instants expected = byInstants(scenario, 6, 0.02 / 60);
  expectNear(scenario, largest, expected.largest_db, 0.2,
             "largest, at the end of an active time, between two steps");
  expectNear(scenario, mean, expected.mean_db, 0.1, "mean");

  scenario->emitters.front().scan = {};
  scenario->output.interval = {IntervalKind::mean, 6, {}};
  const float part = overInterval(scenario, IntervalKind::mean, 6).front();
  scenario->emitters.front().active_s.clear();
  const float whole = overInterval(scenario, IntervalKind::mean, 6).front();
  EXPECT_NEAR(static_cast<double>(whole - part), -ratioToDb((0.8 + 0.5) / 6), 1e-3);
}

TEST_P(Intervals, WholeTurnsAreConstantOverTime) {
  auto scenario = around(scenario::makeGaussian(30, 4, 6, -35), rotating(7, 3));
  scenario->output.interval = {IntervalKind::max_hold, {}, 2.0};
  FieldSolver solver = solverOf(scenario);
  const UnsetVector<float> first = valuesOf(solver, scenario, 0);
  EXPECT_FALSE(solver.update(scenario::snapshotAt(scenario, nullptr, 1.3)).volumes.size() > 0);
  EXPECT_EQ(first, valuesOf(solver, scenario, 2.1));

  scenario->output.interval = {IntervalKind::max_hold, 12.3, {}};  // 1.4 turns
  FieldSolver longer = solverOf(scenario);
  valuesOf(longer, scenario, 0);
  EXPECT_TRUE(longer.update(scenario::snapshotAt(scenario, nullptr, 1.3)).volumes.empty());
}

TEST_P(Intervals, MaximumIsConstantBeyondOneSweepCycle) {
  auto scenario = around(scenario::makeGaussian(30, 4, 6, -35), sweeping(ScanKind::sector, 90, 50));
  scenario->output.interval = {IntervalKind::max_hold, 4.5, {}};  // of 3.6 s there and back
  FieldSolver solver = solverOf(scenario);
  const UnsetVector<float> first = valuesOf(solver, scenario, 0);
  for (const double t_s : {0.3, 1.1, 2.9, 17.77}) {
    EXPECT_TRUE(solver.update(scenario::snapshotAt(scenario, nullptr, t_s)).volumes.empty()) << t_s;
  }
}

TEST_P(Intervals, PartsOfATurnAreEqualInNewSolver) {
  auto scenario = around(scenario::makeSinc(30, 4, 6, -35), rotating(7, 3));
  scenario->output.interval = {IntervalKind::mean, 3.0, {}};
  FieldSolver solver = solverOf(scenario);
  valuesOf(solver, scenario, 0);
  const UnsetVector<float> later = valuesOf(solver, scenario, 4.9);
  FieldSolver anew = solverOf(scenario);
  EXPECT_EQ(valuesOf(anew, scenario, 4.9), later);
}

/// A radar of which targets are detected half way.
std::shared_ptr<Scenario> radarAround(const ScanSpec& scan) {
  auto scenario = around(scenario::makeGaussian(30, 4, 20, -35), scan);
  Emitter radar = radarOf(scenario->emitters.front().antenna);
  radar.platform = 0;
  radar.scan = scan;
  radar.power_w = 60;
  scenario->emitters = {radar};
  scenario->output.quantities = {"detection_probability"};
  scenario->output.radar_look = scenario::RadarAim::target;
  scenario->output.floor = 0;
  return scenario;
}

TEST_P(Intervals, CumulateTheLooksOfATurn) {
  const auto scenario = radarAround(rotating(10));
  FieldSolver solver = solverOf(scenario);
  const UnsetVector<float> once = valuesOf(solver, scenario, kBegin_s);
  const UnsetVector<float> thrice = overInterval(scenario, IntervalKind::cumulative, 18);
  EXPECT_EQ(overInterval(scenario, IntervalKind::max_hold, 18), once);
  double most = 0;
  for (std::size_t v = 0; v < once.size(); ++v) {
    const double expected = 1 - std::pow(1 - static_cast<double>(once[v]), 3);
    EXPECT_NEAR(static_cast<double>(thrice[v]), expected, 1e-5);
    if (once[v] < 0.9f) most = std::max(most, expected - static_cast<double>(once[v]));
  }
  EXPECT_GT(most, 0.3) << "the scenario must have probabilities between 0 and 1";
}

// Looks are counted by stepping through time: a look is a passage of the beam's azimuth.
TEST_P(Intervals, CumulateTheLooksOfEachAzimuth) {
  for (const ScanSpec& scan : {rotating(10), rotating(-8), sweeping(ScanKind::sector, 90, 50)}) {
    for (const double seconds : {2.0, 9.5}) {
      SCOPED_TRACE(seconds);
      const auto scenario = radarAround(scan);
      FieldSolver solver = solverOf(scenario);
      const UnsetVector<float> once = valuesOf(solver, scenario, kBegin_s);
      const UnsetVector<float> found = overInterval(scenario, IntervalKind::cumulative, seconds);
      const volume::Grid grid = gridOf(scenario->region);
      int compared = 0;
      for (int j = 0; j < grid.dims.y; ++j) {
        for (int i = 0; i < grid.dims.x; ++i) {
          const Vec3d at = grid.center_m(i, j, 3) - grid.center_m(grid.dims.x / 2, grid.dims.y / 2, 0);
          const double azimuth_deg = radToDeg(std::atan2(at.x, at.y));
          int looks = 0;
          double before_deg = 0;
          for (int n = 0; n <= 4000; ++n) {
            const double beam_deg = beamAt(scan, kBegin_s + seconds * n / 4000).azimuth_deg;
            const double off_deg = std::remainder(beam_deg - azimuth_deg, 360);
            if (n > 0 && std::abs(off_deg) < 90 && (off_deg > 0) != (before_deg > 0)) ++looks;
            before_deg = off_deg;
          }
          if (looks == 0 || std::hypot(at.x, at.y) < 2000) continue;
          ++compared;
          const auto v = static_cast<std::size_t>(grid.index(i, j, 3));
          EXPECT_NEAR(static_cast<double>(found[v]), 1 - std::pow(1 - static_cast<double>(once[v]), looks),
                      0.005)
              << looks << " looks at " << azimuth_deg << " deg";
        }
      }
      EXPECT_GT(compared, 50);
    }
  }
}

// The last detection is found by stepping back in time in steps of a twentieth of the beam.
TEST_P(Intervals, AgeOfLastDetection) {
  for (const ScanSpec& scan : {rotating(10), rotating(-8), sweeping(ScanKind::sector, 90, 50)}) {
    for (const double seconds : {2.0, 9.5}) {
      for (const bool pauses : {false, true}) {
        SCOPED_TRACE(::testing::Message() << toString(scan.kind) << " " << seconds << " s " << pauses);
        const auto scenario = radarAround(scan);
        scenario->emitters[0].power_w = 200;
        if (pauses)
          scenario->emitters[0].active_s = {{0, kBegin_s + 0.4 * seconds},
                                            {kBegin_s + 0.6 * seconds, kBegin_s + 0.9 * seconds}};
        const auto isActive = [&](double t_s) {
          return !pauses || t_s < scenario->emitters[0].active_s[0].end_s ||
                 (t_s >= scenario->emitters[0].active_s[1].begin_s &&
                  t_s < scenario->emitters[0].active_s[1].end_s);
        };
        FieldSolver solver = solverOf(scenario);
        const UnsetVector<float> once = valuesOf(solver, scenario, kBegin_s);
        auto aged = std::make_shared<Scenario>(*scenario);
        aged->output.quantities = {"detection_age_s"};
        aged->output.detection_threshold = 0.3;
        const UnsetVector<float> found = overInterval(aged, IntervalKind::cumulative, seconds);
        const double rate_deg_s =
            scan.kind == ScanKind::rotate ? 6 * std::abs(scan.rate_rpm) : scan.rate_deg_s;
        const double step_s = 4.0 / 20 / rate_deg_s;
        const volume::Grid grid = gridOf(scenario->region);
        int detected = 0, undetected = 0, at_edges = 0;
        for (int j = 0; j < grid.dims.y; ++j) {
          for (int i = 0; i < grid.dims.x; ++i) {
            const Vec3d at = grid.center_m(i, j, 1) - grid.center_m(grid.dims.x / 2, grid.dims.y / 2, 0);
            if (std::hypot(at.x, at.y) < 2000) continue;
            const double azimuth_deg = radToDeg(std::atan2(at.x, at.y));
            const auto v = static_cast<std::size_t>(grid.index(i, j, 1));
            double age_s = -1, before_deg = 180;
            for (double back_s = 0; back_s <= seconds && age_s < 0; back_s += step_s) {
              const double t_s = kBegin_s + seconds - back_s;
              const double off_deg = std::remainder(beamAt(scan, t_s).azimuth_deg - azimuth_deg, 360);
              const bool passes = isActive(t_s) && std::abs(off_deg) < 90 && std::abs(before_deg) < 90 &&
                                  (off_deg > 0) != (before_deg > 0);
              if (passes && once[v] >= 0.3f) age_s = back_s;
              before_deg = isActive(t_s) ? off_deg : 180;
            }
            if (std::abs(once[v] - 0.3f) < 0.01f) continue;
            // At the edges of the swept sector and of active intervals, single steps decide.
            const bool is_same =
                (age_s < 0) == (found[v] < 0) &&
                (age_s < 0 || std::abs(static_cast<double>(found[v]) - age_s) <= 1.01 * step_s);
            (is_same ? age_s >= 0 ? detected : undetected : at_edges)++;
          }
        }
        EXPECT_GT(detected, 5);
        EXPECT_GT(undetected, 5);
        EXPECT_LE(at_edges, 6);
      }
    }
  }
}

using Bursts = std::vector<scenario::TimeInterval>;

/// A beam in small steps of time: what each voxel of a radar sees of it.
class SteppedBeam {
 public:
  /// @param solver    of the radar's scan, without active times
  /// @param scenario  its only emitter is in the middle of the region
  SteppedBeam(FieldSolver& solver, const std::shared_ptr<Scenario>& scenario)
      : solver_(solver), scenario_(scenario), grid_(gridOf(scenario->region)) {
    const auto voxels = static_cast<std::size_t>(grid_.dims.count());
    largest.resize(voxels);
    looks.resize(voxels);
    before_deg_.resize(voxels);
  }
  /// Follows the beam from a time to another, in which the emitter is active.
  void follow(double begin_s, double end_s) {
    const ScanSpec& scan = scenario_->emitters[0].scan;
    const double rate_deg_s = scan.kind == ScanKind::rotate ? 6 * std::abs(scan.rate_rpm) : scan.rate_deg_s;
    const int steps = static_cast<int>(std::ceil((end_s - begin_s) * rate_deg_s / 0.2));
    for (int n = 0; n <= steps; ++n) {
      const double t_s = n < steps ? begin_s + (end_s - begin_s) * n / steps : end_s - 1e-9;
      solver_.update(scenario::snapshotAt(scenario_, nullptr, t_s));
      const auto volume = solver_.volumes().front().host();
      const scenario::BeamDirection beam = beamAt(scan, t_s);
      for (std::size_t v = 0; v < looks.size(); ++v) {
        largest[v] = std::max(largest[v], volume->values[v]);
        const double off_deg = std::remainder(beam.azimuth_deg - azimuth_deg(v), 360);
        const double bar_step_deg = scan.kind == ScanKind::raster ? scan.elevation_step_deg : 360;
        const bool is_its_bar = std::abs(barTowards_deg(v) - beam.elevation_deg) < bar_step_deg / 2;
        if (n > 0 && is_its_bar && std::abs(off_deg) < 90 && (off_deg > 0) != (before_deg_[v] > 0))
          ++looks[v];
        before_deg_[v] = off_deg;
      }
    }
  }
  double azimuth_deg(std::size_t v) const {
    const Vec3d at = from(v);
    return radToDeg(std::atan2(at.x, at.y));
  }
  double elevation_deg(std::size_t v) const {
    const Vec3d at = from(v);
    return radToDeg(std::atan2(at.z, std::hypot(at.x, at.y)));
  }
  double levelDistance_m(std::size_t v) const { return std::hypot(from(v).x, from(v).y); }
  /// Elevation of the nearest bar.
  double barTowards_deg(std::size_t v) const {
    const ScanSpec& scan = scenario_->emitters[0].scan;
    double nearest_deg = scan.elevation_deg - (scan.bars - 1) / 2.0 * scan.elevation_step_deg;
    for (int bar = 1; bar < scan.bars; ++bar) {
      const double bar_deg = scan.elevation_deg + (bar - (scan.bars - 1) / 2.0) * scan.elevation_step_deg;
      if (std::abs(bar_deg - elevation_deg(v)) < std::abs(nearest_deg - elevation_deg(v)))
        nearest_deg = bar_deg;
    }
    return nearest_deg;
  }

  std::vector<float> largest;  ///< probability of detection of any instant
  std::vector<int> looks;      ///< number of passes

 private:
  /// In the emitter's east-north-up axes.
  Vec3d from(std::size_t v) const {
    const int i = static_cast<int>(v) % grid_.dims.x, j = static_cast<int>(v) / grid_.dims.x % grid_.dims.y,
              k = static_cast<int>(v) / (grid_.dims.x * grid_.dims.y);
    return grid_.center_m(i, j, k) - grid_.center_m(grid_.dims.x / 2, grid_.dims.y / 2, 0);
  }

  FieldSolver& solver_;
  std::shared_ptr<Scenario> scenario_;
  volume::Grid grid_;
  std::vector<double> before_deg_;
};

// The beam is stepped through all active times: its largest probability of detection, and its passes.
TEST_P(Intervals, SLOW_LookWhereTheBeamPassesInBursts) {
  Bursts many;
  for (int n = 0; n < 13; ++n) many.push_back({kBegin_s + 0.7 * n, kBegin_s + 0.7 * n + 0.31});
  ScanSpec raster = sweeping(ScanKind::raster, 70, 60, 3);
  raster.elevation_deg = raster.elevation_step_deg = 8;
  for (const ScanSpec& scan : {rotating(10), rotating(-8), sweeping(ScanKind::sector, 90, 50), raster}) {
    const auto scenario = radarAround(scan);
    scenario->output.radar_look = scenario::RadarAim::scan;
    const bool is_raster = scan.kind == ScanKind::raster;
    if (is_raster) scenario->emitters[0].antenna = scenario::makeGaussian(30, 4, 6, -35);
    FieldSolver solver = solverOf(scenario);
    for (const auto& [seconds, bursts] : std::vector<std::pair<double, Bursts>>{
             {2.83, {{0, 100}}},
             {1.3, {{kBegin_s, kBegin_s + 0.33}, {kBegin_s + 0.33, kBegin_s + 0.47}}},
             {8, {{kBegin_s + 0.21, kBegin_s + 0.92}, {kBegin_s + 3.34, kBegin_s + 4.45}}},
             {9.2, many},
         }) {
      SCOPED_TRACE(::testing::Message() << toString(scan.kind) << " " << scan.rate_rpm << ", " << seconds
                                        << " s, " << bursts.size() << " bursts");
      SteppedBeam beam(solver, scenario);
      for (std::size_t n = 0; n < bursts.size(); ++n) {
        const double begin_s = std::max(bursts[n].begin_s, kBegin_s);
        double end_s = std::min(bursts[n].end_s, kBegin_s + seconds);
        if (n + 1 < bursts.size() && bursts[n + 1].begin_s == end_s) end_s = bursts[++n].end_s;
        beam.follow(begin_s, end_s);
      }
      auto in_bursts = std::make_shared<Scenario>(*scenario);
      in_bursts->emitters[0].active_s = bursts;
      const UnsetVector<float> once = overInterval(in_bursts, IntervalKind::max_hold, seconds);
      const UnsetVector<float> all = overInterval(in_bursts, IntervalKind::cumulative, seconds);
      const int most = *std::max_element(beam.looks.begin(), beam.looks.end());
      int passed = 0, missed = 0;
      for (std::size_t v = 0; v < once.size(); ++v) {
        if (beam.levelDistance_m(v) < 2000) continue;
        if (is_raster && std::abs(beam.elevation_deg(v) - beam.barTowards_deg(v)) > 0.3) continue;
        const double largest = static_cast<double>(beam.largest[v]);
        const auto inLooks = [&](int looks) { return 1 - std::pow(1 - largest, looks); };
        const std::string where = fmt::format("azimuth {:.3f}, elevation {:.3f}, {} looks",
                                              beam.azimuth_deg(v), beam.elevation_deg(v), beam.looks[v]);
        const bool is_passed = beam.looks[v] > 0;
        (is_passed ? passed : missed)++;
        // Beside a raster's bars, the look in the nearest direction may not be the best one.
        if (is_passed || !is_raster) {
          EXPECT_NEAR(static_cast<double>(once[v]), largest, 0.012) << where;
        } else {
          EXPECT_LE(static_cast<double>(once[v]), largest + 0.012) << where;
        }
        if (is_passed) {
          EXPECT_NEAR(static_cast<double>(all[v]), inLooks(beam.looks[v]), 0.02) << where;
        } else {
          EXPECT_GE(all[v], once[v] - 1e-6f) << where;
          EXPECT_LE(static_cast<double>(all[v]), inLooks(std::max(most, 1)) + 0.02) << where;
        }
      }
      EXPECT_GT(passed, is_raster ? 1 : 50);
      EXPECT_GT(missed, is_raster ? 5 : 20);
    }
  }
}

/// A turning radar and jammers that take turns, from the interval's begin on.
std::shared_ptr<Scenario> radarAmidBlinkingJammers(const ScanSpec& scan) {
  auto scenario = radarAround(scan);
  scenario->emitters[0].power_w = 500;
  const std::vector<Bursts> bursts{
      {{kBegin_s + 0.5, kBegin_s + 2.1}, {kBegin_s + 4, kBegin_s + 9.5}, {kBegin_s + 14.2, kBegin_s + 15}},
      {{kBegin_s + 5, kBegin_s + 7}, {kBegin_s + 12, kBegin_s + 40}}};
  for (const Bursts& active_s : bursts) {
    Emitter jammer = jammerOf(1000 * static_cast<double>(scenario->emitters.size()));
    jammer.active_s = active_s;
    addEmitter(*scenario, pointAt(*scenario, 40e3, 30e3), jammer);
  }
  return scenario;
}

// Each pass of the beam is one look, jammed by those that radiate at its time.
TEST_P(Intervals, JamEachLookByTheJammersOfItsTime) {
  constexpr double kSeconds = 17;
  const auto scenario = radarAmidBlinkingJammers(rotating(10));
  std::vector<UnsetVector<float>> by_jammers;  // bit n: of jammer n
  for (int set = 0; set < 4; ++set) {
    const auto instant = std::make_shared<Scenario>(*scenario);
    for (int n = 0; n < 2; ++n) {
      Emitter& jammer = instant->emitters[static_cast<std::size_t>(n) + 1];
      jammer.active_s.clear();
      jammer.enabled = (set >> n) % 2 == 1;
    }
    FieldSolver solver = solverOf(instant);
    by_jammers.push_back(valuesOf(solver, instant, kBegin_s));
  }
  const UnsetVector<float> all = overInterval(scenario, IntervalKind::cumulative, kSeconds);
  const UnsetVector<float> largest = overInterval(scenario, IntervalKind::max_hold, kSeconds);
  scenario->output.quantities = {"detection_age_s"};
  const UnsetVector<float> age = overInterval(scenario, IntervalKind::cumulative, kSeconds);
  const volume::Grid grid = gridOf(scenario->region);
  int compared = 0, between = 0, aged = 0;
  for (int j = 0; j < grid.dims.y; ++j) {
    for (int i = 0; i < grid.dims.x; ++i) {
      const auto v = static_cast<std::size_t>(grid.index(i, j, 1));
      const Vec3d at = grid.center_m(i, j, 1) - grid.center_m(grid.dims.x / 2, grid.dims.y / 2, 0);
      if (std::hypot(at.x, at.y) < 2000) continue;
      const double azimuth_deg = radToDeg(std::atan2(at.x, at.y));
      double missed = 1, best = 0, age_s = -1;
      bool is_sure = true;
      for (double pass_s = std::fmod(azimuth_deg - 20 + 720, 360) / 60; pass_s < kBegin_s + kSeconds;
           pass_s += 6) {
        is_sure = is_sure && std::abs(pass_s - kBegin_s) > 1e-3;
        if (pass_s < kBegin_s) continue;
        int set = 0;
        for (int n = 0; n < 2; ++n) {
          for (const auto& burst : scenario->emitters[static_cast<std::size_t>(n) + 1].active_s) {
            set |= pass_s >= burst.begin_s && pass_s < burst.end_s ? 1 << n : 0;
            is_sure =
                is_sure && std::abs(pass_s - burst.begin_s) > 1e-3 && std::abs(pass_s - burst.end_s) > 1e-3;
          }
        }
        const double probability = static_cast<double>(by_jammers[static_cast<std::size_t>(set)][v]);
        missed *= 1 - probability;
        best = std::max(best, probability);
        if (probability >= 0.5) age_s = kBegin_s + kSeconds - pass_s;
      }
      if (!is_sure) continue;
      ++compared;
      between += best > 0.1 && best < 0.9;
      aged += age_s > 6;
      EXPECT_NEAR(static_cast<double>(all[v]), 1 - missed, 1e-4) << azimuth_deg;
      EXPECT_GE(static_cast<double>(largest[v]), best - 1e-4) << azimuth_deg;
      if (best > 0.3) {
        EXPECT_NEAR(static_cast<double>(largest[v]), best, 0.02) << azimuth_deg;
      }
      EXPECT_NEAR(static_cast<double>(age[v]), age_s, 1e-3) << azimuth_deg;
    }
  }
  EXPECT_GT(compared, 150);
  EXPECT_GT(between, 20);
  EXPECT_GT(aged, 5) << "some are detected only in an earlier turn";
}

// Whether the parts of an interval are told apart changes nothing by itself, also beside what a scan passes.
TEST_P(Intervals, AreTheSameByTheTimesOfAJammerWithoutPower) {
  ScanSpec northeast = sweeping(ScanKind::sector, 90, 9);  // voxels lie in the directions of its edges
  northeast.azimuth_deg = 45;
  for (const ScanSpec& scan : {rotating(3), rotating(10), sweeping(ScanKind::sector, 90, 9), northeast,
                               sweeping(ScanKind::sector, 70, 60), sweeping(ScanKind::raster, 70, 60, 3)}) {
    const auto scenario = radarAround(scan);
    scenario->emitters[0].power_w = 500;
    addEmitter(*scenario, pointAt(*scenario, 40e3, 30e3), jammerOf(1e-12));
    const volume::Grid grid = gridOf(scenario->region);
    for (const double seconds : {4.0, 10.0}) {
      scenario->emitters[1].active_s.clear();
      const UnsetVector<float> always = overInterval(scenario, IntervalKind::cumulative, seconds);
      scenario->emitters[1].active_s = {{kBegin_s, kBegin_s + 1.3}, {kBegin_s + 2.9, kBegin_s + 3.4}};
      const UnsetVector<float> in_parts = overInterval(scenario, IntervalKind::cumulative, seconds);
      int between = 0;
      for (std::size_t v = 0; v < always.size(); ++v) {
        const Vec3d at = grid.center_m(static_cast<int>(v) % grid.dims.x,
                                       static_cast<int>(v) / grid.dims.x % grid.dims.y, 1) -
                         grid.center_m(grid.dims.x / 2, grid.dims.y / 2, 0);
        if (std::abs(at.x - at.y) < 1e-6) continue;  // the jammer switches while the beam is there
        // The beam turns there: a look or two, as a GPU rounds the direction to either side of one pass.
        if (GetParam() == Backend::cuda && std::min(std::abs(at.x), std::abs(at.y)) < 1e-6) continue;
        EXPECT_NEAR(in_parts[v], always[v], 1e-4F)
            << int(scan.kind) << ", " << seconds << " s, " << radToDeg(std::atan2(at.x, at.y)) << " deg";
        between += always[v] > 0.05F && always[v] < 0.95F;
      }
      EXPECT_GT(between, 10) << int(scan.kind) << ' ' << seconds;
    }
  }
}

TEST_P(Intervals, AreJammedWhileTheJammersPlatformIsPresent) {
  const auto scenario = radarAmidBlinkingJammers(rotating(10));
  scenario->emitters.pop_back();
  Emitter& jammer = scenario->emitters[1];
  jammer.active_s = {{kBegin_s + 3, kBegin_s + 8}};
  const UnsetVector<float> expected = overInterval(scenario, IntervalKind::cumulative, 17);
  jammer.active_s.clear();
  scenario::Platform& platform = scenario->platforms[static_cast<std::size_t>(jammer.platform)];
  platform.track.push_back(platform.track[0]);
  platform.track[0].t_s = kBegin_s + 3;
  platform.track[1].t_s = kBegin_s + 8;
  const UnsetVector<float> found = overInterval(scenario, IntervalKind::cumulative, 17);
  for (std::size_t v = 0; v < found.size(); ++v) ASSERT_NEAR(found[v], expected[v], 1e-6f) << v;
  platform.outside_track = scenario::OutsideTrack::hold;
  EXPECT_NE(overInterval(scenario, IntervalKind::cumulative, 17), expected);
}

// The pose of a live exercise holds for the whole interval, whatever the file's track says of that time.
TEST_P(Intervals, AreJammedWhileAStatedPoseSaysThatTheJammerIsPresent) {
  const auto scenario = radarAmidBlinkingJammers(rotating(10));
  scenario->emitters.pop_back();
  scenario->output.interval = {IntervalKind::cumulative, 17, {}};
  scenario->emitters[1].active_s.clear();
  const auto with = [&](bool enabled) {
    const auto copy = std::make_shared<Scenario>(*scenario);
    copy->emitters[1].enabled = enabled;
    FieldSolver solver = solverOf(copy);
    return valuesOf(solver, copy, kBegin_s);
  };
  const UnsetVector<float> jammed = with(true), unjammed = with(false);
  ASSERT_NE(jammed, unjammed);
  const int carrier = scenario->emitters[1].platform;
  scenario::Platform& platform = scenario->platforms[static_cast<std::size_t>(carrier)];
  const scenario::SitePosition there = platform.track[0].position;
  for (const bool moves : {false, true}) {
    if (moves) {  // and comes long after the interval
      platform.track.push_back(platform.track[0]);
      platform.track[0].t_s = kBegin_s + 100;
      platform.track[1].t_s = kBegin_s + 110;
    }
    FieldSolver solver = solverOf(scenario);
    const auto posed = [&](bool is_present) {
      solver.update(kBegin_s, {{carrier, there, {}, is_present}});
      return solver.volumes().front().host()->values;
    };
    for (const bool is_present : {true, false, true}) {
      const UnsetVector<float> found = posed(is_present);
      const UnsetVector<float>& expected = is_present ? jammed : unjammed;
      for (std::size_t v = 0; v < found.size(); ++v)
        ASSERT_NEAR(found[v], expected[v], 1e-6f) << v << ' ' << moves << is_present;
    }
  }
}

// What a radar's scan would pass before its platform comes is shared out as without jamming.
TEST_P(Intervals, OfARadarThatComesInTheirCourseAreTheSameByTheTimesOfAJammerWithoutPower) {
  for (const ScanSpec& scan : {rotating(3), sweeping(ScanKind::sector, 90, 9)}) {
    const auto scenario = radarAround(scan);
    scenario->emitters[0].power_w = 500;
    addEmitter(*scenario, pointAt(*scenario, 40e3, 30e3), jammerOf(1e-12));
    std::vector<scenario::TrackPoint>& track =
        scenario->platforms[static_cast<std::size_t>(scenario->emitters[0].platform)].track;
    track.push_back(track[0]);
    track[0].t_s = kBegin_s + 6;
    track[1].t_s = kBegin_s + 100;
    const UnsetVector<float> always = overInterval(scenario, IntervalKind::cumulative, 10);
    scenario->emitters[1].active_s = {{kBegin_s + 7.3, kBegin_s + 8.1}};
    const UnsetVector<float> in_parts = overInterval(scenario, IntervalKind::cumulative, 10);
    int between = 0;
    for (std::size_t v = 0; v < always.size(); ++v) {
      EXPECT_NEAR(in_parts[v], always[v], 1e-4F) << v << ' ' << int(scan.kind);
      between += always[v] > 0.05F && always[v] < 0.95F;
    }
    EXPECT_GT(between, 10) << int(scan.kind);
  }
}

// A beam that stands still has one look in the interval, shared out by time.
TEST_P(Intervals, SharesTheLooksOfAFixedBeamByTheTimesOfJammers) {
  ScanSpec scan;
  scan.kind = ScanKind::track;
  const auto scenario = radarAmidBlinkingJammers(scan);
  scenario->emitters.pop_back();
  const UnsetVector<float> found = overInterval(scenario, IntervalKind::cumulative, 10);
  const double jammed = (1.6 + 5.5) / 10;
  std::vector<UnsetVector<float>> by_jammers;
  for (const bool is_on : {false, true}) {
    const auto instant = std::make_shared<Scenario>(*scenario);
    instant->emitters[1].active_s.clear();
    instant->emitters[1].enabled = is_on;
    FieldSolver solver = solverOf(instant);
    by_jammers.push_back(valuesOf(solver, instant, kBegin_s));
  }
  for (std::size_t v = 0; v < found.size(); ++v) {
    const double missed = std::pow(1 - static_cast<double>(by_jammers[0][v]), 1 - jammed) *
                          std::pow(1 - static_cast<double>(by_jammers[1][v]), jammed);
    ASSERT_NEAR(static_cast<double>(found[v]), 1 - missed, 1e-4) << v;
  }
}

TEST_P(Intervals, CountEveryBurst) {
  auto scenario = radarAround(rotating(10));
  FieldSolver solver = solverOf(scenario);
  const UnsetVector<float> once = valuesOf(solver, scenario, kBegin_s);
  const volume::Grid grid = gridOf(scenario->region);
  const auto at_20_deg_east = static_cast<std::size_t>(grid.index(9, 13, 1));
  for (const int turns : {1, 4, 5, 12, 40}) {
    Bursts& bursts = scenario->emitters[0].active_s;
    bursts.clear();
    // From azimuth 356 to 44 in each turn.
    for (int n = 0; n < turns; ++n) bursts.push_back({6 * n + 5.6, 6 * n + 6.4});
    const UnsetVector<float> found = overInterval(scenario, IntervalKind::cumulative, 6 * turns);
    EXPECT_NEAR(static_cast<double>(found[at_20_deg_east]),
                1 - std::pow(1 - static_cast<double>(once[at_20_deg_east]), turns), 1e-5);
  }
}

TEST_P(Intervals, AgeOfDetectionsInManyBursts) {
  auto scenario = radarAround(rotating(10));
  scenario->emitters[0].power_w = 2000;
  FieldSolver solver = solverOf(scenario);
  const UnsetVector<float> once = valuesOf(solver, scenario, kBegin_s);
  scenario->output.quantities = {"detection_age_s"};
  // Nearly two turns; the bursts of the second are at other azimuths.
  constexpr double kPeriod_s = 0.47, kBurst_s = 0.23, kEnd_s = kBegin_s + 11.9;
  for (int n = 0; n < 30; ++n)
    scenario->emitters[0].active_s.push_back({kPeriod_s * n, kPeriod_s * n + kBurst_s});
  const UnsetVector<float> found = overInterval(scenario, IntervalKind::cumulative, kEnd_s - kBegin_s);
  const volume::Grid grid = gridOf(scenario->region);
  int counts[3] = {};
  for (int j = 0; j < grid.dims.y; ++j) {
    for (int i = 0; i < grid.dims.x; ++i) {
      const auto v = static_cast<std::size_t>(grid.index(i, j, 1));
      const Vec3d at = grid.center_m(i, j, 1) - grid.center_m(grid.dims.x / 2, grid.dims.y / 2, 0);
      if (once[v] < 0.5f || std::hypot(at.x, at.y) < 2000) continue;
      const double azimuth_deg = radToDeg(std::atan2(at.x, at.y));
      const double first_pass_s = std::fmod(azimuth_deg - 20 + 720, 360) / 60;
      double age_s = -1;
      int turn = 0;
      for (int n = 0; n < 3; ++n) {
        const double pass_s = first_pass_s + 6 * n;
        const bool is_lit = pass_s >= kBegin_s && pass_s < kEnd_s && std::fmod(pass_s, kPeriod_s) < kBurst_s;
        if (is_lit) age_s = kEnd_s - pass_s, turn = age_s < 6 ? 1 : 2;
      }
      ++counts[turn];
      EXPECT_NEAR(static_cast<double>(found[v]), age_s, 1e-4) << azimuth_deg;
    }
  }
  for (const int count : counts) EXPECT_GT(count, 20);
}

TEST_P(Intervals, CountCyclesOfDwellsInActiveTimes) {
  auto scenario = radarAround(dwelling());
  const UnsetVector<float> twice = overInterval(scenario, IntervalKind::cumulative, 2.1);
  EXPECT_NE(twice, overInterval(scenario, IntervalKind::cumulative, 20));
  scenario->emitters[0].active_s = {{kBegin_s - 1, kBegin_s + 1.3}, {kBegin_s + 15, kBegin_s + 15.8}};
  EXPECT_EQ(twice, overInterval(scenario, IntervalKind::cumulative, 20));
  ScanSpec one = dwelling();
  one.dwells.resize(1);
  scenario = radarAround(one);
  const double cycle_s = one.dwells[0].duration_s;
  const UnsetVector<float> once = overInterval(scenario, IntervalKind::cumulative, cycle_s),
                           thrice = overInterval(scenario, IntervalKind::cumulative, 3 * cycle_s);
  for (std::size_t v = 0; v < once.size(); ++v)
    EXPECT_NEAR(thrice[v], 1 - std::pow(1 - once[v], 3), 1e-5) << v;
}

TEST_P(Intervals, DetectAwayFromAllDwellsOnlyByTheNearestDwellsBeam) {
  ScanSpec scan;
  scan.kind = ScanKind::dwell_list;
  scan.dwells = {{-20, 3, 0.4}, {10, 3, 0.3}, {35, 3, 0.3}};
  for (const bool is_array : {false, true}) {
    const auto scenario = radarAround(scan);
    Emitter& radar = scenario->emitters[0];
    radar.antenna =
        is_array ? scenario::makePhasedArray(30, 24, 24, 0.5, 1, -60) : scenario::makeGaussian(30, 4, 4, -60);
    radar.power_w = 6e4;
    const UnsetVector<float> held = overInterval(scenario, IntervalKind::max_hold, 1.0);
    std::vector<float> largest(held.size(), 0);
    for (const scenario::Dwell& dwell : scan.dwells) {  // each alone, the beam as the scan has it
      const auto one = radarAround(scan);
      one->emitters[0].antenna = radar.antenna;
      one->emitters[0].power_w = radar.power_w;
      one->emitters[0].scan.dwells = {dwell};
      one->output.radar_look = scenario::RadarAim::scan;
      FieldSolver solver = solverOf(one);
      const UnsetVector<float> here = valuesOf(solver, one, kBegin_s);
      for (std::size_t v = 0; v < held.size(); ++v) largest[v] = std::max(largest[v], here[v]);
    }
    int seen = 0;
    for (std::size_t v = 0; v < held.size(); ++v) {
      ASSERT_NEAR(held[v], largest[v], 2e-3) << v << (is_array ? ", array" : ", turning");
      seen += largest[v] > 0.5f;
    }
    EXPECT_GT(seen, 10);
  }
}

TEST_P(Intervals, MeanPowerDensityIsThatOfThePulsesTimesTheDutyCycle) {
  auto scenario = radarAround(rotating(10));
  scenario->emitters[0].waveform = scenario::Waveform{1000, 1e-5, {}};
  scenario->output.floor = -300;
  scenario->output.quantities = {"power_density_dbwm2"};
  const UnsetVector<float> pulses = overInterval(scenario, IntervalKind::mean, 6);
  scenario->output.quantities = {"mean_power_density_dbwm2"};
  const UnsetVector<float> mean = overInterval(scenario, IntervalKind::mean, 6);
  for (std::size_t v = 0; v < mean.size(); ++v) ASSERT_NEAR(mean[v], pulses[v] - 20, 1e-3) << v;
}

TEST_P(Intervals, NarrowBeamsEqualFineSteps) {
  const double width_deg = 0.2;
  const auto scenario =
      around(scenario::makeGaussian(48, width_deg, 4, -35), sweeping(ScanKind::sector, 4, 2));
  // Close to the ground of the region's middle a voxel is at most 0.1 degrees from the middle of the sector.
  expectAsByInstants(scenario, 2, width_deg / 20 / 2);
}

TEST(IntervalWarnings, NameTheErrorOfATableThatIsCoarseForTheBeam) {
  ScanSpec scan;
  scan.kind = ScanKind::dwell_list;
  const auto warnings = [&](int dwells, IntervalKind kind) {
    scan.dwells.clear();
    for (int n = 0; n < dwells; ++n)
      scan.dwells.push_back({-60 + n * 0.04, -30 + std::fmod(n * 7.7, 60), 1e-3});
    const auto scenario = around(scenario::makeGaussian(60, 0.1, 0.1, -40), scan);
    scenario->output.interval = {kind, {}, 1.0};
    std::string all;
    for (const std::string& warning : checkModels(*scenario)) all += warning;
    return all;
  };
  EXPECT_EQ(warnings(5, IntervalKind::max_hold), "");
  EXPECT_EQ(warnings(3000, IntervalKind::instant), "");
  EXPECT_NE(warnings(3000, IntervalKind::max_hold).find("dB low; a shorter interval has fewer directions"),
            std::string::npos);
}

TEST_P(Intervals, AdjacentActiveTimesEqualOne) {
  auto scenario = radarAround(rotating(10));
  for (const IntervalKind kind : {IntervalKind::max_hold, IntervalKind::cumulative}) {
    scenario->emitters[0].active_s = {{0, 2.5}};
    const UnsetVector<float> expected = overInterval(scenario, kind, 6);
    scenario->emitters[0].active_s = {{2, 2.5}, {0, 2}, {1, 1.5}};
    EXPECT_EQ(overInterval(scenario, kind, 6), expected);
  }
}

TEST_P(Intervals, HoldTheLargestOfBurstsThatOverlapInAzimuth) {
  auto scenario = around(scenario::makeGaussian(30, 4, 6, -35), rotating(10));
  Bursts& bursts = scenario->emitters[0].active_s;
  bursts = {{2, 3.2}};
  const UnsetVector<float> expected = overInterval(scenario, IntervalKind::max_hold, 60);
  bursts.clear();
  for (int n = 0; n < 10; ++n) bursts.push_back({2 + 6.1 * n, 2.3 + 6.1 * n});  // 6 degrees on in each turn
  const UnsetVector<float> found = overInterval(scenario, IntervalKind::max_hold, 60);
  for (std::size_t v = 0; v < found.size(); ++v) ASSERT_NEAR(found[v], expected[v], 1e-3) << v;

  scenario->output.interval = {IntervalKind::max_hold, 60.0, {}};
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, kBegin_s);
  const IntervalBeam beam =
      intervalBeam(*scenario, scenario->emitters[0], snapshot.emitters[0], kBegin_s, false, nullptr);
  EXPECT_EQ(beam.of_sweep.arcs.size(), 1U) << "the time to compute a pattern grows with their number";
}

TEST_P(Intervals, FixedRadarDetectsContinuously) {
  ScanSpec scan;
  scan.kind = ScanKind::track;
  const auto scenario = radarAround(scan);
  FieldSolver solver = solverOf(scenario);
  const UnsetVector<float> once = valuesOf(solver, scenario, kBegin_s);
  scenario->output.quantities = {"detection_age_s"};
  for (const float age_s : {0.0f, 2.0f}) {
    if (age_s > 0) scenario->emitters[0].active_s = {{0, kBegin_s + 8}};
    const UnsetVector<float> found = overInterval(scenario, IntervalKind::cumulative, 10);
    int detected = 0;
    for (std::size_t v = 0; v < once.size(); ++v) {
      const bool is_detected = once[v] >= 0.5f;
      detected += is_detected ? 1 : 0;
      EXPECT_NEAR(found[v], is_detected ? age_s : -1, 1e-4f);
    }
    EXPECT_GT(detected, 5);
  }
}

EMSCAPE_ON_BACKENDS(Intervals);

}  // namespace
}  // namespace emscape::emfield
