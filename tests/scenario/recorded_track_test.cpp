// Tracks of platforms in files of other programs.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "emscape/scenario/file/scenario_file.h"
#include "tests/scenario/scenario_files.h"

namespace emscape::scenario {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class RecordedTrack : public ::testing::Test {
 protected:
  /// Reads a scenario with one platform of a track. @param keys  of the track
  ParseResult read(const std::string& keys, const std::string& head = "epoch: \"2026-06-01T06:00:00Z\"\n") {
    const std::string file = folder_.write(
        "scenario.yaml",
        "schema_version: 1\nname: a\n" + head +
            "duration_s: 60\nstep_s: 1\nregion: {origin: {latitude_deg: 52, longitude_deg: 5, height_msl_m: "
            "0}, "
            "size_m: [9000, 9000, 3000], dims: [16, 16, 8]}\nplatforms:\n  - {name: a, track: {" +
            keys +
            "}}\nemitters:\n  - {name: e, platform: a, kind: transmitter, frequency_hz: 1.0e9, power_w: 1, "
            "antenna: {pattern: isotropic, gain_dbi: 0}}\noutput: {quantities: [power_density_dbwm2]}\n");
    return parseScenario(file, {}, ReadFor::chosen_times);
  }
  std::vector<TrackPoint> pointsOf(const std::string& keys,
                                   const std::string& head = "epoch: \"2026-06-01T06:00:00Z\"\n") {
    const ParseResult result = read(keys, head);
    problems_.clear();
    for (const Problem& problem : result.problems)
      problems_.push_back(toString(problem.location) + ": " + problem.message);
    return result.scenario ? result.scenario->platforms.at(0).track : std::vector<TrackPoint>();
  }

  const test::TemporaryFolder folder_;
  std::vector<std::string> problems_;
};

const char* const kGpx =
    "<gpx><trk><name>hiker</name><trkseg><trkpt lat='52.001' "
    "lon='5'><ele>10</ele><time>2026-06-01T06:00:10Z</time>"
    "</trkpt><trkpt lat='52.002' "
    "lon='5'><ele>20</ele><time>2026-06-01T08:00:40+02:00</time></trkpt></trkseg></trk>"
    "</gpx>";

TEST_F(RecordedTrack, TimesAreThoseOfTheEpoch) {
  folder_.write("walk.gpx", kGpx);
  const auto points = pointsOf("file: walk.gpx");
  ASSERT_THAT(points, SizeIs(2)) << testing::PrintToString(problems_);
  EXPECT_EQ(points[0].t_s, 10);
  EXPECT_EQ(points[1].t_s, 40);
  EXPECT_EQ(points[1].position.height_msl_m, 20);
  EXPECT_FALSE(points[1].heading_deg);
}

TEST_F(RecordedTrack, WithoutAnEpochTheFileBeginsAtZeroWhichIsTold) {
  folder_.write("walk.gpx", kGpx);
  const auto points = pointsOf("file: walk.gpx", "");
  ASSERT_THAT(points, SizeIs(2));
  EXPECT_EQ(points[0].t_s, 0);
  EXPECT_THAT(problems_, testing::Contains(HasSubstr("'epoch: \"2026-06-01T06:00:10.000Z\"' says so")));
}

TEST_F(RecordedTrack, TimesOfADayAreThoseOfTheDayOfTheEpoch) {
  const auto nmea = [](const std::string& first, const std::string& second) {
    return "$GPGGA," + first + ",5200.000,N,00500.000,E,1,8,1.0,12,M,46,M,,\n$GPGGA," + second +
           ",5200.600,N,00500.000,E,1,8,1.0,12,M,46,M,,\n";
  };
  folder_.write("a.nmea", nmea("060010", "060050"));
  auto points = pointsOf("file: a.nmea");
  ASSERT_THAT(points, SizeIs(2));
  EXPECT_EQ(points[0].t_s, 10);
  EXPECT_THAT(problems_, testing::Contains(HasSubstr("taken as those of 2026-06-01, the day")));
  folder_.write("b.nmea", nmea("000010", "000020"));
  points = pointsOf("file: b.nmea", "epoch: \"2026-06-01T23:59:50Z\"\n");
  ASSERT_THAT(points, SizeIs(2));
  EXPECT_EQ(points[0].t_s, 20) << "after midnight";
  EXPECT_EQ(pointsOf("file: a.nmea", "").at(0).t_s, 0) << "without an epoch the file begins there";
}

TEST_F(RecordedTrack, AnEndWithinATickOfTheScenariosEndIsNoAbsence) {
  folder_.write("t.csv", "time,lat,lon\n2026-06-01T06:00:00Z,52,5\n2026-06-01T06:00:59.999998Z,52.1,5\n");
  const ParseResult result = read("file: t.csv");
  ASSERT_TRUE(result.scenario);
  EXPECT_TRUE(result.scenario->platforms[0].isPresentAt(60));
  for (const Problem& problem : result.problems)
    EXPECT_THAT(problem.message, testing::Not(HasSubstr("absent"))) << problem.message;
}

TEST_F(RecordedTrack, AnObjectIsChosenByNameOrIdAndTheOthersAreNamed) {
  folder_.write(
      "fight.acmi",
      "FileType=text/acmi/tacview\nFileVersion=2.2\n0,ReferenceTime=2026-06-01T06:00:00Z\n#0\n"
      "1a,T=5|52|100|1|2|90,Type=Air+FixedWing,Name=F-16\n2b,T=5|52|200,Type=Air+FixedWing,Name=F-16\n"
      "3c,T=5|52|0,Type=Ground+AntiAircraft,Name=SAM\n4d,T=5|52|300,Type=Air+FixedWing,Name=MiG-29\n#20\n"
      "1a,T=5.01||\n2b,T=5.02||\n4d,T=5.03||\n");
  EXPECT_EQ(pointsOf("file: fight.acmi, object: MiG-29").at(1).position.height_msl_m, 300);
  const auto points = pointsOf("file: fight.acmi, object: 1a");
  ASSERT_THAT(points, SizeIs(2));
  EXPECT_EQ(points[0].pitch_deg, 2);
  EXPECT_EQ(points[1].t_s, 20);
  pointsOf("file: fight.acmi");
  EXPECT_THAT(problems_,
              ElementsAre(HasSubstr("3 objects in it move; choose one by its name: 'object: NAME', of "
                                    "'F-16', 'F-16', 'MiG-29'")));
  pointsOf("file: fight.acmi, object: F-16");
  EXPECT_THAT(problems_, ElementsAre(HasSubstr("choose one by its id: 'object: ID', of '1a', '2b'")));
  pointsOf("file: fight.acmi, object: MiG-28");
  EXPECT_THAT(problems_, ElementsAre(HasSubstr("did you mean 'MiG-29'")));
  pointsOf("file: fight.acmi, object: SAM");
  EXPECT_THAT(problems_,
              ElementsAre(HasSubstr("'position: {latitude_deg: 52.0000000, longitude_deg: 5.0000000, "
                                    "height_msl_m: 0.0}'")));
}

TEST_F(RecordedTrack, ATableOfOthersIsReadByItsColumns) {
  folder_.write(
      "log.csv",
      "\xEF\xBB\xBFZeit;Breite;Laenge;Hoehe;Bemerkung\r\n2026-06-01T06:00:05Z;52,001;5,0;1000;a\r\n"
      "2026-06-01T06:00:05Z;52,0015;5,0;1000;doppelt\r\n2026-06-01T06:00:25Z;52,002;5,0;2000;\r\nkaputt\r\n");
  const auto points =
      pointsOf("file: log.csv, columns: \"time=Zeit,latitude=Breite,longitude=Laenge,height=Hoehe:ft\"");
  ASSERT_THAT(points, SizeIs(2)) << testing::PrintToString(problems_);
  EXPECT_EQ(points[0].t_s, 5);
  EXPECT_DOUBLE_EQ(points[0].position.latitude_deg, 52.0015) << "of two at one time the later one";
  EXPECT_DOUBLE_EQ(*points[1].position.height_msl_m, 609.6);
  EXPECT_THAT(problems_, testing::Contains(HasSubstr("1 record cannot be read, the first: line 5")));
  pointsOf("file: log.csv, columns: \"time=Zeit,latitude=Breit\"");
  EXPECT_THAT(problems_, ElementsAre(HasSubstr("the table has no column 'Breit'; it has Zeit, Breite")));
}

TEST_F(RecordedTrack, SecondsOfATableWithoutDatesAreThoseOfTheScenario) {
  folder_.write("log.csv", "time,lat,lon,alt_ft\n12.5,52.001,5,1000\n30,52.002,5,1000\n");
  const auto points = pointsOf("file: log.csv");
  ASSERT_THAT(points, SizeIs(2)) << testing::PrintToString(problems_);
  EXPECT_EQ(points[0].t_s, 12.5);
  EXPECT_EQ(points[1].t_s, 30);
}

TEST_F(RecordedTrack, GapsAreAbsenceAndHeightsMayBeAboveTheGround) {
  folder_.write("log.csv", "time,lat,lon,alt\n0,52,5,10\n5,52.001,5,10\n40,52.002,5,10\n");
  auto points = pointsOf("file: log.csv, gap_s: 10, height_agl_m: 2");
  ASSERT_THAT(points, SizeIs(3)) << testing::PrintToString(problems_);
  EXPECT_FALSE(points[0].gap_after);
  EXPECT_TRUE(points[1].gap_after);
  EXPECT_FALSE(points[2].gap_after);
  Platform platform;
  platform.track = points;
  for (const OutsideTrack outside : {OutsideTrack::absent, OutsideTrack::hold}) {
    platform.outside_track = outside;
    EXPECT_TRUE(platform.isPresentAt(3));
    EXPECT_TRUE(platform.isPresentAt(5));
    EXPECT_FALSE(platform.isPresentAt(20));
    EXPECT_TRUE(platform.isPresentAt(40));
    EXPECT_EQ(platform.isPresentAt(50), outside == OutsideTrack::hold);
  }
  EXPECT_EQ(points[2].position.height_agl_m, 2);
  EXPECT_FALSE(points[2].position.height_msl_m);
  folder_.write("own.csv", "t_s,latitude_deg,longitude_deg,height_agl_m\n0,52,5,10\n40,52.002,5,10\n");
  points = pointsOf("file: own.csv, gap_s: 10");
  ASSERT_THAT(points, SizeIs(2)) << testing::PrintToString(problems_);
  EXPECT_TRUE(points[0].gap_after) << "files of the format as well";
  EXPECT_EQ(points[1].position.height_agl_m, 10);
}

TEST_F(RecordedTrack, AFileOfTheFormatWithATypingErrorIsStillThatAndOtherFilesAreNamed) {
  folder_.write("own.csv", "t_s,latitude,longitude_deg,height_msl_m\n0,52,5,10\n");
  pointsOf("file: own.csv");
  EXPECT_THAT(problems_, testing::Contains(HasSubstr("unknown key 'latitude'")));
  folder_.write("notes.txt", "nothing of use\n");
  pointsOf("file: notes.txt, object: a");
  EXPECT_THAT(problems_, ElementsAre(HasSubstr("no recording of a known format")));
  pointsOf(
      "points: [{t_s: 0, latitude_deg: 52, longitude_deg: 5, height_msl_m: 0}, {t_s: 1, latitude_deg: 52, "
      "longitude_deg: 5, height_msl_m: 0}], object: a");
  EXPECT_THAT(problems_, ElementsAre(HasSubstr("'object'")));
}

TEST_F(RecordedTrack, WhatIsTrueOfAFileIsToldOnceForAllItsPlatforms) {
  folder_.write("two.csv", "time,id,lat,lon\n0,a,52,5\n0,b,52,5\n9,a,52.1,5\n9,b,52.1,5\nx,b,52,5\n");
  pointsOf("file: two.csv, object: a}}\n  - {name: b, track: {file: two.csv, object: b");
  EXPECT_THAT(problems_, testing::IsSupersetOf(
                             {HasSubstr("1 record cannot be read"), HasSubstr("0 m is taken (4 times)")}));
  EXPECT_EQ(
      std::count_if(problems_.begin(), problems_.end(),
                    [](const std::string& text) { return text.find("0 m is taken") != std::string::npos; }),
      1);
}

TEST_F(RecordedTrack, ATableWithUnknownNamesIsToldOfColumnsWhateverSeparatesThem) {
  for (const char* text : {"Zeit [s];Breite;Laenge;Hoehe [m]\n0;52,5;5;9\n9;52,6;5;9\n",
                           "Zeit [s]\tBreite\tLaenge\tHoehe [m]\n0\t52.5\t5\t9\n9\t52.6\t5\t9\n"}) {
    folder_.write("own.csv", text);
    pointsOf("file: own.csv");
    EXPECT_THAT(problems_, ElementsAre(AllOf(HasSubstr("columns: \"time=NAME,latitude=NAME"),
                                             HasSubstr("It has Zeit [s], Breite, Laenge, Hoehe [m]"))));
    const auto points = pointsOf(
        "file: own.csv, columns: \"time=Zeit [s],latitude=Breite,longitude=Laenge,height=Hoehe [m]\"");
    ASSERT_THAT(points, SizeIs(2)) << testing::PrintToString(problems_);
    EXPECT_EQ(points[1].position.latitude_deg, 52.6);
  }
  folder_.write("own.csv", "time,mgrs,alt_m\n0,19T BJ 92602 08632,900\n60,19T BJ 92660 10854,900\n");
  pointsOf("file: own.csv");
  EXPECT_THAT(problems_, ElementsAre(HasSubstr("position=NAME for MGRS")));
  EXPECT_THAT(pointsOf("file: own.csv, columns: \"time=time,position=mgrs,height=alt_m\""), SizeIs(2))
      << testing::PrintToString(problems_);
}

TEST_F(RecordedTrack, AHeightAboveTheGroundNeedsNoHeightsOfTheFile) {
  folder_.write("agl.csv", "time,lat,lon,height_agl\n0,52,5,30\n9,52.1,5,30\n");
  pointsOf("file: agl.csv");
  EXPECT_THAT(problems_,
              testing::IsSupersetOf({HasSubstr("0 m is taken"), HasSubstr("'height_agl_m' of a track")}));
  const auto points = pointsOf("file: agl.csv, height_agl_m: 30");
  ASSERT_THAT(points, SizeIs(2)) << testing::PrintToString(problems_);
  EXPECT_EQ(points[1].position.height_agl_m, 30);
  EXPECT_THAT(problems_, testing::Not(testing::Contains(HasSubstr("0 m is taken"))));
}

TEST_F(RecordedTrack, AnEditReadsAnotherObjectOfTheSameFile) {
  folder_.write("two.csv", "time,id,lat,lon,alt\n0,a,52,5,10\n0,b,52,5,20\n9,a,52.1,5,10\n9,b,52.1,5,20\n");
  const ParseResult result = read("file: two.csv, object: a");
  ASSERT_TRUE(result.scenario);
  Scenario edited = *result.scenario;
  edited.set("platforms.a.track.object", "b");
  EXPECT_EQ(edited.platforms[0].track.at(0).position.height_msl_m, 20);
  edited.set("duration_s", "30");
  EXPECT_EQ(edited.platforms[0].track.at(0).position.height_msl_m, 20);
}

}  // namespace
}  // namespace emscape::scenario
