// Profiles of refractivity in CSV files.
#include "scenario/air/refractivity_file.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/scenario/dem_file.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using propagation::RefractivityAlongPath;
using testing::EndsWith;
using testing::HasSubstr;

class RefractivityFiles : public testing::Test {
 protected:
  RefractivityFile read(const std::string& text) { return readRefractivity(folder_.write("air.csv", text)); }
  /// The air along a path of profiles by range, or of one profile.
  static RefractivityAlongPath airOf(const RefractivityFile& file) {
    if (file.field.ranges_m.empty()) return file.field.profiles.at(0);
    return {file.field.ranges_m, file.field.profiles};
  }
  std::string errorOf(const std::string& text) {
    return test::errorOf([&] { read(text); }, ErrorCode::bad_input);
  }
  test::TemporaryFolder folder_;
};

TEST_F(RefractivityFiles, HoldOneProfileInMOrN) {
  const RefractivityFile in_m = read("height_msl_m,m_units\n0,330\n100,320\n");
  EXPECT_DOUBLE_EQ(airOf(in_m).at(5e4).at(50), 325);
  EXPECT_TRUE(airOf(in_m).traps());
  EXPECT_TRUE(in_m.warnings.empty());
  const RefractivityFile in_n = read("n_units,height_msl_m\n330,0\n290,1000\n");
  EXPECT_NEAR(airOf(in_n).at(0).at(1000), 290 + 1e6 / 6371, 1e-9);
  EXPECT_FALSE(airOf(in_n).traps());
}

TEST_F(RefractivityFiles, HoldProfilesByRange) {
  const RefractivityFile file =
      read("range_m,height_msl_m,m_units\n0,0,330\n0,10,320\n1000,0,330\n1000,30,320\n");
  EXPECT_DOUBLE_EQ(airOf(file).at(500).at(20), 320);  // the duct is 20 m high halfway
  EXPECT_FALSE(airOf(file).pointwise());
}

TEST_F(RefractivityFiles, WarnOfUnitsAndOfUnequalProfiles) {
  EXPECT_THAT(read("height_msl_m,m_units\n0,330\n2000,260\n").warnings,
              testing::ElementsAre(HasSubstr("look like N-units")));
  EXPECT_THAT(
      read("height_msl_m,pressure_hpa,temperature_k,relative_humidity_percent\n0,1013,288,0.78\n"
           "1000,900,282,0.4\n")
          .warnings,
      testing::ElementsAre(HasSubstr("relative_humidity_percent is 0.78 at most: is it a fraction?")));
  EXPECT_THAT(read("range_m,height_msl_m,m_units\n0,0,330\n0,10,331\n1000,0,330\n1000,30,320\n1000,60,325\n")
                  .warnings,
              testing::ElementsAre(HasSubstr("differ in their numbers of levels")));
}

TEST_F(RefractivityFiles, AirThatIsNoneAtItsHeightAndACutLastRowAreTold) {
  const auto profile = [](const char* column, double top_m, double at_ground, double at_top, double unit_m) {
    std::string text = fmt::format("height_msl_m,{}\n", column);
    for (int i = 0; i <= 10; ++i)
      text +=
          fmt::format("{:.1f},{:.2f}\n", top_m * i / 10 / unit_m, at_ground + (at_top - at_ground) * i / 10);
    return text;
  };
  constexpr double kFoot_m = 0.3048;
  for (const double top_m : {600.0, 2000.0, 5000.0}) {
    const double m_units = 330 + 0.118 * top_m;
    EXPECT_THAT(read(profile("m_units", top_m, 330, m_units, 1)).warnings, testing::IsEmpty()) << top_m;
    EXPECT_THAT(read(profile("m_units", top_m, 330, m_units, kFoot_m)).warnings,
                testing::ElementsAre(HasSubstr("are the heights in feet?")))
        << top_m;
  }
  EXPECT_THAT(read(profile("n_units", 3000, 315, 210, 1)).warnings, testing::IsEmpty());
  EXPECT_THAT(read(profile("n_units", 3000, 315, 210, kFoot_m)).warnings,
              testing::ElementsAre(HasSubstr("its air has 210 N-units at 9842 m, usual are about 83")));
  EXPECT_THAT(read(profile("m_units", 300, 340, 310, 1)).warnings, testing::IsEmpty()) << "a duct";
  EXPECT_THAT(read("height_msl_m,m_units\n0,330\n200,3").warnings,
              testing::ElementsAre(HasSubstr(".csv:3:1: a level has no end")));
}

TEST_F(RefractivityFiles, ErrorsHaveLocations) {
  EXPECT_THAT(errorOf(""), HasSubstr("air.csv:1:1: the file is empty"));
  EXPECT_THAT(errorOf("height_m,m_units\n"), HasSubstr("air.csv:1:1: unknown column 'height_m'"));
  EXPECT_THAT(errorOf("height_msl_m,height_msl_m\n"),
              HasSubstr("air.csv:1:14: second column 'height_msl_m'"));
  EXPECT_THAT(errorOf("height_msl_m,m_units,n_units\n"), HasSubstr("air.csv:1:1: the header has"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n"), HasSubstr("no levels; expected 2 or more"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\n"), HasSubstr("has 1 level; expected 2 or more"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\n5\n"), HasSubstr("air.csv:3:1: 1 values"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\nnan,331\n"),
              HasSubstr("air.csv:3:1: height_msl_m is 'nan'"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\n0,331\n"),
              EndsWith("air.csv:3:1: height: 0 m is not above the level before, 0 m"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\n70000,331\n"),
              HasSubstr("not within 60000 m of sea level"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,-1\n"), HasSubstr("M: -1 is not in 0 .. 2500 M-units"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\n1,340\n"),
              HasSubstr("10 M-units per metre is not within +-5"));
  EXPECT_THAT(errorOf("height_msl_m,n_units\n0,501\n"), HasSubstr("n_units is 501; allowed are 0 to 500"));
  EXPECT_THAT(errorOf("range_m,height_msl_m,m_units\n9,0,330\n9,1,331\n5,0,330\n"),
              HasSubstr("air.csv:4:1: range_m is 5 behind 9; ranges ascend"));
  EXPECT_THAT(test::errorOf([] { readRefractivity("/none/air.csv"); }), HasSubstr("/none/air.csv"));
}

TEST_F(RefractivityFiles, HoldPressureTemperatureAndHumidity) {
  // The check of ITU-R P.453: N = 318.78.
  const RefractivityFile file = read(
      "height_msl_m,pressure_hpa,temperature_k,relative_humidity_percent\n0,1013,288.15,60\n100,1001,287.5,"
      "60\n");
  EXPECT_NEAR(file.field.profiles.at(0).at(0), 318.78, 0.01);
}

TEST_F(RefractivityFiles, ContainProfilesByPosition) {
  const RefractivityFile file = read(
      "latitude_deg,longitude_deg,height_msl_m,m_units\n50,1,0,330\n50,1,10,320\n51,2,0,330\n51,2,30,320\n");
  ASSERT_EQ(file.field.positions.size(), 2u);
  EXPECT_EQ(file.field.positions[1].longitude_deg, 2);
  EXPECT_EQ(file.description, "2 profiles by place");
  EXPECT_TRUE(file.field.ranges_m.empty());
  EXPECT_THAT(errorOf("latitude_deg,longitude_deg,height_msl_m,m_units\n5,1,0,330\n5,1,1,331\n6,1,0,330\n"
                      "6,1,1,331\n5,1,2,332\n"),
              HasSubstr("air.csv:6:1: the rows of the place 5, 1 do not follow each other"));
}

TEST_F(RefractivityFiles, GuessTheUnitOfImpossibleWeather) {
  const std::string header = "height_msl_m,pressure_hpa,temperature_k,relative_humidity_percent\n";
  EXPECT_THAT(errorOf(header + "0,101300,288,60\n"),
              HasSubstr("air.csv:2:3: pressure_hpa is 101300; allowed are 0.1 to 1100; is it in Pa?"));
  EXPECT_THAT(
      errorOf(header + "0,1013,15,60\n"),
      HasSubstr("air.csv:2:8: temperature_k is 15; allowed are 150 to 350; is it in degrees Celsius?"));
  EXPECT_THAT(errorOf(header + "0,1013,288,130\n"), HasSubstr("relative_humidity_percent is 130"));
}

TEST_F(RefractivityFiles, WantOneKindOfColumns) {
  for (const char* header : {"height_msl_m,pressure_hpa,temperature_k\n",
                             "height_msl_m,m_units,pressure_hpa\n", "height_msl_m,m_units,latitude_deg\n",
                             "m_units\n", "range_m,latitude_deg,longitude_deg,height_msl_m,m_units\n"}) {
    EXPECT_THAT(errorOf(header), HasSubstr("air.csv:1:1: the header has height_msl_m and")) << header;
  }
}

TEST_F(RefractivityFiles, MayComeFromASpreadsheet) {
  EXPECT_EQ(
      read("\"height_msl_m\",\"m_units\"\r\n0,330\r\n\"10\",320\r\n,\r\n").field.profiles[0].levels.size(),
      2u);
  EXPECT_THAT(errorOf("height_msl_m;m_units\n0;330\n"),
              HasSubstr("air.csv:1:1: columns are separated by commas, not semicolons"));
  EXPECT_THAT(errorOf("height_msl_m,m_units,\n0,330,\n"), HasSubstr("air.csv:1:22: column 3 has no name"));
}

TEST_F(RefractivityFiles, DifferFromAntennaPatternsAndTracks) {
  EXPECT_TRUE(isRefractivityCsv(folder_.write("a.csv", "# made\nheight_msl_m,m_units\n")));
  EXPECT_TRUE(isRefractivityCsv(folder_.write("e.csv", "\xEF\xBB\xBFheight_msl_m,M_units\n")));
  EXPECT_FALSE(isRefractivityCsv(folder_.write("b.csv", "azimuth_deg,attenuation_db\n")));
  EXPECT_FALSE(isRefractivityCsv(folder_.write("c.csv", "t_s,latitude_deg,longitude_deg,height_msl_m\n")));
  EXPECT_FALSE(isSoundingFile(folder_.write("d.txt", "# a text\n")));
}

// Two soundings of Chanhassen, Minnesota, cut short (IGRA 2, USM00072649, 18 November 2023): real records.
const char* const kChanhassen =
    "#USM00072649 2023 11 18 00 2303    3 ncdc-nws           448497  -935647\n"
    "21     0  98107B  290    65B  350   143   360     0 \n"
    "20     7  97609   332B   66B  339   147   208    45 \n"
    "20    33  95916   476B   60B  325   152   224    73 \n"
    "#USM00072649 2023 11 18 12 1101    2 ncdc-nws           448497  -935647\n"
    "21     0  98022B  290    -9B  810    28   360     0 \n"
    "20     4  97717   316B   -1B  771    35   275    26 \n";
constexpr std::int64_t kMidnight_ms = 1700265600000;  // 2023-11-18T00:00:00Z

class Soundings : public RefractivityFiles {
 protected:
  RefractivityFile sounding(const std::string& text, std::optional<std::int64_t> time_ms = {}) {
    return readSounding(folder_.write("station.txt", text), time_ms);
  }
  std::string soundingError(const std::string& text) {
    return test::errorOf([&] { sounding(text); }, ErrorCode::bad_input);
  }
};

TEST_F(Soundings, HoldTheRefractivityOfTheirLevels) {
  const RefractivityFile last = sounding(kChanhassen), first = sounding(kChanhassen, kMidnight_ms);
  EXPECT_THAT(last.description, HasSubstr("USM00072649, 2023-11-18T12:00:00Z (2 of 2 levels; 2 soundings"));
  EXPECT_THAT(first.description, HasSubstr("2023-11-18T00:00:00Z"));
  // 981.07 hPa, 6.5 C, 35 %: vapour 3.389 hPa, N = 77.6 / 279.65 (981.07 + 4810 * 3.389 / 279.65) = 288.41.
  const propagation::RefractivityProfile& profile = first.field.profiles.at(0);
  EXPECT_NEAR(profile.levels.front().height_msl_m, 290, 0.02);
  EXPECT_NEAR(profile.levels.front().m_units, 288.41 + 0.15696 * 290, 0.05);
  EXPECT_NEAR(profile.levels.back().height_msl_m, 476, 0.05);
  EXPECT_TRUE(isSoundingFile(folder_.write("s.txt", kChanhassen)));
}

TEST_F(Soundings, OfTheStormPredictionCenterAreRead) {
  const std::string text =
      "%TITLE%\n SCSN   231118/0000 \n\n   LEVEL       HGHT       TEMP       DWPT       WDIR       WSPD\n"
      "-------------------------------------------------------------------\n%RAW%\n"
      " 1000.00,    100.00,  -9999.00,  -9999.00,  -9999.00,  -9999.00\n"
      " 955.00,    520.00,     22.00,      18.00,    90.00,     10.00\n"
      " 897.14,    1020.00,     18.75,      14.75,    90.00,     10.00\n%END%\n";
  const RefractivityFile read = sounding(text);
  EXPECT_THAT(read.description, HasSubstr("SCSN, 2023-11-18T00:00:00Z (2 of 3 levels"));
  // 955 hPa, 22 C, dew point 18 C: vapour 20.64 hPa, N = 77.6 / 295.15 (955 + 4810 * 20.64 / 295.15) = 339.5.
  EXPECT_NEAR(read.field.profiles.at(0).levels.front().m_units, 339.5 + 0.15696 * 520, 0.3);
  EXPECT_TRUE(isSoundingFile(folder_.write("s.spc", text)));
  EXPECT_THAT(soundingError("%TITLE%\n SCSN 2023-11-18\n%RAW%\n"),
              HasSubstr("station.txt:2:1: expected a station and a time below %TITLE%"));
  EXPECT_THAT(soundingError("%TITLE%\n SCSN 231118/0000\n%RAW%\n955,520\n%END%\n"),
              HasSubstr("station.txt:4:1: expected LEVEL, HGHT, TEMP, DWPT"));
}

TEST_F(Soundings, TakeTheDewPointWhereTheHumidityIsMissing) {
  std::string without = kChanhassen;
  without.replace(without.find("  350   143"), 5, "-9999");
  EXPECT_NEAR(sounding(without, kMidnight_ms).field.profiles.at(0).levels.front().m_units,
              sounding(kChanhassen, kMidnight_ms).field.profiles.at(0).levels.front().m_units, 0.2);
}

TEST_F(Soundings, ComputeMissingHeights) {
  // The archive's own heights, left out: 332 m and 476 m above a surface of 290 m; and the surface's.
  std::string without = kChanhassen;
  for (const char* height : {"  332B", "  476B"}) without.replace(without.find(height), 6, "-9999 ");
  EXPECT_NEAR(sounding(without, kMidnight_ms).field.profiles.at(0).levels.back().height_msl_m, 476, 2);
  without = kChanhassen;
  without.replace(without.find("  290 "), 6, "-8888 ");
  EXPECT_NEAR(sounding(without, kMidnight_ms).field.profiles.at(0).levels.front().height_msl_m, 290, 2);
}

TEST_F(Soundings, LeaveOutLevelsWithoutTemperatureOrHumidityAndAreDryAboveTheHighest) {
  // Made by the format's text.
  const std::string text =
      "#XXM00000001 2020 01 01 99 1130    5                    448497  -935647\n"
      "21     0 100000B    0   150B  800 -9999 -9999 -9999 \n"
      "20     4  95000 -9999 -9999 -9999 -9999 -9999 -9999 \n"
      "20     8  90000 -9999    80B-9999 -9999 -9999 -9999 \n"
      "20     9  80000 -9999    20B  300 -9999 -9999 -9999 \n"
      "20    10  70000 -9999   -40B-9999 -9999 -9999 -9999 \n";
  const RefractivityFile file = sounding(text);
  EXPECT_THAT(file.description, HasSubstr("3 of 5 levels"));
  EXPECT_EQ(file.sounding->time_utc, "2020-01-01T11:30:00Z") << "of the release, as the hour is missing";
  std::string timeless = text;
  timeless.replace(timeless.find("1130"), 4, "9999");
  EXPECT_THAT(
      soundingError(timeless),
      HasSubstr("station.txt:1:25: HOUR is 99 and RELTIME 9999 in all soundings, 1: their times are not "
                "known"));
  const propagation::RefractivityLevel& top = file.field.profiles.at(0).levels.back();
  EXPECT_NEAR(top.m_units - 0.15696 * top.height_msl_m, 77.6 * 700 / 269.15, 0.05);
  EXPECT_NEAR(top.height_msl_m, 2950, 60);
}

TEST_F(Soundings, OfWindAloneAreLeftOutForTheNearestUsableOne) {
  const std::string wind =
      "#USM00072649 2023 11 18 18 2303    2 ncdc-nws           448497  -935647\n"
      "30 -9999  -9999   500 -9999 -9999 -9999   280   100 \n"
      "30 -9999  -9999  1000 -9999 -9999 -9999   280   100 \n";
  const RefractivityFile file = sounding(kChanhassen + wind);
  EXPECT_EQ(file.sounding->time_utc, "2023-11-18T12:00:00Z");
  EXPECT_THAT(file.warnings,
              testing::ElementsAre(HasSubstr(
                  "station.txt:8: the last sounding, that of 2023-11-18T18:00:00Z cannot be used: the "
                  "sounding has no level with pressure")));
  EXPECT_TRUE(sounding(kChanhassen + wind, kMidnight_ms).warnings.empty());
  EXPECT_THAT(soundingError(wind + wind), HasSubstr("none of the 1 others in the file can be used either"));
}

// Made by the format's text. N of 998 hPa, 25 C, dew point 20 C: vapour 23.4 hPa, 77.6 / 298.15 (998 + 4810 *
// 23.4 / 298.15) = 358.0.
const char* const kList =
    "<HTML><H2>72200 XYZ Test Observations at 12Z 02 Jul 2020</H2>\n<PRE>\n"
    "-----------------------------------------------------------------------------\n"
    "   PRES   HGHT   TEMP   DWPT   RELH   MIXR   DRCT   SKNT   THTA   THTE   THTV\n"
    "    hPa     m      C      C      %    g/kg    deg   knot     K      K      K \n"
    "-----------------------------------------------------------------------------\n"
    " 1000.0     94                                                               \n"
    "  998.0    112   25.0   20.0     74  15.01    150      7  298.3  342.0  301.0\n"
    "  850.0   1500   18.0    4.0     39   6.02    200     25  304.9  324.2  306.1\n"
    "</PRE><H3>Station information and sounding indices</H3><PRE>\n"
    "                           Station latitude: 39.50\n"
    "                          Station longitude: -84.25\n</PRE></HTML>\n";

TEST_F(Soundings, AreReadFromListsOfWyoming) {
  const RefractivityFile file = sounding(kList);
  EXPECT_TRUE(isSoundingFile(folder_.write("w.html", kList)));
  const propagation::RefractivityLevel& ground = file.field.profiles.at(0).levels.front();
  EXPECT_NEAR(ground.m_units, 358.0 + 0.15696 * 112, 0.3);
  EXPECT_NEAR(ground.height_msl_m, 112, 0.01);
  EXPECT_EQ(file.sounding->time_utc, "2020-07-02T12:00:00Z");
  EXPECT_EQ(file.sounding->position->latitude_deg, 39.5);
  EXPECT_EQ(file.sounding->position->longitude_deg, -84.25);
  EXPECT_THAT(file.description, HasSubstr("72200 XYZ Test, 2020-07-02T12:00:00Z (2 of 3 levels"));
  std::string text = kList;
  text.replace(text.find("    hPa     m      C "), 21, "    hPa     m      K ");
  EXPECT_THAT(soundingError(text), HasSubstr("station.txt:5:15: TEMP is in 'K'; expected C"));
  text = kList;
  text.replace(text.find("12Z 02 Jul 2020"), 15, "12Z 02 Brumaire");
  EXPECT_THAT(soundingError(text), HasSubstr("expected a time such as 12Z 02 Jul 2020"));
}

TEST_F(Soundings, ThatWereCutAreTold) {
  const std::string spc =
      "%TITLE%\n OAX   140616/1900\n%RAW%\n 955.00, 520.00, 22.00, 18.00\n 897.00, 1020.00, 18.75, 14.75\n";
  EXPECT_THAT(sounding(spc + "%END%\n").warnings, testing::IsEmpty());
  EXPECT_THAT(sounding(spc).warnings,
              testing::ElementsAre(HasSubstr("station.txt: its last sounding has no %END%")));
  const std::string list(kList), rows = list.substr(0, list.find('\n', list.find("  850.0")) + 1);
  ASSERT_GT(rows.size(), 100U);
  EXPECT_THAT(sounding(list).warnings, testing::IsEmpty());
  EXPECT_THAT(sounding(rows).warnings, testing::IsEmpty()) << "the list alone, with its last line's end";
  EXPECT_THAT(sounding(rows.substr(0, rows.find("  850.0") + 27)).warnings,
              testing::ElementsAre(HasSubstr("a level, has no end: if the file was cut there")));
}

TEST_F(Soundings, AreReadFromArchivesAsTheyAreDownloaded) {
  const std::string text = folder_.write("USM00072649-data.txt", kChanhassen);
  test::writeZip(folder_ / "USM00072649-data.txt.zip", {{"USM00072649-data.txt", text}});
  test::writeGzip(text, folder_ / "USM00072649-data.txt.gz");
  for (const char* packed : {"USM00072649-data.txt.zip", "USM00072649-data.txt.gz"}) {
    EXPECT_TRUE(isSoundingFile(folder_ / packed)) << packed;
    EXPECT_THAT(readSounding(folder_ / packed, kMidnight_ms).description, HasSubstr("2023-11-18T00:00:00Z"))
        << packed;
  }
}

TEST_F(Soundings, OfWhichAnArchiveHasSeveralAreRefusedWithTheirNames) {
  const std::string first = folder_.write("a.txt", kChanhassen), second = folder_.write("b.txt", kList);
  test::writeZip(folder_ / "two.zip", {{"a.txt", first}, {"b.txt", second}});
  const std::string archive = folder_ / "two.zip";
  for (const bool is_sounding : {true, false}) {
    EXPECT_THAT(test::errorOf([&] { is_sounding ? readSounding(archive, {}) : readRefractivity(archive); },
                              ErrorCode::bad_input),
                testing::AllOf(HasSubstr("two.zip: "), HasSubstr("it is an archive (ZIP) of a.txt, b.txt; "),
                               HasSubstr("unpack it (unzip " + archive + ") and name one of them")));
  }
  EXPECT_NO_THROW(readSounding(first, {}));  // the remedy
}

TEST_F(Soundings, WhoseColumnsContradictEachOtherAreRefused) {
  std::string text = kList;
  for (const auto& [from, to] : {std::pair("25.0   20.0", "20.0   25.0"), {" 18.0    4.0", "  4.0   18.0"}})
    text.replace(text.find(from), std::string(from).size(), to);
  EXPECT_THAT(soundingError(text), HasSubstr("the dew point is above the temperature on 2 of 2 levels"));
  text = kList;
  for (const auto& [from, to] : {std::pair("   112 ", "   367 "), {"  1500 ", "  4921 "}})
    text.replace(text.find(from), std::string(from).size(), to);
  EXPECT_THAT(soundingError(text), HasSubstr("are the heights in feet?"));
}

TEST(ProfilesOfWeather, WithHeightsInFeetAreRefused) {
  const test::TemporaryFolder folder;
  const auto profileOf = [&](double unit, const std::string& top) {
    std::string text = "height_msl_m,pressure_hpa,temperature_k,relative_humidity_percent\n";
    for (const auto& [height_m, rest] : {std::pair(10.0, "1010,299.65,86.2"),
                                         {232.0, "985,299.95,55"},
                                         {780.0, "925,295.65,58.6"},
                                         {1510.0, "850,290.75,61"}})
      text += fmt::format("{:.0f},{}\n", height_m * unit, rest);
    return folder.write("profile.csv", text + top);
  };
  const auto errorOfProfile = [&](const std::string& file) {
    return test::errorOf([&] { readRefractivity(file); }, ErrorCode::bad_input);
  };
  EXPECT_NO_THROW(readRefractivity(profileOf(1, "")));
  EXPECT_THAT(
      errorOfProfile(profileOf(1 / 0.3048, "")),
      testing::AllOf(HasSubstr("profile.csv:2"), HasSubstr("the heights rise by 4921 m from 1010 to 850 hPa"),
                     HasSubstr("are the heights in feet?")));
  EXPECT_THAT(errorOfProfile(profileOf(1 / 0.3048, "18800,500,265,20\n")),
              HasSubstr("are the heights in feet?"))
      << "M is out of its range";
}

TEST_F(Soundings, AreReadFromCsvOfWyoming) {
  const std::string csv =
      "time,longitude,latitude,pressure_hPa,geopotential height_m,temperature_C,dew point "
      "temperature_C,relative "
      "humidity_%\n"
      "2020-07-02 11:02:03,-84.25,39.5,998.0,112,25.0,20.0,74\n"
      "2020-07-02 11:02:04,-84.25,39.5,,,25.0,20.0,74\n"
      "2020-07-02 11:12:03,-84.25,39.5,850.0,1500,18.0,,39\n";
  const RefractivityFile file = sounding(csv);
  EXPECT_NEAR(file.field.profiles.at(0).levels.front().m_units, 358.0 + 0.15696 * 112, 0.3);
  EXPECT_EQ(file.field.profiles.at(0).levels.size(), 2U);
  EXPECT_EQ(file.sounding->time_utc, "2020-07-02T11:02:03Z");
  EXPECT_EQ(file.sounding->position->latitude_deg, 39.5);
}

TEST_F(RefractivityFiles, OfManyLevelsAreThinned) {
  std::string text = "height_msl_m,m_units\n";
  for (int i = 0; i < 2000; ++i)
    text += fmt::format("{},{}\n", 5 * i, 330 + 0.118 * 5 * i + 3 * std::sin(i / 60.0));
  const RefractivityFile file = read(text);
  const propagation::RefractivityProfile& profile = file.field.profiles.at(0);
  EXPECT_LE(profile.levels.size(), kMaxProfileLevels);
  EXPECT_THAT(file.description, HasSubstr("1 profile, thinned from 2000 to"));
  for (int i = 0; i < 2000; ++i)
    ASSERT_NEAR(profile.at(5 * i), 330 + 0.118 * 5 * i + 3 * std::sin(i / 60.0), 0.5) << i;
}

TEST_F(Soundings, ErrorsHaveLocations) {
  EXPECT_THAT(soundingError(""), HasSubstr("station.txt:1:1: no soundings"));
  EXPECT_THAT(soundingError("21     0  98107B  290\n"),
              HasSubstr("station.txt:1:1: a sounding's header begins"));
  std::string text = kChanhassen;
  text.replace(text.find("   3 ncdc"), 4, "   9");
  EXPECT_THAT(soundingError(text), HasSubstr("station.txt:1:33: NUMLEV is 9, but only 6 lines follow"));
  text = kChanhassen;
  text.replace(text.find("   3 ncdc"), 4, "   2");
  EXPECT_THAT(soundingError(text), HasSubstr("station.txt:4:1: a sounding's header begins"));
  text = kChanhassen;
  text.replace(text.find(" 95916"), 6, " 9x916");
  EXPECT_THAT(test::errorOf([&] { sounding(text, kMidnight_ms); }),
              HasSubstr("station.txt:4:10: PRESS is ' 9x916', not a number"));
  text = kChanhassen;
  text.replace(text.find("2023 11 18 12"), 13, "2023 13 18 12");
  EXPECT_THAT(soundingError(text), HasSubstr("station.txt:5:14: 2023-13-18T12:00:00Z is not a time"));
  text = kChanhassen;
  text.replace(text.find("2023 11 18 12"), 4, "9e23");
  EXPECT_THAT(soundingError(text),
              HasSubstr("station.txt:5:14: YEAR is '9e23', not a whole number from 0 to 9999"));
  EXPECT_THAT(soundingError("#USM00072649 2023 11 18 00 2303    1\n21     0  98107B  290\n"),
              HasSubstr("station.txt:2:22: the line ends before TEMP in columns 23 to 27"));
  EXPECT_THAT(soundingError("#USM00072649 2023 11 18 00 2303    1\n"
                            "21     0  -9999   290    65B  350   143   360     0 \n"),
              HasSubstr("station.txt:1:1: the sounding has no level with"));
}

}  // namespace
}  // namespace emscape::scenario
