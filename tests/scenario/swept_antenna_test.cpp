// Patterns of intervals of narrow beams against the beam in small steps.
#include "scenario/scan/swept_antenna.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "emscape/base/units.h"
#include "scenario/antenna/pattern.h"
#include "scenario/antenna/shapes.h"

namespace emscape::scenario {
namespace {

Vec3d directionOf(double azimuth_deg, double elevation_deg) {
  const double azimuth_rad = degToRad(azimuth_deg), elevation_rad = degToRad(elevation_deg);
  return {std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}

/// Power of an antenna that is turned to an azimuth and tilted.
double turnedPower(const Antenna& antenna, double azimuth_deg, double tilt_deg, const Vec3d& direction) {
  const double turn_rad = degToRad(azimuth_deg), tilt_rad = degToRad(tilt_deg);
  const double ahead = direction.x * std::cos(turn_rad) + direction.y * std::sin(turn_rad),
               right = direction.y * std::cos(turn_rad) - direction.x * std::sin(turn_rad);
  const double amplitude =
      antenna.amplitudeTowards({ahead * std::cos(tilt_rad) + direction.z * std::sin(tilt_rad), right,
                                direction.z * std::cos(tilt_rad) - ahead * std::sin(tilt_rad)},
                               0, 0);
  return amplitude * amplitude;
}

/// The power of an interval, from 60 steps per beamwidth.
double steppedPower(const Antenna& antenna, const ScanSweep& sweep, SweptPattern pattern,
                    const Vec3d& direction) {
  double power = 0;
  const auto add = [&](double share, double value) {
    power = pattern == SweptPattern::mean ? power + share * value : std::max(power, value);
  };
  for (const SweptArc& arc : sweep.arcs) {
    const int steps = std::max(1, static_cast<int>(std::ceil(arc.width_deg / antenna.beamwidth_az_deg * 60)));
    for (int n = 0; n < steps; ++n) {
      const double at = pattern == SweptPattern::mean ? n + 0.5 : double(n) * steps / std::max(1, steps - 1);
      add(arc.share / steps,
          turnedPower(antenna, arc.first_deg + arc.width_deg * at / steps, arc.elevation_deg, direction));
    }
  }
  for (const SweptDwell& dwell : sweep.dwells) {
    const Vec3d steering = directionOf(dwell.azimuth_deg, dwell.elevation_deg);
    const double amplitude = antenna.amplitudeTowards(direction, steering.y, steering.z);
    add(dwell.share, amplitude * amplitude);
  }
  return power;
}

/// Directions around the ends and the middles of arcs, and around dwells, down to 20 dB below the maximum.
void expectAsInSteps(const AntennaPtr& antenna, const ScanSweep& sweep, double tolerance_db = 0.1) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> off(-1.5, 1.5);
  std::vector<std::pair<double, double>> middles_deg;
  for (const SweptArc& arc : sweep.arcs) {
    for (const double at : {0.0, 0.377, 1.0})
      middles_deg.emplace_back(arc.first_deg + at * arc.width_deg, arc.elevation_deg);
  }
  for (const SweptDwell& dwell : sweep.dwells)
    middles_deg.emplace_back(dwell.azimuth_deg, dwell.elevation_deg);
  for (const SweptPattern pattern : {SweptPattern::largest, SweptPattern::mean}) {
    const AntennaPtr swept = sweptAntenna(*antenna, sweep, pattern);
    const PatternView view = swept->view();
    double worst_db = 0, largest = 0;
    for (const auto& [azimuth_deg, elevation_deg] : middles_deg)
      largest =
          std::max(largest, steppedPower(*antenna, sweep, pattern, directionOf(azimuth_deg, elevation_deg)));
    int compared = 0;
    for (const auto& [azimuth_deg, elevation_deg] : middles_deg) {
      for (int n = 0; n < 15; ++n) {
        const double scale = n == 0 ? 0 : 1;
        const Vec3d direction = directionOf(azimuth_deg + scale * off(random) * antenna->beamwidth_az_deg,
                                            elevation_deg + scale * off(random) * antenna->beamwidth_el_deg);
        const double expected = steppedPower(*antenna, sweep, pattern, direction);
        if (expected < largest / 100) continue;
        const double found = double(patternAmplitude(view, vecCast<float>(direction), 0, 0));
        worst_db = std::max(worst_db, std::abs(ratioToDb(found * found / expected)));
        ++compared;
      }
    }
    EXPECT_GT(compared, 15);
    EXPECT_LE(worst_db, tolerance_db)
        << antenna->description << (pattern == SweptPattern::mean ? ", mean" : ", largest");
    EXPECT_LE(lowOnAxis_db(*antenna, sweep), 0.05);
  }
}

TEST(SweptAntennas, SLOW_EqualNarrowBeamsInSmallSteps) {
  ScanSweep sector, raster, turn, dwells, stays;
  sector.arcs = {{-3.21, 6.42, 1.234, 1, 2}};
  raster.arcs = {{-2, 4, 0.3, 0.5, 1}, {-2, 4, 0.7, 0.5, 1}};
  turn.arcs = {{170, 15, 0, 1, 1}};  // across the end of the table
  stays.arcs = {{-20, 0, 3, 0.3, 1}, {31.7, 0, -2, 0.7, 1}};
  dwells.dwells = {{-20, 0.5, 0.3}, {35.4, 11, 0.2}, {5, -3, 0.5}};
  for (const ScanSweep& sweep : {sector, raster, turn, stays})
    expectAsInSteps(makeGaussian(50, 0.2, 0.2, -40), sweep);
  for (const double width_deg : {0.5, 0.1})
    expectAsInSteps(makeGaussian(50, width_deg, width_deg, -40), sector);
  expectAsInSteps(makeGaussian(45, 0.2, 4, -40), sector);
  expectAsInSteps(makeSinc(50, 0.2, 0.4, -40), sector, 0.5);  // next to nulls
  expectAsInSteps(makePhasedArray(45, 400, 400, 0.5, 1, -50), dwells);
}

TEST(SweptAntennas, SLOW_OfManyBurstsEqualTheBeamInSmallSteps) {
  ScanSweep bursts;
  for (int n = 0; n < 40; ++n) bursts.arcs.push_back({9.0 * n - 180, 4.1, 1, n % 3 * 0.01, 1});
  ASSERT_TRUE(areManyArcs(bursts.arcs.size(), 1, SweptPattern::mean));
  // largest values have kinks between bursts, which a table cuts
  expectAsInSteps(makeGaussian(30, 5, 6, -40), bursts, 0.3);
}

TEST(SweptAntennas, SLOW_EqualWholeTurnsOfNarrowBeamsInSmallSteps) {
  ScanSweep turns;
  turns.arcs = {{0, 360, 2.345, 1, 1}};
  for (const double width_deg : {0.3, 0.1})
    expectAsInSteps(makeGaussian(50, width_deg, width_deg, -40), turns);
}

TEST(SweptAntennas, FewerStepsAroundVeryManyDirectionsAreTold) {
  ScanSweep sweep;
  for (int n = 0; n < 3000; ++n) sweep.dwells.push_back({-60 + n * 0.04, -30 + std::fmod(n * 7.7, 60), 1e-3});
  const double low_db = lowOnAxis_db(*makePhasedArray(45, 1000, 1000, 0.5, 1, -50), sweep);
  EXPECT_GT(low_db, 0.5);
  EXPECT_LT(low_db, 5);
}

}  // namespace
}  // namespace emscape::scenario
