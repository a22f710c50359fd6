#include "base/geodesy/geoid_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape {
namespace {

/// A smooth undulation (m), one value at each pole.
double wave_m(double latitude_deg, double longitude_deg) {
  const double latitude = degToRad(latitude_deg), longitude = degToRad(longitude_deg);
  return 20 * std::sin(latitude) + 30 * std::cos(latitude) * std::cos(longitude - 1);
}

/// A grid of a post per degree in GeographicLib's format: north-west corner first, from Greenwich.
std::string pgm() {
  std::string text = "P5\n# Geoid file in PGM format\n# Offset -108\n# Scale 0.003\n360 181\n65535\n";
  for (int latitude_deg = 90; latitude_deg >= -90; --latitude_deg) {
    for (int longitude_deg = 0; longitude_deg < 360; ++longitude_deg) {
      const auto value =
          static_cast<std::uint16_t>(std::lround((wave_m(latitude_deg, longitude_deg) + 108) / 0.003));
      text += {static_cast<char>(value >> 8), static_cast<char>(value & 255)};
    }
  }
  return text;
}

TEST(GeoidGrid, ReadsGeographicLibsFormat) {
  const test::TemporaryFolder folder;
  test::writeFile(folder / "egm2008-5.pgm", pgm());
  const GeoidGrid grid(folder / "egm2008-5.pgm");
  for (double latitude_deg : {-90.0, -77.3, 0.0, 44.9, 89.7, 90.0}) {
    for (double longitude_deg : {-180.0, -71.2, -0.4, 0.0, 123.456, 179.9, 400.2}) {
      EXPECT_NEAR(grid.undulation_m(latitude_deg, longitude_deg), wave_m(latitude_deg, longitude_deg), 0.003)
          << latitude_deg << " " << longitude_deg;
    }
  }
}

TEST(GeoidGrid, AnAreaHasTheValuesOfTheGlobe) {
  const test::TemporaryFolder folder;
  test::writeFile(folder / "grid.pgm", pgm());
  const GeoidGrid globe(folder / "grid.pgm");
  for (const GeoidArea& area : {GeoidArea{49, 50, 10, 11}, GeoidArea{-3.2, 4.7, 175.5, 187.5},
                                GeoidArea{-90, -88.5, -184, -20}, GeoidArea{88.2, 90, -180, 180}}) {
    const GeoidGrid part(folder / "grid.pgm", area);
    for (double t = 0; t <= 1; t += 0.0625) {
      const double latitude_deg = area.south_deg + t * (area.north_deg - area.south_deg);
      const double longitude_deg = area.west_deg + t * (area.east_deg - area.west_deg);
      EXPECT_EQ(part.undulation_m(latitude_deg, longitude_deg),
                globe.undulation_m(latitude_deg, longitude_deg));
    }
  }
  const GeoidGrid part(folder / "grid.pgm", {49, 50, 10, 11});
  EXPECT_TRUE(std::isnan(part.undulation_m(49.5, 20)));
  EXPECT_TRUE(std::isnan(part.undulation_m(60, 10.5)));
}

TEST(GeoidGrid, RefusesOtherRasters) {
  const test::TemporaryFolder folder;
  test::writeFile(folder / "small.pgm", "P5\n# Offset -108\n# Scale 0.003\n2 1\n255\nab");
  EXPECT_THAT(test::errorOf([&] { GeoidGrid(folder / "small.pgm"); }, ErrorCode::bad_input),
              testing::HasSubstr("not a global geoid grid (360 n x (180 n + 1) posts)"));
}

TEST(GeoidGrid, AReadErrorNamesTheFileOnce) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "cut.pgm", name = "cut.pgm";
  test::writeFile(file, pgm().substr(0, 60000));
  const std::string error = test::errorOf([&] { const GeoidGrid grid(file); }, ErrorCode::bad_input);
  EXPECT_THAT(error, testing::HasSubstr("cut.pgm: cannot read: "));
  EXPECT_EQ(error.find(name), error.rfind(name)) << error;
}

/// NGA's test output for EGM2008 (OUTPUT.DAT).
TEST(GeoidGrid, Egm2008HasNgasUndulations) {
  std::optional<GeoidGrid> egm2008;
  try {
    egm2008 = egm2008Grid({});
  } catch (const Error& missing) {
    GTEST_SKIP() << missing.message();
  }
  EXPECT_NEAR(egm2008->undulation_m(37, 241), -26.151, 0.02);
  EXPECT_NEAR(egm2008->undulation_m(37, -119), -26.151, 0.02);
  EXPECT_NEAR(egm2008->undulation_m(36, 242.983333), -29.171, 0.02);
  EXPECT_NEAR(egm2008->undulation_m(90, 0), 14.899, 0.02);
  EXPECT_NEAR(egm2008->undulation_m(-90, 359.983333), -30.150, 0.02);
  double largest_m = 0;
  for (double latitude_deg = -89; latitude_deg < 90; latitude_deg += 1.7) {
    for (double longitude_deg = -180; longitude_deg < 180; longitude_deg += 2.3) {
      largest_m = std::max(largest_m, std::abs(egm2008->undulation_m(latitude_deg, longitude_deg) -
                                               geoidUndulation_m(latitude_deg, longitude_deg)));
    }
  }
  EXPECT_GT(largest_m, 1);
  EXPECT_LT(largest_m, 13);
}

}  // namespace
}  // namespace emscape
