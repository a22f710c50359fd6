// The pattern of an interval with many arcs against those of its parts, which have few and are summed arc by
// arc.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "emscape/base/units.h"
#include "scenario/antenna/pattern.h"
#include "scenario/antenna/shapes.h"
#include "scenario/scan/swept_antenna.h"
#include "tests/support/stopping.h"

namespace emscape::scenario {
namespace {

Vec3f arcDirection(double azimuth_deg, double elevation_deg) {
  const double azimuth = degToRad(azimuth_deg), elevation = degToRad(elevation_deg);
  return vecCast<float>(Vec3d{std::cos(azimuth) * std::cos(elevation),
                              std::sin(azimuth) * std::cos(elevation), std::sin(elevation)});
}

double powerOf(const Antenna& antenna, const Vec3f& direction) {
  const double amplitude = static_cast<double>(patternAmplitude(antenna.view(), direction, 0, 0));
  return amplitude * amplitude;
}

/// Arcs at random azimuths, also across north and of more than a turn, of several tilts and widths from 0 on.
ScanSweep drawnSweep(unsigned seed, int arcs, double widest_deg) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> turn(-400, 400), width(0, widest_deg);
  ScanSweep sweep;
  for (int n = 0; n < arcs; ++n) {
    const bool is_turn = n % 50 == 49;
    sweep.arcs.push_back({turn(random),
                          n % 7 == 0 ? 0
                          : is_turn  ? 500
                                     : width(random),
                          5.0 * (n % 3), 0.8 / arcs, 1});
  }
  return sweep;
}

ScanSweep partOf(const ScanSweep& sweep, std::size_t begin, std::size_t end) {
  ScanSweep part;
  part.arcs.assign(sweep.arcs.begin() + static_cast<std::ptrdiff_t>(begin),
                   sweep.arcs.begin() + static_cast<std::ptrdiff_t>(std::min(end, sweep.arcs.size())));
  return part;
}

/// As a raster of a thousand bars has them: one elevation of the table takes a tenth of a second.
TEST(SweptAntenna, OfManyTiltsIsStoppedWithinAnElevation) {
  const AntennaPtr antenna = makeGaussian(30, 0.5, 0.5, -30);
  ScanSweep sweep;
  for (int n = 0; n < 1000; ++n) sweep.arcs.push_back({-45, 90, 0.05 * n - 25, 1e-3, 1});
  for (const SweptPattern pattern : {SweptPattern::mean, SweptPattern::largest})
    emscape::test::expectStopsWithinASecond([&] { sweptAntenna(*antenna, sweep, pattern); }, 30);
}

TEST(SweptAntenna, OfManyArcsEqualsThatOfItsParts) {
  constexpr std::size_t kFew = 60;
  const AntennaPtr antenna = makeGaussian(16, 16, 16, -30);  // tables with an entry per degree
  for (const double widest_deg : {0.3, 20.0}) {
    ScanSweep sweep = drawnSweep(7, 300, widest_deg);
    const AntennaPtr mean = sweptAntenna(*antenna, sweep, SweptPattern::mean);
    std::vector<AntennaPtr> mean_parts, largest_parts;
    for (std::size_t n = 0; n < sweep.arcs.size(); n += kFew)
      mean_parts.push_back(sweptAntenna(*antenna, partOf(sweep, n, n + kFew), SweptPattern::mean));
    for (SweptArc& arc : sweep.arcs) arc.first_deg /= 4;  // leaves a part of the circle
    for (SweptArc& arc : sweep.arcs) arc.width_deg = std::min(arc.width_deg, widest_deg);
    const AntennaPtr largest = sweptAntenna(*antenna, sweep, SweptPattern::largest);
    for (std::size_t n = 0; n < sweep.arcs.size(); n += kFew)
      largest_parts.push_back(sweptAntenna(*antenna, partOf(sweep, n, n + kFew), SweptPattern::largest));
    // At entries: between them the interpolation of the largest values is above that of each part.
    for (double azimuth_deg = -180; azimuth_deg < 180; azimuth_deg += 3) {
      for (const double elevation_deg : {-10.0, 0.0, 4.0, 11.0, 60.0}) {
        const Vec3f direction = arcDirection(azimuth_deg, elevation_deg);
        double sum = 0, most = 0;
        for (const AntennaPtr& part : mean_parts) sum += powerOf(*part, direction);
        for (const AntennaPtr& part : largest_parts) most = std::max(most, powerOf(*part, direction));
        ASSERT_NEAR(ratioToDb(powerOf(*mean, direction)), ratioToDb(sum), 0.01)
            << azimuth_deg << ", " << elevation_deg << ", up to " << widest_deg;
        ASSERT_NEAR(ratioToDb(powerOf(*largest, direction)), ratioToDb(most), 0.05)
            << azimuth_deg << ", " << elevation_deg << ", up to " << widest_deg;
      }
    }
  }
}

}  // namespace
}  // namespace emscape::scenario
