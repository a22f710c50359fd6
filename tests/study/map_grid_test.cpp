#include "emscape/study/maps/map_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <GeographicLib/UTMUPS.hpp>
#include <cmath>
#include <numeric>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/units.h"
#include "tests/support/errors.h"

namespace emscape::study {
namespace {

using ::testing::HasSubstr;

struct GeographicPoint {
  double latitude_deg, longitude_deg;
};

/// Compares every n-th pixel with GeographicLib's projection. @return the number compared
int expectPositionsOfUtm(const GeographicPoint& middle, double radius_m, double cell_m, int every) {
  const auto [latitude_deg, longitude_deg] = middle;
  const MapGrid grid = makeMapGrid(circularArea({latitude_deg, longitude_deg, radius_m}), cell_m, "utm");
  const int zone = GeographicLib::UTMUPS::StandardZone(latitude_deg, longitude_deg);
  EXPECT_EQ(grid.crs, "EPSG:" + std::to_string((latitude_deg < 0 ? 32700 : 32600) + zone));
  EXPECT_EQ(std::fmod(grid.left_m, cell_m), 0);
  EXPECT_EQ(std::fmod(grid.top_m, cell_m), 0);
  int inside = 0;
  for (int p = 0; p < static_cast<int>(grid.pixels()); p += every) {
    const auto [lat, lon] = grid.positions[p];
    if (std::isnan(lat)) continue;
    ++inside;
    int found_zone = 0;
    bool is_north = false;
    double x = 0, y = 0;
    GeographicLib::UTMUPS::Forward(lat, lon, found_zone, is_north, x, y, zone);
    if (latitude_deg < 0 && is_north) y += 10e6;
    if (latitude_deg > 0 && !is_north) y -= 10e6;
    EXPECT_NEAR(x, grid.left_m + (p % grid.width + 0.5) * cell_m, 0.001);
    EXPECT_NEAR(y, grid.top_m - (p / grid.width + 0.5) * cell_m, 0.001);
  }
  return inside;
}

TEST(MapGrid, PixelsOfUtmAreWhereTheProjectionPutsThem) {
  for (const GeographicPoint& middle :
       {GeographicPoint{44.3, -71.4}, {-33.9, 151.2}, {0.01, 2.99}, {79.5, 17}, {60.4, 5.3}, {78.5, 11}}) {
    EXPECT_GT(expectPositionsOfUtm(middle, 20e3, 90, 37), 3000);
    EXPECT_GT(expectPositionsOfUtm(middle, 100e3, 700, 13), 3000);
    EXPECT_GT(expectPositionsOfUtm(middle, 100e3, 2000, 1), 3000);
  }
}

TEST(MapGrid, ACirclesPixelsHaveItsArea) {
  constexpr double kRadius_m = 30e3;
  for (const char* crs : {"utm", "local"}) {
    const MapGrid grid = makeMapGrid(circularArea({61.2, 20.9, kRadius_m}), 60, crs);
    const double area_m2 = std::accumulate(grid.areas_m2.begin(), grid.areas_m2.end(), 0.0);
    EXPECT_NEAR(area_m2 / (kPi * kRadius_m * kRadius_m), 1, 2e-4) << crs;
  }
}

TEST(MapGrid, ACircleMayHoldAPole) {
  constexpr double kRadius_m = 20e3;
  for (const double latitude_deg : {89.97, -89.97, 90.0, 89.0}) {
    SCOPED_TRACE(latitude_deg);
    const MapGrid grid = makeMapGrid(circularArea({latitude_deg, 10, kRadius_m}), 100, "local");
    const double area_m2 = std::accumulate(grid.areas_m2.begin(), grid.areas_m2.end(), 0.0);
    EXPECT_NEAR(area_m2 / (kPi * kRadius_m * kRadius_m), 1, 3e-4);
    for (std::size_t p = 0; p < grid.pixels(); p += 7) {
      const auto [lat, lon] = grid.positions[p];
      if (std::isnan(lat)) continue;
      const double x = grid.left_m + (static_cast<double>(p % grid.width) + 0.5) * grid.cell_m;
      const double y = grid.top_m - (static_cast<double>(p / grid.width) + 0.5) * grid.cell_m;
      ASSERT_NEAR(geodesicInverse(latitude_deg, 10, lat, lon).distance_m, std::hypot(x, y), 0.001);
    }
  }
}

TEST(MapGrid, ARegionWithAPoleIsCoveredWholly) {
  scenario::Region region;
  region.origin = {FrameKind::altitude, 89.95, 30, 0};
  region.size_m = {40e3, 40e3, 1000};
  const MapGrid grid = makeMapGrid(areaOf(region), 500, "local");
  const GeoFrame frame(region.origin);
  for (double x = -19.9e3; x < 20e3; x += 1990) {
    for (double y = -19.9e3; y < 20e3; y += 1990) {
      const GeodeticPosition at = frame.toGeodetic({x, y, 0});
      const long long pixel = grid.pixelAt(at.latitude_deg, at.longitude_deg);
      ASSERT_GE(pixel, 0);
      EXPECT_FALSE(std::isnan(grid.positions[static_cast<std::size_t>(pixel)].latitude_deg))
          << x << ", " << y;
    }
  }
}

TEST(MapGrid, ABoxMayCrossTheAntimeridian) {
  MapArea area;
  area.box = {-17.2, -17.0, 179.9, 180.2};
  const MapGrid grid = makeMapGrid(area, 500, "local");
  int west = 0, east = 0;
  for (const auto& [latitude_deg, longitude_deg] : grid.positions) {
    if (std::isnan(latitude_deg)) continue;
    ASSERT_TRUE(longitude_deg >= 179.9 - 1e-6 || longitude_deg <= -179.8 + 1e-6) << longitude_deg;
    ++(longitude_deg > 0 ? west : east);
  }
  EXPECT_GT(west, 500);
  EXPECT_GT(east, 1000);
  EXPECT_GE(grid.pixelAt(-17.1, 179.95), 0);
  EXPECT_GE(grid.pixelAt(-17.1, -179.95), 0);
  EXPECT_EQ(grid.pixelAt(-17.1, 178), -1);
}

TEST(MapGrid, RefusesProjectionsThatAreCutWithinTheArea) {
  const auto messageOf = [](double longitude_deg, const char* crs) {
    return test::errorOf([&] { makeMapGrid(circularArea({-17, longitude_deg, 10e3}), 500, crs); });
  };
  EXPECT_THAT(messageOf(179.96, "EPSG:3857"), HasSubstr("'EPSG:3857' is cut within the area"));
  EXPECT_THAT(messageOf(-179.99, "EPSG:3395"), HasSubstr("40074 km apart"));
  EXPECT_NO_THROW(makeMapGrid(circularArea({-17, 179.9, 10e3}), 500, "EPSG:3857"));
  EXPECT_NO_THROW(makeMapGrid(circularArea({-17, 179.96, 10e3}), 500, "EPSG:3832"));
  MapArea earth;
  earth.box = {-70, 70, -180, 180};
  EXPECT_EQ(makeMapGrid(earth, 100e3, "EPSG:3857").width, 402);
}

TEST(MapGrid, RefusesInvalidAreas) {
  const MapArea area = circularArea({44, -71, 10e3});
  EXPECT_THAT(test::errorOf([&] { makeMapGrid(area, 100, "EPSG:4326"); }),
              HasSubstr("not a projection in metres"));
  EXPECT_THAT(test::errorOf([&] { makeMapGrid(area, 100, "EPSG:99999"); }), HasSubstr("EPSG:NUMBER"));
  EXPECT_THAT(test::errorOf([&] { makeMapGrid(area, 100, "mercator"); }), HasSubstr("'mercator'"));
  EXPECT_THAT(test::errorOf([&] { makeMapGrid(area, 0, "utm"); }), HasSubstr("positive"));
  EXPECT_THAT(test::errorOf([&] { makeMapGrid(area, 0.5, "utm"); }), HasSubstr("larger cell"));
  EXPECT_THAT(test::errorOf([&] {
                makeMapGrid(circularArea({88, 0, 40e3}), 20, "EPSG:3413");
              }),
              HasSubstr("beyond 85 degrees of latitude has more than 16777216: a larger cell"));
  EXPECT_THAT(test::errorOf([&] { circularArea({91, 0, 1e3}); }), HasSubstr("-90..90"));
  EXPECT_THAT(test::errorOf([&] { circularArea({1, 0, 1e7}); }), HasSubstr("2000000"));
}

TEST(MapGrid, HoldsTheWholeAreaOrIsRefused) {
  constexpr double kEarth_km2 = 5.1006e8;
  int covered = 0;
  for (const double latitude_deg : {40.0, 60.0, 80.0}) {
    for (const double west_deg : {-180.0, -90.0, 20.0}) {
      const MapArea area{{-latitude_deg, latitude_deg, west_deg, west_deg + 360}, {}};
      const double asked_km2 = kEarth_km2 * std::sin(degToRad(latitude_deg));
      for (const char* crs : {"utm", "local", "EPSG:6933", "EPSG:3395"}) {
        try {
          const MapGrid grid = makeMapGrid(area, 100e3, crs);
          const double found_km2 = std::accumulate(grid.areas_m2.begin(), grid.areas_m2.end(), 0.0) / 1e6;
          EXPECT_NEAR(found_km2 / asked_km2, 1, 0.1) << crs << " " << latitude_deg << " " << west_deg;
          ++covered;
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::usage);
        }
      }
    }
  }
  EXPECT_GE(covered, 5);
}

TEST(MapGrid, RemedyForAnAreaThatIsNotHeldHoldsIt) {
  const MapArea area{{-80, 80, -180, 180}, {}};
  EXPECT_THAT(test::errorOf([&] { makeMapGrid(area, 100e3, "utm"); }, ErrorCode::usage),
              HasSubstr("EPSG:3395 holds all longitudes"));
  EXPECT_GT(makeMapGrid(area, 100e3, "EPSG:3395").pixels(), 40000u);
}

}  // namespace
}  // namespace emscape::study
