#include "base/geodesy/position_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "emscape/base/geodesy/geo_frame.h"
#include "tests/support/errors.h"

namespace emscape {
namespace {

constexpr double kLatitude_deg = 36.503333, kLongitude_deg = -84.2;

TEST(PositionText, WritesEachFormat) {
  EXPECT_EQ(positionText(kLatitude_deg, kLongitude_deg), "36.50333°N 84.20000°W");
  EXPECT_EQ(positionText(kLatitude_deg, kLongitude_deg, PositionFormat::dms), "36°30'12.0\"N 84°12'00.0\"W");
  EXPECT_EQ(positionText(33.44, 43.27, PositionFormat::mgrs), "38S LC 39187 01405");
  EXPECT_EQ(positionText(-0.000001, 190), "0.00000°N 170.00000°W");
  EXPECT_EQ(positionText(59.99999999, 0, PositionFormat::dms), "60°00'00.0\"N 0°00'00.0\"E");
  EXPECT_EQ(positionText(NAN, 0), "invalid position");
}

TEST(PositionText, OneCoordinateIsReadInEachForm) {
  for (const char* text :
       {"-84.2", "84.2W", "84.2°W", "W84.2", "84°12'W", "84°12'00.0\"W", "84d12'W", "-84 12 0"})
    EXPECT_NEAR(parseCoordinate(text, false).value_or(NAN), -84.2, 1e-9) << text;
  EXPECT_NEAR(parseCoordinate("44 24 30", true).value_or(NAN), 44 + 24.5 / 60, 1e-9);
  for (const char* text : {"", "west", "84.2N", "44.4 -71.2", "44 71", "44.4, -71.2", "84 kW",
                           "39d3  3   3  3  3   3", "1:2:3:4:5", "1d2:3:4:5:6N"})
    EXPECT_FALSE(parseCoordinate(text, false)) << text;
}

TEST(PositionText, AnyWrittenPositionIsReadAgain) {
  for (double latitude_deg = -90; latitude_deg <= 90; latitude_deg += 11.25) {
    for (double longitude_deg = -179.7; longitude_deg < 180; longitude_deg += 23.1) {
      for (const PositionFormat format :
           {PositionFormat::decimal, PositionFormat::dms, PositionFormat::mgrs}) {
        const std::string text = positionText(latitude_deg, longitude_deg, format);
        const ParsedPosition read = parsePosition(text);
        EXPECT_LT(
            geodesicInverse(latitude_deg, longitude_deg, read.latitude_deg, read.longitude_deg).distance_m,
            format == PositionFormat::decimal ? 0.8 : 2.3)
            << text;
        EXPECT_FALSE(read.height_m) << text;
      }
    }
  }
}

TEST(ParsePosition, ReadsTheUsualForms) {
  for (const char* const text :
       {"36.503333,-84.2", "36.503333, -84.2", "36.503333 -84.2", "36.503333N 84.2W", "36.503333 N, 84.2 W",
        "84.2W 36.503333N", "N36.503333 W84.2", "N 36.503333 W 84.2", "36°30'12\"N 84°12'W",
        "36° 30' 12\" N, 84° 12' 00\" W", "36°30′12″N 84°12′0″W", "36d30'12\"N 84d12'W",
        "36:30:12N 84:12:00W", "36.503333°N 84.20000°W"}) {
    const ParsedPosition read = parsePosition(text);
    EXPECT_NEAR(read.latitude_deg, kLatitude_deg, 1e-6) << text;
    EXPECT_NEAR(read.longitude_deg, kLongitude_deg, 1e-6) << text;
    EXPECT_FALSE(read.height_m) << text;
  }
  for (const char* const text : {"38S LC 39187 01405", "38SLC3918701405", "38s lc 39187 01405",
                                 "38n 339188 3701405", "38 n 339188 3701405"}) {
    const ParsedPosition read = parsePosition(text);
    EXPECT_NEAR(read.latitude_deg, 33.44, 2e-5) << text;
    EXPECT_NEAR(read.longitude_deg, 43.27, 2e-5) << text;
  }
}

TEST(ParsePosition, ReadsAHeightAfterAnyForm) {
  for (const char* const text :
       {"36.5,-84.2,150", "36.5N 84.2W, 150", "36°30'N 84°12'W,150.0", "16S GF 50784 43054,150"}) {
    EXPECT_EQ(parsePosition(text).height_m, 150) << text;
  }
}

TEST(ParsePosition, RefusesOtherTexts) {
  for (const char* const text :
       {"", "  ", "36.5", "91,0", "36.5,-84.2,x", "36.5,-84.2,150,3", "north", "36.5N 84.2N", "16S", "16SGF",
        "16S GF", "nan,nan", "1:2:3:4:5 6:7:8:9:10", "99SGF1234567890", "36.5;84.2", "36.5, 8\f4.2", "\v"}) {
    EXPECT_EQ(test::errorOf([&] { parsePosition(text); }, ErrorCode::usage).find("is not a position") !=
                  std::string::npos,
              true)
        << text;
  }
}

/// GPS receivers write the band of MGRS after the zone.
TEST(ParsePosition, RefusesAZonesSThatMayBeABandOrSouth) {
  for (const char* const text : {"16S 733000 4043000", "16s 733000 4043000", "16 S 0733000 4043000",
                                 "733000 4043000 16S", "16S,733000,4043000", "16S 733000 4043000, 150"}) {
    const std::string message = test::errorOf([&] { parsePosition(text); }, ErrorCode::usage);
    EXPECT_THAT(message,
                testing::HasSubstr("may be MGRS's band, 32 to 40 degrees north, or south of the equator"))
        << text;
    for (const bool is_north : {true, false}) {  // the remedies
      const std::size_t begin = message.find('\'', message.find(is_north ? "write '" : " or '16")) + 1;
      const std::size_t at = is_north ? begin : message.rfind('\'', message.size() - 2) + 1;
      const ParsedPosition read = parsePosition(message.substr(at, message.find('\'', at) - at));
      EXPECT_NEAR(read.latitude_deg, is_north ? 36.5 : -53.8, 0.1) << message;
    }
  }
  EXPECT_NEAR(parsePosition("56S 334000 6252000").latitude_deg, -33.86, 0.01) << "no northing of the band";
  EXPECT_NEAR(parsePosition("16N 733000 404300").latitude_deg, 3.66, 0.01) << "band N is in the north";
}

TEST(ParsePosition, ReadsUtmWithTheBandOfMgrsAfterTheZone) {
  for (const char* const text :
       {"19T 316175 4904508", "19t 316175 4904508", "19 T 316175 4904508", "19T,316175,4904508",
        "316175 4904508 19T", "19T 316175.00 m E 4904508.00 m N", "19 T 316175mE 4904508mN",
        "19T 316175E 4904508N"}) {
    const ParsedPosition read = parsePosition(text);  // by gdaltransform -s_srs EPSG:32619
    EXPECT_NEAR(read.latitude_deg, 44.270596, 2e-6) << text;
    EXPECT_NEAR(read.longitude_deg, -71.303300, 2e-6) << text;
  }
  EXPECT_EQ(parsePosition("19T 316175 4904508, 150").height_m, 150);
  EXPECT_NEAR(parsePosition("56H 334000 6252000").latitude_deg, -33.86, 0.01);
  EXPECT_NEAR(parsePosition("36 N 84 W").latitude_deg, 36, 1e-9) << "no zone";
  EXPECT_THAT(test::errorOf([] { parsePosition("19I 316175 4904508"); }),
              testing::HasSubstr("not a position"));
}

TEST(CoordinateText, HasTheDigitsOfTheStep) {
  EXPECT_EQ(coordinateText(36.25, true, PositionFormat::decimal, 0.25), "36.25°N");
  EXPECT_EQ(coordinateText(-84.5, false, PositionFormat::decimal, 0.5), "84.5°W");
  EXPECT_EQ(coordinateText(-84, false, PositionFormat::mgrs, 1), "84°W");
  EXPECT_EQ(coordinateText(36.25, true, PositionFormat::dms, 0.25), "36°15'N");
  EXPECT_EQ(coordinateText(36, true, PositionFormat::dms, 1), "36°N");
  EXPECT_EQ(coordinateText(-0.0125, true, PositionFormat::dms, 1.0 / 240), "0°00'45\"S");
}

}  // namespace
}  // namespace emscape
