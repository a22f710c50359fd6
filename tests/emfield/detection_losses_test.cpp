// Losses of detection against closed forms, and their effect on the probability of detection.
#include "emfield/radar/detection_losses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "emscape/base/units.h"
#include "emscape/emfield/link/path_budget.h"
#include "tests/emfield/radar_duel.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using scenario::BeamShapeLoss;

TEST(BeamShapeLoss, GaussianBeamEqualsMeanOfItsPulses) {
  // Two-way power over pulses from -5 to 5 beamwidths, counted within one beamwidth.
  constexpr int kPulses = 1000;
  double sum = 0;
  for (int i = -5 * kPulses; i <= 5 * kPulses; ++i) {
    const double off_axis = double(i) / kPulses;  // beamwidths
    sum += std::exp(-8 * std::log(2.0) * off_axis * off_axis);
  }
  EXPECT_NEAR(beamShapeLossDb(BeamShapeLoss::barton, 1), ratioToDb(kPulses / sum), 1e-6);
  EXPECT_NEAR(beamShapeLossDb(BeamShapeLoss::barton, 2), 2 * 1.2338, 1e-3);
  EXPECT_DOUBLE_EQ(beamShapeLossDb(BeamShapeLoss::blake, 2), 3.2);
  EXPECT_EQ(beamShapeLossDb(BeamShapeLoss::none, 2), 0);
}

TEST(CfarLoss, OnePulseEqualsClosedForm) {
  for (const int cells : {4, 10, 32, 500}) {
    const Detector detector{Swerling::slow_exponential, 1, 1e-6};
    const double power = -1.0 / cells;
    const double needed = (std::pow(1e-6, power) - 1) / (std::pow(0.5, power) - 1) - 1;
    const double ideal = std::log(1e-6) / std::log(0.5) - 1;
    EXPECT_NEAR(cfarLossDb(detector, cells), ratioToDb(needed / ideal), 1e-8) << cells;
  }
}

TEST(CfarLoss, FallsWithCellsAndWithPulses) {
  const Detector one{Swerling::fast_exponential, 1, 1e-6}, ten{Swerling::fast_exponential, 10, 1e-6};
  EXPECT_LT(cfarLossDb(ten, 16), cfarLossDb(one, 16));
  EXPECT_LT(cfarLossDb(ten, 64), cfarLossDb(ten, 16));
  EXPECT_GT(cfarLossDb(ten, 1000), 0);
  EXPECT_LT(cfarLossDb(ten, 1000), 0.05);
  EXPECT_LT(cfarLossDb({Swerling::steady, 1000000, 1e-6}, 16), 1);  // no overflow
}

TEST(BinaryIntegrationLoss, TwoOfThreeEqualsExactProbability) {
  const Detector detector{Swerling::steady, 3, 1e-6};
  const double loss_db = binaryIntegrationLossDb(detector, 2);
  // 3 p^2 - 2 p^3 = 1e-6 by iteration; it is 1/2 for p = 1/2.
  double p = std::sqrt(1e-6 / 3);
  for (int i = 0; i < 50; ++i) p = std::sqrt((1e-6 + 2 * p * p * p) / 3);
  const Detector one{Swerling::steady, 1, p};
  EXPECT_NEAR(requiredSnrDb(one, 0.5) - requiredSnrDb(detector, 0.5), loss_db, 1e-6);
}

TEST(BinaryIntegrationLoss, IsZeroForOnePulseAndSmallAtBestThreshold) {
  EXPECT_NEAR(binaryIntegrationLossDb({Swerling::steady, 1, 1e-6}, 1), 0, 1e-6);
  const Detector ten{Swerling::steady, 10, 1e-6};
  const double at_best_db = binaryIntegrationLossDb(ten, 5);
  // Skolnik, Introduction to Radar Systems, 2nd ed., section 10.7: the loss is about 1 to 2 dB.
  EXPECT_GT(at_best_db, 0.8);
  EXPECT_LT(at_best_db, 2);
  EXPECT_GT(binaryIntegrationLossDb(ten, 1), at_best_db);
  EXPECT_GT(binaryIntegrationLossDb(ten, 10), at_best_db);
}

double detectionAt(const scenario::Emitter& radar, const char* term = "detection_probability") {
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), radar);
  scenario->output.radar_look = scenario::RadarAim::target;
  const PathEnd end{pointAt(*scenario, 30e3, 0), 500};
  return pathBudget(scenario::snapshotAt(scenario, nullptr, 0), 0, end, radar.propagation.model, nullptr)
      .find(term)
      ->value;
}

TEST(DetectionLosses, EqualReductionOfPower) {
  scenario::Emitter radar = trackingRadar();
  radar.receiver.pulses = 10;
  radar.receiver.target_rcs_m2 = 1;
  radar.scan.kind = scenario::ScanKind::raster;
  radar.scan.width_deg = 360;
  const double required_db = detectionAt(radar, "required_snr_db");
  scenario::Emitter lossy = radar;
  lossy.receiver.beam_shape_loss = BeamShapeLoss::blake;
  lossy.receiver.cfar_cells = 16;
  lossy.receiver.binary_threshold = 6;
  const DetectionLosses losses = detectionLosses(lossy);
  EXPECT_DOUBLE_EQ(losses.beam_shape_db, 3.2);
  EXPECT_GT(losses.cfar_db, 0.1);
  EXPECT_GT(losses.binary_db, 0.5);
  radar.power_w *= dbToRatio(-losses.total_db());
  const double expected = detectionAt(radar);
  EXPECT_GT(expected, 0.01);
  EXPECT_LT(expected, 0.99);
  EXPECT_NEAR(detectionAt(lossy), expected, 2e-4);
  EXPECT_NEAR(detectionAt(lossy, "required_snr_db"), required_db + losses.total_db(), 1e-9);
  EXPECT_NEAR(detectionAt(lossy, "detection_losses_db"), losses.total_db(), 1e-9);
}

TEST(MeanPowerDensity, EqualsPeakTimesDutyCycle) {
  scenario::Emitter radar = trackingRadar();
  radar.waveform = scenario::Waveform{1000, 10e-6, std::nullopt};
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), radar);
  const float peak_db = east(scenario, "power_density_dbwm2", 20e3);
  EXPECT_NEAR(east(scenario, "mean_power_density_dbwm2", 20e3), peak_db - 20, 1e-4);
  scenario->emitters[0].waveform.reset();
  EXPECT_EQ(east(scenario, "mean_power_density_dbwm2", 20e3), peak_db);
}

TEST(PathBudget, RadarWarnsOfRangesOutsideItsPulses) {
  scenario::Emitter radar = trackingRadar();
  radar.waveform = scenario::Waveform{1000, 10e-6, 20e3};
  const auto warningsAt = [&](double range_m) {
    auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
    addEmitter(*scenario, middleOf(*scenario), radar);
    const PathEnd end{pointAt(*scenario, range_m, 0), 500};
    std::string all;
    for (const std::string& warning :
         pathBudget(scenario::snapshotAt(scenario, nullptr, 0), 0, end, radar.propagation.model, nullptr)
             .warnings)
      all += warning;
    return all;
  };
  EXPECT_EQ(warningsAt(10e3), "");
  EXPECT_NE(warningsAt(30e3).find("instrumented range of 20.0 km"), std::string::npos);
  EXPECT_NE(warningsAt(1000).find("% of the echo arrives while the radar transmits"), std::string::npos);
  radar.waveform = scenario::Waveform{10e3, 1e-6, std::nullopt};
  EXPECT_NE(warningsAt(20e3).find("unambiguous range of 15.0 km"), std::string::npos);
}

TEST(DetectionRange, EndsWithTheInstrumentedAndTheUnambiguousRange) {
  scenario::Emitter radar = trackingRadar();
  radar.power_w *= 1e8;
  const auto at = [&](const scenario::Waveform& waveform, double range_m) {
    auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
    radar.waveform = waveform;
    addEmitter(*scenario, middleOf(*scenario), radar);
    return static_cast<double>(east(scenario, "detection_probability", range_m));
  };
  scenario::Waveform waveform{1000, 1e-6, 20e3};
  EXPECT_GT(at(waveform, 18e3), 0.99);
  EXPECT_EQ(at(waveform, 22e3), 0);
  waveform.limits_detection = false;
  EXPECT_GT(at(waveform, 22e3), 0.98);
  waveform = scenario::Waveform{10e3, 1e-6, {}};  // unambiguous up to 15 km
  EXPECT_GT(at(waveform, 13e3), 0.99);
  EXPECT_EQ(at(waveform, 17e3), 0);
}

TEST(DetectionRange, InBlindRangesEqualsThatOfTheRestOfThePulse) {
  scenario::Emitter radar = trackingRadar();
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  radar.waveform =
      scenario::Waveform{5e3, 60e-6, {}};  // echoes from up to 9 km and from beyond 21 km are cut
  addEmitter(*scenario, middleOf(*scenario), radar);
  const Detector detector = detectorOf(radar.receiver);
  int partial = 0;
  for (double range_m = 1e3; range_m < 29e3; range_m += 2e3) {
    const double snr_db = static_cast<double>(east(scenario, "snr_db", range_m));
    const double part = 1 - radar.waveform->eclipsedPart(range_m);
    const double expected =
        detectionProbability(detector, detectionThreshold(detector), dbToRatio(snr_db) * part * part);
    EXPECT_NEAR(east(scenario, "detection_probability", range_m), expected, 5e-4) << range_m;
    partial += part < 0.9;
  }
  EXPECT_GT(partial, 4);
}

}  // namespace
}  // namespace emscape::emfield
