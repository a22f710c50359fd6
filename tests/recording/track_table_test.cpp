// Tables of tracks: what of a table is used, and files in zip files.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "emscape/base/geodesy/geoid.h"
#include "tests/recording/read_as.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::interop {
namespace {

using testing::HasSubstr;

constexpr const char* kTwoAircraft =
    "Time,Tail Number,lat,lon,alt_m\n2026-06-01T06:00:00Z,CC-AAA,-33.45,-70.55,3000\n"
    "2026-06-01T06:00:00Z,CC-BBB,-33.43,-70.53,3500\n2026-06-01T06:00:10Z,CC-AAA,-33.449,-70.549,3010\n"
    "2026-06-01T06:00:10Z,CC-BBB,-33.429,-70.529,3510\n";

TEST(TrackTable, RowsOfOneTimeFarApartAreRefusedWithTheColumnThatTellsObjectsApart) {
  const std::string problem = test::errorOf([] { readAs("s.csv", kTwoAircraft); }, ErrorCode::bad_input);
  EXPECT_THAT(problem, testing::AllOf(HasSubstr("2 of 4 positions have the time of a later one"),
                                      HasSubstr("tells objects apart: id=Tail Number")));
  ReadOptions options;
  options.columns = problem.substr(problem.find("id="));
  const Recording r = readAs("s.csv", kTwoAircraft, options);
  ASSERT_EQ(r.objects.size(), 2u);
  EXPECT_EQ(r.objects[1].name, "CC-BBB");
  EXPECT_EQ(r.objects[1].poses.at(1).height_msl_m, 3510);
  EXPECT_THAT(test::errorOf([] { readAs("s.csv", "time,lat,lon\n1.78E+12,52,5\n1.78E+12,52.001,5\n"); },
                            ErrorCode::bad_input),
              HasSubstr("as all times are equal"));
}

TEST(TrackTable, SignsThatMayBeBetweenThousandsAreRefusedBesideOtherDecimals) {
  const auto table = [](const std::string& height) {
    return "time;lat;lon;alt_m\n0;44,3;-71,6;950,5\n30;44,31;-71,6;" + height + "\n60;44,32;-71,6;1.150,5\n";
  };
  for (const char* const height : {"1.050", "-1.050", "12.345"}) {
    EXPECT_THAT(test::errorOf([&] { readAs("s.csv", table(height)); }, ErrorCode::bad_input),
                HasSubstr(std::string("s.csv:3: '") + height +
                          "': is its point decimal, or between thousands? Other "
                          "numbers have decimal commas ('44,3')"));
  }
  for (const auto& [height, height_m] :
       {std::pair("1050", 1050.0), {"1.050,0", 1050.0}, {"0.050", 0.05}, {"1050.5", 1050.5}})
    EXPECT_EQ(readAs("s.csv", table(height)).objects.at(0).poses.at(1).height_msl_m, height_m) << height;
  EXPECT_THAT(test::errorOf(
                  [&] { readAs("s.csv", "time;lat;lon;alt_ft\n0;44.3;-71.6;900\n30;44.31;-71.6;35,000\n"); },
                  ErrorCode::bad_input),
              HasSubstr("s.csv:3: '35,000': is its comma decimal, or between thousands? Other numbers have "
                        "decimal points ('44.3'); write it without a comma, or with a point"));
  const std::string points = "time;lat;lon;alt_m\n0.000;44.300;-71.6;950.5\n30.000;44.310;-71.6;950.123\n";
  EXPECT_EQ(readAs("s.csv", points).objects.at(0).poses.at(1).height_msl_m, 950.123);
}

TEST(TrackTable, QuotedCommasAreBetweenThousandsUnlessOthersAreDecimal) {
  const auto table = [](const std::string& latitude, const std::string& first, const std::string& height) {
    return fmt::format("time,lat,lon,alt_m\n0,{0},-71.6,{1}\n30,{0}1,-71.6,\"{2}\"\n", latitude, first,
                       height);
  };
  for (const auto& [height, height_m] :
       {std::pair("1,050", 1050.0), {"1,050.5", 1050.5}, {"12,345", 12345.0}})
    EXPECT_EQ(readAs("s.csv", table("44.3", "950.5", height)).objects.at(0).poses.at(1).height_msl_m,
              height_m);
  for (const std::string& text : {table("44.3", "\"950,5\"", "1,050"), table("44.3", "\"0,5\"", "12,345")}) {
    EXPECT_THAT(test::errorOf([&] { readAs("s.csv", text); }, ErrorCode::bad_input),
                HasSubstr("is its comma decimal, or between thousands?"));
  }
  EXPECT_THAT(
      test::errorOf(
          [] {
            readAs("s.csv",
                   "time,lat,lon,alt_m\n0,\"44,3\",\"-71,6\",900\n30,\"44,31\",\"-71,6\",\"1,050\"\n");
          },
          ErrorCode::bad_input),
      HasSubstr("s.csv:3: '1,050': is its comma decimal, or between thousands? '44,3' has a decimal one"));
}

TEST(TrackTable, ARowWithoutAnEndAndTimesWithoutAZoneAreTold) {
  const auto notesOf = [](const std::string& header, const std::string& time, const std::string& end) {
    return readAs("s.csv",
                  fmt::format("{}\n{},52,5,100\n{},52.001,5,1{}", header, fmt::format(fmt::runtime(time), 0),
                              fmt::format(fmt::runtime(time), 1), end))
        .tally.notes;
  };
  const std::string header = "time,lat,lon,alt_m";
  EXPECT_THAT(notesOf(header, "2026-06-01T06:00:0{}Z", "00\n"), testing::IsEmpty());
  EXPECT_THAT(notesOf(header, "2026-06-01T06:00:0{}Z", ""),
              testing::ElementsAre(HasSubstr("line 3, a row, has no end: if the file was cut there")));
  for (const char* const with_zone :
       {"2026-06-01 08:00:0{}+02:00", "2026-06-01 06:00:0{} UTC", "20260601T06000{}Z"})
    EXPECT_THAT(notesOf(header, with_zone, "00\n"), testing::IsEmpty()) << with_zone;
  EXPECT_THAT(notesOf("time_utc,lat,lon,alt_m", "2026-06-01 06:00:0{}", "00\n"), testing::IsEmpty());
  for (const char* const without : {"2026-06-01 06:00:0{}", "2026-06-01T06:00:0{}.5"})
    EXPECT_THAT(notesOf(header, without, "00\n"),
                testing::ElementsAre(HasSubstr("time without a zone: taken as UTC; if it is local, write its "
                                               "offset with it (2026-06-01 08:00:00+02:00)")))
        << without;
}

TEST(TrackTable, DaysOfSpreadsheetsAreRecognisedInTwoRows) {
  const Recording r =
      readAs("s.csv", "time,lat,lon,alt\n46174.25,44.3,-71.6,900\n46174.250694444,44.32,-71.6,900\n");
  EXPECT_THAT(r.tally.notes, testing::Contains(HasSubstr("times are taken as days since 1900")));
  const auto& poses = r.objects.at(0).poses;
  EXPECT_NEAR(poses.at(1).t_s - poses.at(0).t_s, 60, 1e-3);
  EXPECT_NO_THROW(readAs("s.csv", "time,lat,lon,alt\n10,44.3,-71.6,900\n10.001,44.32,-71.6,900\n"));
}

TEST(TrackTable, PositionsAtTheTimeOfALaterOneAreCounted) {
  const Recording r = readAs(
      "s.csv", "time,lat,lon,alt_m\n0,52,5,1\n0,52.0001,5,1\n0,52.0002,5,1\n9,52.001,5,1\n9,52.001,5,1\n");
  EXPECT_EQ(r.objects.at(0).poses.size(), 2u);
  EXPECT_THAT(r.tally.notes,
              testing::ElementsAre(HasSubstr("2 positions have the time of a later one of the same "
                                             "object, up to 22.2")));
}

TEST(TrackTable, ColumnsWithoutAUseAreNamed) {
  const Recording r = readAs("s.csv",
                             "time,lat,lon,altitude_agl_m,tail\n0,52,5,150,A\n5,52.001,5,150,B\n"
                             "10,52,5,150,A\n15,52.001,5,150,B\n");
  EXPECT_THAT(r.tally.notes, testing::IsSupersetOf({HasSubstr("not used: column 'tail'; --columns"),
                                                    HasSubstr("of column 'tail' take turns"),
                                                    HasSubstr("0 m is taken (4 times)")}));
}

TEST(TrackTable, UnknownHeightsWithinAFlightAreInterpolatedInTime) {
  for (const char* unknown : {"", "NaN", "n/a", "null", "-", "-9999", "9999999", "-32768"}) {
    const Recording r = readAs("s.csv", std::string("time,lat,lon,alt_m\n0,52,5,") + unknown +
                                            "\n10,52.01,5,3000\n20,52.02,5," + unknown +
                                            "\n40,52.03,5,3030\n50,52.04,5," + unknown + "\n");
    const auto& poses = r.objects.at(0).poses;
    ASSERT_EQ(poses.size(), 5u) << unknown;
    EXPECT_EQ(poses[0].height_msl_m, 3000) << unknown;
    EXPECT_NEAR(poses[2].height_msl_m, 3010, 1e-9) << unknown;
    EXPECT_EQ(poses[4].height_msl_m, 3030) << unknown;
    EXPECT_THAT(r.tally.notes,
                testing::ElementsAre(HasSubstr("interpolated in time between the known ones of its "
                                               "object (3 times)")));
  }
}

TEST(TrackTable, HeightsAreKnownByTheWordsOfTheirNames) {
  const auto heightOf_m = [](const std::string& name) {
    return readAs("s.csv", "time,lat,lon," + name + "\n0,52,5,1000\n9,52.01,5,1000\n")
        .objects.at(0)
        .poses.at(0)
        .height_msl_m;
  };
  for (const char* name : {"alt_m", "Elev (m)", "hgt_m", "MSL Altitude (m)", "alt_asl_m", "baro_alt_m"})
    EXPECT_EQ(heightOf_m(name), 1000) << name;
  EXPECT_NEAR(heightOf_m("Altitude (ft MSL)"), 304.8, 1e-9);
  for (const char* name : {"alt_wgs84_m", "ellipsoid_height_m", "hae_m"})
    EXPECT_NEAR(heightOf_m(name), 1000 - geoidUndulation_m(52, 5), 1e-9) << name;
  for (const char* name : {"altitude_agl_m", "geoid_height_m", "height_above_takeoff(feet)",
                           "relative_altitude_m", "OSD.height [ft]"})
    EXPECT_EQ(heightOf_m(name), 0) << name;
}

TEST(TrackTable, OfSeveralHeightsTheFirstNameOfTheListIsTakenWhereverItStands) {
  const auto heightOf_m = [](const std::string& names) {
    return readAs("s.csv", "time,lat,lon," + names + "\n0,52,5,100,900\n9,52.01,5,100,900\n")
        .objects.at(0)
        .poses.at(0)
        .height_msl_m;
  };
  for (const char* names : {"height_m,altitude_m", "ele_m,alt_m", "elevation_m,hgt_m", "altitude_m,alt_msl_m",
                            "OSD.height [m],OSD.altitude [m]"})
    EXPECT_EQ(heightOf_m(names), 900) << names;
  for (const char* names : {"altitude_m,height_m", "alt_asl_m,altitude_m", "OSD.altitude [m],OSD.height [m]"})
    EXPECT_EQ(heightOf_m(names), 100) << names;
}

TEST(TrackTable, HeightsAboveTheGroundByTheirNameAreNotAdvisedAsHeights) {
  const auto notesOf = [](const std::string& names, const std::string& columns = "",
                          bool uses_heights = true) {
    ReadOptions options;
    options.columns = columns;
    options.uses_heights = uses_heights;
    const Recording r = readAs("s.csv", "time,lat,lon," + names + "\n0,52,5,9\n9,52.01,5,9\n", options);
    std::string all;
    for (const std::string& note : r.tally.notes) all += note + "\n";
    return all;
  };
  for (const char* name :
       {"height_agl", "AGL (ft)", "alt_agl_ft", "altitude (agl)", "altitude [ft AGL]", "HeightAGL",
        "height_above_ground_at_drone_location(feet)", "OSD.vpsHeight [ft]", "radar_altitude"})
    EXPECT_THAT(
        notesOf(name),
        testing::AllOf(HasSubstr("by its name it is above the ground"), HasSubstr("is not used"),
                       HasSubstr("'height_agl_m' of a track"), testing::Not(HasSubstr("height=NAME"))))
        << name;
  for (const char* name : {"relative_alt", "rel_alt_m", "height_above_takeoff(feet)", "OSD.height [ft]"})
    EXPECT_THAT(notesOf(name), HasSubstr("Add the height of the take-off point to it")) << name;
  EXPECT_THAT(notesOf("eagle_alt"),
              testing::AllOf(testing::Not(HasSubstr("above the ground")), HasSubstr("height=NAME:ft")));
  EXPECT_THAT(notesOf("height_agl", "height=height_agl:m"),
              testing::AllOf(HasSubstr("by its name it is above the ground"),
                             HasSubstr("is taken as 'columns' says")));
  EXPECT_EQ(notesOf("height_agl", "", false), "not used: column 'height_agl'\n") << "heights are replaced";
  EXPECT_EQ(notesOf("alt", "", false), "") << "a unit that is not known";
}

TEST(TrackTable, HemispheresInColumnsOfTheirOwnGiveTheSigns) {
  const Recording r = readAs("s.csv",
                             "time,lat,NS,lon,EW,alt_m\n0,33.45,S,70.55,W,9\n9,33.44,S,70.54,W,9\n"
                             "18,33.43,?,70.53,W,9\n");
  EXPECT_EQ(r.objects.at(0).poses.at(0).latitude_deg, -33.45);
  EXPECT_EQ(r.objects.at(0).poses.at(1).longitude_deg, -70.54);
  EXPECT_THAT(r.tally.first_bad, HasSubstr("line 4: its hemisphere '?'"));
  EXPECT_THAT(r.tally.notes, testing::IsEmpty());
}

TEST(TrackTable, TimesAndNumbersOfSpreadsheetsReceiversAndLoggers) {
  const auto readWith = [](const std::string& columns, const std::string& text) {
    ReadOptions options;
    options.columns = columns;
    return readAs("s.csv", text, options);
  };
  const Recording excel = readAs("s.csv", "sep=;\ntime;lat;lon;alt_m\n0;52,5;5;1.000,5\n9;52,51;5;1000,5\n");
  EXPECT_EQ(excel.objects.at(0).poses.at(0).height_msl_m, 1000.5);
  const Recording quoted = readAs("s.csv", "time,lat,lon,alt_ft\n0,52.123,5,\"9,843\"\n9,52.2,5,\"9,843\"\n");
  EXPECT_NEAR(quoted.objects.at(0).poses.at(0).height_msl_m, 9843 * 0.3048, 1e-9);
  EXPECT_EQ(readAs("s.csv", "time,lat,lon,alt_m\n20260601060000,52,5,1\n20260601060010,52.01,5,1\n").epoch_ms,
            kSix_ms);
  const Recording gps = readAs("s.csv", "gps_time,lat,lon,alt_m\n1464328818,52,5,1\n1464328828,52.01,5,1\n");
  EXPECT_THAT(gps.tally.notes, testing::ElementsAre(HasSubstr("time=gps_time:gps")));
  EXPECT_EQ(readWith("time=gps_time:gps", "gps_time,lat,lon,alt_m\n1464328818,52,5,1\n1464328828,52.01,5,1\n")
                .epoch_ms,
            kSix_ms);
  const Recording minutes = readWith("time=t:min,latitude=lat:dm,longitude=lon:dm,height=alt:mm",
                                     "t,lat,lon,alt\n0,-3327.6,07033,3000000\n1,-3327,07033,3000000\n");
  EXPECT_NEAR(minutes.objects.at(0).poses.at(0).latitude_deg, -33.46, 1e-12);
  EXPECT_EQ(minutes.objects.at(0).poses.at(1).t_s, 60);
  EXPECT_NEAR(minutes.objects.at(0).poses.at(1).height_msl_m, 3000, 1e-9);
  const Recording day = readAs("s.csv", "time,lat,lon,alt_m\n23:59:55,52,5,1\n00:00:05,52.01,5,1\n");
  EXPECT_TRUE(day.has_times_of_day);
  EXPECT_EQ(day.objects.at(0).poses.at(1).t_s, 10);
}

/// A file in a zip file. @param is_size_known  else it stands behind the data, as streams write it
std::string zipEntry(const std::string& name, const std::string& content, bool is_size_known = true) {
  const auto number = [](std::size_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xFF);
    return text;
  };
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, content.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  const std::size_t crc =
      crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
  const std::string sizes = number(crc, 4) + number(packed.size(), 4) + number(content.size(), 4);
  return "PK\x03\x04" + number(20, 2) + number(is_size_known ? 0 : 8, 2) + number(8, 2) + number(0, 4) +
         (is_size_known ? sizes : std::string(12, '\0')) + number(name.size(), 2) + number(0, 2) + name +
         packed + (is_size_known ? "" : "PK\x07\x08" + sizes);
}

TEST(ZippedRecording, OfAnyFormatIsReadAndOfSeveralNoneIsGuessed) {
  const std::string table = "time,lat,lon,alt_m\n0,52,5,1\n9,52.01,5,1\n";
  const std::string gpx = "<gpx><wpt lat='52' lon='5'><ele>7</ele><name>mast</name></wpt></gpx>";
  for (const bool is_size_known : {true, false}) {
    const std::string hidden = zipEntry("__MACOSX/._log.csv", "xyz", is_size_known);
    EXPECT_EQ(readAs("a.zip", hidden + zipEntry("log.csv", table, is_size_known)).objects.at(0).poses.size(),
              2u);
    EXPECT_EQ(readAs("a.zip",
                     zipEntry("read me.txt", "text", is_size_known) + zipEntry("d/a.gpx", gpx, is_size_known))
                  .objects.at(0)
                  .name,
              "mast");
    EXPECT_THAT(
        test::errorOf(
            [&] {
              readAs("a.zip", zipEntry("a.gpx", gpx, is_size_known) + zipEntry("b.gpx", gpx, is_size_known));
            },
            ErrorCode::bad_input),
        HasSubstr("has 2 files that may be the recording (a.gpx, b.gpx); unpack it, and give one of them"));
  }
  EXPECT_THAT(
      test::errorOf([&] { readAs("a.xlsx", zipEntry("[Content_Types].xml", "<x/>")); }, ErrorCode::bad_input),
      HasSubstr("save its table as CSV"));
}

}  // namespace
}  // namespace emscape::interop
