#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "emscape/base/log.h"
#include "emscape/scenario/model/target.h"
#include "scenario/antenna/pattern.h"
#include "scenario/antenna/pattern_file.h"
#include "scenario/antenna/shapes.h"
#include "tests/scenario/antenna_directions.h"
#include "tests/scenario/antenna_files.h"

namespace emscape::scenario {
namespace {

const std::string kAzimuthCut = "azimuth_deg,attenuation_db\n0,0\n45,3\n90,12\n180,30\n270,14\n";
const std::string kElevationCut = "elevation_deg,attenuation_db\n-90,40\n-10,3\n0,0\n10,3.5\n90,35\n";

double lossAt_db(const AntennaPtr& antenna, double azimuth_deg, double elevation_deg) {
  return antenna->gain_dbi - gainTowards_dbi(*antenna, towards(azimuth_deg, elevation_deg));
}

AntennaPtr readCsvGrid(const std::string& file, double gain_dbi) {
  std::vector<std::string> warnings;
  return antennaOf(file, readGridPattern(file), gain_dbi, warnings);
}

/// Attenuation (dB) of the test's grid: different in every cell.
double gridLoss_db(int azimuth_deg, int elevation_deg) {
  return std::abs(azimuth_deg) / 10.0 + (azimuth_deg < 0 ? 1 : 0) + std::abs(elevation_deg) / 5.0 +
         (elevation_deg > 0 ? 0.5 : 0);
}
std::string gridRow(int azimuth_deg, int elevation_deg) {
  char row[64];
  std::snprintf(row, sizeof row, "%d,%d,%.3f\n", azimuth_deg, elevation_deg,
                gridLoss_db(azimuth_deg, elevation_deg));
  return row;
}
std::string grid(int step_deg) {
  std::string text = "azimuth_deg,elevation_deg,attenuation_db\n";
  for (int elevation = -90; elevation <= 90; elevation += step_deg) {
    for (int azimuth = -180; azimuth < 180; azimuth += step_deg) text += gridRow(azimuth, elevation);
  }
  return text;
}

/// The warnings of a call.
std::string warningsOf(const std::function<void()>& call) {
  std::string warnings;
  setLogSink([&](LogLevel level, const std::string& text) {
    if (level == LogLevel::warning) warnings += text + "\n";
  });
  call();
  setLogSink({});
  return warnings;
}

TEST(CsvTables, TellALastRowWithoutALineEnd) {
  std::string gains = grid(30);
  gains.replace(gains.find("attenuation_db"), 14, "gain_dbi");
  for (const bool is_cut : {false, true}) {
    const auto text = [&](const std::string& whole) {
      return whole.substr(0, whole.size() - (is_cut ? 1 : 0));
    };
    const TemporaryFile azimuth("azimuth.csv", text(kAzimuthCut)), elevation("elevation.csv", kElevationCut);
    const TemporaryFile cells("grid.csv", text(grid(30))), table("table.csv", text(gains));
    const TemporaryFile section("rcs.csv", text("azimuth_deg,rcs_dbsm\n0,10\n90,20\n180,10\n270,20\n"));
    const auto expectTold = [&](int line, const std::function<void()>& read) {
      const std::string told = ".csv:" + std::to_string(line) + ":1: a row has no end";
      EXPECT_EQ(warningsOf(read).find(told) != std::string::npos, is_cut) << told;
    };
    expectTold(6, [&] { readCsvCuts(azimuth.path(), elevation.path(), 20); });
    expectTold(1 + 7 * 12, [&] { readAntenna(cells.path(), 20); });
    expectTold(1 + 7 * 12, [&] { readAntenna(table.path(), 20); });
    expectTold(5, [&] { readRcsTable(section.path()); });
  }
}

TEST(CsvCuts, AddTheirAttenuations) {
  const TemporaryFile azimuth("azimuth.csv", kAzimuthCut);
  const TemporaryFile elevation("elevation.csv", kElevationCut);
  const AntennaPtr antenna = readCsvCuts(azimuth.path(), elevation.path(), 20);
  EXPECT_EQ(antenna->gain_dbi, 20);
  EXPECT_NEAR(lossAt_db(antenna, 0, 0), 0, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, 45, 0), 3, 1e-5);
  EXPECT_NEAR(lossAt_db(antenna, -90, 0), 14, 1e-5);
  EXPECT_NEAR(lossAt_db(antenna, 180, 0), 30, 1e-5);
  EXPECT_NEAR(lossAt_db(antenna, 0, -10), 3, 1e-5);
  EXPECT_NEAR(lossAt_db(antenna, 0, 10), 3.5, 1e-5);
  EXPECT_NEAR(lossAt_db(antenna, 90, 10), 15.5, 1e-5);
}

TEST(CsvCuts, AreLinearInAmplitudeBetweenRows) {
  const TemporaryFile azimuth("azimuth.csv", kAzimuthCut);
  const TemporaryFile elevation("elevation.csv", kElevationCut);
  const AntennaPtr antenna = readCsvCuts(azimuth.path(), elevation.path(), 20);
  const double halfway = 0.5 * (1 + std::pow(10.0, -3 / 20.0));
  EXPECT_NEAR(antenna->amplitudeTowards(towards(22.5, 0), 0, 0), halfway, 1e-9);
  EXPECT_NEAR(patternAmplitude(antenna->view(), vecCast<float>(towards(22.5, 0)), 0, 0), halfway, 1e-6);
}

TEST(CsvCuts, MeasureTheirBeamwidths) {
  const TemporaryFile azimuth(
      "azimuth.csv", "azimuth_deg,attenuation_db\n-180,30\n-90,30\n-20,3.0103\n0,0\n30,3.0103\n90,30\n");
  const TemporaryFile elevation("elevation.csv", kElevationCut);
  EXPECT_NEAR(readCsvCuts(azimuth.path(), elevation.path(), 20)->beamwidth_az_deg, 50, 0.05);
  const TemporaryFile round("round.csv", "azimuth_deg,attenuation_db\n0,0\n90,0\n180,0\n270,0.5\n");
  EXPECT_EQ(readCsvCuts(round.path(), elevation.path(), 20)->beamwidth_az_deg, 360);
}

TEST(CsvGrid, HoldsItsRowsInAnyOrderAndWraps) {
  std::string reversed = "# turned round\r\nattenuation_db, azimuth_deg ,elevation_deg\r\n";
  for (int elevation = 90; elevation >= -90; elevation -= 30) {
    for (int azimuth = 360; azimuth >= 0; azimuth -= 30) {
      char row[64];
      const int wrapped = azimuth >= 180 ? azimuth - 360 : azimuth;
      std::snprintf(row, sizeof row, "%.3f , %d,%d\r\n", gridLoss_db(wrapped, elevation), azimuth, elevation);
      reversed += row;
    }
  }
  const TemporaryFile plain("plain.csv", grid(30));
  const TemporaryFile turned("turned.csv", reversed);
  for (const TemporaryFile* file : {&plain, &turned}) {
    const AntennaPtr antenna = readCsvGrid(file->path(), 12);
    for (int azimuth = -180; azimuth < 180; azimuth += 30) {
      for (int elevation = -60; elevation <= 60; elevation += 30) {
        EXPECT_NEAR(lossAt_db(antenna, azimuth, elevation), gridLoss_db(azimuth, elevation), 1e-4);
      }
    }
    const double across =
        0.5 * (std::pow(10.0, -gridLoss_db(150, 0) / 20) + std::pow(10.0, -gridLoss_db(-180, 0) / 20));
    EXPECT_NEAR(antenna->amplitudeTowards(towards(165, 0), 0, 0), across, 1e-6);
    EXPECT_NEAR(patternAmplitude(antenna->view(), vecCast<float>(towards(165, 0)), 0, 0), across, 1e-6);
  }
}

TEST(CsvGrid, NeedNotHaveARowAtBoresight) {
  std::string text = "azimuth_deg,elevation_deg,attenuation_db\n";
  for (int elevation = -90; elevation <= 90; elevation += 20) {
    for (int azimuth = 5; azimuth < 360; azimuth += 10) {
      text += std::to_string(azimuth) + "," + std::to_string(elevation) + ",1\n";
    }
  }
  const TemporaryFile file("offset.csv", text);
  const AntennaPtr antenna = readCsvGrid(file.path(), 12);
  for (const double azimuth_deg : {-180.0, 0.0, 5.0, 77.0})
    EXPECT_NEAR(lossAt_db(antenna, azimuth_deg, 3), 1, 1e-5);
}

TEST(CsvGrid, NamesTheMissingPair) {
  std::string text = grid(30);
  const std::string row = gridRow(60, -30);
  text.erase(text.find(row), row.size());
  const TemporaryFile file("hole.csv", text);
  expectFault([&] { readCsvGrid(file.path(), 12); }, file.path(), 0, 0,
              "no row for azimuth 60 deg, elevation -30 deg");
}

TEST(CsvGrid, ErrorsHaveReasonAndLocation) {
  const TemporaryFile file("grid.csv", "");
  const auto expectBroken = [&](const std::string& content, int line, int column, const std::string& part) {
    file.rewrite(content);
    expectFault([&] { readCsvGrid(file.path(), 12); }, file.path(), line, column, part);
  };
  const std::string header = "azimuth_deg,elevation_deg,attenuation_db\n";
  expectBroken("", 1, 1, "no header line; it should be elevation_deg,azimuth_deg,attenuation_db");
  expectBroken(header, 0, 0, "the grid's azimuths has no rows");
  expectBroken("azimuth_deg,elevation,attenuation_db\n", 1, 13, "unknown column 'elevation'");
  expectBroken("azimuth_deg,azimuth_deg,attenuation_db\n", 1, 13, "column 'azimuth_deg' occurs twice");
  expectBroken("azimuth_deg,elevation_deg\n", 1, 1, "missing column");
  expectBroken("azimuth_deg\televation_deg\tattenuation_db\n", 1, 1, "separated by commas, not tabs");
  expectBroken(header + "0,0\n", 2, 1, "2 values, but the header names 3 columns");
  expectBroken(header + "0,x,0\n", 2, 3, "elevation_deg is 'x', not a number");
  expectBroken(header + "\n0, ,0\n", 3, 3, "elevation_deg is '', not a number");
  expectBroken(header + "0,91,0\n", 2, 3, "elevation_deg is 91 deg; allowed are -90 to 90 deg");
  expectBroken(header + "0,0,-3\n", 2, 5, "attenuation_db is -3 dB; allowed are 0 to 300 dB");
  expectBroken(header + "0,0,nan\n", 2, 5, "attenuation_db is 'nan', not a number");
  expectBroken(grid(30) + "0,0,7\n", 86, 1,
               "azimuth 0 deg, elevation 0 deg occurs a second time, with 7 dB instead of 0 dB");
  expectBroken(header + "0,-90,0\n90,-90,0\n180,-90,0\n270,-90,0\n", 0, 0,
               "runs from -90 to -90 deg; it must reach from -90 to 90 deg");
}

TEST(CsvAntenna, SurvivesDamageToEveryByte) {
  const TemporaryFile azimuth("azimuth.csv", kAzimuthCut);
  const TemporaryFile elevation("elevation.csv", kElevationCut);
  surviveDamage(azimuth, kAzimuthCut, [&] { readCsvCuts(azimuth.path(), elevation.path(), 20); });
  const std::string small = grid(90);
  const TemporaryFile file("grid.csv", small);
  surviveDamage(file, small, [&] { readCsvGrid(file.path(), 20); });
}

TEST(AntennaFile, IsReadByItsEnding) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const TemporaryFile csv("grid.CSV", grid(30));
  EXPECT_EQ(readAntenna(csv.path(), 7)->gain_dbi, 7);
  expectFault([&] { readAntenna(csv.path(), kNan); }, csv.path(), 0, 0, "the CSV grid has no gain");
  const TemporaryFile msi("antenna.pln",
                          "NAME a, b\nGAIN 10\nHORIZONTAL 4\n0 0\n90 10\n180 20\n270 11\nVERTICAL 4\n0 0\n90 "
                          "15\n180 20\n270 16\n");
  EXPECT_NEAR(readAntenna(msi.path(), kNan)->gain_dbi, 12.15, 1e-12);
  EXPECT_EQ(readAntenna(msi.path(), 7)->gain_dbi, 7);
}

}  // namespace
}  // namespace emscape::scenario
