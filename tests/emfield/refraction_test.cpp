// An exponential atmosphere against rays traced through it.
//
// The figures come from a numerical integration of Snell's law in spherical layers, n r cos(theta) =
// constant: dr / dphi = r tan(theta), dtheta / dphi = 1 + (r / n) dn/dr, Runge-Kutta of fourth order in steps
// of 20 m over an earth of 6371 km, n = 1 + 313e-6 exp(-h / 6.9513 km).
#include "emfield/columns/refraction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "emfield/columns/station.h"
#include "emscape/base/units.h"
#include "propagation/horizon/horizon.h"

namespace emscape::emfield {
namespace {

/// At the latitude where the earth's Gaussian radius is 6371 km.
Station stationAt(double height_msl_m) {
  propagation::Atmosphere atmosphere;
  atmosphere.refraction = propagation::RefractionProfile::exponential;
  atmosphere.sea_level_refractivity = 313;
  return makeStation({35.31, 5, height_msl_m}, height_msl_m, atmosphere);
}

TEST(Refraction, HorizonsEqualTracedRays) {
  const Station station = stationAt(0);
  EXPECT_NEAR(station.earth_radius_m, 6371e3, 100);
  const double traced_m[][2] = {{10e3, 408.01e3}, {20e3, 565.32e3}, {30e3, 682.98e3}};
  for (const auto& [height_m, range_m] : traced_m) {
    const Refraction& refraction = station.refraction;
    EXPECT_NEAR(refraction.horizon_m(refraction.grazingHeight_m(height_m)) / range_m, 1, 1e-3) << height_m;
  }
  // k = 4/3 puts that of 20 km of height 3 % too far.
  EXPECT_NEAR(station.refraction.horizon_m(20e3) / 565.32e3, 1.030, 1e-3);
}

/// A ray that leaves a station at an elevation, and its height over a range.
struct TracedRay {
  double station_msl_m, elevation_deg, range_m, height_msl_m;
};
constexpr TracedRay kTraced[] = {
    {0, 0.5, 400e3, 13483.1}, {0, 2, 300e3, 16374.9},      {0, 0.2, 500e3, 17416.8}, {0, 10, 110e3, 20276.4},
    {1000, 0, 300e3, 6508.8}, {10e3, -2.5, 250e3, 3464.1}, {10e3, 0, 300e3, 16661.8}};

TEST(Refraction, RaysStartLikeTracedRays) {
  for (const TracedRay& ray : kTraced) {
    const Station station = stationAt(ray.station_msl_m);
    const double angle = ray.range_m / station.earth_radius_m;
    const double to_m = station.earth_radius_m + ray.height_msl_m;
    const double level_m = to_m * std::sin(angle);
    const double rise_m = to_m * std::cos(angle) - station.earth_radius_m - ray.station_msl_m +
                          refractionLift_m(station, ray.range_m, level_m, ray.height_msl_m);
    EXPECT_NEAR(radToDeg(std::atan2(rise_m, level_m)), ray.elevation_deg, 0.003) << ray.range_m;
  }
}

TEST(Refraction, RaysFromNearGroundEqualTracedRays) {
  for (const TracedRay& ray : kTraced) {
    if (ray.station_msl_m > 0) continue;
    const Station station = stationAt(ray.station_msl_m);
    const propagation::HorizonGeometry<double> geometry{station.effective_height_msl_m,
                                                        station.effective_earth_radius_m};
    const double image_m =
        geometry.heightOn(std::tan(degToRad(ray.elevation_deg)), geometry.termsAt(ray.range_m));
    const double height_m = station.refraction.heightOfImage_m(image_m, ray.station_msl_m, ray.range_m);
    EXPECT_NEAR(height_m, ray.height_msl_m, 20) << ray.range_m;
    EXPECT_NEAR(station.refraction.effectiveHeight_m(height_m, ray.station_msl_m, ray.range_m), image_m, 0.1);
  }
}

TEST(Refraction, HeightsGoOnWithoutAJump) {
  for (const double station_msl_m : {-20.0, 5.0, 800.0, 9000.0}) {
    const Refraction refraction = stationAt(station_msl_m).refraction;
    for (const double range_m : {100.0, 5e3, 60e3, 300e3, 600e3, 900e3}) {
      double before_m = refraction.effectiveHeight_m(0, station_msl_m, range_m);
      for (double height_m = 25; height_m < 30e3; height_m += 25) {
        const double here_m = refraction.effectiveHeight_m(height_m, station_msl_m, range_m);
        EXPECT_GT(here_m, before_m) << range_m << " " << height_m;
        EXPECT_LT(here_m, before_m + 50) << range_m << " " << height_m;
        before_m = here_m;
      }
    }
    EXPECT_NEAR(refraction.effectiveHeight_m(20e3, station_msl_m, 10), 20e3, 20);
    EXPECT_EQ(refraction.effectiveHeight_m(2900, station_msl_m, 200e3), 2900);
  }
}

TEST(Refraction, LinearRefractivityKeepsHeights) {
  const Station station = makeStation({35.31, 5, 30e3}, 30e3, propagation::Atmosphere{});
  EXPECT_EQ(station.effective_height_msl_m, 30e3);
  EXPECT_EQ(station.refraction.effectiveHeight_m(25e3, 30e3, 500e3), 25e3);
  EXPECT_EQ(station.refraction.heightOfImage_m(25e3, 30e3, 500e3), 25e3);
}

}  // namespace
}  // namespace emscape::emfield
