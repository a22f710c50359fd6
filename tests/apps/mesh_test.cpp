// Fields on tetrahedra through the program: simulate --mesh, info and render.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

Arguments simulate(const std::string& folder, const Arguments& more = {}) {
  return joined({"simulate", shippedScenario("jacksboro.yaml"), "-o", folder, "--set",
                 "region.dims=[20, 18, 10]", "--times", "0:20:10", "--quiet"},
                more);
}

TEST(MeshSeries, SLOW_IsReproducible) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"}) {
    const ProgramResult result = runWell(simulate(folder / name, {"--mesh", "terrain:9,4"}));
  }
  for (const char* file : {"jacksboro.pvd", "jacksboro_0001.vtu", "jacksboro_0003.vtu", "series.json"}) {
    EXPECT_EQ(readFile(folder / ("a/" + std::string(file))), readFile(folder / ("b/" + std::string(file))))
        << file;
  }
  EXPECT_THAT(readFile(folder / "a/jacksboro.pvd"), HasSubstr("jacksboro_0003.vtu"));
  EXPECT_EQ(run(simulate(folder / "a", {"--mesh", "terrain:9,4", "--resume"})).status, 0);
  EXPECT_EQ(run(simulate(folder / "a", {"--mesh", "terrain:9,5", "--resume"})).status, 3);

  for (const char* input : {"a", "a/jacksboro.pvd"}) {
    const json info = json::parse(runWell({"info", folder / input, "--json"}).out);
    EXPECT_EQ(info["kind"], "mesh");
    EXPECT_EQ(info["steps"], 3);
    EXPECT_EQ(info["points"], 20 * 18 * 10);
    EXPECT_EQ(info["tetrahedra"], 6 * 19 * 17 * 9);
    EXPECT_EQ(info["inverted_tetrahedra"], 0);
    EXPECT_EQ(info["touching_faces"], 0);
    EXPECT_EQ(info["fields"][0]["quantity"], "power_density_dbwm2");
    EXPECT_EQ(info["fields"][0]["unit"], "dBW/m2");
  }

  const auto render = [&](const Arguments& more) {
    return run(joined({"render", folder / "a", "--size", "320x240", "--quiet"}, more));
  };
  for (const char* name : {"one.png", "two.png"}) {
    const ProgramResult drawn =
        render({"-o", folder / name, "--scenario", shippedScenario("jacksboro.yaml"), "--times", "10"});
    ASSERT_EQ(drawn.status, 0) << drawn.err;
  }
  EXPECT_EQ(readFile(folder / "one.png"), readFile(folder / "two.png"));
  EXPECT_EQ(render({"-o", folder / "frames"}).status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "frames/jacksboro_0003.png"))
      << "named by the scenario, which the series knows";

  const auto refusal = [&](const Arguments& more) {
    const ProgramResult result = render(joined({"-o", folder / "no.png"}, more));
    EXPECT_EQ(result.status, 2);
    return result.err;
  };
  EXPECT_THAT(refusal({"--mode", "mida"}),
              HasSubstr("mode mida: fields on tetrahedra support only mode dvr"));
  EXPECT_THAT(refusal({"--rays", "columns"}), HasSubstr("--rays columns: has no effect"));
  EXPECT_THAT(refusal({"--step", "0.5"}), HasSubstr("--step: has no effect"));
  EXPECT_THAT(refusal({"--compare", "original"}), HasSubstr("--compare: has no effect"));
  EXPECT_THAT(refusal({"--mesh", "terrain:9"}), HasSubstr("is not a scenario"));
  EXPECT_THAT(refusal({"--plane", "horizontal:altitude_m=900"}), HasSubstr("plane"));
  EXPECT_FALSE(std::filesystem::exists(folder / "no.png"));
}

TEST(MeshSeries, SLOW_ScenarioIsDrawnLikeItsFiles) {
  const TemporaryFolder folder;
  const Arguments mesh{"--mesh", "terrain:9,4"}, picture{"--size", "320x240", "--quiet", "--json"};
  ASSERT_EQ(run(simulate(folder / "a", mesh)).status, 0);
  const auto draw = [&](Arguments arguments, const Arguments& more) {
    arguments.insert(arguments.begin(), "render");
    for (const Arguments& some : {picture, more}) arguments.insert(arguments.end(), some.begin(), some.end());
    return json::parse(runWell(arguments).out);
  };
  const std::string scenario = shippedScenario("jacksboro.yaml");
  const Arguments computed{scenario,         "--mesh",  "terrain:9,4", "--set", "region.dims=[20, 18, 10]",
                           "--range=-120:0", "--times", "10"};
  const Arguments stored{folder / "a", "--scenario", scenario, "--range=-120:0", "--times", "10"};
  const json marched = draw(computed, {"-o", folder / "computed.png"});
  EXPECT_EQ(marched["cells"]["drawn"], "marched");
  draw(stored, {"-o", folder / "stored.png"});
  const auto pixelsOf = [&](const char* name) {  // without the text that tells of edits
    const std::string png = readFile(folder / name);
    return png.substr(std::min(png.find("sRGB"), png.size()));
  };
  EXPECT_EQ(pixelsOf("computed.png"), pixelsOf("stored.png"));

  EXPECT_THAT(run({"render", scenario, "-o", folder / "no.png", "--cells", "march"}).err,
              HasSubstr("--cells: has no effect on volumes"));
  const auto projected = [&](const char* rasterizer, const char* order) {
    const json report = draw(stored, {"-o", folder / "projected.png", "--cells", "project",
                                      "--cell-rasterizer", rasterizer, "--cell-order", order});
    EXPECT_EQ(report["cells"]["drawn"], "projected by " + std::string(order));
    return report["cells"];
  };
  constexpr int kCells = 6 * 19 * 17 * 9;
  for (const char* order : {"centroids", "visibility"}) {
    const json tiles = projected("tiles", order);
    EXPECT_GT(tiles["tetrahedra"], 0);
    EXPECT_LE(tiles["tetrahedra"], kCells);
  }
  EXPECT_THAT(run({"render", folder / "a", "-o", folder / "no.png", "--cells", "project", "--cell-rasterizer",
                   "tiles", "--cell-perspective", "published"})
                  .err,
              HasSubstr("tiles of pixels support only the exact form"));
  const Arguments by_opengl{"render",  folder / "a",        "-o",     folder / "a.png", "--cells",
                            "project", "--cell-rasterizer", "opengl", "--quiet"};
  if (run(by_opengl).status == 4) GTEST_SKIP() << "no OpenGL without a window";
  for (const char* order : {"centroids", "visibility"}) {
    const json opengl = projected("opengl", order);
    EXPECT_EQ(opengl["tetrahedra"], kCells);
    EXPECT_EQ(opengl["sent_bytes"], 21 * 4 * kCells);
  }
}

TEST(MeshSeries, FormatsAndMeshesGoTogether) {
  const TemporaryFolder folder;
  const auto refusal = [&](const Arguments& more) {
    const ProgramResult result = run(simulate(folder / "a", more));
    EXPECT_EQ(result.status, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "a"));
    return result.err;
  };
  EXPECT_THAT(refusal({"--format", "vtu"}), HasSubstr("--format vtu: needs --mesh"));
  EXPECT_THAT(refusal({"--format", "vti", "--mesh", "terrain:9"}),
              HasSubstr("--format vti: with --mesh the format is vtu"));
  EXPECT_THAT(refusal({"--mesh", "terrain:none"}), HasSubstr("LAYERS 'none' must be a number 1..4096"));
  EXPECT_THAT(refusal({"--mesh", "terrain:100,500"}), HasSubstr("FIRST_M must be at most"));
}

TEST(MeshFile, DamageIsReportedInOneLine) {
  const TemporaryFolder folder;
  const std::string file = folder.write("a.vtu", "<VTKFile type=\"UnstructuredGrid\"></VTKFile>");
  for (const Arguments& arguments :
       {Arguments{"info", file}, Arguments{"render", file, "-o", folder / "a.png"}}) {
    EXPECT_THAT(errorOfRun(arguments, 3), HasSubstr("a.vtu: an unstructured grid in one piece can be read"));
  }
}

}  // namespace
}  // namespace emscape::test
