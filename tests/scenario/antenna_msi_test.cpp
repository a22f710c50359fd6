#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "emscape/base/log.h"
#include "scenario/antenna/pattern.h"
#include "scenario/antenna/pattern_file.h"
#include "scenario/antenna/shapes.h"
#include "tests/scenario/antenna_directions.h"
#include "tests/scenario/antenna_files.h"

namespace emscape::scenario {
namespace {

/// A sector of 90 x 20 degrees, 3 (angle / half width)^2 dB, whose beam points tilt_deg downwards; at most 25
/// dB.
double horizontalLoss_db(int angle) {
  const double off = std::remainder(angle, 360.0);
  return std::min(3 * off * off / (45 * 45), 25.0);
}
double verticalLoss_db(int angle, int tilt_deg) {
  const double off = std::remainder(angle - tilt_deg, 360.0);
  return std::min(3 * off * off / (10 * 10), 25.0);
}

std::string cut(const std::string& keyword, double (*loss_db)(int, int), int tilt_deg,
                const std::string& line_end) {
  std::string text = keyword + " 360" + line_end;
  for (int i = 0; i < 360; ++i) {
    char row[64];
    std::snprintf(row, sizeof row, "%d\t%.4f", i, loss_db(i, tilt_deg));
    text += row + line_end;
  }
  return text;
}

std::string sector(const std::string& header, int tilt_deg = 0, const std::string& line_end = "\n") {
  return header +
         cut(
             "HORIZONTAL", [](int i, int) { return horizontalLoss_db(i); }, 0, line_end) +
         cut("VERTICAL", verticalLoss_db, tilt_deg, line_end);
}

AntennaPtr readText(const std::string& content) {
  return readAntenna(TemporaryFile("antenna.msi", content).path());
}

double lossAt_db(const AntennaPtr& antenna, double azimuth_deg, double elevation_deg) {
  return antenna->gain_dbi - gainTowards_dbi(*antenna, towards(azimuth_deg, elevation_deg));
}

/// Four rows a cut: enough for a pattern, small enough to break byte by byte.
const std::string kSmall =
    "NAME small\n"                                // 1
    "GAIN 10 dBi\n"                               // 2
    "HORIZONTAL 4\n0 0\n90 10\n180 20\n270 11\n"  // 3..7
    "VERTICAL 4\n0 0\n90 15\n180 20\n270 16\n";   // 8..12

TEST(MsiAntenna, GainWithoutAUnitIsToldWithItsValue) {
  const TemporaryFile file("antenna.msi", sector("GAIN 15\n"));
  const PatternFile pattern = readPatternFile(file.path());
  std::vector<std::string> warnings;
  antennaOf(file.path(), pattern, std::nan(""), warnings);
  EXPECT_THAT(warnings, testing::ElementsAre(testing::HasSubstr(
                            "has no unit and is taken as dBd, as the format defines: 17.15 dBi. If it is in "
                            "dBi, 'gain_dbi: 15'")));
  warnings.clear();
  antennaOf(file.path(), pattern, 15, warnings);
  EXPECT_THAT(warnings, testing::IsEmpty()) << "stated";
}

TEST(MsiAntenna, TakesGainInDbdUnlessTheFileSaysDbi) {
  EXPECT_NEAR(readText(sector("GAIN 15\n"))->gain_dbi, 17.15, 1e-12);
  EXPECT_NEAR(readText(sector("GAIN 15 dBd\n"))->gain_dbi, 17.15, 1e-12);
  EXPECT_NEAR(readText(sector("GAIN\t15.5 dBi\n"))->gain_dbi, 15.5, 1e-12);
  EXPECT_NEAR(readText(sector("gain +15.5DBI  \n"))->gain_dbi, 15.5, 1e-12);
}

TEST(MsiAntenna, TakesTheLibertiesOfManufacturers) {
  // Without NAME, with a title that begins with a number, decimal commas, and units in brackets.
  const AntennaPtr antenna = readText(
      "80010292 X-pol panel\nMAKE Acme\nFREQUENCY (MHz) 900\nGAIN [dBi] 15,5\nTILT ELECTRICAL\n"
      "HORIZONTAL 4\n0 0,0\n90 10,5\n180 20\n270 10,5\nVERTICAL 4\n0 0\n90 15\n180 20\n270 16\n");
  EXPECT_NEAR(antenna->gain_dbi, 15.5, 1e-12);
  EXPECT_NEAR(lossAt_db(antenna, 90, 0), 10.5, 1e-4);
  EXPECT_THAT(antenna->description, testing::StartsWith("80010292 X-pol panel, "));
  EXPECT_NEAR(readText(sector("GAIN 15,35 (dBd)\n"))->gain_dbi, 17.5, 1e-12);
}

TEST(MsiAntenna, TakesAGainGivenBesideTheFile) {
  const TemporaryFile file("antenna.msi", sector(""));
  EXPECT_EQ(readAntenna(file.path(), 12)->gain_dbi, 12);
  expectFault([&] { readAntenna(file.path()); }, file.path(), 0, 0, "has no gain; gain_dbi must be given");
}

TEST(MsiAntenna, ReproducesBothCuts) {
  const AntennaPtr antenna = readText(sector("NAME sector\nGAIN 15 dBi\n"));
  for (const int angle : {0, 10, 45, 100, 170, 180, 200, 300, 359}) {
    EXPECT_NEAR(lossAt_db(antenna, angle, 0), horizontalLoss_db(angle), 1e-4) << angle;
  }
  for (const int elevation : {-90, -60, -10, 0, 10, 45, 90}) {
    EXPECT_NEAR(lossAt_db(antenna, 0, elevation), verticalLoss_db(-elevation, 0), 1e-4) << elevation;
    EXPECT_NEAR(lossAt_db(antenna, 180, elevation), verticalLoss_db(180 + elevation, 0), 1e-4) << elevation;
  }
  EXPECT_NEAR(antenna->beamwidth_az_deg, 90, 0.5);
  EXPECT_NEAR(antenna->beamwidth_el_deg, 20, 0.2);
}

TEST(MsiAntenna, GainInLoopsEqualsGainOfAntenna) {
  const AntennaPtr antenna = readText(sector("GAIN 15 dBi\n", 6));
  const PatternView view = antenna->view();
  for (double azimuth_deg = -180; azimuth_deg <= 180; azimuth_deg += 3.7) {
    for (double elevation_deg = -90; elevation_deg <= 90; elevation_deg += 2.3) {
      const Vec3d direction = towards(azimuth_deg, elevation_deg);
      EXPECT_NEAR(patternAmplitude(view, vecCast<float>(direction), 0, 0),
                  antenna->amplitudeTowards(direction, 0, 0), 1e-5);
    }
  }
}

TEST(MsiAntenna, CountsTheVerticalAngleDownwards) {
  const AntennaPtr antenna = readText(sector("GAIN 15 dBi\nELECTRICAL_TILT 6\n", 6));
  EXPECT_NEAR(lossAt_db(antenna, 0, -6), 0, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, 0, 0), 3 * 0.36, 1e-4);
  EXPECT_NEAR(lossAt_db(antenna, 0, 6), 3 * 1.44, 1e-4);
}

TEST(MsiAntenna, TellsATiltThatTheCutDoesNotHoldInWhateverWordsItIsStated) {
  for (const char* const line : {"TILT 6", "TILT MECHANICAL 6", "TILT ELECTRICAL 6", "TILT 6 ELECTRICAL",
                                 "MECHANICAL_TILT 6", "ELECTRICAL_TILT 6"}) {
    int warnings = 0;
    setLogSink([&](LogLevel level, const std::string& message) {
      warnings += level == LogLevel::warning && message.find("6 deg of tilt") != std::string::npos;
    });
    readText(sector(std::string("GAIN 15 dBi\n") + line + "\n", 0));
    EXPECT_EQ(warnings, 1) << line;
  }
  setLogSink({});
}

TEST(MsiAntenna, DoesNotApplyATiltThatTheCutHoldsAlready) {
  int warnings = 0;
  setLogSink([&](LogLevel level, const std::string& message) {
    warnings += level == LogLevel::warning && message.find("6 deg of tilt") != std::string::npos;
  });
  readText(sector("GAIN 15 dBi\nTILT ELECTRICAL\nELECTRICAL_TILT 6\n", 6));
  readText(sector("GAIN 15 dBi\nELECTRICAL_TILT 6\nMECHANICAL_TILT 0\n", 6));
  readText(sector("GAIN 15 dBi\nTILT MECHANICAL 0\nTILT 6\n", 6));
  readText(sector("GAIN 15 dBi\nELECTRICAL_TILT 4\nMECHANICAL_TILT 3\n", 7));
  EXPECT_EQ(warnings, 0);
  const AntennaPtr level = readText(sector("GAIN 15 dBi\nELECTRICAL_TILT 6\n", 0));
  EXPECT_EQ(warnings, 1);
  EXPECT_NEAR(lossAt_db(level, 0, 0), 0, 1e-9);
  setLogSink({});
}

TEST(MsiAntenna, CountsAzimuthClockwise) {
  std::string content =
      "GAIN 10 dBi\nHORIZONTAL 4\n0 0\n90 5\n180 20\n270 15\nVERTICAL 4\n0 0\n90 20\n180 20\n270 20\n";
  const AntennaPtr antenna = readText(content);
  const double to_right_dbi = gainTowards_dbi(*antenna, {0, 1, 0});
  const double to_left_dbi = gainTowards_dbi(*antenna, {0, -1, 0});
  EXPECT_NEAR(to_right_dbi, 5, 1e-5);
  EXPECT_NEAR(to_left_dbi, -5, 1e-5);
}

TEST(MsiAntenna, AddsTheCutsNearTheBeamAndWeighsTheBackOfTheVerticalOneBehind) {
  const AntennaPtr antenna = readText(sector("GAIN 15 dBi\n"));
  const double az = 18, el = -5;  // w = 0.1
  const double expected = horizontalLoss_db(18) + 0.9 * verticalLoss_db(5, 0) +
                          0.1 * (verticalLoss_db(175, 0) - horizontalLoss_db(180));
  EXPECT_NEAR(lossAt_db(antenna, az, el), expected, 1e-4);
}

TEST(MsiAntenna, ReadsEitherOrderCommentsAndForeignLineEnds) {
  const AntennaPtr plain = readText(sector("NAME a\nGAIN 15 dBi\n"));
  const AntennaPtr dos = readText(
      "\xEF\xBB\xBF" +
      sector("# made by hand\r\nNAME a\r\nCOMMENT 65 x 11, sector\r\n\r\nGAIN 15 dBi\r\n", 0, "\r\n"));
  const AntennaPtr mac = readText(sector("NAME a\rGAIN 15 dBi\r", 0, "\r"));
  const AntennaPtr swapped =
      readText(cut("VERTICAL", verticalLoss_db, 0, "\n") +
               cut(
                   "horizontal", [](int i, int) { return horizontalLoss_db(i); }, 0, "\n") +
               "VENDOR_KEY x y\nGAIN 15 dBi\n");
  for (const AntennaPtr& other : {dos, mac, swapped}) {
    EXPECT_EQ(other->gain_dbi, plain->gain_dbi);
    for (const double azimuth_deg : {-100.0, 0.0, 33.0}) {
      EXPECT_EQ(lossAt_db(other, azimuth_deg, 7), lossAt_db(plain, azimuth_deg, 7));
    }
  }
}

TEST(MsiAntenna, ReadsOtherCountsAndIrregularAngles) {
  const AntennaPtr antenna = readText(
      "GAIN 10 dBi\nHORIZONTAL 7\n-90 12\n0 0\n0.5 0.1\n37.25 2\n90 10\n180 20\n-180 20\n"
      "VERTICAL 5\n0 0\n45 8\n90 15\n180 20\n270 16\n");
  EXPECT_NEAR(lossAt_db(antenna, 0.5, 0), 0.1, 1e-5);
  EXPECT_NEAR(lossAt_db(antenna, 37.25, 0), 2, 1e-5);
  EXPECT_NEAR(lossAt_db(antenna, -90, 0), 12, 1e-5);
  EXPECT_NEAR(lossAt_db(antenna, 0, -45), 8, 1e-5);
  EXPECT_NEAR(lossAt_db(antenna, 180, 0), 20, 1e-5);
}

TEST(MsiAntenna, ErrorsHaveReasonAndLocation) {
  const TemporaryFile file("antenna.msi", kSmall);
  EXPECT_NO_THROW(readAntenna(file.path()));
  const auto expectBroken = [&](const std::string& from, const std::string& to, int line, int column,
                                const std::string& part) {
    std::string content = kSmall;
    const std::size_t at = content.find(from);
    ASSERT_NE(at, std::string::npos);
    content.replace(at, from.size(), to);
    file.rewrite(content);
    expectFault([&] { readAntenna(file.path()); }, file.path(), line, column, part);
  };
  expectBroken("GAIN 10 dBi", "GAIN 10 dBm", 2, 9,
               "unit 'dBm' of GAIN; allowed are dBd (the default) and dBi");
  expectBroken("GAIN 10 dBi", "GAIN high", 2, 6, "GAIN 'high' is not a number");
  expectBroken("GAIN 10 dBi", "GAIN 400", 2, 6, "GAIN is 400 dB; allowed are -100 to 100 dB");
  expectBroken("HORIZONTAL 4", "HORIZONTAL", 3, 1,
               "HORIZONTAL must be followed by its number of rows, 4 to 36000");
  expectBroken("HORIZONTAL 4", "HORIZONTAL 4.5", 3, 12, "must be followed by its number of rows");
  expectBroken("HORIZONTAL 4", "HORIZONTAL 5", 8, 1,
               "row 5 of HORIZONTAL 5: angle 'VERTICAL' is not a number");
  expectBroken("VERTICAL 4", "VERTICAL 5", 8, 1, "the file ends after 4 of the 5 rows of VERTICAL");
  expectBroken("VERTICAL 4\n0 0", "VERTICAL 4\n0 0\n10 1", 13, 1, "'270 16' is a row of numbers outside");
  expectBroken("90 10", "90", 5, 1,
               "row 2 of HORIZONTAL 4 is '90'; it should be an angle and an attenuation");
  expectBroken("90 10", "90 1O", 5, 4, "row 2 of HORIZONTAL 4: attenuation '1O' is not a number");
  expectBroken("90 10", "90 -10", 5, 1, "attenuation is -10 dB; allowed are 0 to 300 dB");
  expectBroken("90 10", "900 10", 5, 1, "angle is 900 deg; allowed are -360 to 360 deg");
  expectBroken("HORIZONTAL 4\n0 0", "HORIZONTAL 5\n0 0\n90 12", 6, 1,
               "the HORIZONTAL cut has 90 deg twice, with different attenuations");
  expectBroken("90 10", "60 10", 0, 0,
               "the HORIZONTAL cut has no rows between 60 and -180 deg; gaps of up to 90 deg are allowed");
  expectBroken("VERTICAL 4\n0 0", "VERTICAL 4\n0 5", 0, 0,
               "the smallest attenuation of the VERTICAL cut is 5 dB");
  expectBroken("VERTICAL 4", "HORIZONTAL 4", 8, 1, "a second HORIZONTAL cut");
  file.rewrite("Dear reader,\nthis is not an antenna.\n");
  expectFault([&] { readAntenna(file.path()); }, file.path(), 0, 0,
              "no HORIZONTAL cut: not an MSI antenna file?");
  file.rewrite("");
  expectFault([&] { readAntenna(file.path()); }, file.path(), 0, 0, "no HORIZONTAL cut");
  file.rewrite(std::string("NAME a\0b\n", 9));
  expectFault([&] { readAntenna(file.path()); }, file.path(), 1, 7, "zero byte");
  expectFault([] { readAntenna("/nowhere/antenna.msi"); }, "/nowhere/antenna.msi", 0, 0, "no such file");
}

TEST(MsiAntenna, AHoleInACutIsTold) {
  std::string horizontal, vertical = "VERTICAL 360\n";
  int rows = 0;
  for (int angle_deg = 0; angle_deg < 360; ++angle_deg) {
    const double off_deg = std::min(angle_deg, 360 - angle_deg);
    vertical += fmt::format("{} {}\n", angle_deg, std::min(30.0, off_deg / 2));
    if (angle_deg > 20 && angle_deg < 100) continue;
    horizontal += fmt::format("{} {}\n", angle_deg, std::min(30.0, off_deg / 3));
    ++rows;
  }
  const TemporaryFile file("a.msi",
                           fmt::format("GAIN 10 dBi\nHORIZONTAL {}\n{}{}", rows, horizontal, vertical));
  EXPECT_THAT(readPatternFile(file.path()).warnings,
              testing::ElementsAre(testing::HasSubstr(
                  "the horizontal cut has no rows between 20 and 100 deg, where it changes "
                  "by 23.3 dB: amplitudes are interpolated there")));
}

TEST(MsiAntenna, NameHasOnlyPrintableCharacters) {
  EXPECT_EQ(readText("NAME B\xf6se \x01\n" + kSmall.substr(kSmall.find("GAIN")))->description.substr(0, 7),
            "B?se ?,");
}

TEST(MsiAntenna, CutsThatContradictEachOtherAheadAreToldAndJoinedAtTheHorizontalMaximum) {
  const auto turned = [](int azimuth, int elevation) {
    static int turn, tilt;
    turn = azimuth, tilt = elevation;
    const TemporaryFile file(
        "antenna.msi",
        "NAME x\nGAIN 10 dBi\n" +
            cut(
                "HORIZONTAL", [](int i, int) { return horizontalLoss_db(i - turn); }, 0, "\n") +
            cut(
                "VERTICAL", [](int i, int) { return verticalLoss_db(i, tilt); }, 0, "\n"));
    return readPatternFile(file.path());
  };
  const PatternFile pattern = turned(120, 0);
  ASSERT_EQ(pattern.warnings.size(), 1u);
  EXPECT_NE(
      pattern.warnings[0].find("21.3 dB below the maximum in the horizontal cut, 0.0 dB in the vertical one"),
      std::string::npos)
      << pattern.warnings[0];
  const AntennaPtr antenna = makeGridAntenna(pattern.nodes, pattern.amplitudes, 10, "x");
  EXPECT_NEAR(lossAt_db(antenna, 120, 0), 0, 0.1);
  EXPECT_NEAR(lossAt_db(antenna, 75, 0), 3, 0.1);
  EXPECT_NEAR(lossAt_db(antenna, 0, 0), 21.333, 0.1);
  EXPECT_NEAR(lossAt_db(antenna, 120, 10), 3, 0.1);
  EXPECT_EQ(turned(0, 93).warnings.size(), 1u) << "a vertical cut from the zenith";
  EXPECT_EQ(turned(0, 15).warnings.size(), 0u) << "a horizontal cut through a tilted maximum";
}

TEST(MsiAntenna, SurvivesDamageToEveryByte) {
  const TemporaryFile file("antenna.msi", kSmall);
  surviveDamage(file, kSmall, [&] { readAntenna(file.path()); });
}

}  // namespace
}  // namespace emscape::scenario
