#include "emscape/render/annotate/legend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace emscape::render
