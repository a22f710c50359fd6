#include "emscape/render/annotate/legend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "emscape/base/units.h"

namespace emscape::render {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Ticks, AreAtRoundValuesWithinInterval) {
  EXPECT_THAT(roundTicks(-87, -18, 7), ElementsAre(-80, -70, -60, -50, -40, -30, -20));
  EXPECT_THAT(roundTicks(0, 1, 4), ElementsAre(0, 0.25, 0.5, 0.75, 1));
  EXPECT_THAT(roundTicks(-0.3, 0.3, 3), ElementsAre(-0.2, 0, 0.2));
}

TEST(Ticks, ThereAreNoneInAnEmptyInterval) {
  EXPECT_THAT(roundTicks(3, 3, 5), IsEmpty());
  EXPECT_THAT(roundTicks(4, 3, 5), IsEmpty());
}

TEST(Ticks, HaveAsManyDecimalsAsTheirStepNeeds) {
  EXPECT_EQ(tickText(0.75, 0.25), "0.75");
  EXPECT_EQ(tickText(-80, 10), "−80");
  EXPECT_EQ(tickText(1.5, 0.5), "1.5");
}

TEST(Legend, NamesQuantitiesAndUnitsAsPeopleWriteThem) {
  EXPECT_EQ(quantityTitle("power_density_dbwm2", "dBW/m2"), "Power density");
  EXPECT_EQ(quantityTitle("field_strength_dbuvm", "dBuV/m"), "Field strength");
  EXPECT_EQ(quantityTitle("snr_db", "dB"), "SNR");
  EXPECT_EQ(quantityTitle("snr_difference_db", "dB"), "SNR difference");
  EXPECT_EQ(quantityTitle("sinr_db", "dB"), "SINR");
  EXPECT_EQ(quantityTitle("sclnr_db", "dB"), "SCLNR");
  EXPECT_EQ(quantityTitle("emitter_count", ""), "Emitter count");
  EXPECT_EQ(quantityTitle("snr_db:search radar", "dB"), "SNR of search radar");
  EXPECT_EQ(unitText("dBW/m2"), "dBW/m²");
  EXPECT_EQ(unitText("dBuV/m"), "dBµV/m");
}

TEST(Legend, HasNoteOfTheVolume) {
  volume::VolumeInfo info;
  info.quantity = "jammer_to_signal_db";
  info.unit = "dB";
  EXPECT_EQ(legendOf(info, {}).note, "");
  info.extra[volume::kLegendNoteKey] = "no echo: 100";
  EXPECT_EQ(legendOf(info, {}).note, "no echo: 100");
}

TEST(FieldScale, FieldStrengthOfAPowerDensityIsThatOfAPlaneWave) {
  const FieldScale scale = fieldScale("dBW/m2", FieldUnit::v_per_m);
  EXPECT_EQ(scale.unit, "V/m");
  for (const double density_w_m2 : {1e-9, 1.0, 50.0}) {
    const double expected = std::sqrt(density_w_m2 * kFreeSpaceImpedance);
    EXPECT_NEAR(scale.shown(10 * std::log10(density_w_m2)), expected, 1e-6 * expected);
    EXPECT_NEAR(scale.stored(expected), 10 * std::log10(density_w_m2), 1e-5);
  }
  EXPECT_NEAR(fieldScale("dBuV/m", FieldUnit::v_per_m).shown(120), 1, 1e-12);
}

TEST(FieldScale, LevelsAreShiftedAndOtherQuantitiesStay) {
  EXPECT_NEAR(fieldScale("dBW/m2", FieldUnit::dbm).shown(-40), -10, 1e-12);
  EXPECT_NEAR(fieldScale("dBuV/m", FieldUnit::dbm).shown(fieldScale("dBuV/m", FieldUnit::dbm).stored(-10)),
              -10, 1e-12);
  EXPECT_NEAR(fieldScale("dBuV/m", FieldUnit::dbm).shown(-40 + 145.760306), -10, 1e-4);
  for (const FieldUnit unit : {FieldUnit::dbm, FieldUnit::v_per_m}) {
    EXPECT_EQ(fieldScale("dB", unit).unit, "dB");
    EXPECT_EQ(fieldScale("dBm", unit).shown(-80), -80);
  }
}

TEST(FieldScale, LegendsInVoltsPerMetreHaveRoundValuesAtTheirLevels) {
  const std::vector<double> decades = roundLogTicks(1e-6, 1.5, 7);
  EXPECT_EQ(decades.size(), 7U);
  EXPECT_NEAR(decades.front(), 1e-6, 1e-12);
  EXPECT_NEAR(decades.back(), 1, 1e-12);
  const std::vector<double> within_decades = roundLogTicks(0.01, 1, 7);
  ASSERT_EQ(within_decades.size(), 7U);
  EXPECT_NEAR(within_decades[1], 0.02, 1e-12);
  EXPECT_NEAR(within_decades[2], 0.05, 1e-12);
  EXPECT_TRUE(roundLogTicks(0, 1, 5).empty());
  volume::VolumeInfo info;
  info.quantity = "power_density_dbwm2";
  info.unit = "dBW/m2";
  EXPECT_EQ(legendOf(info, {}, FieldUnit::v_per_m).unit, "V/m");
  EXPECT_EQ(legendOf(info, {}, FieldUnit::v_per_m).quantity, "Field strength");
  EXPECT_EQ(legendOf(info, {}, FieldUnit::dbm).quantity, "Power density");
  EXPECT_EQ(legendOf(info, {}, FieldUnit::dbm).unit, "dBm/m²");
  EXPECT_EQ(legendOf(info, {}).unit, "dBW/m²");
}

}  // namespace
}  // namespace emscape::render
