#include "base/geodesy/fast_geodesy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "emscape/base/units.h"

namespace emscape {
namespace {

/// The specification's bounds to 500 km.
constexpr double kDistanceBound = 1e-4;
constexpr double kAzimuthBound_deg = 0.01;

double azimuthDifference_deg(double a_rad, double b_rad) {
  return std::abs(radToDeg(std::remainder(a_rad - b_rad, 2 * kPi)));
}

/// Largest differences from GeographicLib over random stations and paths.
struct Differences {
  double inverse_distance = 0, inverse_azimuth_deg = 0;  ///< relative errors of distances
  double direct_distance = 0, direct_azimuth_deg = 0;
  double direct_position_m = 0;
};

/// Stations all over the earth, with an increased density near the poles, the antimeridian and the prime
/// meridian.
Differences compare(double distance_m, int paths) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  Differences worst;
  for (int k = 0; k < paths; ++k) {
    double latitude_deg = radToDeg(std::asin(2 * unit(random) - 1));
    double longitude_deg = 360 * unit(random) - 180;
    if (k % 10 == 0) latitude_deg = std::copysign(90 - 3 * std::pow(unit(random), 4), latitude_deg);
    if (k % 50 == 0) latitude_deg = std::copysign(90, latitude_deg);
    if (k % 7 == 0) longitude_deg = 180 - 0.01 * unit(random);
    if (k % 11 == 0) longitude_deg = 0.01 * (unit(random) - 0.5);
    const double azimuth_rad = 2 * kPi * unit(random);
    const FastGeodesy geodesy = fastGeodesy(latitude_deg, longitude_deg);

    const GeodeticPosition end = geodesicDirect(latitude_deg, longitude_deg, azimuth_rad, distance_m);
    const FastInverse inverse =
        fastInverse(geodesy, surfacePoint(end.latitude_deg, end.longitude_deg).ecef_m);
    worst.inverse_distance = std::max(worst.inverse_distance, std::abs(inverse.distance_m / distance_m - 1));
    worst.inverse_azimuth_deg =
        std::max(worst.inverse_azimuth_deg,
                 azimuthDifference_deg(std::atan2(inverse.sin_azimuth, inverse.cos_azimuth), azimuth_rad));

    const FastDirect direct = fastDirect(geodesy, std::sin(azimuth_rad), std::cos(azimuth_rad), distance_m);
    EXPECT_LE(std::abs(direct.latitude_rad), kPi / 2);
    EXPECT_LE(std::abs(direct.longitude_rad), kPi);
    const double direct_lat_deg = radToDeg(direct.latitude_rad),
                 direct_lon_deg = radToDeg(direct.longitude_rad);
    const GeodesicInverse truth =
        geodesicInverse(latitude_deg, longitude_deg, direct_lat_deg, direct_lon_deg);
    worst.direct_distance = std::max(worst.direct_distance, std::abs(truth.distance_m / distance_m - 1));
    worst.direct_azimuth_deg =
        std::max(worst.direct_azimuth_deg, azimuthDifference_deg(truth.azimuth_rad, azimuth_rad));
    worst.direct_position_m = std::max(
        worst.direct_position_m,
        geodesicInverse(end.latitude_deg, end.longitude_deg, direct_lat_deg, direct_lon_deg).distance_m);
  }
  return worst;
}

TEST(FastGeodesy, KeepsTheSpecifiedBoundsTo500Km) {
  for (double distance_m : {1.0, 30.0, 1e3, 2e4, 1e5, 2.5e5, 5e5}) {
    const Differences worst = compare(distance_m, 2000);
    EXPECT_LT(worst.inverse_distance, kDistanceBound) << distance_m;
    EXPECT_LT(worst.inverse_azimuth_deg, kAzimuthBound_deg) << distance_m;
    EXPECT_LT(worst.direct_distance, kDistanceBound) << distance_m;
    EXPECT_LT(worst.direct_azimuth_deg, kAzimuthBound_deg) << distance_m;
  }
}

TEST(FastGeodesy, IsAsAccurateAsItsHeaderSays) {
  struct Stated {
    double distance_m, distance, azimuth_deg, position_m;
  };
  for (const Stated& stated : {Stated{1e5, 3.1e-9, 8e-6, 0.014}, Stated{5e5, 2.4e-7, 2.0e-4, 1.8},
                               Stated{2e6, 1.4e-5, 3.3e-3, 111}}) {
    const Differences worst = compare(stated.distance_m, 10000);
    EXPECT_LT(worst.inverse_distance, stated.distance);
    EXPECT_LT(worst.inverse_azimuth_deg, stated.azimuth_deg);
    EXPECT_LT(worst.direct_distance, stated.distance);
    EXPECT_LT(worst.direct_azimuth_deg, stated.azimuth_deg);
    EXPECT_LT(worst.direct_position_m, stated.position_m);
  }
}

TEST(FastGeodesy, AtTheStationItselfDistanceIsZero) {
  for (double latitude_deg : {-90.0, -12.0, 0.0, 45.0, 90.0}) {
    const FastGeodesy geodesy = fastGeodesy(latitude_deg, 180);
    const FastInverse inverse = fastInverse(geodesy, geodesy.station.ecef_m);
    EXPECT_EQ(inverse.distance_m, 0);
    EXPECT_EQ(inverse.sin_azimuth, 0);
    EXPECT_EQ(inverse.cos_azimuth, 1);
    const FastDirect direct = fastDirect(geodesy, 0.6, 0.8, 0);
    EXPECT_NEAR(radToDeg(direct.latitude_rad), latitude_deg, 1e-12);
  }
}

TEST(FastGeodesy, StaysFiniteFarBeyondItsRange) {
  const FastGeodesy geodesy = fastGeodesy(30, 40);
  const FastInverse antipode = fastInverse(geodesy, surfacePoint(-30, -140).ecef_m);
  EXPECT_NEAR(antipode.distance_m, kPi * 6371e3, 0.02 * kPi * 6371e3);
  const FastDirect far = fastDirect(geodesy, 1, 0, 15e6);
  const GeodeticPosition truth = geodesicDirect(30, 40, kPi / 2, 15e6);
  EXPECT_NEAR(radToDeg(far.latitude_rad), truth.latitude_deg, 0.5);
  EXPECT_NEAR(radToDeg(far.longitude_rad), truth.longitude_deg, 0.5);
}

TEST(FastGeodesy, SurfacePointsLieOnTheEllipsoid) {
  for (double latitude_deg : {-90.0, -45.5, 0.0, 12.25, 90.0}) {
    for (double longitude_deg : {-180.0, -0.5, 0.0, 90.0, 275.0}) {
      const SurfacePoint point = surfacePoint(latitude_deg, longitude_deg);
      EXPECT_LT(length(point.ecef_m - toEcef({latitude_deg, longitude_deg, 0})), 1e-8);
      EXPECT_LT(length(toEcef({latitude_deg, longitude_deg, 1000}) - point.ecef_m - point.up * 1000.0), 1e-6);
    }
  }
}

TEST(FastGeodesy, EllipsoidPointsAreWithinTheirAccuracy) {
  for (double latitude_deg = -90; latitude_deg <= 90; latitude_deg += 0.37) {
    for (double longitude_deg = -180; longitude_deg <= 180; longitude_deg += 1.3) {
      const Vec3d exact = toEcef({latitude_deg, longitude_deg, 0});
      const Vec3d point = ellipsoidPoint_m(degToRad(latitude_deg), degToRad(longitude_deg));
      ASSERT_LT(length(point - exact), 4e-9) << latitude_deg << ", " << longitude_deg;
    }
  }
}

TEST(FastGeodesy, RadiiEqualEllipsoid) {
  const FastGeodesy equator = fastGeodesy(0, 0), pole = fastGeodesy(90, 0);
  EXPECT_NEAR(equator.radius_m(1, 0), 6378137.0, 1e-6);
  EXPECT_NEAR(equator.radius_m(0, 1), 6335439.327, 1e-3);
  EXPECT_NEAR(pole.radius_m(0, 1), 6399593.626, 1e-3);
  EXPECT_NEAR(pole.radius_m(1, 0), pole.radius_m(0, 1), 1e-6);
}

}  // namespace
}  // namespace emscape
