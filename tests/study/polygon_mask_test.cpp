// Pixels within the polygons of a file.
#include "study/sweep/definition/polygon_mask.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "emscape/study/maps/area.h"
#include "tests/study/converted_vectors.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::study {
namespace {

using testing::HasSubstr;

class PolygonMask : public testing::Test {
 protected:
  std::string geojson(const std::string& coordinates, const std::string& crs = "") {
    const std::string member =
        crs.empty() ? "" : R"("crs": {"type": "name", "properties": {"name": ")" + crs + R"("}}, )";
    return folder_.write("p" + std::to_string(++files_) + ".geojson",
                         R"({"type": "FeatureCollection", )" + member +
                             R"("features": [{"type": "Feature", "properties": {}, "geometry": )"
                             R"({"type": "Polygon", "coordinates": )" +
                             coordinates + "}}]}");
  }
  std::string csv(const std::string& wkt) {
    return folder_.write("p" + std::to_string(++files_) + ".csv", "WKT,name\n\"" + wkt + "\",a\n");
  }
  static std::ptrdiff_t count(const std::vector<std::uint8_t>& pixels) {
    return std::count(pixels.begin(), pixels.end(), 1);
  }
  static std::ptrdiff_t inArea(const MapGrid& grid) {
    return std::count_if(grid.positions.begin(), grid.positions.end(),
                         [](const auto& place) { return !std::isnan(place.latitude_deg); });
  }
  static std::string problemOf(const std::string& file, const MapGrid& grid) {
    return test::errorOf([&] { pixelsWithin(file, grid); }, ErrorCode::bad_input);
  }

  test::TemporaryFolder folder_;
  int files_ = 0;
  const MapGrid grid_ = makeMapGrid(parseArea("bbox:4.9,51.9,5.1,52.1"), 200, "utm");
};

TEST_F(PolygonMask, EdgesAreStraightInTheFilesOwnSystem) {
  const std::string sparse = geojson("[[[-120, 52], [50, 52], [50, 53], [-120, 53], [-120, 52]]]");
  std::string dense = "[[";
  for (int i = 0; i <= 1700; ++i) dense += "[" + std::to_string(-120 + 0.1 * i) + ", 52], ";
  dense += "[50, 53], [-120, 53], [-120, 52]]]";
  const auto pixels = pixelsWithin(sparse, grid_);
  EXPECT_EQ(pixels, pixelsWithin(geojson(dense), grid_));
  for (std::size_t p = 0; p < pixels.size(); ++p)
    EXPECT_EQ(pixels[p] == 1, grid_.positions[p].latitude_deg >= 52);
}

TEST_F(PolygonMask, APolygonAroundTheMapHoldsAllOfIt) {
  for (const char* box : {"[[[-30, 46], [40, 46], [40, 60], [-30, 60], [-30, 46]]]",
                          "[[[-80, -90], [80, -90], [80, 90], [-80, 90], [-80, -90]]]"})
    EXPECT_EQ(count(pixelsWithin(geojson(box), grid_)), inArea(grid_)) << box;
}

TEST_F(PolygonMask, HolesAndCrossedEdgesCountByTheEvenOddRule) {
  const auto of = [&](const char* rings) { return count(pixelsWithin(geojson(rings), grid_)); };
  const auto whole = of("[[[4.95, 51.95], [5.05, 51.95], [5.05, 52.05], [4.95, 52.05]]]");
  const auto hole = of("[[[4.98, 51.98], [5.02, 51.98], [5.02, 52.02], [4.98, 52.02]]]");
  EXPECT_EQ(of("[[[4.95, 51.95], [5.05, 51.95], [5.05, 52.05], [4.95, 52.05]],"
               "[[4.98, 51.98], [5.02, 51.98], [5.02, 52.02], [4.98, 52.02]]]"),
            whole - hole);
  const auto bow_tie = of("[[[4.95, 51.95], [5.05, 52.05], [5.05, 51.95], [4.95, 52.05]]]");
  EXPECT_NEAR(double(bow_tie), double(whole) / 2, 0.02 * double(whole));
  // Overlapping polygons of one file join.
  EXPECT_EQ(
      count(pixelsWithin(csv("MULTIPOLYGON (((4.95 51.95, 5.05 51.95, 5.05 52.05, 4.95 52.05, 4.95 51.95)), "
                             "((4.98 51.98, 5.02 51.98, 5.02 52.02, 4.98 52.02, 4.98 51.98)))"),
                         grid_)),
      whole);
}

TEST_F(PolygonMask, AFileMayBeInAProjectionOrNameNoSystem) {
  const std::string utm =
      geojson("[[[632000, 5757000], [642000, 5757000], [642000, 5767000], [632000, 5767000]]]", "EPSG:32631");
  EXPECT_EQ(count(pixelsWithin(utm, grid_)), 50 * 50);
  EXPECT_EQ(pixelsWithin(csv("POLYGON ((4.95 51.95, 5.05 51.95, 5 52.05, 4.95 51.95))"), grid_),
            pixelsWithin(geojson("[[[4.95, 51.95], [5.05, 51.95], [5, 52.05]]]"), grid_));
  EXPECT_THAT(
      problemOf(csv("POLYGON ((630000 5755000, 640000 5755000, 640000 5765000, 630000 5755000))"), grid_),
      HasSubstr("(630000, 5755000), outside the allowed range -360 to 360, -90 to 90 of longitudes and "
                "latitudes: the file names no coordinate system"));
}

TEST_F(PolygonMask, ReadingLeavesNoFileBesideTheUsersFile) {
  const std::string gml = folder_.write(
      "p.gml",
      R"(<c xmlns:g="http://www.opengis.net/gml"><g:featureMember><p><shape><g:Polygon srsName="EPSG:4326">)"
      R"(<g:outerBoundaryIs><g:LinearRing><g:coordinates>4.95,51.95 5.05,51.95 5,52.05 4.95,51.95)"
      R"(</g:coordinates></g:LinearRing></g:outerBoundaryIs></g:Polygon></shape></p></g:featureMember></c>)");
  EXPECT_EQ(pixelsWithin(gml, grid_),
            pixelsWithin(geojson("[[[4.95, 51.95], [5.05, 51.95], [5, 52.05]]]"), grid_));
  EXPECT_THAT(folder_.files(), testing::ElementsAre("p.gml", "p1.geojson"));
}

TEST_F(PolygonMask, EdgesAlongAPoleMayBeLong) {
  EXPECT_EQ(
      count(pixelsWithin(geojson("[[[-180, -90], [180, -90], [180, 90], [-180, 90], [-180, -90]]]"), grid_)),
      inArea(grid_));
  const MapGrid south = makeMapGrid(parseArea("bbox:100,-80.1,100.2,-80"), 500, "utm");
  const auto antarctica = pixelsWithin(
      geojson("[[[180, -70], [180, -90], [-180, -90], [-180, -70], [-60, -70], [60, -70], [180, -70]]]"),
      south);
  EXPECT_EQ(count(antarctica), inArea(south));
  EXPECT_THAT(problemOf(geojson("[[[-180, -89], [180, -89], [180, 90], [-180, 90], [-180, -89]]]"), grid_),
              HasSubstr("from longitude -180 to 180 may lead either way around the earth"));
}

TEST_F(PolygonMask, AFileMayRoundTheUnitOfItsAngles) {
  const std::string box =
      geojson("[[[-180, 90], [-180, -60], [-60, -60], [60, -60], [180, -60], [180, 90], [-180, 90]]]");
  for (const std::string degree : {"0.0174532925199433", "0.0174532925", "0.017453293"}) {
    const std::string name = "degree_" + degree;
    const std::string file = folder_ / (name + ".shp");
    test::convertVectors(box, "ESRI Shapefile", file);
    folder_.write(
        name + ".prj",
        "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
        "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\"," +
            degree + "]]");
    EXPECT_EQ(count(pixelsWithin(file, grid_)), inArea(grid_)) << degree;
  }
}

TEST_F(PolygonMask, UnreadablePolygonIsAnError) {
  const std::string good = R"({"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
"coordinates": [[[4.95, 51.95], [5.05, 51.95], [5, 52.05], [4.95, 51.95]]]}})";
  std::string bad = good;
  bad.replace(bad.find("4.95"), 4, "\"4.95\"");
  for (const std::string& text :
       {R"({"type": "FeatureCollection", "features": [)" + good + ", " + bad + "]}", bad}) {
    EXPECT_THAT(
        problemOf(folder_.write("bad.geojson", text), grid_),
        testing::AllOf(HasSubstr("bad.geojson: cannot be read completely"), HasSubstr("Invalid 'x'")));
  }
  EXPECT_THAT(
      problemOf(folder_.write("bad.csv",
                              "WKT,name\n\"POLYGON ((4.95 51.95, 5.05 51.95, 5 52.05, 4.95 "
                              "51.95))\",a\n\"POLYGON ((4.95 51.95, 5\",b\n"),
                grid_),
      HasSubstr("bad.csv: the WKT of row 2 after the header is not a geometry: 'POLYGON ((4.95 51.95, 5'"));
  EXPECT_EQ(count(pixelsWithin(folder_.write("empty.csv",
                                             "WKT,name\n\"POLYGON ((4.95 51.95, 5.05 51.95, 5 52.05, "
                                             "4.95 51.95))\",a\n\"\",b\n"),
                               grid_)),
            count(pixelsWithin(geojson("[[[4.95, 51.95], [5.05, 51.95], [5, 52.05]]]"), grid_)));
}

TEST_F(PolygonMask, RingOfOnePointIsAnError) {
  const auto polygon = [](const std::string& coordinates) {
    return R"(<g:featureMember><p><shape><g:Polygon srsName="EPSG:4326"><g:outerBoundaryIs><g:LinearRing>)"
           "<g:coordinates>" +
           coordinates + "</g:coordinates></g:LinearRing></g:outerBoundaryIs></g:Polygon></shape></p>" +
           "</g:featureMember>";
  };
  const std::string good = "4.95,51.95 5.05,51.95 5,52.05 4.95,51.95";
  EXPECT_THAT(problemOf(folder_.write("two.gml", "<c xmlns:g=\"http://www.opengis.net/gml\">" +
                                                     polygon(good) + polygon("a b c") + "</c>"),
                        grid_),
              HasSubstr("two.gml: a ring of a polygon has 1 corner, but needs 3 or more"));
  EXPECT_THAT(problemOf(geojson("[[[4.95, 51.95], [5.05, 51.95], [4.95, 51.95]]]"), grid_),
              HasSubstr("a ring of a polygon has 2 corners, but needs 3 or more"));
}

TEST_F(PolygonMask, TruncatedFileIsRefusedInEachFormat) {
  const std::string source = geojson("[[[4.95, 51.95], [5.05, 51.95], [5, 52.05], [4.95, 51.95]]]");
  const auto expected = pixelsWithin(source, grid_);
  for (const auto& [driver, ending] : {std::pair{"ESRI Shapefile", "shp"},
                                       {"FlatGeobuf", "fgb"},
                                       {"GPKG", "gpkg"},
                                       {"GeoJSON", "geojson"},
                                       {"KML", "kml"},
                                       {"GML", "gml"}}) {
    const std::string file = folder_ / ("converted." + std::string(ending));
    test::convertVectors(source, driver, file);
    EXPECT_EQ(pixelsWithin(file, grid_), expected) << driver;
    std::filesystem::resize_file(file, std::filesystem::file_size(file) - 60);
    EXPECT_NE(problemOf(file, grid_), "") << driver;
  }
}

TEST_F(PolygonMask, LongitudesMayPass180) {
  const MapGrid fiji = makeMapGrid(parseArea("bbox:179.8,-17,-179.8,-16.6"), 500, "utm");
  const auto beyond =
      pixelsWithin(geojson("[[[179.9, -17], [180.1, -17], [180.1, -16.6], [179.9, -16.6]]]"), fiji);
  EXPECT_NEAR(double(count(beyond)), double(inArea(fiji)) / 2, 0.05 * double(fiji.pixels()));
  EXPECT_EQ(pixelsWithin(geojson("[[[-180.1, -17], [-179.9, -17], [-179.9, -16.6], [-180.1, -16.6]]]"), fiji),
            beyond);
  EXPECT_THAT(problemOf(geojson("[[[179.9, -17], [-179.9, -17], [-179.9, -16.6], [179.9, -16.6]]]"), fiji),
              HasSubstr("from longitude 179.9 to -179.9 may lead either way around the earth"));
}

TEST_F(PolygonMask, EmptyMaskIsAnError) {
  EXPECT_THAT(problemOf(geojson("[[[6, 52], [6.1, 52], [6, 52.1]]]"), grid_),
              HasSubstr("has no pixel of the map"));
  EXPECT_THAT(problemOf(csv("LINESTRING (4.95 51.95, 5.05 51.95)"), grid_), HasSubstr("has no polygon"));
}

}  // namespace
}  // namespace emscape::study
