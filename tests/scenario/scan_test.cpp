#include "emscape/scenario/scan/scan.h"

#include <gtest/gtest.h>

namespace emscape::scenario {
namespace {

TEST(Scan, FixedLooksWhereItIsSet) {
  ScanSpec scan;
  scan.azimuth_deg = 30;
  scan.elevation_deg = -2;
  EXPECT_EQ(beamAt(scan, 1234.5).azimuth_deg, 30);
  EXPECT_EQ(beamAt(scan, 1234.5).elevation_deg, -2);
  EXPECT_FALSE(beamAt(scan, 0).electronic);
}

TEST(Scan, RotationIsClockwiseAndExactAfterYears) {
  ScanSpec scan;
  scan.kind = ScanKind::rotate;
  scan.rate_rpm = 12;
  scan.azimuth_deg = 10;
  EXPECT_DOUBLE_EQ(beamAt(scan, 0).azimuth_deg, 10);
  EXPECT_DOUBLE_EQ(beamAt(scan, 1).azimuth_deg, 82);
  EXPECT_DOUBLE_EQ(beamAt(scan, 5).azimuth_deg, 10);
  EXPECT_DOUBLE_EQ(beamAt(scan, 5e8 + 1).azimuth_deg, 82);
  scan.rate_rpm = -12;
  EXPECT_DOUBLE_EQ(beamAt(scan, 1).azimuth_deg, 298);
  EXPECT_DOUBLE_EQ(beamAt(scan, -1).azimuth_deg, 82);
}

ScanSpec sweep(ScanKind kind) {
  ScanSpec scan;
  scan.kind = kind;
  scan.azimuth_deg = 100;
  scan.elevation_deg = 7;
  scan.width_deg = 60;
  scan.rate_deg_s = 20;
  return scan;
}

TEST(Scan, SectorGoesBackAndForth) {
  const ScanSpec scan = sweep(ScanKind::sector);
  const double expected_deg[] = {70, 90, 110, 130, 110, 90, 70, 90};
  for (int t = 0; t < 8; ++t) {
    EXPECT_DOUBLE_EQ(beamAt(scan, t).azimuth_deg, expected_deg[t]) << t;
    EXPECT_DOUBLE_EQ(beamAt(scan, t + 6e7).azimuth_deg, expected_deg[t]) << t;
    EXPECT_DOUBLE_EQ(beamAt(scan, t - 6e7).azimuth_deg, expected_deg[t]) << t;
    EXPECT_EQ(beamAt(scan, t).elevation_deg, 7);
  }
}

TEST(Scan, RasterStacksItsBarsFromTheLowest) {
  ScanSpec scan = sweep(ScanKind::raster);
  scan.bars = 3;
  scan.elevation_step_deg = 4;
  const double expected_deg[] = {3, 3, 3, 7, 7, 7, 11, 11, 11, 3, 3, 3, 7};
  for (int t = 0; t < 13; ++t) {
    EXPECT_DOUBLE_EQ(beamAt(scan, t).elevation_deg, expected_deg[t]) << t;
    EXPECT_DOUBLE_EQ(beamAt(scan, t + 9e8).elevation_deg, expected_deg[t]) << t;
    EXPECT_DOUBLE_EQ(beamAt(scan, t).azimuth_deg, beamAt(sweep(ScanKind::sector), t).azimuth_deg) << t;
  }
}

TEST(Scan, ABarBeginsExactlyWhereThePreviousEnds) {
  ScanSpec scan = sweep(ScanKind::raster);
  scan.width_deg = 40;
  scan.rate_deg_s = 100;
  scan.bars = 3;
  scan.elevation_step_deg = 10;
  scan.elevation_deg = 0;
  for (int n = 0; n < 1000; ++n) EXPECT_EQ(beamAt(scan, n * 4 / 10.0).elevation_deg, (n % 3 - 1) * 10) << n;
}

TEST(Scan, DwellsEndExactlyWhereTheNextBegin) {
  ScanSpec scan;
  scan.kind = ScanKind::dwell_list;
  for (int i = 0; i < 10; ++i) scan.dwells.push_back({i * 1.0, -i * 1.0, 0.1});
  for (const double cycle : {0.0, 1.0, 1e6, -3.0}) {
    for (int i = 0; i < 10; ++i) {
      EXPECT_EQ(beamAt(scan, cycle + i * 0.1).azimuth_deg, i) << cycle;
      EXPECT_EQ(beamAt(scan, cycle + i * 0.1 + 0.0999).elevation_deg, -i) << cycle;
    }
  }
  EXPECT_TRUE(beamAt(scan, 0).electronic);
}

TEST(Scan, UnevenDwellsFollowTheirDurations) {
  ScanSpec scan;
  scan.kind = ScanKind::dwell_list;
  scan.dwells = {{1, 0, 0.5}, {2, 0, 2}, {3, 0, 0.25}};
  EXPECT_EQ(beamAt(scan, 0.49).azimuth_deg, 1);
  EXPECT_EQ(beamAt(scan, 0.5).azimuth_deg, 2);
  EXPECT_EQ(beamAt(scan, 2.5).azimuth_deg, 3);
  EXPECT_EQ(beamAt(scan, 2.75).azimuth_deg, 1);
}

}  // namespace
}  // namespace emscape::scenario
