// What counts once and what twice in the budgets of emitters, radars and jammers, through the whole field.

#include <gtest/gtest.h>

#include "tests/emfield/radar_duel.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;

TEST(Losses, EachLossOfTheChainCountsOnce) {
  scenario::Emitter radar = trackingRadar();
  const auto snr = [&] { return east(duel(radar, jammerOf(1), 0, 60e3), "snr_db", 20e3); };
  radar.scan.azimuth_deg = 90;
  radar.losses_db = radar.receiver.losses_db = 0;
  const double lossless = snr();
  radar.losses_db = 3;
  EXPECT_NEAR(snr(), lossless - 3, 1e-3) << "of the transmit path: once, not once more on receiving";
  radar.receiver.losses_db = 2;
  EXPECT_NEAR(snr(), lossless - 5, 1e-3) << "of the receive path";
  radar.receiver.processing_gain_db = 10;
  EXPECT_NEAR(snr(), lossless + 5, 1e-3);
  // Receive losses attenuate jamming and echo alike; transmit losses only the echo.
  radar.receiver.processing_gain_db = 0;
  const auto ratio = [&] { return east(duel(radar, jammerOf(1), 0, 60e3), "jammer_to_signal_db", 20e3); };
  const double before = ratio();
  radar.receiver.losses_db = 7;
  EXPECT_NEAR(ratio(), before, 1e-3);
  radar.losses_db += 4;
  EXPECT_NEAR(ratio(), before + 4, 1e-3);
}

TEST(Losses, LineLossAddsNoiseByBlake) {
  // An antenna at 290 K: the line's losses add to the noise figure. A cold one gains less than the ratio of
  // the temperatures, as line and receiver stay warm.
  scenario::Emitter radar = trackingRadar();
  radar.receiver.losses_db = 2;
  radar.receiver.noise_figure_db = 3;
  const RadarLink warm = radarLinkOf(radar);
  EXPECT_NEAR(warm.noise_temperature_k, 290 * dbToRatio(3), 1e-9);
  radar.receiver.antenna_temperature_k = 100;
  const double at_antenna_k = 100 + 290 * (dbToRatio(2) - 1) + dbToRatio(2) * 290 * (dbToRatio(3) - 1);
  EXPECT_NEAR(radarLinkOf(radar).noise_temperature_k, at_antenna_k / dbToRatio(2), 1e-9);
}

TEST(RadiatedField, OneKilowattErpEqualsItsEirp) {
  // ITU's curves are for 1 kW ERP, which is 2.15 dB more EIRP: 106.9 dBuV/m at 1 km.
  auto scenario = lineOfVoxels(2e3, 1e3);
  scenario::Emitter emitter = plainEmitter("dipole", 0);
  emitter.antenna = scenario::makeIsotropic(kDipoleGain_dbi);
  addEmitter(*scenario, middleOf(*scenario), emitter);
  EXPECT_NEAR(east(scenario, "field_strength_dbuvm", 1e3), 106.92, 0.01);
  scenario->emitters[0].antenna = scenario::makeIsotropic();
  EXPECT_NEAR(east(scenario, "field_strength_dbuvm", 1e3), 104.77, 0.01);
}

TEST(RadiatedField, StrengthIsRms) {
  // E = sqrt(30 EIRP) / d is RMS: 173.2 mV/m for 1 kW at 1 km; the peak would be 3.01 dB more.
  auto scenario = lineOfVoxels(2e3, 1e3);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("isotropic", 0));
  const double rms_v_per_m = std::sqrt(kFreeSpaceImpedance / (4 * kPi) * 1000) / 1e3;
  EXPECT_NEAR(east(scenario, "field_strength_dbuvm", 1e3), 20 * std::log10(rms_v_per_m * 1e6), 1e-3);
}

TEST(RadiatedField, PowersAreAdded) {
  auto scenario = lineOfVoxels(2e3, 1e3);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("one", 0));
  for (const char* quantity : {"power_density_dbwm2", "field_strength_dbuvm"}) {
    const double one = east(scenario, quantity, 1e3);
    auto two = lineOfVoxels(2e3, 1e3);
    for (int i = 0; i < 2; ++i) addEmitter(*two, middleOf(*two), plainEmitter("one", 0));
    EXPECT_NEAR(east(two, quantity, 1e3) - one, 3.0103, 1e-3);
  }
}

TEST(RadarBudget, PathCountsTwiceForEchoAndOnceForJammer) {
  // Each doubling of range: 12.04 dB of an echo's, 6.02 dB of jamming's power; the pattern likewise.
  scenario::Emitter radar = trackingRadar();
  radar.scan.azimuth_deg = 90;
  const auto scenario = duel(radar, jammerOf(1), 0, 30e3);
  EXPECT_NEAR(east(scenario, "snr_db", 10e3) - east(scenario, "snr_db", 20e3), 40 * std::log10(2.0), 1e-3);
  const auto farther = duel(radar, jammerOf(1), 0, 60e3);
  EXPECT_NEAR(east(scenario, "jammer_to_signal_db", 10e3) - east(farther, "jammer_to_signal_db", 10e3),
              20 * std::log10(2.0), 1e-3);
  scenario->emitters[0].scan.azimuth_deg = 88.5;
  EXPECT_NEAR(east(scenario, "snr_db", 10e3) - radarSnrDb(linkTowardsTarget(radar), 5, 10e3),
              2 * 10 * std::log10(0.5), 1e-3);
}

TEST(RadarBudget, GasesAndRainCountTwiceForEchoAndOnceForJammer) {
  scenario::Emitter radar = trackingRadar(), jammer = jammerOf(100);
  radar.frequency_hz = jammer.frequency_hz = 10e9;
  jammer.polarization = radar.polarization;  // rain does not attenuate all alike
  radar.scan.azimuth_deg = 90;
  auto scenario = duel(radar, jammer, 0, 30e3);
  const auto snr = [&] { return east(scenario, "snr_db", 20e3); };
  const auto density = [&] {
    scenario->output.combine = scenario::CombineMode::per_emitter;
    const float value = east(scenario, "power_density_dbwm2", 20e3);
    scenario->output.combine = scenario::CombineMode::sum;
    return value;
  };
  const auto ratio = [&] { return east(scenario, "jammer_to_signal_db", 20e3); };
  const double dry_snr = snr(), dry_density = density(), dry_ratio = ratio();
  scenario->atmosphere.rain_mm_h = 10;
  const double one_way_db = dry_density - density();
  ASSERT_GT(one_way_db, 1);
  EXPECT_NEAR(dry_snr - snr(), 2 * one_way_db, 0.02);
  // The jammer's path is half as long again.
  EXPECT_NEAR(ratio() - dry_ratio, 2 * one_way_db - 1.5 * one_way_db, 0.05);
}

TEST(RadarBudget, InterceptIsOneWay) {
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("radio", 0));
  scenario->receivers = {scenario::ReceiverProfile{}};
  EXPECT_NEAR(east(scenario, "received_power_dbm", 10e3) - east(scenario, "received_power_dbm", 20e3),
              20 * std::log10(2.0), 1e-3);
}

}  // namespace
}  // namespace emscape::emfield
