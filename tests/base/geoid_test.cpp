#include "emscape/base/geodesy/geoid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape {
namespace {

TEST(Geoid, AgreesWithPublishedCheckPoints) {
  std::ifstream file(test::sourceFile("tests/data/reference/geoid/check_points.csv"));
  std::string line;
  std::getline(file, line);
  int points = 0;
  while (std::getline(file, line)) {
    std::istringstream row(line);
    double latitude_deg = 0, longitude_deg = 0, undulation_m = 0;
    char comma = 0;
    row >> latitude_deg >> comma >> longitude_deg >> comma >> undulation_m;
    EXPECT_NEAR(geoidUndulation_m(latitude_deg, longitude_deg), undulation_m, 0.02) << line;
    ++points;
  }
  EXPECT_EQ(points, 6);
}

TEST(Geoid, StaysWithinTheEarthsExtremes) {
  double lowest_m = 0, highest_m = 0;
  for (double latitude_deg = -90; latitude_deg <= 90; latitude_deg += 0.37) {
    for (double longitude_deg = -180; longitude_deg < 180; longitude_deg += 0.53) {
      const double undulation_m = geoidUndulation_m(latitude_deg, longitude_deg);
      lowest_m = std::min(lowest_m, undulation_m);
      highest_m = std::max(highest_m, undulation_m);
    }
  }
  EXPECT_NEAR(lowest_m, -107.0, 1.0);
  EXPECT_NEAR(highest_m, 85.0, 1.0);
}

TEST(Geoid, WrapsInLongitude) {
  for (double latitude_deg : {-77.3, 0.0, 12.1, 44.9}) {
    for (double longitude_deg : {-179.99, -71.2, 0.01, 123.456, 179.99}) {
      const double undulation_m = geoidUndulation_m(latitude_deg, longitude_deg);
      EXPECT_NEAR(geoidUndulation_m(latitude_deg, longitude_deg + 360), undulation_m, 1e-9);
      EXPECT_NEAR(geoidUndulation_m(latitude_deg, longitude_deg - 720), undulation_m, 1e-9);
    }
    EXPECT_NEAR(geoidUndulation_m(latitude_deg, -180 + 1e-9), geoidUndulation_m(latitude_deg, 180 - 1e-9),
                1e-6);
    EXPECT_NEAR(geoidUndulation_m(latitude_deg, -1e-9), geoidUndulation_m(latitude_deg, 1e-9), 1e-6);
  }
}

TEST(Geoid, HasOneValueAtEachPoleAndContinuesAcrossIt) {
  for (double pole_deg : {-90.0, 90.0}) {
    const double undulation_m = geoidUndulation_m(pole_deg, 0);
    for (double longitude_deg = -180; longitude_deg <= 180; longitude_deg += 15) {
      EXPECT_NEAR(geoidUndulation_m(pole_deg, longitude_deg), undulation_m, 0.01);
      EXPECT_NEAR(geoidUndulation_m(pole_deg - std::copysign(0.001, pole_deg), longitude_deg), undulation_m,
                  0.02);
    }
  }
}

TEST(Geoid, AnswersNaNForNaN) {
  EXPECT_TRUE(std::isnan(geoidUndulation_m(std::nan(""), 0)));
  EXPECT_TRUE(std::isnan(geoidUndulation_m(0, std::nan(""))));
}

TEST(Geoid, IsEqualFromManyThreads) {
  const double expected_m = geoidUndulation_m(44.3, -71.2);
  std::vector<double> results_m(8);
  std::vector<std::thread> threads;
  for (double& result_m : results_m) {
    threads.emplace_back([&result_m] { result_m = geoidUndulation_m(44.3, -71.2); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double result_m : results_m) EXPECT_EQ(result_m, expected_m);
}

TEST(Geoid, AFileThatIsNamedTooLateIsRefused) {
  geoidUndulation_m(0, 0);
  EXPECT_EQ(test::errorOf([] { setGeoidFile("mine.gtx"); }, ErrorCode::usage),
            "geoid file 'mine.gtx': the geoid grid was read before");
}

}  // namespace
}  // namespace emscape
