// Files as other programs write them.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "recording/read_recording.h"
#include "tests/support/errors.h"
#include "tests/support/stopping.h"
#include "tests/support/temporary_folder.h"

namespace emscape::interop {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

constexpr std::int64_t kSix_ms = 1780293600000;  // 2026-06-01T06:00:00Z

Recording readAs(const std::string& name, const std::string& text, const std::string& columns = "") {
  const test::TemporaryFolder folder;
  ReadOptions options;
  options.columns = columns;
  return readRecording(folder.write(name, text), options);
}
std::string errorOf(const std::string& name, const std::string& text, const std::string& columns = "") {
  return test::errorOf([&] { readAs(name, text, columns); }, ErrorCode::bad_input);
}

TEST(TablesOfOthers, Flightradar24HasOneColumnOfCoordinatesAndFeet) {
  const Recording r = readAs("a.csv",
                             "Timestamp,UTC,Callsign,Position,Altitude,Speed,Direction\n"
                             "1780293600,2026-06-01T06:00:00Z,KLM12,\"52.3086,4.7639\",1000,150,360\n"
                             "1780293610,2026-06-01T06:00:10Z,KLM12,\"52.3186,4.7639\",2000,150,10\n");
  ASSERT_THAT(r.objects, SizeIs(1));
  EXPECT_EQ(r.objects[0].name, "KLM12");
  EXPECT_EQ(r.epoch_ms, kSix_ms);
  EXPECT_DOUBLE_EQ(r.objects[0].poses.at(1).latitude_deg, 52.3186);
  EXPECT_DOUBLE_EQ(r.objects[0].poses[0].height_msl_m, 304.8);
  EXPECT_THAT(r.tally.notes, Contains(HasSubstr("taken as feet (2 times)")));
}

TEST(TablesOfOthers, OneColumnOfCoordinatesAloneIsNotFlightradar24) {
  const Recording r = readAs("a.csv",
                             "Date,Time,LatLon,Height\n2026-06-01,06:00:00,\"-33.45 -70.55\",3000\n"
                             "2026-06-01,06:00:10,\"-33.449 -70.549\",3090\n");
  ASSERT_THAT(r.objects, SizeIs(1));
  EXPECT_EQ(r.objects[0].poses.at(1).height_msl_m, 3090);
}

TEST(TablesOfOthers, AColumnThatIsNamedKeepsTheUnitOfItsName) {
  const Recording r =
      readAs("a.csv",
             "time (us),lat (rad),lon (rad),OSD.altitude [ft]\n0,0.5,0.1,1000\n"
             "10000000,0.5001,0.1,2000\n20000000,0.5002,0.1,3000\n",
             "time=time (us),latitude=lat (rad),longitude=lon (rad),height=OSD.altitude [ft]");
  const auto& poses = r.objects.at(0).poses;
  EXPECT_DOUBLE_EQ(poses.at(2).t_s, 20);
  EXPECT_NEAR(poses.at(0).latitude_deg, 28.6478898, 1e-6);
  EXPECT_DOUBLE_EQ(poses.at(0).height_msl_m, 304.8);
  const Recording told = readAs("b.csv", "time,lat,lon,alt (ft)\n0,52,5,1000\n9,52.01,5,1000\n",
                                "time=time,latitude=lat,longitude=lon,height=alt (ft):m");
  EXPECT_EQ(told.objects.at(0).poses.at(0).height_msl_m, 1000) << "the option says another one";
}

TEST(TablesOfOthers, GarminAvionicsWriteLocalTimesWithTheirOffsetAndUnitsInAComment) {
  const Recording r =
      readAs("a.csv",
             "#airframe_info, log_version=\"1.00\"\n#yyy-mm-dd, hh:mm:ss, hh:mm, degrees, degrees, ft msl\n"
             "  Lcl Date, Lcl Time, UTCOfst, Latitude, Longitude, AltMSL\n"
             "2026-06-01, 02:00:00, -04:00, -33.45, -70.55, 10000\n"
             "2026-06-01, 02:00:10, -04:00, -33.449, -70.549, 10100\n");
  EXPECT_EQ(r.epoch_ms, kSix_ms);
  EXPECT_NEAR(r.objects.at(0).poses.at(1).height_msl_m, 10100 * 0.3048, 1e-9);
}

TEST(TablesOfOthers, AUnitInANameIsOfTheColumnsKind) {
  const Recording r = readAs("a.csv",
                             "Clock,Lat (d),Lon (d),H (m),Kurs (d)\n2026-06-01T06:00:00Z,52,5,100,90\n"
                             "2026-06-01T06:00:10Z,52.001,5,100,90\n",
                             "time=Clock,latitude=Lat (d),longitude=Lon (d),height=H (m),heading=Kurs (d)");
  EXPECT_NEAR(r.objects.at(0).poses.at(0).latitude_deg, 52, 1e-9);
}

TEST(TablesOfOthers, OffsetsFromUtcCountForLocalTimesOnly) {
  const auto epochOf = [](const std::string& titles, const std::string& time, const std::string& offset) {
    std::string text = titles + ",lat,lon,alt_m\n";
    for (int n = 0; n < 3; ++n) text += fmt::format("{}:0{}{},52.00{},5,1\n", time, n, offset, n);
    return readAs("a.csv", text);
  };
  for (const char* offset : {",-4", ",-04:00", ",UTC-4", ",-0400"}) {
    const Recording r = epochOf("time,utc_offset", "2026-06-01 02:00", offset);
    EXPECT_EQ(r.epoch_ms, kSix_ms) << offset;
    EXPECT_THAT(r.tally.notes,
                Contains(HasSubstr("times are local: column 'utc_offset' gives their offset")));
  }
  EXPECT_EQ(epochOf("time,utc_offset", "2026-06-01T06:00", "Z,-04:00").epoch_ms, kSix_ms);
  EXPECT_EQ(epochOf("time,utc_offset", "2026-06-01T02:00", "-04:00,-04:00").epoch_ms, kSix_ms);
  EXPECT_EQ(epochOf("time_utc,utc_offset", "2026-06-01 06:00", ",-04:00").epoch_ms, kSix_ms);
  EXPECT_EQ(epochOf("time,utc_offset", "2026-06-01 09:00", ",3").epoch_ms, kSix_ms) << "hours without a sign";
}

TEST(TablesOfOthers, MicrosecondsTakenAsSecondsAreTold) {
  const Recording r = readAs("a.csv",
                             "timestamp,lat,lon,alt_m\n123456789,52,5,1\n133456789,52.001,5,1\n"
                             "143456789,52.002,5,1\n153456789,52.003,5,1\n");
  EXPECT_THAT(r.tally.notes, Contains(HasSubstr("time=timestamp:us")));
  const Recording us = readAs("b.csv",
                              "timestamp,lat,lon,alt_m\n123456789,52,5,1\n133456789,52.001,5,1\n"
                              "143456789,52.002,5,1\n",
                              "time=timestamp:us");
  EXPECT_NEAR(us.objects.at(0).poses.back().t_s - us.objects.at(0).poses.front().t_s, 20, 1e-6);
}

TEST(TablesOfOthers, RowsWithMoreCellsThanTheHeaderAreBad) {
  const std::string problem = errorOf("a.csv", "time,lat,lon,alt_m\n0,52,1,13,4,100\n10,52,2,13,4,100\n");
  EXPECT_THAT(problem, HasSubstr("it has 6 cells, the header 4; are decimals written with commas"));
  EXPECT_THAT(readAs("b.csv", "time,lat,lon,alt_m\n0,52,1,100,,\n10,52.01,1,100,,\n").objects, SizeIs(1))
      << "empty cells at the end";
}

TEST(TablesOfOthers, AreNotReadToTheirEndOnceTheWorkIsStopped) {
  const test::TemporaryFolder folder;
  std::string rows = "time,lat,lon,alt_m\n";
  for (int n = 0; n < 200000; ++n) rows += fmt::format("{},52,5.{:06d},100\n", n, n);
  const std::string file = folder.write("a.csv", rows);
  test::expectStopsWithinASecond([&] { readRecording(file); }, 10);
}

TEST(TablesOfOthers, NamesInOtherEncodingsStayApart) {
  const std::string rows =
      "time,name,lat,lon,alt_m\n0,\xC1\xEE\xF0\xF2,52,5,1\n0,\xCA\xF0\xE0\xED,52.5,5,1\n"
      "9,\xC1\xEE\xF0\xF2,52.001,5,1\n9,\xCA\xF0\xE0\xED,52.501,5,1\n";
  const Recording table = readAs("a.csv", rows);
  EXPECT_THAT(table.objects, SizeIs(2));
  EXPECT_THAT(table.tally.notes, Contains(HasSubstr("iconv -f ENCODING -t UTF-8")));
  const std::string gpx =
      "<gpx version=\"1.1\"><trk><name>\xC1\xEE\xF0\xF2</name><trkseg><trkpt lat=\"52\" lon=\"5\">"
      "<time>2026-06-01T06:00:00Z</time></trkpt><trkpt lat=\"52.01\" lon=\"5\"><time>2026-06-01T06:00:10Z"
      "</time></trkpt></trkseg></trk></gpx>";
  EXPECT_EQ(readAs("a.gpx", "<?xml version=\"1.0\" encoding=\"windows-1251\"?>" + gpx).objects.at(0).name,
            "Борт");
  EXPECT_EQ(readAs("b.gpx", "<?xml version=\"1.0\" encoding=\"iso-8859-1\"?>" + gpx).objects.at(0).name,
            "Áîðò");
  EXPECT_THAT(readAs("c.gpx", gpx).tally.notes, Contains(HasSubstr("taken as Latin-1")));
}

TEST(TracksOfOthers, InAnotherEncodingThanTheyStateStayApartAndAreTold) {
  const auto track = [](const std::string& name, const std::string& latitude) {
    return "<trk><name>" + name + "</name><trkseg><trkpt lat=\"" + latitude +
           "\" lon=\"5\"><ele>1</ele><time>2026-06-01T06:00:00Z</time></trkpt><trkpt lat=\"" + latitude +
           "1\" lon=\"5\"><ele>1</ele><time>2026-06-01T06:00:10Z</time></trkpt></trkseg></trk>";
  };
  // Two Cyrillic names of four letters in WINDOWS-1251, and letters that look like Latin ones.
  const auto gpx = [&](const std::string& encoding) {
    return "<?xml version=\"1.0\" encoding=\"" + encoding + "\"?><gpx version=\"1.1\">" +
           track("\xC1\xEE\xF0\xF2", "52") + track("\xCA\xF0\xE0\xED", "53") + track("\xC0-1", "54") +
           track("A-1", "55") + "</gpx>";
  };
  for (const char* const stated : {"UTF-8", "us-ascii", "no-such-encoding"}) {
    const Recording recording = readAs("a.gpx", gpx(stated));
    EXPECT_THAT(recording.objects, SizeIs(4)) << stated;
    EXPECT_THAT(recording.tally.notes, Contains(AllOf(HasSubstr(std::string("states the encoding ") + stated),
                                                      HasSubstr("encoding=\"windows-1251\""))));
    EXPECT_EQ(recording.objects.at(3).name, "A-1");
  }
  const Recording right = readAs("b.gpx", gpx("windows-1251"));  // the remedy
  EXPECT_EQ(right.objects.at(0).name, "Борт");
  EXPECT_THAT(right.tally.notes, Not(Contains(HasSubstr("encoding"))));
}

/// The height that a table states in a column of this name with the value 1000.
double heightIn(const std::string& column) {
  const Recording r =
      readAs("a.csv", "time,lat,lon," + column + "\n0,52,5,1000\n10,52.01,5,1000\n20,52.02,5,1000\n");
  return r.objects.at(0).poses.at(0).height_msl_m;
}

TEST(TablesOfOthers, UnitsAreWordsOfTheColumnsNames) {
  for (const char* const feet : {"Altitude feet", "altitude_feet", "Altitude (feet)", "Altitude in feet",
                                 "AltitudeFeet", "alt_ft_msl", "Altitude-ft", "Alt ft", "altitude feet amsl"})
    EXPECT_NEAR(heightIn(feet), 304.8, 1e-9) << feet;
  for (const char* const metres :
       {"Altitude metres", "altitude_meters", "AltitudeMeters", "alt m", "height_msl_m", "Elevation in m"})
    EXPECT_NEAR(heightIn(metres), 1000, 1e-9) << metres;
  const Recording unknown = readAs("a.csv", "time,lat,lon,Altitude kft\n0,52,5,10\n10,52.01,5,10\n");
  EXPECT_THAT(unknown.tally.notes, Contains(HasSubstr("not used: column 'Altitude kft'")))
      << "a unit that is not known is not assumed";
  const Recording ms = readAs("a.csv", "time ms,lat,lon,alt m\n0,52,5,10\n10000,52.01,5,10\n");
  EXPECT_NEAR(ms.objects.at(0).poses.at(1).t_s, 10, 1e-9);
}

TEST(TablesOfOthers, BaseStationHasNoNames) {
  const Recording r = readAs(
      "a.csv",
      "MSG,1,1,1,4CA2D6,1,2026/06/01,06:00:00.000,2026/06/01,06:00:00.1,KLM1,,,,,,,,,,,\n"
      "MSG,3,1,1,4CA2D6,1,2026/06/01,06:00:00.500,2026/06/01,06:00:00.6,,10000,,,51.45,-1.02,,,0,0,0,0\n"
      "MSG,3,1,1,4CA2D6,1,2026/06/01,06:00:10.500,2026/06/01,06:00:10.6,,10000,,,51.46,-1.02,,,0,0,0,0\n");
  ASSERT_THAT(r.objects, SizeIs(1));
  EXPECT_EQ(r.objects[0].name, "4CA2D6");
  EXPECT_EQ(r.objects[0].poses.at(1).t_s, 10.5);
  EXPECT_EQ(r.objects[0].poses[1].height_msl_m, 3048);
  EXPECT_EQ(r.tally.ignored.at("message without a position"), 1);
}

TEST(TablesOfOthers, ArchivesOfAisHaveUnknownHeadingsOf511) {
  const Recording r = readAs("a.csv",
                             "MMSI,BaseDateTime,LAT,LON,SOG,COG,Heading,VesselName\n338,2026-06-01T06:00:00,"
                             "43.65,-70.25,0.0,358.8,511.0,BOAT\n"
                             "338,2026-06-01T06:01:00,43.66,-70.25,0.0,358.8,90,BOAT\n");
  ASSERT_THAT(r.objects.at(0).poses, SizeIs(2));
  EXPECT_TRUE(std::isnan(r.objects[0].poses[0].heading_deg));
  EXPECT_EQ(r.objects[0].poses[1].heading_deg, 90);
  // The names may stand in a comment, and the order of a date must be told.
  const std::string danish =
      "# Timestamp,Type of mobile,MMSI,Latitude,Longitude\n01/06/2026 06:00:00,Class A,219,55.1,10.1\n";
  EXPECT_THAT(errorOf("a.csv", danish),
              HasSubstr("the date '01/06/2026 06:00:00' may begin with its day or its month"));
  EXPECT_EQ(
      readAs("a.csv", danish, "time=Timestamp:dmy,latitude=Latitude,longitude=Longitude,id=MMSI").epoch_ms,
      kSix_ms);
}

TEST(TablesOfOthers, SpreadsheetsHaveLocalNumbersDatesAndEncodings) {
  const Recording german =
      readAs("a.csv",
             "\xEF\xBB\xBFTime;Latitude;Longitude;Altitude [m]\r\n01.06.2026 06:00:00;52,1;5,1;1.000,5\r\n"
             "01.06.2026 06:00:10;52,2;5,1;1.020,0\r\n");
  EXPECT_EQ(german.epoch_ms, kSix_ms);
  EXPECT_EQ(german.objects.at(0).poses.at(0).height_msl_m, 1000.5);
  const std::string american =
      "Date,Time,Lat,Long,Alt (ft)\r\n6/1/2026,6:00:00 AM,52.1,5.1,1000\r\n6/1/2026,6:00:10 "
      "AM,52.2,5.1,\"1,200\"\r\n";
  EXPECT_THAT(errorOf("a.csv", american), HasSubstr("date=NAME:mdy"));
  const Recording told =
      readAs("a.csv", american, "date=Date:mdy,time=Time,latitude=Lat,longitude=Long,height=Alt (ft):ft");
  EXPECT_EQ(told.epoch_ms, kSix_ms);
  EXPECT_NEAR(told.objects.at(0).poses.at(1).height_msl_m, 1200 * 0.3048, 1e-9);
  EXPECT_THAT(errorOf("a.txt", std::string("\xFF\xFET\0i\0m\0e\0", 10)),
              HasSubstr("a text in UTF-16; save it in UTF-8"));
  EXPECT_THAT(errorOf("a.csv", "Zeit;Breite;Laenge\r\n1;2;3\r\n"), HasSubstr("Name the columns of a table"));
}

TEST(TablesOfOthers, CoordinatesMayHaveLettersMinutesAndSeconds) {
  const Recording r =
      readAs("a.csv",
             "time,lat,lon,alt\n0,52.1N,5.1W,0\n10000,52°06'00\"S,5°06'00\"E,0\n20000,52 06.6 N,5 "
             "06 E,ground\n30000,52;1,5,0\n");
  const auto& poses = r.objects.at(0).poses;
  ASSERT_THAT(poses, SizeIs(3));
  EXPECT_NEAR(poses[0].longitude_deg, -5.1, 1e-9);
  EXPECT_NEAR(poses[1].latitude_deg, -52.1, 1e-9);
  EXPECT_NEAR(poses[2].latitude_deg, 52.11, 1e-9);
  EXPECT_THAT(r.tally.first_bad, HasSubstr("its position '52;1, 5' cannot be read"));
}

TEST(XmlOfOthers, AFileThatWasCutIsReadToItsLastWholeElement) {
  const std::string gpx =
      "<gpx><trk><trkseg><trkpt lat='52' lon='5'><ele>1</ele><time>2026-06-01T06:00:00Z</time></trkpt>"
      "<trkpt lat='52.1' lon='5'><ele>1</ele><time>2026-06-01T06:00:10Z</time></trkpt><trkpt lat='52.2' lo";
  const Recording r = readAs("a.gpx", gpx);
  EXPECT_THAT(r.objects.at(0).poses, SizeIs(2));
  EXPECT_THAT(r.tally.torn, HasSubstr("the file was cut there"));
  EXPECT_THAT(errorOf("a.gpx", "<gpx><trk></wpt>" + std::string(1000, ' ') + "<wpt/></gpx>"),
              HasSubstr("no XML"));
  EXPECT_THAT(errorOf("a.gpx", "<gpx><rte><rtept lat='52' lon='5'/></rte></gpx>"),
              HasSubstr("route without times: not used"));
}

TEST(KmlOfOthers, PointsHaveSpansAndStandInGroupsAndTracksHaveCommas) {
  const Recording r = readAs("a.kml",
                             "<kml "
                             "xmlns:gx='g'><Document><Placemark><name>T1</"
                             "name><TimeSpan><begin>2026-06-01T06:00:00Z</begin></TimeSpan><Point>"
                             "<altitudeMode>absolute</altitudeMode><coordinates> "
                             "5.1,52.1,9</coordinates></Point></Placemark><Placemark><name>T1</name>"
                             "<TimeSpan><begin>2026-06-01T06:00:10Z</begin></"
                             "TimeSpan><MultiGeometry><Point><altitudeMode>absolute</altitudeMode>"
                             "<coordinates>5.2,52.1,10</coordinates></Point></MultiGeometry></"
                             "Placemark><Placemark><name>UAV</name><gx:Track>"
                             "<gx:altitudeMode>absolute</gx:altitudeMode><when>2026-06-01</"
                             "when><when>2026-06-01T01:00:10-05:00</when>"
                             "<gx:coord>5.1,52.1,100</gx:coord><gx:coord>5.2  52.1 "
                             "100</gx:coord></gx:Track></Placemark></Document></kml>");
  ASSERT_THAT(r.objects, SizeIs(2));
  ASSERT_THAT(r.objects[0].poses, SizeIs(2));
  EXPECT_EQ(r.objects[0].poses[1].t_s, 6 * 3600 + 10);
  ASSERT_THAT(r.objects[1].poses, SizeIs(2));
  EXPECT_EQ(r.objects[1].poses[1].height_msl_m, 10);
  EXPECT_THAT(
      errorOf("a.kml", "<kml xmlns:gx='g'><Document><gx:Tour><name>a</name></gx:Tour></Document></kml>"),
      HasSubstr("tour of the camera: not used"));
}

TEST(NmeaOfOthers, LoggersWriteTheTimeOfArrivalAndAMark) {
  const Recording r =
      readAs("a.nmea",
             "\xEF\xBB\xBF"
             "2026-06-01 06:00:00.120 $GPRMC,060000,A,5206.000,N,00506.000,E,010.0,090.0,010626,,\n"
             "2026-06-01 06:00:01.120 $GPRMC,060001,A,5206.010,N,00506.000,E,010.0,090.0,010626,,\n");
  EXPECT_THAT(r.objects.at(0).poses, SizeIs(2));
  EXPECT_THAT(r.tally.notes,
              Contains(HasSubstr("height of a position of an object without any: 0 m is taken (2 times)")));
}

TEST(AcmiOfOthers, NamesMayHaveOtherCasesAndTagsBlanks) {
  const Recording r =
      readAs("a.acmi",
             "filetype=text/acmi/tacview\r\nfileversion=2.1\r\n0,referencetime=2026-06-01T06:00:00Z\r\n#0\r\n"
             "a1,T=5|52|1000,type=Air + FixedWing,name=F-16C,color=red\r\n#10\r\na1,T=5.1||\r\n");
  ASSERT_THAT(r.objects, SizeIs(1));
  EXPECT_EQ(r.objects[0].domain, Domain::air);
  EXPECT_EQ(r.objects[0].type, "Air+FixedWing");
  EXPECT_EQ(r.objects[0].name, "F-16C");
  EXPECT_EQ(r.objects[0].side, Side::hostile);
  EXPECT_EQ(r.epoch_ms, kSix_ms);
}

TEST(CzmlOfOthers, AvailabilityWithoutLimitsIsAlways) {
  const auto objectWith = [](const std::string& availability) {
    return readAs("a.czml",
                  "[{\"id\": \"document\", \"version\": \"1.0\"}, {\"id\": \"a\", \"availability\": \"" +
                      availability +
                      "\", \"position\": {\"epoch\": \"2026-06-01T06:00:00Z\", \"cartographicDegrees\": [0, "
                      "5, 52, 100, 60, 5.1, "
                      "52, 100]}}]");
  };
  for (const char* ever :
       {"0000-01-01T00:00:00Z/9999-12-31T24:00:00Z", "2026-06-01T06:00:00Z/9999-12-31T24:00:00Z",
        "2020-01-01T00:00:00Z/9999-12-31T24:00:00Z"}) {
    const Recording r = objectWith(ever);
    EXPECT_TRUE(r.objects.at(0).presence.back().is_present) << ever;
    EXPECT_EQ(spanOf(r).end_s, 60) << ever;
    EXPECT_EQ(r.tally.bad, 0);
  }
  const Recording part = objectWith("2026-06-01T06:00:10Z/2026-06-01T06:00:20Z");
  EXPECT_THAT(part.objects[0].presence, SizeIs(3));
  const Recording unknown = objectWith("always");
  EXPECT_THAT(unknown.objects[0].presence, SizeIs(0));
  EXPECT_THAT(unknown.tally.first_bad, HasSubstr("its availability is not BEGIN/END"));
}

TEST(StkOfOthers, KeysMayStandInAnyOrderAndCase) {
  const std::string rows =
      "EphemerisLLATimePos\n0 52 5 0\n10 52.1 5 0\n20 52.2 5.3 0\n30 52.3 5 0\n40 52.4 5 0\nEND EPHEMERIS\n";
  const Recording r =
      readAs("a.e",
             "STK.v.11.0\nBEGIN EPHEMERIS\nScenarioEpoch 1 jun 2026 06:00:00\nCoordinateSystem FIXED\n"
             "InterpolationMethod Linear\nInterpolationSamplesM1 5\n" +
                 rows);
  EXPECT_EQ(r.epoch_ms, kSix_ms);
  EXPECT_THAT(r.objects.at(0).poses, SizeIs(5)) << "straight lines";
}

}  // namespace
}  // namespace emscape::interop
