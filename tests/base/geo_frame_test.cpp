#include "emscape/base/geodesy/geo_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "tests/support/errors.h"

namespace emscape {
namespace {

constexpr double kSemiMajor_m = 6378137.0;

/// A right angle of the meridian, WGS84 (m).
constexpr double kMeridianQuadrant_m = 10001965.7293;

const FrameOrigin kOrigins[] = {
    {FrameKind::altitude, 36.59, -84.25, 0}, {FrameKind::altitude, -45.0, 179.95, 500},
    {FrameKind::altitude, 89.9, 10, 0},      {FrameKind::altitude, -90.0, 0, 2800},
    {FrameKind::altitude, 0.0, 0.0, 0},      {FrameKind::enu, 36.59, -84.25, 300},
    {FrameKind::enu, -45.0, -179.95, 0},     {FrameKind::enu, 90.0, 0, 0},
    {FrameKind::enu, 0.0, 0.0, 10},
};

TEST(GeoFrame, ComesBackToTheSamePoint) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> across_m(-250e3, 250e3), up_m(-100, 20e3);
  for (const FrameOrigin& origin : kOrigins) {
    const GeoFrame frame(origin);
    for (int k = 0; k < 200; ++k) {
      const Vec3d local{across_m(random), across_m(random), up_m(random)};
      const Vec3d back = frame.toLocal(frame.toGeodetic(local));
      EXPECT_LT(length(back - local), 1e-5) << toString(origin.kind) << " at " << origin.latitude_deg;
    }
  }
}

TEST(GeoFrame, AltitudeKeepsDistanceAndAzimuthFromTheOrigin) {
  const GeoFrame frame({FrameKind::altitude, 36.59, -84.25, 0});
  const GeodeticPosition position = frame.toGeodetic({30000, 40000, 0});
  const GeodesicInverse inverse =
      geodesicInverse(36.59, -84.25, position.latitude_deg, position.longitude_deg);
  EXPECT_NEAR(inverse.distance_m, 50000, 1e-6);
  EXPECT_NEAR(inverse.azimuth_rad, std::atan2(3, 4), 1e-9);
}

TEST(GeoFrame, AltitudeCountsZFromMeanSeaLevelEverywhere) {
  const GeoFrame frame({FrameKind::altitude, 36.59, -84.25, 1000});
  for (const Vec3d& local : {Vec3d{0, 0, 0}, Vec3d{90e3, -20e3, 0}, Vec3d{-15e3, 60e3, 1234}}) {
    const GeodeticPosition position = frame.toGeodetic(local);
    EXPECT_NEAR(
        position.height_ellipsoid_m - geoidUndulation_m(position.latitude_deg, position.longitude_deg),
        local.z, 1e-9);
    EXPECT_EQ(frame.heightMsl_m(local), local.z);
  }
}

TEST(GeoFrame, EnuBeginsAtTheOriginsHeightAboveMeanSeaLevel) {
  const GeoFrame frame({FrameKind::enu, 36.59, -84.25, 300});
  const GeodeticPosition origin = frame.toGeodetic({0, 0, 0});
  EXPECT_NEAR(origin.latitude_deg, 36.59, 1e-12);
  EXPECT_NEAR(origin.longitude_deg, -84.25, 1e-12);
  EXPECT_NEAR(origin.height_ellipsoid_m, 300 + geoidUndulation_m(36.59, -84.25), 1e-8);
  EXPECT_NEAR(frame.heightMsl_m({0, 0, 0}), 300, 1e-8);
}

TEST(GeoFrame, TheEarthCurvesAwayBelowEnu) {
  const GeoFrame frame({FrameKind::enu, 0, 0, 0});
  const double distance_m = 100e3;
  const double undulation_m = geoidUndulation_m(0, 0);
  const GeodeticPosition position = frame.toGeodetic({distance_m, 0, 0});
  EXPECT_NEAR(position.height_ellipsoid_m, std::hypot(kSemiMajor_m + undulation_m, distance_m) - kSemiMajor_m,
              1e-6);
}

TEST(GeoFrame, EnuIsRigid) {
  const GeoFrame frame({FrameKind::enu, 51.2, 7.1, 120});
  const Vec3d a{1000, -20000, 300}, b{-45000, 8000, 9000};
  EXPECT_NEAR(length(toEcef(frame.toGeodetic(a)) - toEcef(frame.toGeodetic(b))), length(a - b), 1e-6);
}

TEST(GeoFrame, RejectsAnOriginOffTheEarth) {
  const auto make = [](double latitude_deg, double longitude_deg) {
    GeoFrame({FrameKind::altitude, latitude_deg, longitude_deg, 0});
  };
  EXPECT_THAT(test::errorOf([&] { make(91, 0); }, ErrorCode::bad_input),
              testing::HasSubstr("latitude_deg 91.000000 is outside -90..90 degrees"));
  EXPECT_THROW(make(std::nan(""), 0), Error);
  EXPECT_THROW(make(0, INFINITY), Error);
}

TEST(Geodesy, EcefOfKnownPoints) {
  const Vec3d equator = toEcef({0, 90, 100});
  EXPECT_NEAR(equator.x, 0, 1e-6);
  EXPECT_NEAR(equator.y, kSemiMajor_m + 100, 1e-6);
  EXPECT_NEAR(toEcef({-90, 0, 0}).z, -6356752.314245, 1e-5);
  const GeodeticPosition back = fromEcef(toEcef({-33.5, 151.25, 4321}));
  EXPECT_NEAR(back.latitude_deg, -33.5, 1e-12);
  EXPECT_NEAR(back.longitude_deg, 151.25, 1e-12);
  EXPECT_NEAR(back.height_ellipsoid_m, 4321, 1e-8);
}

TEST(Geodesy, GeodesicsOfKnownLength) {
  EXPECT_NEAR(geodesicInverse(0, 20, 90, 20).distance_m, kMeridianQuadrant_m, 1e-3);
  EXPECT_NEAR(geodesicInverse(0, 179.5, 0, -179.5).distance_m, kSemiMajor_m * kPi / 180, 1e-6);
  EXPECT_NEAR(geodesicInverse(0, 179.5, 0, -179.5).azimuth_rad, kPi / 2, 1e-12);
  EXPECT_NEAR(geodesicInverse(10, 5, 10.1, 4.9).azimuth_rad,
              2 * kPi - geodesicInverse(10, 5, 10.1, 5.1).azimuth_rad, 1e-12);
  const GeodeticPosition end = geodesicDirect(0, 179.5, kPi / 2, kSemiMajor_m * kPi / 180);
  EXPECT_NEAR(end.longitude_deg, -179.5, 1e-9);
  EXPECT_EQ(end.height_ellipsoid_m, 0);
}

TEST(FrameWkt, RefusesAnOriginThatIsNotOnTheEarth) {
  EXPECT_THROW(wktOf({FrameKind::altitude, 95, 0, 0}), Error);
}

TEST(Geodesy, WrapsLongitudes) {
  EXPECT_EQ(wrapLongitude_deg(190), -170);
  EXPECT_EQ(wrapLongitude_deg(-190), 170);
  EXPECT_EQ(wrapLongitude_deg(725), 5);
  EXPECT_EQ(wrapLongitude_deg(-84.25), -84.25);
}

}  // namespace
}  // namespace emscape
