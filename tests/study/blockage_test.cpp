/// Beam blockage: the closed form, and terrain for which it is known.
#include "study/blockage/blockage.h"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <iostream>
#include <memory>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/units.h"
#include "emscape/scenario/file/scenario_file.h"
#include "tests/scenario/dem_file.h"
#include "tests/support/errors.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::study {
namespace {

using testing::HasSubstr;

TEST(PartOfBeamBelow, IsTheAreaOfTheSegmentOfACircle) {
  EXPECT_EQ(partOfBeamBelow(-3, 2), 0);
  EXPECT_EQ(partOfBeamBelow(0, 2), 0.5);
  EXPECT_EQ(partOfBeamBelow(5, 2), 1);
  EXPECT_TRUE(std::isnan(partOfBeamBelow(NAN, 2)));
  // By counting chords.
  constexpr int kChords = 200000;
  for (const double edge : {-0.9, -0.5, 0.2, 0.7}) {
    double below = 0, all = 0;
    for (int i = 0; i < kChords; ++i) {
      const double y = -1 + (i + 0.5) * 2 / kChords, chord = std::sqrt(1 - y * y);
      all += chord;
      if (y < edge) below += chord;
    }
    EXPECT_NEAR(partOfBeamBelow(3 * edge, 3), below / all, 1e-5) << edge;
    EXPECT_NEAR(partOfBeamBelow(edge, 1) + partOfBeamBelow(-edge, 1), 1, 1e-12);
  }
}

class BeamBlockage : public testing::Test {
 protected:
  static constexpr double kLatitude_deg = 36.3, kLongitude_deg = -84.25, kAntenna_m = 100;

  /// Ground at 0 m, with a wall of a height from 10 to 11 km in the east.
  BeamBlockage() {
    const double per_degree_m = 111320 * std::cos(degToRad(kLatitude_deg));
    test::geographicDem(-84.7, 36.7, 0.001, 900, 800, [=](double latitude_deg, double longitude_deg) {
      const double east_m = (longitude_deg - kLongitude_deg) * per_degree_m;
      const bool is_wall = east_m > 10e3 && east_m < 11e3 && std::abs(latitude_deg - kLatitude_deg) < 0.05;
      return is_wall ? kWall_m : 0.0;
    }).write(folder_ / "wall.tif");
    test::writeFile(folder_ / "s.yaml", R"(schema_version: 1
name: wall
epoch: 2026-06-01T06:00:00Z
duration_s: 0
step_s: 1
region: {origin: {latitude_deg: 36.3, longitude_deg: -84.25, height_msl_m: 0}, size_m: [10000, 10000, 1000], dims: [10, 10, 10]}
terrain: {files: [wall.tif], vertical_datum: egm96}
atmosphere: {k_factor: 1.3333}
platforms:
  - {name: site, position: {latitude_deg: 36.3, longitude_deg: -84.25, height_agl_m: 100}}
emitters:
  - name: radar
    platform: site
    kind: radar
    frequency_hz: 3.0e9
    power_w: 1000
    antenna: {pattern: gaussian, gain_dbi: 38, beamwidth_az_deg: 2, beamwidth_el_deg: 2}
    receiver: {noise_figure_db: 3, bandwidth_hz: 1.0e6}
)");
    scenario_ = scenario::loadScenario(folder_ / "s.yaml");
  }

  static constexpr double kWall_m = 200;
  test::TemporaryFolder folder_;
  std::shared_ptr<const scenario::Scenario> scenario_;
};

TEST_F(BeamBlockage, OfAWallIsThatOfItsHeightAboveTheAxisAndStaysBehindIt) {
  BlockageRequest request;
  request.range_m = 20e3;
  request.step_m = 500;
  request.azimuths = 8;
  request.elevation_deg = 0.5;
  const Blockage blockage = computeBlockage(scenario_, request);
  ASSERT_EQ(blockage.ranges, 40);
  const int east = 2 * blockage.ranges;
  EXPECT_EQ(blockage.partial[east + 10], 0) << "5 km: the beam is above the ground";
  // The least clearance of the gate from 10 to 10.5 km is at its beginning.
  const auto cutBy = [](double ground_m, double range_m) {
    const double axis_m =
        kAntenna_m + range_m * std::sin(degToRad(0.5)) + range_m * range_m / (2 * 4.0 / 3 * 6371e3);
    return partOfBeamBelow(ground_m - axis_m, range_m * degToRad(1.0));
  };
  const double expected = cutBy(kWall_m, 10.25e3);
  EXPECT_NEAR(blockage.partial[east + 20], expected, 0.01);
  EXPECT_GT(expected, 0.3);
  EXPECT_NEAR(blockage.partial[east + 30], cutBy(0, 15.25e3), 0.002)
      << "flat ground in the beam's lower edge";
  EXPECT_GE(blockage.cumulative[east + 39], blockage.partial[east + 20]) << "what was cut is missing behind";
  const int west = 6 * blockage.ranges;
  EXPECT_NEAR(blockage.cumulative[west + 39], cutBy(0, 19.75e3), 0.003);
}

TEST_F(BeamBlockage, OfTheBeamOfTheAntennaIsTheDefault) {
  BlockageRequest request;
  request.range_m = 12e3;
  request.azimuths = 4;
  const Blockage blockage = computeBlockage(scenario_, request);
  EXPECT_EQ(blockage.beamwidth_deg, 2);
  EXPECT_NEAR(blockage.elevation_deg, 0, 1e-6);
}

TEST_F(BeamBlockage, IsUnknownBehindMissingTerrain) {
  BlockageRequest request;
  request.range_m = 90e3;
  request.azimuths = 4;
  const Blockage blockage = computeBlockage(scenario_, request);
  EXPECT_TRUE(std::isnan(blockage.cumulative[3 * blockage.ranges + blockage.ranges - 1]));
  writeBlockageCsv(blockage, folder_ / "a.csv");
  EXPECT_THAT(test::readFile(folder_ / "a.csv"), HasSubstr("270,89750,"));
}

TEST_F(BeamBlockage, IsWrittenOverAzimuthAndRangeWithThePositionsOfTheGates) {
  BlockageRequest request;
  request.range_m = 12e3;
  request.azimuths = 8;
  const Blockage blockage = computeBlockage(scenario_, request);
  writeBlockageNetcdf(blockage, folder_ / "a.nc");
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> file(
      GDALDataset::Open((folder_ / "a.nc").c_str(), GDAL_OF_MULTIDIM_RASTER));
  ASSERT_NE(file, nullptr);
  const auto valuesOf = [&](const char* name) {
    const auto array = file->GetRootGroup()->OpenMDArray(name);
    std::vector<double> values(array->GetTotalElementsCount());
    const std::vector<GUInt64> start{0, 0};
    const std::vector<std::size_t> count{8, static_cast<std::size_t>(blockage.ranges)};
    array->Read(start.data(), count.data(), nullptr, nullptr, GDALExtendedDataType::Create(GDT_Float64),
                values.data());
    return values;
  };
  const std::vector<double> latitude_deg = valuesOf("lat"), longitude_deg = valuesOf("lon"),
                            part = valuesOf("cumulative_blockage"), beam_m = valuesOf("beam_msl");
  const int gate = 2 * blockage.ranges + 20;  // to the east
  const GeodeticPosition expected = geodesicDirect(
      blockage.position.latitude_deg, blockage.position.longitude_deg, kPi / 2, blockage.gate_m(20));
  EXPECT_NEAR(latitude_deg[gate], expected.latitude_deg, 1e-4);
  EXPECT_NEAR(longitude_deg[gate], expected.longitude_deg, 1e-4);
  EXPECT_FLOAT_EQ(static_cast<float>(part[gate]), blockage.cumulative[gate]);
  EXPECT_NEAR(beam_m[gate], blockage.axis_msl_m(blockage.gate_m(20)), 0.01);
}

TEST_F(BeamBlockage, ReplacesFilesOfTheUserOnlyIfAsked) {
  BlockageRequest request;
  request.range_m = 12e3;
  request.azimuths = 4;
  const Blockage blockage = computeBlockage(scenario_, request);
  const BlockageMap made = mapOf(blockage);
  const auto write = [&](const std::string& file, Replaces replaces) {
    if (file.back() == 'v') writeBlockageCsv(blockage, file, replaces);
    if (file.back() == 'c') writeBlockageNetcdf(blockage, file, replaces);
    if (file.back() == 'f') writeGeoTiff(file, made.grid, made.map, {}, replaces);
  };
  for (const char* const name : {"a.csv", "a.nc", "a.tif"}) {
    const std::string file = folder_.write(name, "mine");
    EXPECT_THAT(test::errorOf([&] { write(file, Replaces::own); }, ErrorCode::usage), HasSubstr(name));
    EXPECT_EQ(test::readFile(file), "mine");
    write(file, Replaces::any);
    EXPECT_NE(test::readFile(file), "mine");
  }
}

TEST_F(BeamBlockage, AFullDiskIsNamedAsTheCause) {
  BlockageRequest request;
  request.range_m = 60e3;
  const Blockage blockage = computeBlockage(scenario_, request);
  for (const rlim_t bytes : {0, 4000, 20000}) {
    // In a process of its own: HDF5 keeps a file that it cannot close, and may crash with it at the end.
    EXPECT_EXIT(
        {
          auto limit = std::make_unique<test::FileSizeLimit>(bytes);
          const std::string error =
              test::errorOf([&] { writeBlockageNetcdf(blockage, folder_ / "full.nc"); });
          limit.reset();
          std::cerr << error;
          _exit(0);
        },
        testing::ExitedWithCode(0), "full.nc: cannot.*File too large")
        << bytes;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "full.nc"));
  }
}

TEST_F(BeamBlockage, EndsByDefaultWithTheLastGateOverKnownGround) {
  BlockageRequest request;
  request.azimuths = 4;
  const Blockage whole = computeBlockage(scenario_, request);
  EXPECT_LT(whole.range_m(), BlockageRequest::kUsualRange_m);
  bool known = false;
  for (int azimuth = 0; azimuth < 4; ++azimuth)
    known |= !std::isnan(whole.cumulative[static_cast<std::size_t>(azimuth + 1) * whole.ranges - 1]);
  EXPECT_TRUE(known);
  request.range_m = whole.range_m();
  EXPECT_THAT(whole.cumulative, ::testing::Pointwise(::testing::NanSensitiveFloatEq(),
                                                     computeBlockage(scenario_, request).cumulative));
}

TEST_F(BeamBlockage, MapHasTheGateAboveEachPixel) {
  BlockageRequest request;
  request.range_m = 20e3;
  request.elevation_deg = 0.5;
  const Blockage blockage = computeBlockage(scenario_, request);
  const BlockageMap made = mapOf(blockage);
  const auto at = [&](double east_m) {
    const double longitude_deg = kLongitude_deg + east_m / (111320 * std::cos(degToRad(kLatitude_deg)));
    return made.map.values[static_cast<std::size_t>(made.grid.pixelAt(kLatitude_deg, longitude_deg))];
  };
  EXPECT_EQ(at(8e3), 0);
  EXPECT_GT(at(15e3), 0.3F);
  EXPECT_LT(at(-15e3), 0.02F) << "the beam's lower edge";
}

TEST_F(BeamBlockage, WithoutTerrainIsAnErrorThatSaysWhatIsMissing) {
  auto bare = std::make_shared<scenario::Scenario>(*scenario_);
  bare->terrain.reset();
  EXPECT_THAT(test::errorOf([&] { computeBlockage(bare, {}); }), HasSubstr("terrain.files"));
}

}  // namespace
}  // namespace emscape::study
