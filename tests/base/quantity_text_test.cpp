#include "base/text/quantity_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace emscape {
namespace {

TEST(QuantityText, WattsAndHertzHaveAPrefix) {
  EXPECT_EQ(quantityText(1e7, "W"), "10 MW");
  EXPECT_EQ(quantityText(200000, "W"), "200 kW");
  EXPECT_EQ(quantityText(500, "W"), "500 W");
  EXPECT_EQ(quantityText(0.025, "W"), "25 mW");
  EXPECT_EQ(quantityText(3e-7, "W"), "300 nW");
  EXPECT_EQ(quantityText(9.41e9, "Hz"), "9.41 GHz");
  EXPECT_EQ(quantityText(1e12, "Hz"), "1 THz");
  EXPECT_EQ(quantityText(-2000, "Hz"), "-2 kHz");
  EXPECT_EQ(quantityText(0, "W"), "0 W");
}

TEST(QuantityText, OtherUnitsHaveAPlainNumber) {
  EXPECT_EQ(quantityText(12000, "m"), "12000 m");
  EXPECT_EQ(quantityText(4e6, "m"), "4000000 m");
  EXPECT_EQ(quantityText(-63.25, "dBW/m2"), "-63.25 dBW/m2");
  EXPECT_EQ(quantityText(1.5, ""), "1.5");
  EXPECT_EQ(quantityText(-0.0, "dB"), "0 dB");
  EXPECT_EQ(quantityText(1e30, "m"), "1e+30 m");
}

TEST(QuantityText, IsRoundedBeforeThePrefixIsChosen) {
  EXPECT_EQ(quantityText(999999.9, "W"), "1 MW");
  EXPECT_EQ(quantityText(999999.9, "W", 7), "999.9999 kW");
  EXPECT_EQ(quantityText(123456789, "Hz", 3), "123 MHz");
}

TEST(QuantityText, NoNumberHasNoPrefix) {
  EXPECT_EQ(quantityText(std::numeric_limits<double>::infinity(), "W"), "inf W");
  EXPECT_EQ(quantityText(std::nan(""), "Hz"), "nan Hz");
}

TEST(RangeText, NamesTheUnitWhereItDiffers) {
  EXPECT_EQ(rangeText(1e6, 1e12, "Hz"), "1 MHz to 1 THz");
  EXPECT_EQ(rangeText(0, 1e12, "W"), "0 to 1 TW");
  EXPECT_EQ(rangeText(1e6, 5e6, "Hz"), "1 to 5 MHz");
  EXPECT_EQ(rangeText(-90, 90, "deg"), "-90 to 90 deg");
  EXPECT_EQ(rangeText(0, 1, ""), "0 to 1");
  EXPECT_EQ(rangeText(1, 4000000, "m"), "1 to 4000000 m");
}

TEST(ParseQuantity, TakesANumberWithOrWithoutItsUnit) {
  EXPECT_EQ(parseQuantity("3e9", "Hz"), 3e9);
  EXPECT_EQ(parseQuantity("3", "Hz", 1e9), 3e9);
  EXPECT_EQ(parseQuantity("3 GHz", "Hz", 1e6), 3e9);
  EXPECT_EQ(parseQuantity("3000MHz ", "Hz"), 3e9);
  EXPECT_EQ(parseQuantity("10 Hz", "Hz", 1e6), 10);
  EXPECT_EQ(parseQuantity("-5 kW", "W"), -5000);
  EXPECT_EQ(parseQuantity("2 m", "m"), 2);
  EXPECT_EQ(parseQuantity("2 kg", "m"), std::nullopt);
  EXPECT_EQ(parseQuantity("2 GW", "Hz"), std::nullopt);
  EXPECT_EQ(parseQuantity("much", "Hz"), std::nullopt);
  EXPECT_EQ(parseQuantity("", "Hz"), std::nullopt);
  EXPECT_EQ(parseQuantity("inf", "m"), std::nullopt);
}

TEST(ReadUnits, NamesEachUnitThatIsReadOnce) {
  EXPECT_EQ(readUnits("m"), "m, km, cm, mm, ft, NM, mi");
  EXPECT_EQ(readUnits("W"), "W, mW, kW, MW, GW, TW, dBW, dBm");
  EXPECT_EQ(readUnits("deg"), "°");
  EXPECT_EQ(readUnits("s"), "s, ms, us, ns, min, h");
  EXPECT_EQ(readUnits(""), "");
}

TEST(ParseQuantity, TakesOtherUnitsOfTheDimension) {
  const auto expectNear = [](const char* text, const char* unit, double expected) {
    const auto value = parseQuantity(text, unit);
    ASSERT_TRUE(value) << text;
    EXPECT_NEAR(*value, expected, 1e-9 * std::abs(expected)) << text;
  };
  expectNear("2 km", "m", 2000);
  expectNear("1000 ft", "m", 304.8);
  expectNear("3 NM", "m", 5556);
  expectNear("10 kt", "m/s", 5.144444444444445);
  expectNear("36 km/h", "m/s", 10);
  expectNear("12 µs", "s", 12e-6);
  expectNear("45°", "deg", 45);
  expectNear("15 °C", "K", 288.15);
  expectNear("-3 dBW", "W", 0.5011872336272722);
  expectNear("30 dBm", "W", 1);
  expectNear("-120 dBW", "dBm", -90);
  expectNear("10 dBsm", "m2", 10);
  expectNear("5 m²", "m2", 5);
}

TEST(ParseQuantity, ReadsUnitsOfEitherCaseWhereOnlyOneIsPossible) {
  EXPECT_EQ(parseQuantity("5 kw", "W"), 5000);
  EXPECT_EQ(parseQuantity("300 mhz", "Hz"), 300e6);
  EXPECT_EQ(parseQuantity("5 mw", "W"), std::nullopt);
  EXPECT_EQ(parseQuantity("-3 dbw", "W"), parseQuantity("-3 dBW", "W"));
}

TEST(UnitSigns, AreReadAsTheUnit) {
  for (const char* unit : {"deg", "deg/s", "m2", "g/m3", "dBW/m2", "percent", "m"})
    EXPECT_EQ(parseQuantity("2 " + unitSigns(unit), unit), 2) << unit;
}

}  // namespace
}  // namespace emscape
