// Files from which a study's points and polygons are read.
#include "study/sweep/definition/candidate_sites.h"

#include <cpl_conv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "base/geodesy/gdal_file.h"
#include "emscape/base/log.h"
#include "tests/support/errors.h"
#include "tests/support/listener.h"
#include "tests/support/temporary_folder.h"

namespace emscape::study {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(CandidateSites, AreNotReadFromTheNetwork) {
  const test::TemporaryFolder folder;
  const test::Listener listener;
  CPLSetThreadLocalConfigOption("GDAL_HTTP_TIMEOUT", "1");  // limits the wait if the test fails
  const std::string gml = folder.write("a.gml", R"(<?xml version="1.0" encoding="utf-8"?>
<wfs:FeatureCollection xmlns:wfs="http://www.opengis.net/wfs" xmlns:gml="http://www.opengis.net/gml"
xmlns:a="http://a/" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation="http://a/ )" +
                                                    listener.url() +
                                                    R"(wfs?SERVICE=WFS&amp;VERSION=1.0.0&amp;)"
                                                    R"(REQUEST=DescribeFeatureType&amp;TYPENAME=a:p">
<gml:featureMember><a:p fid="1"><a:name>hill</a:name><a:g><gml:Point srsName="EPSG:4326">
<gml:coordinates>5,52</gml:coordinates></gml:Point></a:g></a:p></gml:featureMember>
</wfs:FeatureCollection>)");
  const std::string geojson = folder.write(
      "a.geojson", R"({"type": "FeatureCollection", "crs": {"type": "link", "properties": {"href": ")" +
                       listener.url() + R"(crs.wkt", "type": "ogcwkt"}}, "features": [{"type": "Feature",
"properties": {"name": "hill"}, "geometry": {"type": "Point", "coordinates": [5, 52]}}]})");
  const std::vector<CandidateSite> sites = readCandidates(gml);
  ASSERT_EQ(sites.size(), 1u);
  EXPECT_EQ(sites[0].name, "hill");
  EXPECT_FALSE(listener.wasReached());
  EXPECT_THAT(test::errorOf([&] { readCandidates(geojson); }), HasSubstr("cannot be read completely"))
      << "its coordinate system is not known";
  EXPECT_FALSE(listener.wasReached());
  for (const std::string& name : {"/vsicurl/" + listener.url() + "a.geojson", listener.url() + "a.geojson"}) {
    EXPECT_THAT(test::errorOf([&] { readCandidates(name); }), HasSubstr("no such file"));
    EXPECT_FALSE(listener.wasReached()) << name;
  }
}

TEST(CandidateSites, HaveOnePositionEach) {
  const test::TemporaryFolder folder;
  const auto sitesOf = [&](const std::string& wkt) {
    return readCandidates(folder.write("a.csv", "WKT,name\n\"POINT (5 52)\",a\n\"" + wkt + "\",b\n"));
  };
  const auto sites = sitesOf("MULTIPOINT ((5.5 52.5))");
  ASSERT_EQ(sites.size(), 2u);
  EXPECT_EQ(sites[1].longitude_deg, 5.5);
  EXPECT_THAT(test::errorOf([&] { sitesOf("POINT EMPTY"); }),
              HasSubstr("a.csv: point 2 is empty: it has no coordinates"));
  EXPECT_THAT(
      test::errorOf([&] { sitesOf("POINT (400 46)"); }),
      HasSubstr("point 2 is at longitude 400, latitude 46, outside the allowed range -180 to 360, -90 to "
                "90"));
  EXPECT_THAT(test::errorOf([&] { sitesOf("MULTIPOINT ((5 52), (5.1 52))"); }),
              HasSubstr("point 2 is a multipoint of 2 places"));
}

TEST(CandidateSites, WithoutANameAreNumbered) {
  const test::TemporaryFolder folder;
  const auto sites = readCandidates(
      folder.write("a.csv", "WKT,name\nPOINT (5 52),\nPOINT (5.1 52),hill\nPOINT (5.2 52),\n"));
  ASSERT_EQ(sites.size(), 3u);
  EXPECT_EQ(sites[0].name, "site 1");
  EXPECT_EQ(sites[2].name, "site 3");
}

TEST(CandidateSites, TablesOfLatitudesAndLongitudesNeedNoWkt) {
  const test::TemporaryFolder folder;
  int files = 0;
  for (const char* text :
       {"name,latitude_deg,longitude_deg\nhill,52.5,5.25\n",
        "\xEF\xBB\xBFlongitude_deg,owner,latitude_deg,mast_m,name\r\n5.25,\"A, B\",52.5,30,hill\r\n",
        "Name;Latitude;Longitude\nhill;52,5;5,25\n", "lat\tlon\tname\n52.5\t5.25\thill\n",
        "name,lat,lon\nhill,\"52,5\",\"5,25\"\n"}) {
    const auto sites = readCandidates(folder.write("a" + std::to_string(++files) + ".csv", text));
    ASSERT_EQ(sites.size(), 1u) << text;
    EXPECT_EQ(sites[0].name, "hill") << text;
    EXPECT_EQ(sites[0].latitude_deg, 52.5) << text;
    EXPECT_EQ(sites[0].longitude_deg, 5.25) << text;
  }
  const auto unnamed = readCandidates(folder.write("b.csv", "latitude_deg,longitude_deg\n52,5\n52,6\n"));
  ASSERT_EQ(unnamed.size(), 2u);
  EXPECT_EQ(unnamed[1].name, "site 2");
}

TEST(CandidateSites, CoordinatesOfATableMayBeTexts) {
  const test::TemporaryFolder folder;
  int files = 0;
  for (const char* text :
       {"name;lat;lon\nhill;36°30'36\"N;84°12'00\"W\n", "name,lat,lon\nhill,36 30 36,-84 12 0\n",
        "name,lat,lon\nhill,N36 30.6,W84 12.0\n", "name,lat,lon\nhill,36.51,275.8\n",
        "name,lat,lon\nhill,\"36°30'36\"N\",\"84°12'00\"W\"\n", "name,lat,NS,lon,EW\nhill,36.51,N,84.2,W\n",
        "sep=;\nname;lat;lon\nhill;36,51;-84,2\n", "name,lat,lon\nhill,36 30.6 N,84 12.0 W\n",
        "name,Latitude (DMS),Longitude (DMS)\nhill,36d30'36\"N,84d12'0\"W\n",
        "name,lat,lon\nhill,\"36°30'36\"\"N\",\"84°12'00\"\"W\"\n", "name,mgrs\nhill,16S GF 50751 44164\n",
        "name,MGRS\nhill,16SGF5075144164\n", "name;utm\nhill;16n 750751 4044164\n",
        "name,coordinates\nhill,\"36.51, -84.2\"\n"}) {
    const auto sites = readCandidates(folder.write("a" + std::to_string(++files) + ".csv", text));
    ASSERT_EQ(sites.size(), 1u) << text;
    EXPECT_NEAR(sites[0].latitude_deg, 36.51, 2e-5) << text;
    EXPECT_NEAR(sites[0].longitude_deg, -84.2, 2e-5) << text;
  }
}

std::string warningsOf(const std::function<void()>& call) {
  std::string warnings;
  setLogSink([&](LogLevel level, const std::string& message) {
    if (level == LogLevel::warning) warnings += message;
  });
  call();
  setLogSink({});
  return warnings;
}

TEST(CandidateSites, FieldsAndFeaturesOfVectorFilesThatAreNotUsedAreTold) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("a.geojson", R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"name": "hill", "Hoehe_m": 60}, "geometry": {"type": "Point", "coordinates": [5, 52]}},
    {"type": "Feature", "properties": {"name": "lost", "Hoehe_m": null}, "geometry": null}]})");
  const std::string warnings = warningsOf([&] { EXPECT_EQ(readCandidates(file).size(), 1u); });
  EXPECT_THAT(warnings, HasSubstr("not used: column 'Hoehe_m'; each site has the height of its platform"));
  EXPECT_THAT(warnings, HasSubstr("1 of 2 features have no point and are left out"));
}

TEST(CandidateSites, ColumnsOfATableThatAreNotUsedAreNamedInAWarning) {
  const test::TemporaryFolder folder;
  const std::string warnings =
      warningsOf([&] { readCandidates(folder.write("a.csv", "name,lat,lon,mast\nhill,52,5,60\n")); });
  EXPECT_THAT(warnings, HasSubstr("not used: column 'mast'; each site has the height of its platform"));
  EXPECT_THAT(warnings, HasSubstr("height_agl_m"));
}

// A comma may be decimal or between thousands: without another number it is not known.
TEST(CandidateSites, CommasInNumbersOfATableThatAreUnclearAreTold) {
  const test::TemporaryFolder folder;
  const std::string header = "name,mgrs,height_msl_m\n", hill = "hill,16SGF5075144164,";
  const auto readTable = [&](const std::string& text) { return readCandidates(folder.write("a.csv", text)); };
  for (const std::string& text : std::vector<std::string>{
           header + hill + "\"1,050\"\n", "name;mgrs;height_msl_m\nhill;16SGF5075144164;1,050\n",
           "name,lat,lon,height_msl_m\nhill,36,-84,\"1,050\"\n"}) {
    EXPECT_THAT(test::errorOf([&, &of = text] { readTable(of); }, ErrorCode::bad_input),
                HasSubstr("'1,050': is its comma decimal, or between thousands?"))
        << text;
  }
  EXPECT_EQ(readTable(header + hill + "1050\n").front().height->height_m, 1050) << "as the message says";
  EXPECT_EQ(readTable("name;lat;lon;height_msl_m\nhill;36,51;-84,2;1,050\n").front().height->height_m, 1.05)
      << "others have decimal commas";
}

TEST(CandidateSites, MinutesInAColumnOfTheirOwnAreRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(
      test::errorOf([&] {
        readCandidates(folder.write("a.csv", "name,lat_deg,lat_min,lon_deg,lon_min\nA,43,45.5,-71,12\n"));
      }),
      HasSubstr("a.csv:1:14: 'lat_min' is a part of a position"));
}

TEST(CandidateSites, HeightsAreThoseOfAColumnThatStatesItsReference) {
  const test::TemporaryFolder folder;
  std::vector<CandidateSite> sites;
  const std::string warnings = warningsOf([&] {
    sites = readCandidates(folder.write("a.csv", "name,lat,lon,height_agl_m\nhill,52,5,60\nflat,52.1,5,\n"));
  });
  EXPECT_EQ(warnings, "");
  ASSERT_TRUE(sites[0].height);
  EXPECT_STREQ(sites[0].height->key(), "height_agl_m");
  EXPECT_EQ(sites[0].height->height_m, 60);
  EXPECT_FALSE(sites[1].height) << "an empty cell: that of the platform";
  sites = readCandidates(folder.write(
      "a.geojson", R"({"type": "Feature", "properties": {"height_msl_m": 120.5}, "geometry": {"type": "Point",
"coordinates": [5, 52]}})"));
  ASSERT_TRUE(sites[0].height);
  EXPECT_STREQ(sites[0].height->key(), "height_msl_m");
  EXPECT_EQ(sites[0].height->height_m, 120.5);
}

TEST(CandidateSites, HeightsThatContradictEachOtherAreRefused) {
  const test::TemporaryFolder folder;
  const auto table = [&](const std::string& rows) {
    return folder.write("a.csv", "name,lat,lon,height_msl_m,height_ellipsoid_m\n" + rows);
  };
  // The geoid is about 43 m above the ellipsoid there.
  std::vector<CandidateSite> sites;
  const std::string warnings =
      warningsOf([&] { sites = readCandidates(table("hill,52,5,60,103\nflat,52,5.1,20,\n")); });
  EXPECT_EQ(sites.at(0).height->height_m, 60);
  EXPECT_EQ(warnings, "") << "the other height was compared";
  EXPECT_THAT(
      test::errorOf([&] { readCandidates(table("hill,52,5,60,103\nflat,52,5.1,20,20\n")); }),
      HasSubstr("a.csv:3:16: height_msl_m is 20 and height_ellipsoid_m 20; mean sea level is 43 m above "
                "the ellipsoid there"));
  const std::string geojson = folder.write(
      "a.geojson", R"({"type": "Feature", "properties": {"height_msl_m": 120, "height_ellipsoid_m": 120},
"geometry": {"type": "Point", "coordinates": [5, 52]}})");
  EXPECT_THAT(
      test::errorOf([&] { readCandidates(geojson); }),
      HasSubstr("a.geojson: point 1 contradicts itself: height_msl_m is 120 and height_ellipsoid_m 120"));
}

/// A file of one vector format with a point named hill at 52.5 N 5.25 W; in a .zip if its name says so.
std::string pointFile(const test::TemporaryFolder& folder, const char* driver, const std::string& name) {
  gdal::prepare();
  const std::string file = folder / name;
  const gdal::Dataset dataset(
      GDALCreate(GDALGetDriverByName(driver), file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (dataset == nullptr) return "";
  gdal::SpatialReference wgs84(OSRNewSpatialReference(nullptr));
  OSRImportFromEPSG(wgs84.get(), 4326);
  OSRSetAxisMappingStrategy(wgs84.get(), OAMS_TRADITIONAL_GIS_ORDER);
  const OGRLayerH layer = GDALDatasetCreateLayer(dataset.get(), "sites", wgs84.get(), wkbPoint, nullptr);
  const OGRFieldDefnH field = OGR_Fld_Create("name", OFTString);
  OGR_L_CreateField(layer, field, 1);
  OGR_Fld_Destroy(field);
  const OGRFeatureH feature = OGR_F_Create(OGR_L_GetLayerDefn(layer));
  OGR_F_SetFieldString(feature, OGR_F_GetFieldIndex(feature, "name"), "hill");
  const OGRGeometryH point = OGR_G_CreateGeometry(wkbPoint);
  OGR_G_SetPoint_2D(point, 0, -5.25, 52.5);
  OGR_F_SetGeometry(feature, point);
  OGR_G_DestroyGeometry(point);
  OGR_L_CreateFeature(layer, feature);
  OGR_F_Destroy(feature);
  return file;
}

TEST(CandidateSites, AreReadFromArchivesAndWaypoints) {
  const test::TemporaryFolder folder;
  // GDAL writes a shapefile into an archive by its name.
  const std::string kmz = pointFile(folder, "LIBKML", "a.kmz");
  const std::string shapes = pointFile(folder, "ESRI Shapefile", "a.shp.zip");
  const std::string gpx = folder.write(
      "a.gpx",
      "<gpx version=\"1.1\" creator=\"t\" xmlns=\"http://www.topografix.com/GPX/1/1\"><wpt lat=\"52.5\" "
      "lon=\"-5.25\"><ele>31</ele><name>hill</name></wpt><trk><trkseg><trkpt lat=\"51\" lon=\"-5\"/><trkpt "
      "lat=\"51.1\" lon=\"-5\"/></trkseg></trk></gpx>");
  for (const std::string& file : {kmz, shapes, gpx}) {
    std::vector<CandidateSite> sites;
    const std::string warnings = warningsOf([&] { sites = readCandidates(file); });
    ASSERT_EQ(sites.size(), 1u) << file;
    EXPECT_EQ(sites[0].name, "hill") << file;
    EXPECT_NEAR(sites[0].latitude_deg, 52.5, 1e-9) << file;
    EXPECT_NEAR(sites[0].longitude_deg, -5.25, 1e-9) << file;
    if (file == gpx)
      EXPECT_THAT(warnings, HasSubstr("not used: the heights of the points; each site has the height of"));
    else
      EXPECT_EQ(warnings, "") << file;
  }
}

TEST(CandidateSites, OfAnArchiveNeedOneFile) {
  const test::TemporaryFolder folder;
  const auto faultOf = [&](const std::string& file) {
    return test::errorOf([&] { readCandidates(file); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(faultOf(folder.write("a.zip", "no archive")),
              HasSubstr("a.zip: cannot be read as a ZIP archive"));
  EXPECT_THAT(faultOf(folder / "missing.zip"), HasSubstr("no such file"));
}

TEST(CandidateSites, UnreadableCellOfATableIsNamedByItsPlace) {
  const test::TemporaryFolder folder;
  const auto faultOf = [&](const std::string& rows) {
    return test::errorOf(
        [&] { readCandidates(folder.write("a.csv", "latitude_deg,longitude_deg\n" + rows)); });
  };
  EXPECT_THAT(
      faultOf("52,5\n52.1,east\n"),
      HasSubstr("a.csv:3:6: the longitude is 'east', not a number of degrees or such as 84°12'00\"W"));
  EXPECT_THAT(faultOf("520,5\n"), HasSubstr("a.csv:2:1: the latitude is 520; allowed are -90 to 90 deg"));
  EXPECT_THAT(faultOf("52,5,7\n"), HasSubstr("3 values, but the header names 2 columns"));
}

TEST(CandidateSites, NumberOutsideLimitsIsRefused) {
  const test::TemporaryFolder folder;
  std::string points = "WKT,name\n";
  for (int n = 0; n <= 10000; ++n) points += "POINT (5 52),\n";
  const std::string many = test::errorOf([&] { readCandidates(folder.write("many.csv", points)); });
  EXPECT_THAT(many, HasSubstr("10001 points, outside the allowed range 1 to 10000"));
  EXPECT_THAT(many, Not(HasSubstr("WKT")));
  EXPECT_THAT(
      test::errorOf([&] { readCandidates(folder.write("none.csv", "WKT,name\n")); }),
      HasSubstr(
          "0 points, outside the allowed range 1 to 10000; a CSV file needs the columns latitude_deg and "
          "longitude_deg, or mgrs, or WKT"));
}

TEST(CandidateSites, UnreadablePointIsAnError) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::errorOf([&] {
                readCandidates(folder.write("a.csv", "WKT,name\n\"POINT (5 52)\",a\n\"POINT(\",b\n"));
              }),
              HasSubstr("a.csv: the WKT of row 2 after the header is not a geometry: 'POINT('"));
  EXPECT_THAT(test::errorOf([&] {
                readCandidates(folder.write(
                    "a.geojson", R"({"type": "Feature", "properties": {}, "geometry": {"type": "Point",
"coordinates": ["10.02", 46]}})"));
              }),
              HasSubstr("Invalid 'x' coordinate"));
}

TEST(CandidateSites, UnreadablePointInAnyWktColumnIsAnError) {
  const test::TemporaryFolder folder;
  const std::string rows = "a,\"POINT (5 52)\"\nb,\"POINT (5.1\"\nc,\"POINT (5.2 52)\"\n";
  folder.write("typed.csvt", "String,WKT\n");
  for (const auto& [file, column] :
       {std::pair{"named.csv", "_WKTpt"}, {"lower.csv", "_wkt"}, {"typed.csv", "geom_shape"}}) {
    const std::string points = folder.write(file, "name," + std::string(column) + "\n" + rows);
    EXPECT_THAT(test::errorOf([&] { readCandidates(points); }),
                HasSubstr(file + std::string(": the ") + column +
                          " of row 2 after the header is not a geometry: 'POINT (5.1'"));
  }
}

TEST(CandidateSites, AreReadFromFormatsThatNameNoOtherFile) {
  const test::TemporaryFolder folder;
  folder.write("other.csv", "name,X,Y\nhill,5,52\n");
  const std::string vrt =
      folder.write("a.vrt", "<OGRVRTDataSource><OGRVRTLayer name=\"other\"><SrcDataSource>" +
                                folder / "other.csv" + "</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>");
  EXPECT_THAT(test::errorOf([&] { readCandidates(vrt); }),
              HasSubstr("not a file of points or polygons that can be read"));
  EXPECT_THAT(test::errorOf([&] { readCandidates(folder.path()); }), HasSubstr("not a regular file"));
}

TEST(CandidateSites, AViewOfAGeoPackageIsRefused) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "a.gpkg";
  gdal::prepare();
  {
    const gdal::Dataset dataset(
        GDALCreate(GDALGetDriverByName("GPKG"), file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    ASSERT_NE(dataset, nullptr);
    for (const char* statement :
         {"CREATE VIEW endless AS WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c) SELECT n "
          "AS "
          "fid, NULL AS geom FROM c",
          "INSERT INTO gpkg_contents (table_name, data_type, identifier, srs_id) VALUES ('endless', "
          "'features', "
          "'endless', 4326)",
          "INSERT INTO gpkg_geometry_columns VALUES ('endless', 'geom', 'POINT', 4326, 0, 0)"}) {
      GDALDatasetReleaseResultSet(dataset.get(),
                                  GDALDatasetExecuteSQL(dataset.get(), statement, nullptr, nullptr));
    }
  }
  EXPECT_THAT(test::errorOf([&] { readCandidates(file); }),
              HasSubstr("layer 'endless' is a view (SQL), which is not read; export it as a table"));
}

}  // namespace
}  // namespace emscape::study
