// Links over time against closed forms and against the budget of the same path.
#include "emscape/emfield/link/link.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "emfield/link/target_view.h"
#include "emfield/radar/receiver.h"
#include "emscape/emfield/link/path_budget.h"
#include "tests/emfield/radar_duel.h"
#include "tests/support/errors.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kLinkGain_dbi = 6;

/// A receiver of 1 MHz on a new platform.
scenario::PlacedReceiver& addReceiver(scenario::Scenario& scenario, const GeodeticPosition& position) {
  scenario.platforms.push_back(fixedPlatform(position));
  scenario::PlacedReceiver receiver;
  receiver.name = "receiver";
  receiver.platform = static_cast<int>(scenario.platforms.size()) - 1;
  receiver.antenna = scenario::makeIsotropic(kLinkGain_dbi);
  receiver.losses_db = 2;
  receiver.noise_figure_db = 5;
  receiver.bandwidth_hz = 1e6;
  scenario.placed_receivers.push_back(receiver);
  return scenario.placed_receivers.back();
}

/// A transmitter of 1 kW at 1 GHz in the middle, and a receiver 10 km to the east; straight rays.
std::shared_ptr<scenario::Scenario> oneLink() {
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("wanted", 0));
  addReceiver(*scenario, pointAt(*scenario, 10e3, 0));
  return scenario;
}

LinkReport linksOf(const std::shared_ptr<scenario::Scenario>& scenario, std::vector<double> times_s = {0}) {
  LinkOptions options;
  options.times_s = std::move(times_s);
  for (int e = 0; e < static_cast<int>(scenario->emitters.size()); ++e) options.emitters.push_back(e);
  for (int r = 0; r < static_cast<int>(scenario->placed_receivers.size()); ++r)
    options.receivers.push_back(r);
  for (int t = 0; t < static_cast<int>(scenario->targets.size()); ++t) options.targets.push_back(t);
  return computeLinks(scenario, nullptr, options);
}

/// Friis' equation with the link's receiver (dBm); P. 525, eq. (4).
double friis_dbm(double power_w, double frequency_hz, double distance_m) {
  return ratioToDb(power_w) + 30 + kLinkGain_dbi - 2 -
         20 * std::log10(4 * kPi * distance_m / wavelength_m(frequency_hz));
}

/// Noise (dBm) behind a line of 2 dB at 290 K with an antenna at 290 K: k T0 B F.
double noise_dbm() {
  return ratioToDb(kBoltzmann * 290 * 1e6) + 30 + 5;
}

TEST(Link, OneTransmitterEqualsFriisOverNoise) {
  const LinkReport report = linksOf(oneLink());
  ASSERT_EQ(report.links.size(), 1u);
  const LinkRow& row = report.links[0].rows.at(0);
  EXPECT_NEAR(row.range_m, 10e3, 0.01);
  EXPECT_NEAR(row.received_power_dbm, friis_dbm(1000, 1e9, 10e3), 1e-4);
  EXPECT_NEAR(row.noise_dbm, noise_dbm(), 1e-9);
  EXPECT_NEAR(row.sinr_db, row.received_power_dbm - noise_dbm(), 1e-9);
  EXPECT_EQ(row.interference_dbm, -HUGE_VAL);
  EXPECT_EQ(row.jammer_to_signal_db, -HUGE_VAL);
  EXPECT_FALSE(row.is_received) << "there is no threshold";
}

TEST(Link, OthersInBandInterfereAndJammersCountSeparately) {
  const auto scenario = oneLink();
  scenario::Emitter other = plainEmitter("other", 0);
  other.power_w = 10;
  other.frequency_hz = 1.0002e9;
  addEmitter(*scenario, pointAt(*scenario, 10e3, 5e3), other);
  scenario::Emitter far = other;
  far.name = "off the band";
  far.frequency_hz = 1.1e9;
  addEmitter(*scenario, pointAt(*scenario, 10e3, 4e3), far);
  scenario::Emitter jammer = plainEmitter("jammer", 0);
  jammer.kind = scenario::EmitterKind::jammer;
  jammer.bandwidth_hz = 10e6;
  jammer.power_w = 50;
  addEmitter(*scenario, pointAt(*scenario, 10e3, -5e3), jammer);
  const LinkReport report = linksOf(scenario);
  const LinkRow& row = report.links[0].rows.at(0);
  const double other_dbm = friis_dbm(10, 1.0002e9, 5e3), jammer_dbm = friis_dbm(50, 1e9, 5e3) - 10;
  const double interference_w = dbToRatio(other_dbm) + dbToRatio(jammer_dbm);
  EXPECT_NEAR(row.interference_dbm, ratioToDb(interference_w), 1e-3);
  EXPECT_NEAR(row.sinr_db, row.received_power_dbm - ratioToDb(interference_w + dbToRatio(noise_dbm())), 1e-3);
  EXPECT_NEAR(row.jammer_to_signal_db, jammer_dbm - row.received_power_dbm, 1e-3);
}

TEST(Link, EmittersOfTheReceiversOwnPlatformDoNotCount) {
  const auto scenario = oneLink();
  scenario::Emitter own = plainEmitter("own", 0);
  addEmitter(*scenario, pointAt(*scenario, 10e3, 0), own);
  scenario->emitters.back().platform = scenario->placed_receivers[0].platform;
  const LinkReport report = linksOf(scenario);
  ASSERT_EQ(report.links.size(), 1u);
  EXPECT_EQ(report.links[0].rows[0].interference_dbm, -HUGE_VAL);
}

TEST(Link, EmitterOutsideReceiverBandHasNoLink) {
  const auto scenario = oneLink();
  scenario->placed_receivers[0].center_frequency_hz = 1.002e9;
  EXPECT_THAT(linksOf(scenario).links, IsEmpty());
}

TEST(Link, ReceiverAntennaHasGainTowardsEmitter) {
  const auto scenario = oneLink();
  scenario::PlacedReceiver& receiver = scenario->placed_receivers[0];
  const double isotropic_dbm = linksOf(scenario).links[0].rows[0].received_power_dbm;
  receiver.antenna = scenario::makeGaussian(20, 10, 10, -30);
  const auto gain_db = [&](double heading_deg) {
    scenario->platforms[static_cast<std::size_t>(receiver.platform)].attitude.heading_deg = heading_deg;
    return linksOf(scenario).links[0].rows[0].received_power_dbm - isotropic_dbm + kLinkGain_dbi;
  };
  EXPECT_NEAR(gain_db(270.07), 20, 0.05);  // the emitter is to the west, but for the meridians' convergence
  EXPECT_NEAR(gain_db(275), 17, 0.15);     // half the beamwidth off
  EXPECT_NEAR(gain_db(90), -10, 1e-6);
}

// Reciprocity: a pattern weights the two rays equally at either end.
TEST(Link, TwoRaysAreReciprocal) {
  const auto received_dbm = [](bool is_at_receiver, const scenario::AntennaPtr& antenna, double height_m) {
    const auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
    scenario->ground.kind = propagation::GroundKind::sea;
    scenario->ground.surface_msl_m = 0;
    GeodeticPosition low = pointAt(*scenario, 0, 0), high = pointAt(*scenario, 3e3, 0);
    const double surface_m = low.height_ellipsoid_m;
    low.height_ellipsoid_m = surface_m + 20;
    high.height_ellipsoid_m = surface_m + height_m;
    scenario::Emitter emitter = plainEmitter("emitter", 0);
    emitter.propagation.model = propagation::PropagationModel::two_ray;
    emitter.antenna = is_at_receiver ? scenario::makeIsotropic(kLinkGain_dbi) : antenna;
    addEmitter(*scenario, is_at_receiver ? high : low, emitter);
    scenario::PlacedReceiver& receiver = addReceiver(*scenario, is_at_receiver ? low : high);
    if (is_at_receiver) receiver.antenna = antenna;
    // The directional end is the low one; it looks east.
    scenario->emitters[0].scan.azimuth_deg = receiver.scan.azimuth_deg = 90;
    return linksOf(scenario).links.at(0).rows.at(0).received_power_dbm;
  };
  const scenario::AntennaPtr narrow = scenario::makeGaussian(kLinkGain_dbi, 60, 4, -40);
  double farthest_db = 0;
  for (const double height_m : {60., 90., 130., 180.}) {
    EXPECT_NEAR(received_dbm(true, narrow, height_m), received_dbm(false, narrow, height_m), 0.02)
        << height_m;
    const scenario::AntennaPtr wide = scenario::makeIsotropic(kLinkGain_dbi);
    farthest_db = std::max(
        farthest_db, std::abs(received_dbm(true, narrow, height_m) - received_dbm(true, wide, height_m)));
  }
  EXPECT_GT(farthest_db, 0.5) << "the pattern must weigh";
}

TEST(Link, IsReceivedWhereItMeetsItsThresholds) {
  const auto scenario = oneLink();
  scenario::TrackPoint end = scenario->platforms[0].track.front();
  end.t_s = 10;
  end.position.longitude_deg = pointAt(*scenario, 9e3, 0).longitude_deg;
  scenario->platforms[0].track.push_back(end);
  scenario->emitters[0].active_s = {{0, 9.5}};
  const double at_5_km_dbm = friis_dbm(1000, 1e9, 5e3);
  scenario->placed_receivers[0].sensitivity_dbm = at_5_km_dbm;
  const std::vector<double> times_s{0, 2, 4, 6, 8, 9, 10};
  const Link link = linksOf(scenario, times_s).links.at(0);
  ASSERT_EQ(link.rows.size(), times_s.size());
  EXPECT_EQ(link.firstReceived_s(), 6);
  EXPECT_EQ(link.lastReceived_s(), 9);
  EXPECT_NEAR(link.receivedShare(), 3.0 / 7, 1e-12);
  EXPECT_FALSE(link.rows.back().active);
  EXPECT_THAT(link.rows.back().verdict, HasSubstr("Silent: "));
  scenario->placed_receivers[0].required_sinr_db = 300;
  EXPECT_FALSE(linksOf(scenario, times_s).links.at(0).firstReceived_s());
}

TEST(Link, RowEqualsBudgetOfItsPathForMovingEnds) {
  const auto scenario = oneLink();
  scenario::Emitter& emitter = scenario->emitters[0];
  emitter.propagation.model = propagation::PropagationModel::diffraction;
  emitter.antenna = scenario::makeGaussian(15, 20, 20, -30);
  emitter.scan.kind = scenario::ScanKind::rotate;
  emitter.scan.rate_rpm = 3;
  const auto expectBudgets = [&] {
    const Link link = linksOf(scenario, {0, 1, 2, 7}).links.at(0);
    for (const LinkRow& row : link.rows) {
      const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, row.time_s);
      const scenario::ReceiverState& end = snapshot.receivers.at(0);
      const PathBudget budget =
          pathBudget(snapshot, 0, {end.position, end.height_msl_m}, emitter.propagation.model, nullptr);
      EXPECT_DOUBLE_EQ(row.power_density_dbwm2, budget.find("power_density_dbwm2")->value);
      EXPECT_EQ(row.verdict, budget.verdict);
      EXPECT_EQ(row.pattern_db, budget.pointing.pattern_db);
    }
  };
  expectBudgets();
  scenario::TrackPoint end = scenario->platforms[1].track.front();
  end.t_s = 5;
  end.position.latitude_deg += 0.02;
  scenario->platforms[1].track.push_back(end);
  scenario->platforms[1].outside_track = scenario::OutsideTrack::hold;
  expectBudgets();
}

TEST(Link, ManyReceiversEqualEachReceiverAlone) {
  const auto scenario = oneLink();
  for (int n = 0; n < 6; ++n) {
    scenario::Emitter other = plainEmitter("other " + std::to_string(n), 0);
    other.frequency_hz = 1e9 + 0.3e6 * n;
    if (n % 2 == 1) other.bandwidth_hz = 0.5e6;
    if (n == 4) other.kind = scenario::EmitterKind::jammer;
    addEmitter(*scenario, pointAt(*scenario, 8e3, 1e3 * n), other);
    addReceiver(*scenario, pointAt(*scenario, 12e3, 500.0 * n));
    if (n == 3) scenario->placed_receivers.back().center_frequency_hz = 1.0005e9;
  }
  const std::vector<double> times_s{0, 5};
  const LinkReport all = linksOf(scenario, times_s);
  ASSERT_GT(all.links.size(), 40u);
  for (const Link& link : all.links) {
    LinkOptions alone;
    alone.times_s = times_s;
    alone.emitters = {link.emitter};
    alone.receivers = {link.receiver};
    const LinkReport report = computeLinks(scenario, nullptr, alone);
    const LinkRow &row = link.rows.at(1), &expected = report.links.at(0).rows.at(1);
    EXPECT_EQ(row.received_power_dbm, expected.received_power_dbm);
    EXPECT_EQ(row.interference_dbm, expected.interference_dbm);
    EXPECT_EQ(row.jammer_to_signal_db, expected.jammer_to_signal_db);
    EXPECT_EQ(row.sinr_db, expected.sinr_db);
  }
  for (std::size_t i = 1; i < all.links.size(); ++i) {
    const Link &before = all.links[i - 1], &link = all.links[i];
    EXPECT_LT(std::pair(before.emitter, before.receiver), std::pair(link.emitter, link.receiver));
  }
}

TEST(Link, StopsBetweenTheReceiversOfOneTime) {
  const auto scenario = oneLink();
  for (int n = 0; n < 200; ++n) addReceiver(*scenario, pointAt(*scenario, 10e3, 10.0 * n));
  LinkOptions options;
  options.times_s = {0};
  options.emitters = {0};
  for (int r = 0; r < static_cast<int>(scenario->placed_receivers.size()); ++r)
    options.receivers.push_back(r);
  std::vector<double> parts;
  computeLinks(scenario, nullptr, options,
               [&](const std::string&, double fraction) { parts.push_back(fraction); });
  ASSERT_GT(parts.size(), 1u);
  EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end()));
  EXPECT_EQ(parts.back(), 1);
  EXPECT_EQ(std::count(parts.begin(), parts.end(), 1.0), 1);
  const auto stop = [](const std::string&, double fraction) {
    if (fraction < 1) throw std::runtime_error("stopped");
  };
  EXPECT_THROW(computeLinks(scenario, nullptr, options, stop), std::runtime_error);
}

TEST(Link, HasNoPathBetweenEndsAboveOneAnother) {
  const auto scenario = oneLink();
  scenario->platforms[1].track[0].position = scenario->platforms[0].track[0].position;
  *scenario->platforms[1].track[0].position.height_ellipsoid_m += 500;
  const LinkRow row = linksOf(scenario).links.at(0).rows.at(0);
  EXPECT_FALSE(row.has_path);
  EXPECT_EQ(row.received_power_dbm, -HUGE_VAL);
  EXPECT_THAT(row.verdict, HasSubstr("straight above or below"));
}

/// Larger from the sides than from nose and tail.
class SidewaysTable : public scenario::RcsTable {
 public:
  double rcs_dbsm(double azimuth_deg, double elevation_deg) const override {
    azimuth = azimuth_deg;
    elevation = elevation_deg;
    return std::abs(std::abs(azimuth_deg) - 90) < 45 ? 10 : 0;
  }
  mutable double azimuth = 0, elevation = 0;
};

/// A rotating radar in the middle and a target 20 km to the east of it.
std::shared_ptr<scenario::Scenario> radarAndTarget() {
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  scenario::Emitter radar = radarOf(scenario::makeGaussian(kGain_dbi, 3, 30, -35));
  radar.scan.kind = scenario::ScanKind::rotate;
  radar.scan.rate_rpm = 15;
  addEmitter(*scenario, middleOf(*scenario), radar);
  scenario->platforms.push_back(fixedPlatform(pointAt(*scenario, 20e3, 0)));
  scenario->targets.push_back({"target", 1, 2.0, nullptr, 3});
  return scenario;
}

TEST(Detection, TargetFollowsRadarEquationAndStatistics) {
  const auto scenario = radarAndTarget();
  const Detection detection = linksOf(scenario).detections.at(0);
  const DetectionRow& row = detection.rows.at(0);
  const RadarLink link = linkTowardsTarget(scenario->emitters[0]);
  EXPECT_NEAR(row.snr_db, radarSnrDb(link, 2, 20e3), 0.01);
  const Detector detector{Swerling::slow_dominant, 1, 1e-6};
  EXPECT_NEAR(row.detection_probability,
              detectionProbability(detector, detectionThreshold(detector), dbToRatio(row.snr_db)), 2e-4);
}

TEST(Detection, RowsShareTheRadarsCurve) {
  const scenario::Emitter radar = radarOf(scenario::makeIsotropic());
  const auto curve = detectionCurveOf(radar);
  EXPECT_EQ(detectionCurveOf(radar), curve);
  scenario::Emitter other = radar;
  other.receiver.pfa = 1e-4;
  EXPECT_NE(detectionCurveOf(other), curve);
}

TEST(Detection, AccumulatesOverTheLooksOfTheScan) {
  const auto scenario = radarAndTarget();
  std::vector<double> times_s;
  for (int t = 0; t <= 20; ++t) times_s.push_back(t);
  const Detection detection = linksOf(scenario, times_s).detections.at(0);
  const double p = detection.rows[0].detection_probability;
  ASSERT_GT(p, 0.05);
  ASSERT_LT(p, 0.95);
  for (const DetectionRow& row : detection.rows) {
    const int looks = 1 + static_cast<int>(row.time_s) / 4;  // a turn takes 4 s
    EXPECT_NEAR(row.cumulative_probability, 1 - std::pow(1 - p, looks), 1e-9) << row.time_s;
  }
  EXPECT_EQ(detection.firstDetection_s().has_value(), p >= 0.5);
  scenario->emitters[0].active_s = {{30, 40}};
  const Detection silent = linksOf(scenario, times_s).detections.at(0);
  EXPECT_EQ(silent.rows.back().cumulative_probability, 0);
  EXPECT_EQ(silent.rows.back().snr_db, -HUGE_VAL);
}

TEST(Detection, FormulaForTargetOutOfReachGivesPfa) {
  using scenario::DetectionMethod;
  for (const auto method : {DetectionMethod::exact, DetectionMethod::albersheim, DetectionMethod::shnidman}) {
    const auto scenario = radarAndTarget();
    scenario->emitters[0].power_w = 1e-6;
    scenario->emitters[0].receiver.pulses = 4;
    scenario->emitters[0].receiver.swerling = 0;
    scenario->emitters[0].receiver.detection = method;
    scenario->targets[0].swerling = 0;
    const Detection detection = linksOf(scenario, {0, 400}).detections.at(0);
    EXPECT_NEAR(detection.rows[0].detection_probability, 1e-6, 1e-9);
    EXPECT_NEAR(detection.rows[1].cumulative_probability, 101e-6, 1e-6) << "of 101 looks";
  }
}

TEST(Detection, RadialSpeedIsTakenAtTheTime) {
  const auto scenario = radarAndTarget();
  // 200 m/s to the north, 2 km east of the radar; then to the east
  scenario::Platform& aircraft = scenario->platforms[1];
  const struct {
    double t_s, east_m, north_m;
  } points[] = {{0, 2000, -2000}, {20, 2000, 2000}, {30, 4000, 2000}};
  aircraft.track.clear();
  for (const auto& point : points) {
    aircraft.track.push_back(fixedPlatform(pointAt(*scenario, point.east_m, point.north_m)).track[0]);
    aircraft.track.back().t_s = point.t_s;
  }
  const auto speed_mps = [&](double t_s) {
    return radialSpeed_mps(scenario::instantAt(scenario, nullptr, t_s), 0, 1, nullptr);
  };
  EXPECT_NEAR(speed_mps(0), -200 * std::sqrt(0.5), 0.1) << "the beginning of the track";
  EXPECT_NEAR(speed_mps(5), -200 * std::sqrt(0.2), 0.05);
  EXPECT_NEAR(speed_mps(10), 0, 0.01) << "abeam";
  EXPECT_NEAR(speed_mps(20), 200 * std::sqrt(0.5), 0.1) << "eastwards";
  EXPECT_NEAR(speed_mps(30), 200 * std::sqrt(0.8), 0.1) << "the end of the track";
}

// Figures of M. A. Richards, Fundamentals of Radar Signal Processing, section 5.2: an aircraft 3048 m up at
// 134.1 m/s looks 45 degrees to the right and 10 degrees down at 10 GHz; ground clutter at 93.4 m/s, 6.23
// kHz.
TEST(Detection, TheGroundAheadOfAMovingRadarHasNoSpeedInItsFilter) {
  const auto scenario = radarAndTarget();
  const double height_m = *scenario->platforms[0].track[0].position.height_ellipsoid_m;
  const double ahead_m = 3048 / std::tan(degToRad(10.0));
  scenario->platforms[1] =
      fixedPlatform(pointAt(*scenario, ahead_m * std::sqrt(0.5), ahead_m * std::sqrt(0.5)));
  scenario->platforms[1].track[0].position.height_ellipsoid_m = height_m;
  flyNorth(*scenario, 134.1, height_m + 3048);
  const scenario::Snapshot now = scenario::instantAt(scenario, nullptr, 0);
  const double closing_mps = radialSpeed_mps(now, 0, 1, nullptr);
  EXPECT_NEAR(closing_mps, -93.4, 0.1);
  EXPECT_NEAR(-2 * closing_mps / wavelength_m(10e9), 6230, 10);
  EXPECT_NEAR(speedOverGround_mps(now, 0, 1, nullptr), 0, 1e-6);
}

// The same: at 100 m/s the clutter of a beam of 3 degrees abeam is 35 Hz wide at 1 GHz, of 1 degree 116 Hz at
// 10 GHz.
TEST(Detection, AMovingRadarsGroundIsSpreadAcrossItsBeam) {
  const auto scenario = radarAndTarget();
  flyNorth(*scenario, 100, *scenario->platforms[0].track[0].position.height_ellipsoid_m);
  const auto widthHz = [&](double beamwidth_deg, double frequency_hz, double east_m, double north_m) {
    scenario->emitters[0].antenna = scenario::makeGaussian(30, beamwidth_deg, beamwidth_deg, -40);
    scenario->platforms[1] = fixedPlatform(pointAt(*scenario, east_m, north_m));
    const scenario::Snapshot now = scenario::instantAt(scenario, nullptr, 0);
    return 2 / wavelength_m(frequency_hz) * 4 * std::sqrt(std::log(2.0)) *
           groundSpread_mps(now, 0, 1, nullptr);
  };
  EXPECT_NEAR(widthHz(3, 1e9, 20e3, 0), 35, 0.2);
  EXPECT_NEAR(widthHz(1, 10e9, -20e3, 0), 116, 1);
  EXPECT_NEAR(widthHz(1, 10e9, 0, 20e3), 0, 0.1) << "ahead";
}

TEST(Detection, AMovingArraysGroundIsSpreadAcrossItsSteeredBeam) {
  const auto scenario = radarAndTarget();
  flyNorth(*scenario, 100, *scenario->platforms[0].track[0].position.height_ellipsoid_m);
  scenario->emitters[0].antenna = scenario::makePhasedArray(30, 40, 24, 0.5, 0);
  scenario->emitters[0].scan = {};
  scenario->emitters[0].scan.kind = scenario::ScanKind::dwell_list;
  scenario->emitters[0].scan.dwells = {{0, 0, 1}};
  scenario->output.radar_look = scenario::RadarAim::target;
  const auto perSine = [&](double azimuth_deg) {  // of the array's plane, which looks north
    const double azimuth_rad = degToRad(azimuth_deg);
    scenario->platforms[1] =
        fixedPlatform(pointAt(*scenario, 20e3 * std::sin(azimuth_rad), 20e3 * std::cos(azimuth_rad)));
    return groundSpread_mps(scenario::instantAt(scenario, nullptr, 0), 0, 1, nullptr) / std::sin(azimuth_rad);
  };
  EXPECT_NEAR(perSine(55) / perSine(5) * std::cos(degToRad(55.0)) / std::cos(degToRad(5.0)), 1, 0.005);
}

TEST(Detection, TakesTheCrossSectionFromTheRadarsAspect) {
  const auto scenario = radarAndTarget();
  const auto table = std::make_shared<SidewaysTable>();
  scenario->targets[0].table = table;
  scenario->platforms[1].attitude.heading_deg = 0;  // the radar is to the left
  EXPECT_NEAR(linksOf(scenario).detections[0].rows[0].rcs_m2, 10, 1e-9);
  EXPECT_NEAR(table->azimuth, -90, 0.5);
  EXPECT_NEAR(table->elevation, 0, 0.5);
  scenario->platforms[1].attitude = {270, 20, 0};  // ahead, the nose lifted
  EXPECT_NEAR(linksOf(scenario).detections[0].rows[0].rcs_m2, 1, 1e-9);
  EXPECT_NEAR(table->azimuth, 0, 0.5);
  EXPECT_NEAR(table->elevation, -20, 0.5);
}

TEST(Detection, EqualsBudgetOfPathWithBeamOnTarget) {
  const auto scenario = radarAndTarget();
  addEmitter(*scenario, pointAt(*scenario, 15e3, 12e3), jammerOf(1e-3));
  const Detection detection = linksOf(scenario, {0.5}).detections.at(0);
  const DetectionRow row = detection.rows.at(0);
  scenario->emitters[0].receiver.target_rcs_m2 = 2;
  scenario->emitters[0].receiver.swerling = 3;
  scenario->output.radar_look = scenario::RadarAim::target;
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0.5);
  const scenario::PlatformState& end = snapshot.platforms.at(1);
  const PathBudget budget = pathBudget(snapshot, 0, {end.position, end.height_msl_m},
                                       propagation::PropagationModel::free_space, nullptr);
  EXPECT_DOUBLE_EQ(row.snr_db, budget.find("snr_db")->value);
  EXPECT_DOUBLE_EQ(row.jammer_to_signal_db, budget.find("jammer_to_signal_db")->value);
  EXPECT_DOUBLE_EQ(row.detection_probability, budget.find("detection_probability")->value);
}

TEST(Detection, ManyTargetsEqualEachAlone) {
  const auto scenario = radarAndTarget();
  addEmitter(*scenario, pointAt(*scenario, 15e3, 12e3), jammerOf(1e-3));
  scenario::Emitter radar = scenario->emitters[0];
  radar.name = "other radar";
  radar.receiver.target_rcs_m2 = 100;
  addEmitter(*scenario, pointAt(*scenario, 1e3, 0), radar);
  for (int n = 0; n < 4; ++n) {
    scenario->platforms.push_back(fixedPlatform(pointAt(*scenario, 20e3, 1e3 * n)));
    const int platform = static_cast<int>(scenario->platforms.size()) - 1;
    scenario->targets.push_back({"target " + std::to_string(n), platform, 1.0 + n, nullptr, n});
  }
  const std::vector<double> times_s{0, 5};
  const LinkReport all = linksOf(scenario, times_s);
  ASSERT_EQ(all.detections.size(), 10u);
  for (const Detection& detection : all.detections) {
    LinkOptions alone;
    alone.times_s = times_s;
    alone.emitters = {detection.radar};
    alone.targets = {detection.target};
    const LinkReport report = computeLinks(scenario, nullptr, alone);
    const DetectionRow &row = detection.rows.at(1), &expected = report.detections.at(0).rows.at(1);
    EXPECT_EQ(row.snr_db, expected.snr_db);
    EXPECT_EQ(row.jammer_to_signal_db, expected.jammer_to_signal_db);
    EXPECT_EQ(row.detection_probability, expected.detection_probability);
    EXPECT_EQ(row.cumulative_probability, expected.cumulative_probability);
  }
}

TEST(Detection, TheBudgetNamesThePolarisationLossOfAJammer) {
  const auto scenario = radarAndTarget();
  addEmitter(*scenario, pointAt(*scenario, 15e3, 12e3), jammerOf(1e-3));
  scenario->emitters[0].polarization = propagation::Polarization::horizontal;
  scenario->emitters[1].polarization = propagation::Polarization::vertical;
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0.5);
  const scenario::PlatformState& end = snapshot.platforms.at(1);
  const PathBudget budget = pathBudget(snapshot, 0, {end.position, end.height_msl_m},
                                       propagation::PropagationModel::free_space, nullptr);
  EXPECT_THAT(budget.find("jammer_to_signal_db")->note,
              HasSubstr("polarisation mismatch of '" + scenario->emitters[1].name + "' 25.0 dB"));
}

TEST(Link, AnErrorNamesThePairAndTheTime) {
  const auto scenario = oneLink();
  scenario->emitters[0].propagation.model = propagation::PropagationModel::p528;
  scenario->emitters[0].frequency_hz = 5e6;
  EXPECT_THAT(test::errorOf([&] { linksOf(scenario, {3}); }),
              HasSubstr("'wanted' to 'receiver' at t = 3 s: "));
}

}  // namespace
}  // namespace emscape::emfield
