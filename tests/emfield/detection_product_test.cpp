// Probabilities of detection through the whole pipeline against closed forms; recomputation after changes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/emfield/radar_duel.h"
#include "tests/support/errors.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;

class DetectionProduct : public ::testing::Test {
 protected:
  /// Exact probability from the closed form of the radar equation, with jamming over noise.
  static double exact(const scenario::Emitter& radar, double range_m, double jamming_to_noise = 0) {
    const Detector detector = detectorOf(radar.receiver);
    const double snr = dbToRatio(radarSnrDb(linkTowardsTarget(radar), radar.receiver.target_rcs_m2, range_m));
    return detectionProbability(detector, detectionThreshold(detector), snr / (1 + jamming_to_noise));
  }
};

TEST_F(DetectionProduct, EqualsExactProbabilityOfRadarEquation) {
  for (int swerling = 0; swerling <= 4; ++swerling) {
    scenario::Emitter radar = trackingRadar();
    radar.power_w = 300;
    radar.receiver.swerling = swerling;
    radar.receiver.pulses = 6;
    auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
    scenario->output.radar_look = scenario::RadarAim::target;
    scenario->output.quantities = {"detection_probability"};
    addEmitter(*scenario, middleOf(*scenario), radar);
    const auto volume = solve(scenario);
    for (double range_m = 1e3; range_m <= kFarthest_m; range_m += 1e3) {
      EXPECT_NEAR(valueEast(*volume, range_m), exact(radar, range_m), 1.2e-4) << swerling << ", " << range_m;
    }
    EXPECT_GT(valueEast(*volume, 0), 0.99) << "finite at the radar itself";
  }
}

TEST_F(DetectionProduct, JammingCountsAsNoise) {
  scenario::Emitter radar = trackingRadar();
  const scenario::Emitter jammer = jammerOf(1000);
  const auto scenario = duel(radar, jammer, 0, 60e3);
  scenario->output.radar_look = scenario::RadarAim::target;
  const RadarLink link = radarLinkOf(radar);
  const double jamming_to_noise = jammingPower_w(link, linkTowardsRadar(jammer, kGain_dbi - 35), 60e3) /
                                  noisePower_w(link.bandwidth_hz, link.noise_temperature_k);
  ASSERT_GT(jamming_to_noise, 5);
  for (double range_m = 2e3; range_m <= kFarthest_m; range_m += 4e3) {
    EXPECT_NEAR(east(scenario, "detection_probability", range_m), exact(radar, range_m, jamming_to_noise),
                1.2e-4);
  }
}

TEST_F(DetectionProduct, EqualsFrequencyOfRandomTrials) {
  // Swerling 1 before noise and noise-like jamming: every amplitude a complex Gaussian number.
  scenario::Emitter radar = trackingRadar();
  radar.receiver.pfa = 1e-2;
  const scenario::Emitter jammer = jammerOf(100);
  const auto scenario = duel(radar, jammer, 0, 60e3);
  scenario->output.radar_look = scenario::RadarAim::target;
  const double range_m = 16e3;
  const RadarLink link = radarLinkOf(radar);
  const double noise_w = noisePower_w(link.bandwidth_hz, link.noise_temperature_k);
  const double jamming_w = jammingPower_w(link, linkTowardsRadar(jammer, kGain_dbi - 35), 60e3);
  const double echo_w = echoPower_w(linkTowardsTarget(radar), 5, range_m);
  std::mt19937 random(7);
  std::normal_distribution<double> gauss;
  const auto power = [&](double variance_w) {
    const double i = gauss(random), q = gauss(random);
    return variance_w / 2 * (i * i + q * q);
  };
  constexpr int kTrials = 100000;
  const double threshold = -std::log(radar.receiver.pfa) * (noise_w + jamming_w);
  int detected = 0;
  for (int n = 0; n < kTrials; ++n) detected += power(echo_w + noise_w + jamming_w) > threshold ? 1 : 0;
  EXPECT_NEAR(east(scenario, "detection_probability", range_m), double(detected) / kTrials, 0.006);
}

TEST_F(DetectionProduct, SeveralRadarsAreIndependent) {
  scenario::Emitter radar = trackingRadar();
  radar.power_w = 100;
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  scenario->output.radar_look = scenario::RadarAim::target;
  addEmitter(*scenario, middleOf(*scenario), radar);
  scenario::Emitter other = radar;
  other.receiver.swerling = 0;
  addEmitter(*scenario, middleOf(*scenario), other);
  const double range_m = 11e3;
  const double a = exact(radar, range_m), b = exact(other, range_m);
  ASSERT_GT(std::min(a, b), 0.05);
  ASSERT_LT(std::max(a, b), 0.95);
  EXPECT_NEAR(east(scenario, "detection_probability", range_m), 1 - (1 - a) * (1 - b), 2e-4);
  scenario->output.combine = scenario::CombineMode::max;
  EXPECT_NEAR(east(scenario, "detection_probability", range_m), std::max(a, b), 2e-4);
}

TEST_F(DetectionProduct, IsZeroWithoutEcho) {
  scenario::Emitter radar = trackingRadar();
  radar.propagation.model = propagation::PropagationModel::horizon;
  auto scenario = emptyScenario(FrameKind::altitude, 44, -71, {300e3, 20e3, 2000}, {60, 4, 4});
  addEmitter(*scenario, {44, -71, 30}, radar);
  scenario->output.radar_look = scenario::RadarAim::target;
  scenario->output.quantities = {"detection_probability"};
  const auto volume = solve(scenario);
  EXPECT_EQ(valueAt(*volume, 0, 2, 0), 0) << "below the horizon";
  EXPECT_GT(valueAt(*volume, 28, 2, 0), 0.99);
  EXPECT_EQ(volume->info.floor, 0);
}

TEST_F(DetectionProduct, FormulasReplaceExactStatistics) {
  scenario::Emitter radar = trackingRadar();
  radar.power_w = 300;
  radar.receiver.swerling = 0;
  radar.receiver.pulses = 10;
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  scenario->output.radar_look = scenario::RadarAim::target;
  addEmitter(*scenario, middleOf(*scenario), radar);
  for (const auto method : {scenario::DetectionMethod::albersheim, scenario::DetectionMethod::shnidman}) {
    scenario->emitters[0].receiver.detection = method;
    double worst = 0;
    for (double range_m = 15e3; range_m <= kFarthest_m; range_m += 1e3) {
      const double pd = exact(radar, range_m);
      if (pd < 0.1 || pd > 0.9) continue;
      worst = std::max(worst, std::abs(east(scenario, "detection_probability", range_m) - pd));
    }
    EXPECT_GT(worst, 1e-3) << "it is a formula";
    EXPECT_LT(worst, 0.06);
  }
}

TEST(RadarChannels, OnlyChangedOnesAreComputedAgain) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.kind = scenario::ScanKind::rotate;
  radar.scan.rate_rpm = 10;
  scenario::Emitter jammer = jammerOf(100);
  jammer.active_s = {{0, 3}};
  const auto scenario = duel(radar, jammer, 0, 60e3);
  scenario->output.quantities = {"snr_db", "jammer_to_signal_db"};
  SolvedField solver(scenario);
  const auto before = solver.volumes();
  solver.update(scenario::snapshotAt(scenario, nullptr, 1));
  EXPECT_NE(solver.volumes()[0].dense(), before[0].dense()) << "the beam turned";
  EXPECT_EQ(solver.volumes()[1].dense(), before[1].dense()) << "the look did not";
  solver.update(scenario::snapshotAt(scenario, nullptr, 4));
  EXPECT_NE(solver.volumes()[1].dense(), before[1].dense()) << "the jammer fell silent";
  EXPECT_EQ(valueEast(*solver.volumes()[1].host(), 20e3), -300);
}

TEST(RadarChannels, UpdatesEqualNewSolver) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.kind = scenario::ScanKind::rotate;
  radar.scan.rate_rpm = 10;
  scenario::Emitter standing = trackingRadar();
  standing.name = "standing";
  const auto scenario = duel(radar, jammerOf(100), 5e3, 30e3);
  addEmitter(*scenario, pointAt(*scenario, 3e3, 0), standing);
  scenario::TrackPoint end = scenario->platforms[1].track.front();
  end.t_s = 10;
  end.position.longitude_deg += 0.2;
  scenario->platforms[1].track.push_back(end);
  for (const char* quantity :
       {"snr_db", "detection_probability", "jammer_to_signal_db", "burn_through_margin_db"}) {
    for (const auto look : {scenario::RadarAim::scan, scenario::RadarAim::target}) {
      SCOPED_TRACE(quantity);
      scenario->output.quantities = {quantity};
      scenario->output.radar_look = look;
      FieldOptions bounded;
      bounded.cache_bytes = 1;
      FieldSolver solver(scenario, nullptr, {}), uncached(scenario, nullptr, bounded);
      for (const double t_s : {0.0, 0.5, 0.5, 1.0, 5.0, 0.0}) {
        const auto snapshot = scenario::snapshotAt(scenario, nullptr, t_s);
        FieldSolver fresh(scenario, nullptr, {});
        fresh.update(snapshot);
        const auto expected = fresh.volumes().front().host()->values;
        for (FieldSolver* updated : {&solver, &uncached}) {
          updated->update(snapshot);
          const auto values = updated->volumes().front().host()->values;
          for (std::size_t v = 0; v < values.size(); ++v) ASSERT_NEAR(values[v], expected[v], 1e-4);
        }
      }
    }
  }
}

TEST(RadarChannels, HoldRadarsAndTheirJammers) {
  const auto scenario = duel(trackingRadar(), jammerOf(100), 0, 60e3);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("radio", 0));
  const auto channels = channelsOf(*scenario, {"snr_db", "detection_probability", "emitter_count"});
  EXPECT_THAT(channels[0].emitters, ::testing::ElementsAre(0));
  EXPECT_THAT(channels[0].jammers, ::testing::IsEmpty());
  EXPECT_THAT(channels[1].emitters, ::testing::ElementsAre(0));
  EXPECT_THAT(channels[1].jammers, ::testing::ElementsAre(1));
  EXPECT_THAT(channels[2].emitters, ::testing::ElementsAre(0, 1, 2));
}

TEST(RadarChannels, LeaveOutBandsWithoutRadars) {
  const auto scenario = duel(trackingRadar(), jammerOf(100), 0, 60e3);
  scenario->output.combine = scenario::CombineMode::per_band;
  scenario->bands = {{"L", 1e9, 2e9}, {"S", 2e9, 4e9}};
  const auto channels = channelsOf(*scenario, {"snr_db", "jammer_to_signal_db"});
  ASSERT_EQ(channels.size(), 2u);
  EXPECT_EQ(channels[1].name, "jammer_to_signal_db:S");
  EXPECT_THAT(channels[1].jammers, ::testing::ElementsAre(1));
}

TEST(RadarChannels, NeedARadar) {
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("radio", 0));
  for (const char* quantity : {"snr_db", "detection_probability", "jammer_to_signal_db"}) {
    EXPECT_THAT(
        test::errorOf([&] { east(scenario, quantity, 0); }),
        ::testing::HasSubstr(std::string("quantity '") + quantity + "' needs an emitter of kind 'radar'"));
  }
}

}  // namespace
}  // namespace emscape::emfield
