#include "apps/view/values/number_form.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/errors.h"

namespace emscape::view {
namespace {

using emscape::test::errorOf;

TEST(NumberForm, ReadsWhatItWritesAndOtherUnits) {
  const NumberForm altitude{"altitude ", "m", "", 0};
  EXPECT_EQ(altitude.textOf(1500.4), "altitude 1500 m");
  for (const char* text : {"altitude 1500 m", "1500", "1.5 km", " 1500m ", "altitude 1.5km"})
    EXPECT_NEAR(altitude.valueOf(text), 1500, 1e-9) << text;
  EXPECT_NEAR(altitude.valueOf("1000 ft"), 304.8, 1e-9);
  const NumberForm height{"", "m", " above ground", 0};
  EXPECT_EQ(height.textOf(20), "20 m above ground");
  EXPECT_EQ(height.valueOf("30 m above ground"), 30);
  const NumberForm bearing{"bearing ", "deg", "", 0};
  EXPECT_EQ(bearing.textOf(30), "bearing 30°");
  EXPECT_EQ(bearing.valueOf("45°"), 45);
  const NumberForm rate{"× "};
  EXPECT_EQ(rate.valueOf("× 4"), 4);
  EXPECT_EQ(rate.valueOf("0.25"), 0.25);
  const NumberForm end{"", "s"};
  EXPECT_EQ(end.valueOf("2 min"), 120);
}

TEST(NumberForm, ShownUnitIsThatOfANumberWithoutOne) {
  const NumberForm spacing{"every ", "m", "", -1, "NM", 1852};
  EXPECT_EQ(spacing.textOf(18520), "every 10 NM");
  EXPECT_EQ(spacing.valueOf("5"), 5 * 1852);
  EXPECT_EQ(spacing.valueOf("5 km"), 5000);
}

TEST(NumberForm, ValuesOfFieldsAreReadInEachOfTheirUnits) {
  NumberForm from{"from ", "dBW/m2"};
  EXPECT_EQ(from.textOf(-60), "from -60 dBW/m²");
  EXPECT_EQ(from.valueOf("-60"), -60);
  EXPECT_NEAR(from.valueOf("10 dBm/m²"), -20, 1e-9);
  EXPECT_NEAR(from.valueOf("10 dBm/m2"), -20, 1e-9);
  from.field_unit = FieldUnit::dbm;
  EXPECT_EQ(from.textOf(-60), "from -30 dBm/m²");
  EXPECT_NEAR(from.valueOf("-30"), -60, 1e-9);
  EXPECT_NEAR(from.valueOf("-60 dBW/m²"), -60, 1e-9);
  from.field_unit = FieldUnit::v_per_m;
  EXPECT_NEAR(from.valueOf(from.textOf(-60)), -60, 1e-3);
}

TEST(NumberForm, RefusalsNameTextAndRange) {
  const NumberForm altitude{"altitude ", "m", "", 0, "", 1, {}, 0, 6000};
  EXPECT_EQ(errorOf([&] { altitude.valueOf("7 km"); }), "altitude: 7000 m: expected 0 m to 6000 m");
  EXPECT_EQ(errorOf([&] { altitude.valueOf("high"); }),
            "altitude: 'high' is not a number; units: m, km, cm, mm, ft, NM, mi");
  EXPECT_EQ(errorOf([&] { altitude.valueOf("5 dB"); }),
            "altitude: '5 dB': 'dB' is not one of the units m, km, cm, mm, ft, NM, mi");
  EXPECT_EQ(errorOf([&] { altitude.valueOf("1,5 km"); }),
            "altitude: '1,5 km': a decimal point is needed, 1.5 km");
  EXPECT_EQ(errorOf([&] { altitude.valueOf("1,500 m"); }),
            "altitude: '1,500 m': 1500 m or 1.500 m? A comma has no meaning");
  EXPECT_EQ(errorOf([&] { altitude.valueOf("1 500 m"); }),
            "altitude: '1 500 m': a number has no blanks, 1500 m");
  EXPECT_EQ(errorOf([&] { altitude.valueOf("1e400 m"); }), "altitude: '1e400 m' is too large");
  EXPECT_EQ(errorOf([&] {
              NumberForm{"", "dBW/m2"}.valueOf("5 kW");
            }),
            "'5 kW': 'kW' is not one of the units dBW/m², dBm/m², V/m");
  NumberForm time{"", "s"};
  time.read = [](const std::string& text) { return static_cast<double>(text.size()); };
  EXPECT_EQ(time.valueOf(" 1:15 "), 4) << "a grammar of its own";
}

}  // namespace
}  // namespace emscape::view
