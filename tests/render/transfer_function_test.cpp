#include "emscape/render/transfer/transfer_function.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "render/cast/transfer_table.h"
#include "tests/render/scenes.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::render {
namespace {

using ::testing::HasSubstr;

volume::VolumeInfo decibels() {
  volume::VolumeInfo info;
  info.quantity = "power_density_dbwm2";
  info.unit = "dBW/m2";
  info.floor = -120;
  info.range_min = -100;
  info.range_max = 0;
  return info;
}

std::string errorOf(const std::string& text) {
  return test::errorOf([&] { parseTransferFunction(text, "tf.json", decibels()); }, ErrorCode::bad_input);
}

TEST(TransferFunction, IsLinearBetweenPointsAndConstantOutside) {
  const TransferFunction f =
      testing::makeFunction({{-50, {0, 0, 0}}, {-10, {1, 0.5F, 0}}}, {{-60, 0.1}, {-20, 0.5}});
  EXPECT_FLOAT_EQ(f.color(-30).r, 0.5F);
  EXPECT_FLOAT_EQ(f.color(99).g, 0.5F);
  EXPECT_FLOAT_EQ(f.color(-99).r, 0.0F);
  EXPECT_DOUBLE_EQ(f.opacity(-40), 0.3);
  EXPECT_DOUBLE_EQ(f.opacity(-99), 0.1);
  EXPECT_DOUBLE_EQ(f.opacity(0), 0.5);
  EXPECT_DOUBLE_EQ(f.lowest(), -60);
  EXPECT_DOUBLE_EQ(f.highest(), -10);
}

TEST(TransferFunction, ARepeatedOpacityPointIsAJump) {
  const TransferFunction f = testing::makeFunction({{0, {1, 1, 1}}}, {{0, 0}, {1, 0}, {1, 0.5}, {2, 0.5}});
  EXPECT_DOUBLE_EQ(f.opacity(0.999), 0);
  EXPECT_DOUBLE_EQ(f.opacity(1), 0.5);
}

TEST(TransferFunction, DefaultKnowsTheScaleThatAVolumeNames) {
  volume::VolumeInfo info = decibels();
  info.extra[volume::kScaleKey] = volume::kProbabilityScale;
  const TransferFunction probability = defaultTransferFunction(info);
  EXPECT_DOUBLE_EQ(probability.lowest(), 0);
  EXPECT_DOUBLE_EQ(probability.highest(), 1);
  EXPECT_EQ(probability.opacity(0), 0);
  EXPECT_GT(probability.opacity(0.5), probability.opacity(0.8));

  info.extra[volume::kScaleKey] = volume::kRatioBelowScale;
  const TransferFunction below = defaultTransferFunction(info);
  info.extra[volume::kScaleKey] = volume::kRatioAboveScale;
  const TransferFunction above = defaultTransferFunction(info);
  EXPECT_EQ(below.opacity(info.floor), 0);
  for (const double ratio_db : {-40.0, -30.5, -29.5, -20.0, -1.0, 0.0, 5.0, 30.0, 60.0}) {
    EXPECT_DOUBLE_EQ(below.opacity(ratio_db), above.opacity(-ratio_db)) << ratio_db;
    EXPECT_FLOAT_EQ(below.color(ratio_db).r, above.color(-ratio_db).r) << ratio_db;
  }
  EXPECT_GT(below.color(-20).b, below.color(-20).r) << "blue where what is looked for prevails";
  EXPECT_GT(below.color(20).r, below.color(20).b);
}

TEST(TransferFunction, DefaultSpansTheRangeAndHidesTheFloor) {
  const TransferFunction f = defaultTransferFunction(decibels());
  EXPECT_DOUBLE_EQ(f.lowest(), -100);
  EXPECT_DOUBLE_EQ(f.highest(), 0);
  EXPECT_EQ(f.opacity(-120), 0);
  EXPECT_GT(f.opacity(0), 0.05);
}

TEST(TransferFunction, DefaultOfAVolumeFollowsItsValuesAndEndsAtRoundNumbers) {
  const auto volume = testing::makeEmeVolume({40, 40, 20});
  const TransferFunction f = defaultTransferFunction(*volume);
  EXPECT_EQ(f.opacity(volume->info.floor), 0);
  EXPECT_GT(f.opacity(f.highest()), 0.05);
  EXPECT_DOUBLE_EQ(f.lowest(), std::round(f.lowest()));
  EXPECT_DOUBLE_EQ(f.highest(), std::round(f.highest()));
  EXPECT_LT(f.highest(), 60);
}

TEST(TransferFunction, DefaultOfValuesOnBothSidesOfZeroIsSymmetricalAndDiverging) {
  auto volume =
      *testing::makeVolume({20, 20, 20}, {1, 1, 1}, [](int i, int, int) { return i < 10 ? -0.3F : 0.5F; });
  volume.info.floor = volume::kNoFloor;
  const TransferFunction f = defaultTransferFunction(volume);
  EXPECT_DOUBLE_EQ(f.lowest(), -f.highest());
  EXPECT_GE(f.highest(), 0.5);
  EXPECT_GT(f.opacity(-0.3), 0.01) << "negative values are visible";
  EXPECT_GT(f.color(-0.4).b, f.color(-0.4).r);
  EXPECT_GT(f.color(0.4).r, f.color(0.4).b);
  volume.info.extra["scenario_hash"] = "of Emscape";
  EXPECT_NE(defaultTransferFunction(volume).lowest(), -defaultTransferFunction(volume).highest());
}

TEST(TransferFunction, DefaultOfValuesOfAnotherProgramIsARampOverNearlyAllOfThem) {
  auto volume = *testing::makeVolume({10, 10, 60}, {1, 1, 1},
                                     [](int, int, int k) { return 241 + 2 * static_cast<float>(k); });
  volume.info.floor = volume::kNoFloor;
  const TransferFunction f = defaultTransferFunction(volume);
  EXPECT_LE(f.lowest(), 245);
  EXPECT_GE(f.highest(), 355);
  EXPECT_GT(f.opacity(270), 0.005);
  EXPECT_NEAR(f.opacity(350) - f.opacity(320), f.opacity(290) - f.opacity(260), 1e-9);
}

TEST(TransferFunction, VolumeWithoutFieldHasADefault) {
  const auto empty = testing::makeVolume({4, 4, 4}, {1, 1, 1}, [](int, int, int) { return 0.0F; });
  const TransferFunction f = defaultTransferFunction(*empty);
  EXPECT_GT(f.highest(), f.lowest());
}

TEST(TransferFunction, CategoriesHaveOwnColoursAndNoneIsClear) {
  volume::VolumeInfo info;
  info.categorical = true;
  info.range_max = 2;
  const TransferFunction f = defaultTransferFunction(info);
  EXPECT_EQ(f.opacity(-1), 0);
  EXPECT_GT(f.opacity(0), 0);
  const TransferTable table(f, 1.0);
  const TransferView view = table.view();
  EXPECT_EQ(view.samples[view.index(view.normalized(-1))].a, 0);
  for (int category = 0; category < 3; ++category) {
    const Rgba entry = view.projected[view.index(view.normalized(static_cast<float>(category)))];
    EXPECT_FLOAT_EQ(entry.r, categoryColor(category).r) << category;
  }
}

TEST(CategoryColor, DiffersForTwentyOneCategories) {
  for (int a = 0; a < 21; ++a) {
    for (int b = 0; b < a; ++b) {
      const Rgb one = categoryColor(a), other = categoryColor(b);
      EXPECT_GT(std::abs(one.r - other.r) + std::abs(one.g - other.g) + std::abs(one.b - other.b), 0.19f)
          << a << ", " << b;
    }
  }
  EXPECT_EQ(categoryColor(21).r, categoryColor(0).r);
  EXPECT_EQ(categoryColor(-21).r, categoryColor(0).r);
}

TEST(TransferTable, CorrectsOpacityForTheStep) {
  const TransferTable table(testing::fog(0.3), 0.5);
  EXPECT_NEAR(table.view().samples[100].a, 1 - std::sqrt(0.7), 1e-6);
  EXPECT_NEAR(table.view().projected[100].a, 1, 1e-6);
}

TEST(TransferFile, ReadsValuesAndRelativePositions) {
  const TransferFunction by_value = parseTransferFunction(
      R"({"schema_version": 1, "domain": "value", "unit": "dBW/m2", "colors": [{"at": -90, "color": "#000000"},
          {"at": -10, "color": "#ff8000"}], "opacity": [{"at": -90, "opacity": 0}, {"at": -10, "opacity": 0.2}]})",
      "tf.json", decibels());
  EXPECT_FLOAT_EQ(by_value.color(-10).r, 1);
  EXPECT_NEAR(by_value.opacity(-50), 0.1, 1e-12);
  const TransferFunction relative = parseTransferFunction(
      R"({"schema_version": 1, "domain": "relative", "colors": "viridis",
          "opacity": [{"at": 0.25, "opacity": 0}, {"at": 1, "opacity": 0.2}]})",
      "tf.json", decibels());
  EXPECT_DOUBLE_EQ(relative.lowest(), -75);
  EXPECT_DOUBLE_EQ(relative.highest(), 0);
  EXPECT_NEAR(relative.color(0).r, 0xfd / 255.0, 1e-6);
}

TEST(TransferFile, ErrorsHaveLocationAndReason) {
  const std::string head = "{\"schema_version\": 1,\n \"domain\": \"value\",\n \"colors\": \"viridis\",\n";
  EXPECT_THAT(
      errorOf(head + " \"opacity\": [{\"at\": -90, \"opacity\": 0}, {\"at\": -20, \"opacity\": 1.5}]}"),
      HasSubstr("tf.json:4:64: 'opacity' is 1.5, outside the allowed range 0 to 1"));
  EXPECT_THAT(errorOf(head + " \"opacity\": [{\"at\": 1, \"opacity\": 0}, {\"at\": 0, \"opacity\": 1}]}"),
              HasSubstr("at 0: points must not decrease"));
  EXPECT_THAT(errorOf(head + " \"opacity\": [{\"at\": 1, \"opacity\": 0}]}"),
              HasSubstr("tf.json:3:12: a colour map by name needs opacity points at two different values"));
  EXPECT_THAT(errorOf(head + " \"opacity\": [{\"at\": \"x\", \"opacity\": 0}]}"),
              HasSubstr("'at' must be a number, not the quoted text 'x'"));
  EXPECT_THAT(errorOf(head + " \"opacity\": []}"),
              HasSubstr("'opacity' has 0 items; allowed are 1 to 10000"));
  EXPECT_THAT(errorOf(head + " \"opacity\": [{\"at\": 1}]}"),
              HasSubstr("missing key 'opacity' of the opacity point"));
  EXPECT_THAT(errorOf(head + " \"colour\": 1}"), HasSubstr("tf.json:4:2: unknown key 'colour'"));
  EXPECT_THAT(errorOf(head + " \"domain\": \"value\"}"),
              HasSubstr("tf.json:4:2: duplicate key 'domain'; first at line 2"));
  EXPECT_THAT(errorOf("{\"schema_version\": 2}"), HasSubstr("'schema_version' is 2; this program reads 1"));
  EXPECT_THAT(errorOf("{\"schema_version\": 1, \"domain\": "), HasSubstr("tf.json:1:"));
  EXPECT_THAT(errorOf("[]"), HasSubstr("transfer function must be a set of keys, not a list"));
  EXPECT_THAT(errorOf(""), HasSubstr("the file is empty"));
}

TEST(TransferFile, RefusesUnknownMapsBadColoursAndOtherUnits) {
  const std::string tail = "\"opacity\": [{\"at\": 0, \"opacity\": 0}, {\"at\": 1, \"opacity\": 1}]}";
  EXPECT_THAT(errorOf("{\"schema_version\": 1, \"domain\": \"relative\", \"colors\": \"jet\", " + tail),
              HasSubstr("'colors' must be one of viridis, cividis"));
  EXPECT_THAT(errorOf("{\"schema_version\": 1, \"domain\": \"relative\", \"colors\": [{\"at\": 0, "
                      "\"color\": \"red\"}], " +
                      tail),
              HasSubstr("colour 'red': expected \"#rrggbb\""));
  EXPECT_THAT(
      errorOf("{\"schema_version\": 1, \"domain\": \"value\", \"unit\": \"dBm\", \"colors\": \"viridis\", " +
              tail),
      HasSubstr("unit 'dBm' is not that of the volume: power_density_dbwm2 is in 'dBW/m2'"));
}

TEST(TransferFile, RoundTripIsBitIdentical) {
  std::mt19937 random(7);
  const auto uniform = [&random](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  for (int round = 0; round < 200; ++round) {
    TransferFunction function;
    function.name = round % 3 == 0 ? "" : "a \"name\"\\, \xC3\xA9";
    function.unit = "dBW/m2";
    double at = uniform(-200, 0);
    for (int i = 0; i <= round % 17; ++i) {
      const auto level = [&] {
        return round % 2 == 0 ? static_cast<float>(random() % 256) / 255.0F
                              : static_cast<float>(uniform(0, 1));
      };
      function.colors.push_back({at += uniform(1e-9, 20), {level(), level(), level()}});
    }
    at = uniform(-200, 0);
    for (int i = 0; i < 2 + round % 9; ++i) {
      function.opacities.push_back({at, std::pow(10, uniform(-12, 0))});
      if (i % 3 != 1) at += uniform(0, 20);
    }
    const std::string text = transferFunctionText(function);
    const TransferFunction read = parseTransferFunction(text, "tf.json", decibels());
    EXPECT_EQ(read.name, function.name);
    EXPECT_EQ(read.unit, function.unit);
    ASSERT_EQ(read.colors.size(), function.colors.size());
    for (std::size_t i = 0; i < read.colors.size(); ++i) {
      ASSERT_EQ(read.colors[i].at, function.colors[i].at);
      ASSERT_EQ(read.colors[i].color.r, function.colors[i].color.r) << text;
      ASSERT_EQ(read.colors[i].color.g, function.colors[i].color.g);
      ASSERT_EQ(read.colors[i].color.b, function.colors[i].color.b);
    }
    ASSERT_EQ(read.opacities.size(), function.opacities.size());
    for (std::size_t i = 0; i < read.opacities.size(); ++i) {
      ASSERT_EQ(read.opacities[i].at, function.opacities[i].at);
      ASSERT_EQ(read.opacities[i].opacity, function.opacities[i].opacity);
    }
    EXPECT_EQ(transferFunctionText(read), text);
  }
}

TEST(TransferFile, WholeLevelsAreWrittenAsColoursAndOthersAsComponents) {
  TransferFunction function = defaultTransferFunction(decibels());
  EXPECT_THAT(transferFunctionText(function), HasSubstr("{\"at\": -100.0, \"color\": \"#440154\"}"));
  function.colors[0].color = {0.1F, 0.2F, 0.3F};
  EXPECT_THAT(transferFunctionText(function), HasSubstr("{\"at\": -100.0, \"rgb\": [0.1, 0.2, 0.3]}"));
}

TEST(TransferFile, AColourHasOneForm) {
  const std::string tail = "]}], \"opacity\": [{\"at\": 0, \"opacity\": 0}, {\"at\": 1, \"opacity\": 1}]}";
  const std::string head = "{\"schema_version\": 1, \"domain\": \"value\", \"colors\": [{\"at\": 0, ";
  EXPECT_THAT(errorOf(head + "\"color\": \"#000000\", \"rgb\": [0, 0, 0" + tail),
              HasSubstr("the colour point must have exactly one of 'color', 'rgb'; it has 2"));
  EXPECT_THAT(errorOf(head + "\"rgb\": [0, 0, 2" + tail),
              HasSubstr("is 2, outside the allowed range 0 to 1"));
  EXPECT_THAT(errorOf(head + "\"rgb\": [0, 0" + tail), HasSubstr("'rgb' has 2 items; it must have 3"));
}

TEST(TransferFile, CategoriesAreNotWritten) {
  TransferFunction function = defaultTransferFunction(decibels());
  function.categorical = true;
  EXPECT_THROW(transferFunctionText(function), Error);
}

TEST(TransferFile, AnotherUnitIsRefused) {
  TransferFunction function = defaultTransferFunction(decibels());
  EXPECT_NO_THROW(requireUnitOf(function, decibels()));
  function.unit = "";
  EXPECT_NO_THROW(requireUnitOf(function, decibels()));
  function.unit = "dB";
  EXPECT_THAT(test::errorOf([&] { requireUnitOf(function, decibels()); }),
              HasSubstr("unit 'dB' is not that of the volume: power_density_dbwm2 is in 'dBW/m2'"));
}

TEST(TransferFile, AMissingFileIsNamed) {
  EXPECT_THAT(test::errorOf([] { readTransferFunction("/no/such/file.json", decibels()); }),
              HasSubstr("/no/such/file.json"));
}

TEST(TransferFile, EveryShippedFunctionReads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::shippedScenario("transfer"))) {
    volume::VolumeInfo info = decibels();
    if (entry.path().filename() == "snr_db.json") info.unit = "dB";
    if (entry.path().filename() == "field_strength_dbuvm.json") info.unit = "dBuV/m";
    EXPECT_NO_THROW(readTransferFunction(entry.path().string(), info)) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 5);
}

TEST(TransferFunction, OfADifferenceIsCentredOnZeroAndLeavesOutTheFewLargest) {
  auto volume = testing::makeVolume({20, 10, 10}, {1, 1, 1}, [](int i, int j, int k) {
    return i == 0 && j == 0 ? -110.0F : 10.0F - static_cast<float>((i + j + k) % 20);
  });
  volume->info.extra[volume::kScaleKey] = volume::kDifferenceScale;
  volume->info.range_min = -110;
  volume->info.range_max = 10;
  const TransferFunction fitted = defaultTransferFunction(*volume);
  EXPECT_EQ(fitted.lowest(), -fitted.highest());
  EXPECT_GE(fitted.highest(), 9);
  EXPECT_LE(fitted.highest(), 20);
  EXPECT_EQ(fitted.opacity(0), 0);
  EXPECT_GT(fitted.color(fitted.lowest()).b, fitted.color(fitted.lowest()).r) << "blue below";
  EXPECT_GT(fitted.color(fitted.highest()).r, fitted.color(fitted.highest()).b) << "orange above";
  const TransferFunction whole = defaultTransferFunction(volume->info);
  EXPECT_EQ(whole.lowest(), -whole.highest());
  EXPECT_GE(whole.highest(), 110);
}

TEST(ColorMap, EndsHavePublishedColors) {
  EXPECT_NEAR(colorMap("viridis").at(0).r, 0x44 / 255.0, 1e-6);
  EXPECT_NEAR(colorMap("viridis").at(1).g, 0xe7 / 255.0, 1e-6);
  EXPECT_NEAR(colorMap("cividis").at(0.5).b, 0x78 / 255.0, 1e-6);
  for (const std::string& name : colorMapNames()) EXPECT_EQ(colorMap(name).points.back().at, 1.0) << name;
}

}  // namespace
}  // namespace emscape::render
