// Readers of tracks: GPX, KML, CZML, STK, NMEA and tables.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"
#include "recording/tracks/interpolated_track.h"
#include "tests/recording/read_as.h"
#include "tests/support/errors.h"
#include "tests/support/reference_data.h"
#include "tests/support/temporary_folder.h"

namespace emscape::interop {
namespace {

using testing::HasSubstr;

TEST(Gpx, TracksAreObjectsAndWaypointsFixedOnes) {
  const Recording r =
      readAs("walk.gpx",
             "<?xml version='1.0'?><gpx><wpt lat='52' lon='5'><ele>7</ele><name>mast</name></wpt><trk>"
             "<name>hiker</name><trkseg><trkpt lat='52.1' lon='5.1'><ele>10</ele>"
             "<time>2026-06-01T06:00:00Z</time></trkpt><trkpt lat='52.2' lon='5.1'><ele>12</ele>"
             "<time>2026-06-01T08:00:30+02:00</time></trkpt></trkseg></trk><trk><trkseg>"
             "<trkpt lat='1' lon='2'><time>2026-06-01T06:00:00Z</time></trkpt>"
             "<trkpt lat='1' lon='2'/></trkseg></trk></gpx>");
  ASSERT_EQ(r.objects.size(), 3u);
  EXPECT_EQ(r.objects[0].name, "mast");
  EXPECT_EQ(r.objects[0].poses.at(0).height_msl_m, 7);
  EXPECT_EQ(r.objects[1].name, "hiker");
  ASSERT_EQ(r.objects[1].poses.size(), 2u);
  EXPECT_EQ(r.objects[1].poses[1].t_s, 30);
  EXPECT_EQ(r.objects[1].poses[1].height_msl_m, 12);
  EXPECT_TRUE(std::isnan(r.objects[1].poses[1].heading_deg)) << "along the track";
  EXPECT_EQ(r.objects[2].name, "walk") << "that of the file";
  EXPECT_EQ(r.epoch_ms, kSix_ms);
  EXPECT_THAT(r.tally.first_bad, HasSubstr("point 5: it has no time"));
}

TEST(Gpx, RoutesWithTimesAreObjects) {
  const Recording r = readAs("a.gpx",
                             "<gpx><rte><name>tour</name><rtept lat='52' lon='5'><ele>9</ele>"
                             "<time>2026-06-01T06:00:00Z</time></rtept><rtept lat='52.1' lon='5'>"
                             "<time>2026-06-01T06:00:09Z</time></rtept></rte>"
                             "<rte><rtept lat='52' lon='5'/></rte></gpx>");
  ASSERT_EQ(r.objects.size(), 1u);
  EXPECT_EQ(r.objects[0].name, "tour");
  EXPECT_EQ(r.objects[0].poses.size(), 2u);
  EXPECT_EQ(r.tally.ignored.at("route without times"), 1);
}

TEST(Recordings, PackedByGzipAreReadAndWhatIsNotReadIsNamed) {
  const test::TemporaryFolder folder;
  const auto packed = [](const std::string& text) {
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY);
    std::string bytes(deflateBound(&stream, text.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = static_cast<uInt>(bytes.size());
    deflate(&stream, Z_FINISH);
    bytes.resize(stream.total_out);
    deflateEnd(&stream);
    return bytes;
  };
  const std::string first = "time,lat,lon\n2026-06-01T06:00:00Z,52,5\n",
                    second = "2026-06-01T06:00:09Z,52.1,5\n";
  const std::string bytes = packed(first) + packed(second);
  const Recording r = readRecording(folder.write("a.csv.gz", bytes));
  ASSERT_EQ(r.objects.size(), 1u);
  EXPECT_EQ(r.objects[0].poses.size(), 2u) << "both parts";
  EXPECT_THAT(
      readRecording(folder.write("b.csv.gz", packed(first) + packed(second).substr(0, 20))).tally.torn,
      testing::AnyOf(HasSubstr("the gzip file is cut"), ""));
  const auto errorOf = [&](const std::string& text) {
    return test::errorOf([&] { readRecording(folder.write("x", text)); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(errorOf("\x1F\x8B damaged"), HasSubstr("x: cannot read: the gzip file is damaged"));
  EXPECT_THAT(errorOf(""), HasSubstr("x: the file is empty"));
  EXPECT_THAT(errorOf("\xFD"
                      "7zXZ"),
              HasSubstr("packed by 7z, xz, bzip2 or zstd"));
  EXPECT_THAT(errorOf("Zeit;Breite;L\xE4nge\n1;52;5\n"),
              HasSubstr("a text that is not in UTF-8 (but Latin-1, perhaps); convert it with iconv"));
  EXPECT_THAT(errorOf("Zeit;Breite;L\xC3\xA4nge\n1;52;5\n"), HasSubstr("Name the columns of a table"));
}

TEST(Recordings, LinesMayEndAsOnOldMacintoshes) {
  const Recording r = readAs("a.csv", "time,lat,lon\r2026-06-01T06:00:00Z,52,5\r2026-06-01T06:00:09Z,52.1,5");
  ASSERT_EQ(r.objects.size(), 1u);
  EXPECT_EQ(r.objects[0].poses.size(), 2u);
}

TEST(TrackTable, TimesOfFlightControllersAreKnown) {
  for (const char* const text :
       {"timestamp_us,lat,lon\n1780293600000000,52,5\n1780293609000000,52.1,5\n",
        "timestamp,lat,lon\n1780293600000000,52,5\n1780293609000000,52.1,5\n",
        "time(ns),lat,lon\n1780293600000000000,52,5\n1780293609000000000,52.1,5\n"}) {
    const Recording r = readAs("a.csv", text);
    EXPECT_EQ(r.epoch_ms, kSix_ms) << text;
    EXPECT_NEAR(r.objects.at(0).poses.at(1).t_s, 9, 1e-6) << text;
  }
  const Recording ardupilot =
      readAs("a.csv", "TimeUS,Lat,Lng,Alt\n5000000,520000000,50000000,9\n14000000,521000000,50000000,9\n");
  EXPECT_NEAR(ardupilot.objects.at(0).poses.at(1).t_s, 9, 1e-9);
  EXPECT_NEAR(ardupilot.objects[0].poses[1].latitude_deg, 52.1, 1e-12);
  EXPECT_THAT(ardupilot.tally.notes, testing::Contains(HasSubstr("taken as 1e-7 degrees")));
  const Recording dji = readAs(
      "a.csv",
      "OSD.flyTime [s],CUSTOM.date [local],OSD.latitude,OSD.longitude\n0.5,6/1/2026,52,5\n9.5,,52,5.1\n");
  EXPECT_EQ(dji.objects.at(0).poses.at(1).t_s - dji.objects[0].poses[0].t_s, 9);
}

TEST(Kml, TracksHaveAnglesAndStampedPointsOfOneNameAreOneObject) {
  const Recording r = readAs(
      "a.kml",
      "<kml "
      "xmlns:gx='g'><Document><Folder><Placemark><name>jet</name><gx:Track><altitudeMode>absolute</"
      "altitudeMode>"
      "<when>2026-06-01T06:00:00Z</when><when>2026-06-01T06:00:10Z</when><gx:coord>5 52 3000</gx:coord>"
      "<gx:coord>5.1 52 3100</gx:coord><gx:angles>90 3 -2</gx:angles></gx:Track></Placemark></Folder>"
      "<Placemark><name>van</name><TimeStamp><when>2026-06-01T06:00:05Z</when></"
      "TimeStamp><Point><coordinates>"
      "5,52,0</coordinates></Point></Placemark><Placemark><name>van</"
      "name><TimeStamp><when>2026-06-01T06:00:09Z"
      "</when></TimeStamp><Point><coordinates>5.01,52</coordinates></Point></"
      "Placemark><Placemark><name>mast</name>"
      "<Point><altitudeMode>absolute</altitudeMode><coordinates>5,52,30</coordinates></Point></Placemark></"
      "Document>"
      "</kml>");
  ASSERT_EQ(r.objects.size(), 3u);
  EXPECT_EQ(r.objects[0].name, "jet");
  EXPECT_EQ(r.objects[0].poses.at(1).height_msl_m, 3100);
  EXPECT_EQ(r.objects[0].poses[0].heading_deg, 90);
  EXPECT_EQ(r.objects[0].poses[0].pitch_deg, 3);
  EXPECT_EQ(r.objects[0].poses[0].roll_deg, -2);
  EXPECT_EQ(r.objects[1].poses.at(0).height_msl_m, 30);
  ASSERT_EQ(r.objects[2].poses.size(), 2u) << "stamped points come after the others of their folder";
  EXPECT_EQ(r.objects[2].poses[1].t_s, 9);
}

TEST(Kml, StampedPointsOfAFolderWithNamesOfTheirOwnInTheOrderOfTimeAreOneObject) {
  const auto pointAt = [](int second) {
    return "<Placemark><name>06:00:0" + std::to_string(second) +
           "</name><TimeStamp><when>2026-06-01T06:00:0" + std::to_string(second) +
           "Z</when></TimeStamp><Point><altitudeMode>absolute</altitudeMode><coordinates>5,52.0" +
           std::to_string(second) + ",3000</coordinates></Point></Placemark>";
  };
  const Recording r =
      readAs("a.kml", "<kml><Document><name>all</name><Folder><name>flight 1</name>" + pointAt(1) +
                          pointAt(2) + pointAt(3) + "</Folder></Document></kml>");
  ASSERT_EQ(r.objects.size(), 1u);
  EXPECT_EQ(r.objects[0].name, "flight 1");
  EXPECT_EQ(r.objects[0].poses.size(), 3u);
  EXPECT_THAT(r.tally.notes, testing::Contains(HasSubstr("are taken as one object, 'flight 1'")));
  const Recording without = readAs("a.kml", "<kml>" + pointAt(1) + pointAt(2) + pointAt(3) + "</kml>");
  ASSERT_EQ(without.objects.size(), 1u);
  EXPECT_EQ(without.objects[0].name, "a");
  const Recording places = readAs("a.kml", "<kml>" + pointAt(3) + pointAt(1) + pointAt(2) + "</kml>");
  EXPECT_EQ(places.objects.size(), 3u) << "out of order: several objects";
}

TEST(Kml, TrackWithoutATimeForEachPositionIsCounted) {
  const Recording r = readAs("a.kml",
                             "<kml><Placemark><name>a</name><Track><when>2026-06-01T06:00:00Z</when></"
                             "Track></Placemark><Placemark><name>b"
                             "</name><Point><coordinates>5,52</coordinates></Point></Placemark></kml>");
  EXPECT_THAT(r.tally.first_bad, HasSubstr("a: a track of 1 times and 0 positions"));
}

TEST(Tracks, NmeaOfTwoReceiversIsToldAndHeightsInFeetAreConverted) {
  const Recording r = readAs("a.nmea",
                             "$GPGGA,060000,3327.000,S,07033.000,W,1,08,1,10000,F,,,,\n"
                             "$GLGGA,060000,3327.600,S,07033.000,W,1,08,1,10000,F,,,,\n"
                             "$GPGGA,060010,3326.940,S,07032.940,W,1,08,1,10000,F,,,,\n");
  EXPECT_NEAR(r.objects.at(0).poses.at(0).height_msl_m, 3048, 1e-9);
  EXPECT_THAT(r.tally.notes, testing::Contains(HasSubstr("at two places, as of two receivers")));
}

TEST(Nmea, SentencesOfOneTimeAreOneFix) {
  const Recording r = readAs("ship.nmea",
                             "$GPGGA,235958,5200.000,N,00500.000,E,1,8,1.0,12.5,M,46.0,M,,\r\n"
                             "$GPRMC,235958,A,5200.000,N,00500.000,E,10.0,90.0,310526,,\r\n"
                             "$GPGGA,000002,5200.600,N,00501.200,W,1,8,1.0,13.5,M,46.0,M,,\r\n"
                             "$GPGSV,1,1,00\r\n$GPRMC,000003,V,,,,,,,010626,,\r\n"
                             "$GPRMC,000004,A,5230.000,S,00500.000,E,0,0,010626,,*00\r\n");
  ASSERT_EQ(r.objects.size(), 1u);
  EXPECT_EQ(r.objects[0].name, "ship");
  const auto& poses = r.objects[0].poses;
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].height_msl_m, 12.5);
  EXPECT_EQ(poses[1].t_s, 4) << "over midnight";
  EXPECT_DOUBLE_EQ(poses[1].latitude_deg, 52.01);
  EXPECT_DOUBLE_EQ(poses[1].longitude_deg, -5.02);
  EXPECT_EQ(r.epoch_ms, kSix_ms - 6 * 3600 * 1000 - 2000);
  EXPECT_EQ(r.tally.bad, 1) << "a wrong checksum";
  EXPECT_EQ(r.tally.ignored.at("fix that is not valid"), 1);
}

TEST(Stk, FixedPositionsFollowTheInterpolation) {
  // A circle of 300 m around the north pole's axis would be a straight line without the interpolation.
  std::string text =
      "stk.v.4.3\n# a comment\nBEGIN Ephemeris\nNumberOfEphemerisPoints 6\nScenarioEpoch 1 Jun 2026 "
      "06:00:00.000\n"
      "InterpolationMethod Lagrange\nInterpolationOrder 5\nCentralBody Earth\nCoordinateSystem Fixed\n"
      "DistanceUnit Kilometers\nEphemerisTimePos\n";
  const GeoFrame frame(FrameOrigin{FrameKind::enu, 52, 5, 1000});
  const auto at = [&](double t_s) {
    return toEcef(frame.toGeodetic({3000 * std::sin(0.02 * t_s), 3000 * std::cos(0.02 * t_s), 0}));
  };
  for (int i = 0; i < 6; ++i) {
    const Vec3d position = at(20 * i);
    text += std::to_string(20 * i) + " " + std::to_string(position.x / 1000) + " " +
            std::to_string(position.y / 1000) + " " + std::to_string(position.z / 1000) + "\n";
  }
  const Recording r = readAs("sat.e", text + "END Ephemeris\n");
  EXPECT_EQ(r.tally.bad, 0) << r.tally.first_bad;
  EXPECT_EQ(r.tally.torn, "");
  EXPECT_EQ(r.epoch_ms, kSix_ms);
  ASSERT_EQ(r.objects.size(), 1u);
  EXPECT_EQ(r.objects[0].name, "sat");
  for (double t_s = 0; t_s <= 100; t_s += 3) {
    const PoseSample pose = poseAt(r.objects[0], t_s);
    const double height_m = pose.height_msl_m + geoidUndulation_m(pose.latitude_deg, pose.longitude_deg);
    EXPECT_LT(length(toEcef({pose.latitude_deg, pose.longitude_deg, height_m}) - at(t_s)), 3) << t_s;
  }
  EXPECT_THAT(readAs("sat.e", text).tally.torn, HasSubstr("END Ephemeris is missing"));
}

TEST(Stk, OtherAxesAndBodiesAreRefusedWithAHint) {
  const auto errorOf = [](const std::string& line) {
    return test::errorOf([&] { readAs("a.e", "stk.v.4.3\nBEGIN Ephemeris\n" + line + "\n"); },
                         ErrorCode::bad_input);
  };
  EXPECT_THAT(
      errorOf("CoordinateSystem J2000"),
      HasSubstr("a.e: line 3: CoordinateSystem J2000: only Fixed is read; export the ephemeris in STK"));
  EXPECT_THAT(errorOf("CentralBody Moon"), HasSubstr("only Earth is read"));
  EXPECT_THAT(errorOf("DistanceUnit Furlongs"), HasSubstr("DistanceUnit Furlongs"));
  EXPECT_THAT(errorOf("ScenarioEpoch yesterday"), HasSubstr("'yesterday' is no time such as 1 Jun 2003"));
}

TEST(Czml, PositionsAreSampledConstantOrLeftOutWithTheReason) {
  const Recording r = readAs("a.czml", R"([
{"id": "document", "version": "1.0", "clock": {"interval": "2026-06-01T06:00:00Z/2026-06-01T06:01:00Z"}},
{"id": "jet", "name": "Jet 1", "availability": "2026-06-01T06:00:10Z/2026-06-01T06:00:30Z",
 "position": {"epoch": "2026-06-01T06:00:00Z", "cartographicDegrees": [0, 5, 52, 1000, 60, 5.1, 52.1, 2000]}},
{"id": "mast", "position": {"cartographicRadians": [0.1, 0.9, 100]}},
{"id": "sat", "position": {"referenceFrame": "INERTIAL", "cartesian": [1, 2, 3]}},
{"id": "bad", "position": {"cartographicDegrees": [1, 2, 3, 4, 5]}},
{"id": "sensor", "agi_conicSensor": {}, "position": {"reference": "jet#position"}}
])");
  ASSERT_EQ(r.objects.size(), 2u);
  EXPECT_EQ(r.objects[0].name, "Jet 1");
  EXPECT_EQ(r.objects[0].poses.at(1).t_s, 60);
  EXPECT_NEAR(r.objects[0].poses[0].height_msl_m, 1000 - geoidUndulation_m(52, 5), 1e-9);
  ASSERT_EQ(r.objects[0].presence.size(), 3u);
  EXPECT_EQ(r.objects[0].presence[1].t_s, 10);
  EXPECT_EQ(r.objects[0].presence[2].t_s, 30);
  EXPECT_NEAR(r.objects[1].poses.at(0).latitude_deg, 0.9 * 57.29577951308232, 1e-9);
  EXPECT_THAT(r.tally.first_bad, HasSubstr("packet 5: its cartographicDegrees has 5 numbers"));
  EXPECT_EQ(r.tally.ignored.at("position in the reference frame INERTIAL (only FIXED is read)"), 1);
  EXPECT_EQ(r.tally.ignored.at("position of another object"), 1);
}

TEST(Czml, FaultyJsonNamesTheLine) {
  EXPECT_THAT(test::errorOf([] { readAs("a.czml", "[{\"id\": 1},\n  oops]"); }, ErrorCode::bad_input),
              HasSubstr("a.czml:2:3: not valid JSON; is the file cut?"));
  EXPECT_THAT(test::errorOf([] { readAs("a.czml", "[{\"id\": 1e3001}]"); }, ErrorCode::bad_input),
              HasSubstr("a.czml: number overflow"));
}

TEST(TrackTable, CommonNamesUnitsAndSeparatorsAreKnown) {
  const Recording r =
      readAs("a.csv",
             "Zeit;time;Lat (deg);lon;altitude_ft;heading;id\nx;2026-06-01T06:00:00Z;52,5;5,25;1000;90;A\n"
             "x;2026-06-01T06:00:02Z;52,6;5,25;2000;90;A\nx;2026-06-01T06:00:02Z;51;5;0;;B\n");
  ASSERT_EQ(r.objects.size(), 2u);
  EXPECT_EQ(r.objects[0].name, "A");
  EXPECT_EQ(r.objects[0].poses.at(0).latitude_deg, 52.5);
  EXPECT_NEAR(r.objects[0].poses[1].height_msl_m, 609.6, 1e-9);
  EXPECT_EQ(r.objects[0].poses[1].heading_deg, 90);
  EXPECT_TRUE(std::isnan(r.objects[1].poses.at(0).heading_deg));
  EXPECT_EQ(r.epoch_ms, kSix_ms);
}

TEST(TrackTable, ColumnsCanBeNamed) {
  ReadOptions options;
  options.columns = "time=Uhr,latitude=Breite,longitude=Länge,height=Höhe:ft";
  const Recording r = readAs("a.csv", "Uhr,Breite,Länge,Höhe\n0,52,5,1000\n1,52,5.1,1000\n", options);
  EXPECT_NEAR(r.objects.at(0).poses.at(1).height_msl_m, 304.8, 1e-9);
  EXPECT_FALSE(r.epoch_ms.has_value());
  const auto errorOf = [](const std::string& columns) {
    ReadOptions wrong;
    wrong.columns = columns;
    return test::errorOf([&] { readAs("a.csv", "Uhr,Breite,Länge,Höhe\n0,52,5,1000\n", wrong); },
                         ErrorCode::usage);
  };
  EXPECT_THAT(errorOf("time=Zeit"), HasSubstr("the table has no column 'Zeit'; it has Uhr, Breite"));
  EXPECT_THAT(errorOf("clock=Uhr"), HasSubstr("'clock=Uhr' is not ROLE=NAME"));
  EXPECT_THAT(errorOf("height=Höhe:mile"), HasSubstr("'mile' is no unit; allowed are m, km, ft, cm, mm, fl"));
  EXPECT_THAT(test::errorOf([] { readAs("a.csv", "lat,lon\n1,2\n"); }, ErrorCode::bad_input),
              HasSubstr("no column for the time; name it (--columns, or 'columns' of a track): time=NAME"));
}

TEST(Tracks, GapsEndATrackWhereAskedForAndOutliersAreTold) {
  const std::string text =
      "t_s,latitude_deg,longitude_deg,height_msl_m\n0,52,5,0\n1,52.0001,5,0\n2,52.9,5,0\n3,52.0003,5,0\n"
      "100,52.0004,5,0\n";
  const Recording bridged = readAs("a.csv", text);
  EXPECT_TRUE(bridged.objects.at(0).presence.empty());
  EXPECT_THAT(bridged.tally.notes, testing::Contains(HasSubstr("the first: a at 2.000 s")));
  ReadOptions options;
  options.gap_s = 60;
  const Recording ended = readAs("a.csv", text, options);
  ASSERT_EQ(ended.objects.at(0).presence.size(), 2u);
  EXPECT_EQ(ended.objects[0].presence[0].t_s, 3);
  EXPECT_EQ(ended.objects[0].presence[1].t_s, 100);
}

TEST(MergedRecordings, WithoutACommonEpochSaySo) {
  const std::string with = "time,lat,lon\n2026-06-01T06:00:10Z,52,5\n2026-06-01T06:00:20Z,52,5.1\n";
  const std::string later = "time,lat,lon\n2026-06-01T06:00:30Z,52,5\n2026-06-01T06:00:40Z,52,5.1\n";
  const std::string without = "time,lat,lon\n10,52,5\n20,52,5.1\n";
  const std::string fixed = "<gpx><wpt lat='52' lon='5'><name>mast</name></wpt></gpx>";
  const Recording aligned =
      merged({readAs("b.csv", later), readAs("a.csv", with), readAs("mast.gpx", fixed)});
  EXPECT_EQ(aligned.epoch_ms, kSix_ms + 10000);
  EXPECT_EQ(aligned.objects.at(0).poses.at(0).t_s, 20);
  EXPECT_EQ(aligned.objects.at(2).poses.at(0).t_s, 0);
  EXPECT_THAT(aligned.tally.notes, testing::Not(testing::Contains(HasSubstr("epoch"))));
  const Recording loose = merged({readAs("a.csv", with), readAs("c.csv", without)});
  EXPECT_FALSE(loose.epoch_ms.has_value());
  EXPECT_THAT(loose.tally.notes,
              testing::Contains(HasSubstr("c.csv has none: each recording begins at its own t = 0")));
}

TEST(InterpolatedTrack, PolynomialOfTheDegreeIsExact) {
  // A parabola in the earth's axes is followed within the metre that is promised.
  std::vector<EcefSample> samples;
  const Vec3d begin = toEcef({0, 0, 20000});
  const auto at = [&](double t_s) { return begin + Vec3d{0, 200 * t_s, 5 * t_s * t_s}; };
  for (int i = 0; i <= 5; ++i) samples.push_back({20.0 * i, at(20.0 * i)});
  TrackRecorder recorder("test", {});
  addInterpolated(recorder, recorder.objectOf("a"), samples, 2, "here");
  const Recording r = recorder.finish();
  for (double t_s = 0; t_s <= 100; t_s += 1.7) {
    const PoseSample pose = poseAt(r.objects.at(0), t_s);
    const double height_m = pose.height_msl_m + geoidUndulation_m(pose.latitude_deg, pose.longitude_deg);
    EXPECT_LT(length(toEcef({pose.latitude_deg, pose.longitude_deg, height_m}) - at(t_s)), 1.2) << t_s;
  }
}

/// Files of other programs: their first and last positions.
class PublicTracks : public testing::Test {
 protected:
  static std::optional<Recording> read(const std::string& path) {
    const auto file = test::referenceFile(path);
    if (!file) return std::nullopt;
    return readRecording(*file);
  }
};

TEST_F(PublicTracks, OneFlightInEachFormat) {
  int read_files = 0;
  for (const char* name : {"t.gpx", "opensky.csv", "tacview.csv", "renamed_unix.csv"}) {
    const auto r = read(std::string("field/tracks/") + name);
    if (!r) continue;
    ++read_files;
    ASSERT_EQ(r->objects.size(), 1u) << name;
    const auto& poses = r->objects[0].poses;
    ASSERT_GE(poses.size(), 30u) << name;
    EXPECT_EQ(poses[1].t_s, 1) << name;
    EXPECT_NEAR(poses[1].latitude_deg, 52.001, 1e-9) << name;
    EXPECT_NEAR(poses[1].longitude_deg, 5.001, 1e-9) << name;
    const bool is_ellipsoid = std::string(name) == "opensky.csv" || std::string(name) == "renamed_unix.csv";
    const double height_msl_m = 3053.3 - (is_ellipsoid ? geoidUndulation_m(52.001, 5.001) : 0);
    EXPECT_NEAR(poses[1].height_msl_m, height_msl_m, 1e-6) << name;
    EXPECT_TRUE(r->epoch_ms.has_value()) << name;
    EXPECT_EQ(r->tally.bad, 0) << name << ": " << r->tally.first_bad;
  }
  if (read_files == 0) GTEST_SKIP() << test::notInRepository("field/tracks");
}

TEST_F(PublicTracks, CesiumsSimpleCzmlHasTwoPlacesOnTheGround) {
  const auto r = read("reference/interop/czml/cesium_simple.czml");
  if (!r) GTEST_SKIP() << test::notInRepository("reference/interop/czml/cesium_simple.czml");
  ASSERT_EQ(r->objects.size(), 2u);
  EXPECT_EQ(r->objects[0].name, "Pennsylvania");
  EXPECT_EQ(r->objects[1].name, "AGI");
  EXPECT_NEAR(r->objects[1].poses.at(0).latitude_deg, 40.04, 0.01);
  EXPECT_NEAR(r->objects[1].poses.at(0).longitude_deg, -75.60, 0.01);
  EXPECT_EQ(r->tally.ignored.at("position in the reference frame INERTIAL (only FIXED is read)"), 3);
}

TEST(TrackTable, DaysOfSpreadsheetsAreRecognisedByTheSpeedAndTold) {
  const std::string rows =
      "time,lat,lon,altitude_ft\n46174.25000000,52.000,5.000,9842.52\n46174.25001157,52.001,5.001,9845.8\n"
      "46174.25002315,52.002,5.002,9849.08\n";
  const Recording r = readAs("s.csv", rows);
  EXPECT_EQ(r.epoch_ms, kSix_ms);
  EXPECT_NEAR(r.objects.at(0).poses.at(2).t_s, 2, 0.001);
  EXPECT_THAT(r.tally.notes, testing::Contains(HasSubstr("days since 1900")));
  ReadOptions options;
  options.columns = "time=time:excel,latitude=lat,longitude=lon,height=altitude_ft:ft";
  const Recording stated = readAs("s.csv", rows, options);
  EXPECT_EQ(stated.epoch_ms, kSix_ms);
  EXPECT_THAT(stated.tally.notes, testing::IsEmpty());
  options.columns = "time=time:mjd,latitude=lat,longitude=lon,height=altitude_ft:ft";
  EXPECT_EQ(
      readAs("s.csv", "time,lat,lon,altitude_ft\n61192.25,52,5,1\n61192.26,52,5.1,1\n", options).epoch_ms,
      kSix_ms);
  // The same numbers as seconds of the day, at a speed that is one.
  const Recording seconds =
      readAs("s.csv", "time,lat,lon,altitude_ft\n46174.25,52.000,5,9842\n46175.25,52.001,5,9845\n");
  EXPECT_FALSE(seconds.epoch_ms);
  EXPECT_EQ(seconds.objects.at(0).poses.at(1).t_s, 1.25);
}

TEST(TrackTable, TimesThatMakeAnObjectFasterThanAnyAreRefusedWithTheUnitThatHelps) {
  const std::string rows = "time,lat,lon,height_m\n0,52,5,1000\n0.001,52.001,5,1000\n0.002,52.002,5,1000\n";
  const auto problem = test::errorOf([&] { readAs("s.csv", rows); }, ErrorCode::bad_input);
  EXPECT_THAT(problem, testing::AllOf(HasSubstr("'s' would move at 111.3 km/s"),
                                      HasSubstr("between times 0 and 0.001"), HasSubstr("time=NAME:UNIT")));
  ReadOptions options;
  options.columns = "time=time:days,latitude=lat,longitude=lon,height=height_m";
  EXPECT_NEAR(readAs("s.csv", rows, options).objects.at(0).poses.at(1).t_s, 86.4, 1e-6);
  // One wrong position among others is no wrong unit.
  EXPECT_NO_THROW(readAs("s.csv",
                         "time,lat,lon,height_m\n0,52,5,1\n1,59,5,1\n2,52.0002,5,1\n3,52.0003,5,1\n"
                         "4,52.0004,5,1\n5,52.0005,5,1\n"));
}

TEST(TrackTable, HeightWithoutAUnitIsToldWithTheColumnsThatStateFeet) {
  const std::string rows =
      "timestamp,lat,lon,altitude\n2026-06-01T06:00:00Z,52,5,10000\n2026-06-01T06:00:10Z,52.01,5,10000\n";
  const Recording r = readAs("s.csv", rows);
  ASSERT_EQ(r.tally.notes.size(), 1u);
  const std::string& note = r.tally.notes.front();
  EXPECT_THAT(note, HasSubstr("without a unit in column 'altitude': taken as metres"));
  const std::string before = "columns tell it: ";
  const std::size_t begin = note.find(before) + before.size();
  ReadOptions options;
  options.columns = note.substr(begin, note.find(" (2 times)") - begin);
  EXPECT_EQ(options.columns, "height=altitude:ft");
  EXPECT_NEAR(readAs("s.csv", rows, options).objects.at(0).poses.at(0).height_msl_m, 3048, 1e-6);
  EXPECT_THAT(
      readAs("s.csv", "time,lat,lon,geoaltitude\n1780293600,52,5,1\n1780293610,52.01,5,1\n").tally.notes,
      testing::IsEmpty());
}

}  // namespace
}  // namespace emscape::interop
