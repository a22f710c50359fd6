#include "scenario/map/places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using ::testing::HasSubstr;

constexpr const char* kPlaces = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"name": "harbour"},
   "geometry": {"type": "Point", "coordinates": [3.2, 51.3]}},
  {"type": "Feature", "properties": {"name": "route"},
   "geometry": {"type": "LineString", "coordinates": [[3.0, 51.0], [3.5, 51.5]]}},
  {"type": "Feature", "properties": {},
   "geometry": {"type": "MultiPolygon", "coordinates": [
     [[[3, 51], [4, 51], [4, 52], [3, 51]]], [[[5, 51], [6, 51], [6, 52], [5, 51]]]]}},
  {"type": "Feature", "properties": {"name": "nowhere"}, "geometry": null}]})";

TEST(Places, PointsLinesAndAreasAreReadWithTheirNames) {
  const test::TemporaryFolder folder;
  const std::vector<Place> places = readPlaces(folder.write("places.geojson", kPlaces));
  ASSERT_EQ(places.size(), 4U);
  EXPECT_EQ(places[0].kind, Place::Kind::point);
  EXPECT_EQ(places[0].name, "harbour");
  EXPECT_DOUBLE_EQ(places[0].parts[0][0].latitude_deg, 51.3);
  EXPECT_DOUBLE_EQ(places[0].parts[0][0].longitude_deg, 3.2);
  EXPECT_EQ(places[1].kind, Place::Kind::line);
  EXPECT_EQ(places[1].parts[0].size(), 2U);
  for (const Place* area : {&places[2], &places[3]}) {
    EXPECT_EQ(area->kind, Place::Kind::area);
    EXPECT_EQ(area->name, "");
    EXPECT_EQ(area->parts[0].size(), 4U);
  }
}

TEST(Places, FaultsNameTheFile) {
  const test::TemporaryFolder folder;
  const auto faultOf = [](const std::string& file) {
    return test::errorOf([&] { readPlaces(file); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(faultOf(folder / "missing.geojson"), HasSubstr("missing.geojson: no such file"));
  EXPECT_THAT(faultOf(folder.write("text.geojson", "no places")), HasSubstr("text.geojson"));
  EXPECT_THAT(faultOf(folder.write("far.geojson", R"({"type": "Point", "coordinates": [1000, 51]})")),
              HasSubstr("outside the allowed range"));
  for (const char* const content :
       {"a,b\n1,2\n", "Breite;Laenge\n44,3;-71,6\n", "latitude_deg,longitude_deg\n"})
    EXPECT_THAT(faultOf(folder.write("table.csv", content)), HasSubstr("has no place: ")) << content;
  EXPECT_THAT(faultOf(folder.write("none.geojson", R"({"type": "FeatureCollection", "features": []})")),
              HasSubstr("none.geojson: has no place: features need points, lines or areas"));
  EXPECT_THAT(faultOf("/vsicurl/http://127.0.0.1:1/places.geojson"), HasSubstr("no such file"));
}

}  // namespace
}  // namespace emscape::scenario
