// emscape bench: its measurements, and the JSON on which other programs rely.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr int kUsage = 2, kBadInput = 3;

/// A ball in a cube, smooth at its surface, as unsigned 16-bit values of a .dat file.
std::string ballDat(int edge) {
  std::string file;
  const auto put = [&file](int value) {
    file += static_cast<char>(value & 255);
    file += static_cast<char>(value >> 8);
  };
  for (int axis = 0; axis < 3; ++axis) put(edge);
  const double center = 0.5 * (edge - 1);
  for (int k = 0; k < edge; ++k)
    for (int j = 0; j < edge; ++j)
      for (int i = 0; i < edge; ++i)
        put(static_cast<int>(4000 * std::exp(-std::hypot(i - center, j - center, k - center) / edge)));
  return file;
}

/// JSON result of a benchmark on standard output.
json bench(const Arguments& arguments) {
  Arguments with_json{"bench"};
  with_json.insert(with_json.end(), arguments.begin(), arguments.end());
  with_json.insert(with_json.end(), {"--json", "--quiet"});
  const ProgramResult result = runWell(with_json);
  EXPECT_EQ(result.err, "");
  return json::parse(result.out);
}

/// The device that `--backend auto` selects on this machine.
std::string deviceName() {
  const std::string version = run({"--version"}).out;
  const std::size_t gpu = version.find("GPU: ") + 5;
  const bool none = version.compare(gpu, 4, "none") == 0 || version.compare(gpu, 4, "this") == 0;
  return none ? "cpu" : version.substr(gpu, version.find(',', gpu) - gpu);
}

json benchCells(const char* rasterizer) {
  return bench({"cells", shippedScenario("quick.yaml"), "--mesh", "terrain:4", "--size", "80x60", "--set",
                "region.dims=[9, 8, 10]", "--frames", "1", "--rasterizer", rasterizer});
}

TEST(Bench, CellsAreProjectedByTilesInBothOrdersAndMarched) {
  const json found = benchCells("tiles");
  EXPECT_EQ(found.at("tetrahedra"), 6 * 8 * 7 * 4);
  ASSERT_EQ(found.at("projected").size(), 2);
  for (const json& form : found["projected"]) {
    EXPECT_EQ(form.at("rasterizer"), "tiles");
    EXPECT_GT(form.at("tetrahedra_per_s"), 0);
    EXPECT_TRUE(form.at("bin_ms").at("median").is_number());
    EXPECT_LT(form.at("max_difference"), form.at("order") == "visibility" ? 1e-5 : 1.0);
  }
  EXPECT_GT(found.at("marched").at("cells_passed"), 1000);
}

TEST(Bench, CellsAreProjectedByOpenGlInBothFormsAndOrders) {
  if (run({"render", shippedScenario("quick.yaml"), "--mesh", "terrain:1", "--cells", "project",
           "--cell-rasterizer", "opengl", "--size", "8x8", "-o", TemporaryFolder() / "a.png", "--quiet"})
          .status == 4)
    GTEST_SKIP() << "no OpenGL without a window";
  const json found = benchCells("opengl");
  ASSERT_EQ(found.at("projected").size(), 4);
  for (const json& form : found["projected"]) {
    EXPECT_EQ(form.at("rasterizer"), "opengl");
    EXPECT_EQ(form.at("floats_per_tetrahedron"), form.at("perspective") == "exact" ? 21 : 24);
  }
}

TEST(Bench, CoverageTimesTheFirstHeightAndEachFurtherOne) {
  const json found =
      bench({"coverage", shippedScenario("quick.yaml"), "--cell", "500", "--further", "2", "--repeats", "1"});
  EXPECT_EQ(found.at("device"), deviceName());
  EXPECT_EQ(found.at("further_heights"), 2);
  EXPECT_GT(found.at("pixels"), 100);
  EXPECT_GT(found.at("first_height_ms"), 0);
  EXPECT_TRUE(found.at("further_height_ms").is_number());
  for (const char* step : {"pixels", "places", "columns", "excess", "combine", "product"}) {
    EXPECT_TRUE(found.at("steps_ms").at(step).is_number()) << step;
    EXPECT_TRUE(found.at("further_steps_ms").at(step).is_number()) << step;
  }
}

TEST(Bench, JsonOfFieldHasContractKeys) {
  const json bench =
      json::parse(runWell({"bench", "field", shippedScenario("quick.yaml"), "--repeats", "1", "--json"}).out);
  EXPECT_EQ(bench.at("device"), deviceName());
  EXPECT_EQ(bench.at("grid"), json({40, 40, 20}));
  EXPECT_EQ(bench.at("emitters"), 2);
  for (const char* stage : {"fan", "plane", "combine", "product"})
    EXPECT_TRUE(bench.at("stages_ms").at(stage).is_number());
  for (const char* kind : {"all_moved", "one_moved", "beams_turned"})
    EXPECT_GT(bench.at("update_ms").at(kind), 0.0);
  EXPECT_GT(bench.at("voxels_per_s"), 0.0);
}

TEST(Bench, GlobalOptionsBeforeTheSubcommandReachTheProgram) {
  const ProgramResult result = runWell({"--json", "--quiet", "--threads", "1", "bench", "field",
                                        shippedScenario("quick.yaml"), "--repeats", "1"});
  EXPECT_TRUE(json::parse(result.out).contains("stages_ms"));
  EXPECT_EQ(result.err, "");
}

TEST(Bench, JsonOfRenderHasContractKeys) {
  const json result = bench({"render", shippedScenario("quick.yaml"), "--size", "64x48", "--frames", "3"});
  EXPECT_EQ(result.at("device"), deviceName());
  EXPECT_EQ(result.at("size"), json({64, 48}));
  EXPECT_EQ(result.at("mode"), "dvr");
  EXPECT_EQ(result.at("step_voxels"), 1.0);
  EXPECT_GT(result.at("wall_ms").at("median"), 0.0);
  EXPECT_TRUE(result.at("volume").at("device_bytes").is_number());
  EXPECT_GT(result.at("samples"), 1000);
  EXPECT_LE(result.at("ms").at("min"), result.at("ms").at("median"));
  EXPECT_LE(result.at("ms").at("median"), result.at("ms").at("max"));
  EXPECT_NEAR(result.at("gsamples_per_s"),
              result.at("samples").get<double>() / result.at("ms").at("median").get<double>() / 1e6, 1e-9);
  EXPECT_EQ(result.at("early_termination"), true);
  EXPECT_EQ(result.at("skip_empty"), true);
}

TEST(Bench, ColorsDefaultToShippedFunction) {
  Arguments arguments{"render", shippedScenario("quick.yaml"), "--size", "16x12", "--frames", "1"};
  const json by_default = bench(arguments).at("transfer");
  arguments.insert(arguments.end(), {"--transfer", shippedScenario("transfer/paper.json")});
  EXPECT_EQ(bench(arguments).at("transfer"), by_default);
  arguments.back() = shippedScenario("transfer/relative_viridis.json");
  EXPECT_NE(bench(arguments).at("transfer"), by_default);
}

TEST(Bench, SamplesAreCountedAlongFullRays) {
  const TemporaryFolder folder;
  writeFile(folder / "ball.dat", ballDat(20));
  // Straight down, so that every ray that meets the cube crosses 20 voxels: 29 positions 0.7 voxels apart.
  Arguments arguments{
      "render", folder / "ball.dat", "--size", "40x40",    "--step",
      "0.7",    "--frames",          "1",      "--camera", "orbit:elevation_deg=90,projection=orthographic"};
  const json result = bench(arguments);
  EXPECT_EQ(result.at("volume").at("dims"), json({20, 20, 20}));
  EXPECT_GT(result.at("rays_in_box"), 500);
  EXPECT_EQ(result.at("samples"), 29 * result.at("rays_in_box").get<int>());
  arguments.insert(arguments.end(), {"--exact", "--no-skip", "--rays", "quarter"});
  const json everything = bench(arguments);
  EXPECT_EQ(everything.at("samples"), result.at("samples"));
  EXPECT_EQ(everything.at("early_termination"), false);
  EXPECT_EQ(everything.at("skip_empty"), false);
}

TEST(Bench, RenderWritesThePictureThatItDrew) {
  const TemporaryFolder folder;
  bench({"render", shippedScenario("quick.yaml"), "--size", "64x48", "--frames", "1", "--picture",
         folder / "quick.png"});
  EXPECT_EQ(folder.files(), std::vector<std::string>{"quick.png"});
}

TEST(Bench, JsonOfReconstructionHasContractKeys) {
  const json result = bench({"reconstruction", shippedScenario("quick.yaml"), "--size", "65x47", "--frames",
                             "2", "--mode", "mida"});
  EXPECT_EQ(result.at("device"), deviceName());
  EXPECT_EQ(result.at("volume").at("dims"), json({40, 40, 20}));
  EXPECT_EQ(result.at("size"), json({65, 47}));
  EXPECT_EQ(result.at("mode"), "mida");
  EXPECT_EQ(result.at("step_voxels"), 1.0);
  EXPECT_EQ(result.at("frames"), 2);
  std::vector<std::string> ways;
  for (const json& pattern : result.at("patterns")) {
    ways.push_back(pattern.at("name").get<std::string>() + " " +
                   pattern.at("interpolate").get<std::string>());
    for (const char* times : {"busy_ms", "restore_ms"}) {
      EXPECT_LE(pattern.at(times).at("min"), pattern.at(times).at("median"));
      EXPECT_LE(pattern.at(times).at("median"), pattern.at(times).at("max"));
      EXPECT_EQ(pattern.at(times).at("frames").size(), 2U);
    }
    EXPECT_GT(pattern.at("rays_fraction"), 0.0);
    EXPECT_GT(pattern.at("rays_fraction_of_hits"), 0.0);
    EXPECT_LE(pattern.at("rays_fraction_of_hits"), 1.0);
    EXPECT_GT(pattern.at("ratio_to_full"), 0.0);
    EXPECT_EQ(pattern.at("error").at("max").size(), 4U);
    EXPECT_EQ(pattern.at("error").at("mean").size(), 4U);
    EXPECT_TRUE(pattern.at("error").at("ratio_percent").is_number());
    EXPECT_TRUE(pattern.at("error").contains("psnr_db"));
    EXPECT_EQ(pattern.at("restored_equals_full"), true);
  }
  EXPECT_THAT(
      ways, testing::IsSupersetOf({"full float", "columns float", "columns 8bit", "checkerboard float",
                                   "checkerboard 8bit", "quarter float", "quarter 8bit", "adaptive float"}));
}

TEST(Bench, TheFullPictureHasNoErrorAndQuarterHas) {
  const TemporaryFolder folder;
  writeFile(folder / "ball.dat", ballDat(16));
  const json patterns =
      bench({"reconstruction", folder / "ball.dat", "--size", "64x64", "--frames", "1", "--rays", "quarter"})
          .at("patterns");
  ASSERT_EQ(patterns.size(), 3U);
  const json& full = patterns[0];
  EXPECT_EQ(full.at("name"), "full");
  EXPECT_EQ(full.at("rays_fraction"), 1.0);
  EXPECT_EQ(full.at("rays_fraction_of_hits"), 1.0);
  EXPECT_EQ(full.at("ratio_to_full"), 1.0);
  EXPECT_EQ(full.at("error").at("max"), json({0, 0, 0, 0}));
  EXPECT_TRUE(full.at("error").at("psnr_db").is_null());
  const json& quarter = patterns[1];
  EXPECT_EQ(quarter.at("rays_fraction"), 0.25);
  EXPECT_NEAR(quarter.at("rays_fraction_of_hits"), 0.25, 0.01);
  EXPECT_GT(quarter.at("error").at("ratio_percent"), 0.0);
  EXPECT_GT(quarter.at("error").at("psnr_db"), 20.0);
}

TEST(Bench, VolumesOfEveryKindOfScanAreRead) {
  const TemporaryFolder folder;
  writeFile(folder / "scan_4x5x6_uint8.raw", std::string(4 * 5 * 6, 'a'));
  writeFile(folder / "scan_4x5x6_uint16.raw", std::string(2 * 4 * 5 * 6, 'a'));
  writeFile(folder / "scan_4x5x6_float32.raw", std::string(4 * 4 * 5 * 6, 'a'));
  for (const char* name : {"scan_4x5x6_uint8.raw", "scan_4x5x6_uint16.raw", "scan_4x5x6_float32.raw"}) {
    const json result = bench({"reconstruction", folder / name, "--size", "9x7", "--frames", "1"});
    EXPECT_EQ(result.at("volume").at("dims"), json({4, 5, 6})) << name;
  }
}

TEST(Bench, ScanOfEngineSizeIsRead) {
  const TemporaryFolder folder;
  std::string bytes(256 * 256 * 110, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * i % 251);
  const std::string scan = folder.write("engine_256x256x110_uint8.raw", bytes);
  const json result = bench({"reconstruction", scan, "--size", "32x32", "--frames", "1"});
  EXPECT_EQ(result.at("volume").at("dims"), json({256, 256, 110}));
  for (const json& pattern : result.at("patterns"))
    EXPECT_EQ(pattern.at("error").at("max")[2], 0);  // no blue
}

TEST(Bench, TableStatesRestorationOfEachPattern) {
  const ProgramResult result =
      runWell({"bench", "reconstruction", shippedScenario("quick.yaml"), "--size", "32x24", "--frames", "1"});
  EXPECT_THAT(result.out, HasSubstr("checkerboard"));
  EXPECT_THAT(result.out, HasSubstr("equal"));
}

TEST(Bench, SLOW_ImpossibleMeasurementIsAnErrorWithoutOutput) {
  const TemporaryFolder folder;
  writeFile(folder / "short.dat", ballDat(8).substr(0, 500));
  writeFile(folder / "nameless.raw", "abc");
  const std::string quick = shippedScenario("quick.yaml");
  const std::vector<std::pair<int, Arguments>> wrong{
      {kBadInput, {folder / "short.dat"}},         {kBadInput, {folder / "nameless.raw"}},
      {kBadInput, {folder / "absent.dat"}},        {kBadInput, {quick, "--transfer", folder / "absent.json"}},
      {kUsage, {quick, "--frames", "0"}},          {kUsage, {quick, "--size", "0x5"}},
      {kUsage, {quick, "--mode", "magic"}},        {kUsage, {quick, "--rays", "half"}},
      {kUsage, {quick, "--camera", "orbit:up=1"}}, {kUsage, {quick, "--step", "0"}},
      {kUsage, {quick, "--quantity", "luck"}},
  };
  for (const char* what : {"render", "reconstruction"}) {
    for (const auto& [status, rest] : wrong) {
      Arguments arguments{"bench", what, "--json"};
      arguments.insert(arguments.end(), rest.begin(), rest.end());
      const ProgramResult result = run(arguments);
      EXPECT_EQ(result.status, status) << testing::PrintToString(arguments) << result.err;
      EXPECT_THAT(result.err, HasSubstr("emscape: error: ")) << testing::PrintToString(arguments);
      EXPECT_EQ(result.out, "") << testing::PrintToString(arguments);
    }
  }
}

}  // namespace
}  // namespace emscape::test
