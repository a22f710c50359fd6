// Where radars look, and the loops over voxels.

#include <gtest/gtest.h>

#include "emfield/columns/grid_columns.h"
#include "emfield/combine/radar_product.h"
#include "emfield/geometry/emitter_geometry.h"
#include "tests/emfield/radar_duel.h"
#include "tests/support/files.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;

/// Values along the line for a radar that looks at targets, over those with the beam exactly on them.
double lookGain_db(scenario::Emitter radar, double east_m, double up_m) {
  auto scenario = emptyScenario(FrameKind::enu, 44.3, -71.4, {40.5e3, 1500, 20500}, {81, 3, 41});
  scenario->atmosphere.k_factor = 1;
  const volume::Grid grid = gridOf(scenario->region);
  const Vec3d site = grid.center_m(40, 1, 0);
  addEmitter(*scenario, GeoFrame(grid.frame).toGeodetic(site), std::move(radar));
  scenario->output.quantities = {"snr_db"};
  scenario->output.radar_look = scenario::RadarAim::target;
  const auto volume = solve(scenario);
  const double range_m = std::hypot(east_m, up_m);
  const scenario::Emitter& used = scenario->emitters[0];
  return (valueAt(*volume, 40 + int(std::lround(east_m / 500)), 1, int(std::lround(up_m / 500))) -
          radarSnrDb(linkTowardsTarget(used), 5, range_m)) /
         2;
}

TEST(Look, RotatingRadarCoversAllAzimuthsAtItsElevation) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.kind = scenario::ScanKind::rotate;
  radar.scan.rate_rpm = 10;
  radar.scan.elevation_deg = 2;
  const double level_db = 10 * std::log10(0.5);  // 2 degrees below a beam of 4
  EXPECT_NEAR(lookGain_db(radar, 10e3, 0), level_db, 1e-3);
  EXPECT_NEAR(lookGain_db(radar, -10e3, 0), level_db, 1e-3);
  EXPECT_NEAR(lookGain_db(radar, 10e3, 10e3), -35, 1e-3) << "far above the beam";
}

TEST(Look, SectorReachesItsEnds) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.kind = scenario::ScanKind::sector;
  radar.scan.azimuth_deg = 60;  // east is 30 degrees to the right of its middle
  radar.scan.rate_deg_s = 10;
  radar.scan.width_deg = 60;
  EXPECT_NEAR(lookGain_db(radar, 10e3, 0), 0, 1e-3);
  radar.scan.width_deg = 57;
  EXPECT_NEAR(lookGain_db(radar, 10e3, 0), 10 * std::log10(0.5), 1e-3) << "half a beamwidth beyond the end";
  EXPECT_NEAR(lookGain_db(radar, -10e3, 0), -35, 1e-3);
}

TEST(Look, RasterStaysBetweenItsBars) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.kind = scenario::ScanKind::raster;
  radar.scan.azimuth_deg = 90;
  radar.scan.width_deg = 20;
  radar.scan.rate_deg_s = 10;
  radar.scan.elevation_deg = 24;
  radar.scan.elevation_step_deg = 10;
  radar.scan.bars = 5;  // 4 to 44 degrees
  EXPECT_NEAR(lookGain_db(radar, 10e3, 5e3), 0, 1e-3);
  const double above_deg = 1;
  EXPECT_NEAR(lookGain_db(radar, 10e3, 10e3), 10 * std::log10(0.5) * std::pow(above_deg / 2, 2), 1e-3);
  EXPECT_NEAR(lookGain_db(radar, 10e3, 0), 4 * 10 * std::log10(0.5), 1e-3) << "4 degrees below";
}

TEST(Look, FixedAntennaKeepsItsDirection) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.kind = scenario::ScanKind::fixed;
  radar.scan.azimuth_deg = 88.5;
  EXPECT_NEAR(lookGain_db(radar, 10e3, 0), 10 * std::log10(0.5), 1e-3) << "half a beamwidth beside it";
  EXPECT_NEAR(lookGain_db(radar, -10e3, 0), -35, 1e-3);
  EXPECT_NEAR(lookGain_db(radar, 10e3, 10e3), -35, 1e-3);
}

TEST(Look, ApertureThatIsNoArrayIsNotSteered) {
  scenario::Emitter radar = radarOf(scenario::makeSinc(kGain_dbi, 3, 3, -35));
  radar.scan.kind = scenario::ScanKind::track;
  EXPECT_NEAR(lookGain_db(radar, 10e3, 10e3), 0, 1e-3);
  EXPECT_NEAR(lookGain_db(radar, -10e3, 2e3), 0, 1e-3) << "behind, as far as any turned antenna sees";
  radar.scan.kind = scenario::ScanKind::fixed;
  radar.scan.azimuth_deg = 90;
  EXPECT_NEAR(lookGain_db(radar, -10e3, 0), -35, 1e-3);
}

TEST(Look, TrackingRadarIsOnEveryTarget) {
  const scenario::Emitter radar = trackingRadar();
  EXPECT_NEAR(lookGain_db(radar, 10e3, 10e3), 0, 1e-3);
  EXPECT_NEAR(lookGain_db(radar, -10e3, 2e3), 0, 1e-3);
  EXPECT_NEAR(lookGain_db(radar, 0, 10e3), 0, 1e-3) << "the zenith";
}

TEST(Look, SteeredArrayLosesElementPattern) {
  scenario::Emitter radar = radarOf(scenario::makePhasedArray(kGain_dbi, 16, 16, 0.5, 1));
  radar.scan.azimuth_deg = 90;
  EXPECT_NEAR(lookGain_db(radar, 10e3, 0), 0, 1e-3);
  // an element's amplitude is cos(45 degrees)
  EXPECT_NEAR(lookGain_db(radar, 10e3, 10e3), 10 * std::log10(0.5), 5e-3);
  EXPECT_LT(lookGain_db(radar, -10e3, 0), -30) << "it does not look behind itself";
}

TEST(Look, ScanFollowsTheBeam) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.azimuth_deg = 88.5;
  const auto scenario = duel(radar, jammerOf(1), 0, 1e6);
  const double expected =
      radarSnrDb(linkTowardsTarget(radar), 5, 20e3) + 2 * 10 * std::log10(0.5);  // there and back
  EXPECT_NEAR(east(scenario, "snr_db", 20e3), expected, 1e-3);
  scenario->emitters[1].active_s = {{5, 10}};
  const Detector detector = detectorOf(radar.receiver);
  EXPECT_NEAR(east(scenario, "detection_probability", 20e3),
              detectionProbability(detector, detectionThreshold(detector), dbToRatio(expected)), 1.2e-4);
}

void addEchoOfAnyPattern(const RadarPass& pass, std::size_t column, int k) {
  onPattern(pass.beam.pattern, [&](auto kind) { addEcho<kind>(pass, column, k); });
}

TEST(RadarRows, EqualVoxelFunction) {
  const scenario::AntennaPtr antennas[] = {
      scenario::makeIsotropic(3), scenario::makeGaussian(30, 3, 4, -35),
      scenario::makeCosecant2(34, 2, 5, 40, -40), scenario::makePhasedArray(30, 16, 16, 0.5, 1),
      scenario::readAntenna(test::shippedScenario("data/sector_450mhz.msi"))};
  const auto scenario = emptyScenario(FrameKind::altitude, 40, 5, {37e3, 23e3, 5000}, {70, 9, 7});
  const volume::Grid grid = gridOf(scenario->region);
  const GridColumns columns = makeGridColumns(grid, nullptr);
  scenario::Emitter radar = radarOf(antennas[0]);
  radar.propagation.model = propagation::PropagationModel::horizon;
  addEmitter(*scenario, {40.02, 5.03, 300}, radar);
  const scenario::EmitterState state = scenario::snapshotAt(scenario, nullptr, 0).emitters[0];
  EmitterGeometry geometry;
  EmitterGeometry::Times times;
  geometry.compute(state, *scenario, radar, columns, nullptr, times);
  const DetectionCurve curve(detectorOf(radar.receiver));
  const JammerAtRadar jammers[] = {{{0.6f, 0.8f, 0}, 1e4f}, {{0, -1, 0}, 30}};
  RadarPass pass;
  pass.dims = grid.dims;
  pass.t_m = columns.t_m.data();
  pass.beam.geometry = geometry.view();
  pass.beam.forward = {0, 1, 0};
  pass.beam.right = {1, 0, 0};
  pass.beam.up = {0, 0, 1};
  pass.beam.eirp_over_4pi_w = 1e6;
  pass.task.curve = curve.view();
  pass.task.echo_root = static_cast<float>(echoRoot_m2_w(radar));
  pass.task.jammers = jammers;
  pass.task.jammer_count = 2;
  const RadarLook sector{LookKind::turned, 0.5f, 0.866025404f, 0.1f, 0.994987437f, 0.3f, 0.953939201f};
  const RadarLook looks[] = {{}, sector, {LookKind::steered}};
  const auto voxels = static_cast<std::size_t>(grid.dims.count());
  for (const auto& antenna : antennas) {
    for (const RadarLook& look : looks) {
      for (const auto measure : {RadarMeasure::root_of_signal_to_noise, RadarMeasure::signal_to_jamming,
                                 RadarMeasure::detection}) {
        pass.beam.pattern = antenna->view();
        pass.task.look = look;
        pass.task.measure = measure;
        pass.task.reduction = Reduction::sum;
        std::vector<float> rows(voxels, 0.01f), plain(voxels, 0.01f);
        pass.accumulator = rows.data();
        radarCpu(pass);
        pass.accumulator = plain.data();
        for (int k = 0; k < grid.dims.z; ++k) {
          for (std::size_t column = 0; column < columns.count(); ++column) {
            addEchoOfAnyPattern(pass, column, k);
          }
        }
        for (std::size_t v = 0; v < voxels; ++v) {
          // Fused multiply-adds round differently, which matters near a pattern's nulls.
          const float bound = measure == RadarMeasure::detection ? 2e-5f : 3e-3f * plain[v];
          ASSERT_NEAR(rows[v], plain[v], bound) << antenna->description << ", measure " << int(measure);
        }
      }
    }
  }
}

}  // namespace
}  // namespace emscape::emfield
