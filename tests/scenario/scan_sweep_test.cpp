// The motion of a beam in an interval, at the times at which its emitter is active.
#include "scenario/scan/scan_sweep.h"

#include <gtest/gtest.h>

namespace emscape::scenario {
namespace {

Emitter turning(std::vector<TimeInterval> active_s) {
  Emitter emitter;
  emitter.scan.kind = ScanKind::rotate;
  emitter.scan.rate_rpm = 6;
  emitter.active_s = std::move(active_s);
  return emitter;
}

TEST(ScanSweep, JoinsActiveTimesThatTouchOrOverlap) {
  const ScanSweep expected = sweepOf(turning({{0, 2}, {3, 4}}), 0, 10);
  ASSERT_EQ(expected.arcs.size(), 2u);
  for (const Emitter& emitter : {turning({{0, 1}, {1, 2}, {3, 4}}), turning({{3, 4}, {1, 2}, {0, 1.5}}),
                                 turning({{-5, 2}, {0.5, 1}, {3, 3.5}, {3, 4}})}) {
    EXPECT_TRUE(sweepOf(emitter, 0, 10) == expected);
    EXPECT_DOUBLE_EQ(activeTime_s(emitter, 0, 10), 3);
    EXPECT_EQ(lastPassesOf(emitter, 0, 10).size(), 2u);
  }
  EXPECT_TRUE(sweepOf(turning({{-1, 3}, {3, 12}}), 0.1, 9.7) == sweepOf(turning({}), 0.1, 9.7));
  EXPECT_EQ(activeTime_s(turning({{-1, 3}, {3, 12}}), 0.1, 9.7), 9.7);
}

TEST(ScanSweep, CountsTheBurstsOfEqualArcs) {
  const ScanSweep sweep = sweepOf(turning({{1, 3}, {11, 13}, {25, 26}, {41, 43}}), 0, 50);
  ASSERT_EQ(sweep.arcs.size(), 2u);
  EXPECT_NEAR(sweep.arcs[0].first_deg, 36, 1e-9);
  EXPECT_NEAR(sweep.arcs[0].width_deg, 72, 1e-9);
  EXPECT_EQ(sweep.arcs[0].times, 3);
  EXPECT_NEAR(sweep.arcs[0].share, 6.0 / 50, 1e-12);
  EXPECT_NEAR(sweep.arcs[1].first_deg, 180, 1e-9);
  EXPECT_EQ(sweep.arcs[1].times, 1);
}

TEST(ScanSweep, HasNoPartsThatAreRoundingOfTimes) {
  ScanSpec dwells, raster, sector;
  dwells.kind = ScanKind::dwell_list;
  dwells.dwells = {{-90, 0, 0.1}, {0, 0, 0.1}, {90, 0, 0.1}};
  raster.kind = ScanKind::raster;
  raster.width_deg = 40;
  raster.rate_deg_s = 400;
  raster.bars = 4;
  raster.elevation_step_deg = 10;
  sector = raster;
  sector.kind = ScanKind::sector;
  for (const ScanSpec& scan : {dwells, raster, sector}) {
    Emitter emitter;
    emitter.scan = scan;
    for (int step = 0; step < 1000; ++step) {
      const ScanSweep sweep = sweepOf(emitter, step / 10.0, 0.1);
      ASSERT_EQ(sweep.arcs.size(), 1u) << toString(scan.kind) << " at " << step / 10.0 << " s";
      EXPECT_NEAR(sweep.arcs[0].share, 1, 1e-9);
      const double middle_s = step / 10.0 + 0.05;
      EXPECT_EQ(sweep.arcs[0].elevation_deg, beamAt(scan, middle_s).elevation_deg);
      if (scan.kind != ScanKind::dwell_list) {
        EXPECT_EQ(lastPassesOf(emitter, step / 10.0, 0.1).size(), 1u);
      }
    }
  }
}

TEST(ScanSweep, OfAnEmitterThatIsSwitchedAtTheEndsOfIntervals) {
  for (int step = 0; step < 1000; ++step) {
    const double t_s = step / 10.0;
    EXPECT_EQ(activeTime_s(turning({{(step + 1) / 10.0, 200}}), t_s, 0.1), 0) << t_s;
    EXPECT_EQ(activeTime_s(turning({{-1, t_s}}), t_s, 0.1), 0) << t_s;
    EXPECT_EQ(activeTime_s(turning({{t_s, (step + 1) / 10.0}}), t_s, 0.1), 0.1) << t_s;
  }
  EXPECT_NEAR(activeTime_s(turning({{7, 7.001}}), 0, 1e6), 1e-3, 1e-9) << "a short one in a long interval";
}

}  // namespace
}  // namespace emscape::scenario
