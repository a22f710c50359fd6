// emscape validate on broken scenarios. The parser's tests cover every kind of error; these tests cover the
// program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/sanitizers.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The shipped quick scenario with one piece of text replaced, as a file.
class Validate : public testing::Test {
 protected:
  std::string changed(const std::string& from, const std::string& to) {
    std::string text = readFile(shippedScenario("quick.yaml"));
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    const std::string file = folder_ / "changed.yaml";
    writeFile(file, text.replace(at, from.size(), to));
    return file;
  }

  TemporaryFolder folder_;
};

TEST_F(Validate, ShippedScenariosAreWithoutFault) {
  for (const char* name :
       {"quick.yaml", "sphere_64.yaml", "eme_200.yaml", "jacksboro.yaml", "jamming.yaml"}) {
    const ProgramResult result = run({"validate", shippedScenario(name)});
    EXPECT_EQ(result.status, 0) << name << result.out << result.err;
  }
}

TEST_F(Validate, ReportsTheFaultsOfAllFilesOfTheTerrain) {
  for (const char* const name : {"a.tif", "b.tif", "s.tif", "c.tif"}) writeFile(folder_ / name, "no raster");
  const std::string terrain =
      "terrain: {files: [a.tif, b.tif], surface_files: [s.tif], land_cover: {files: [c.tif], classes: "
      "worldcover}}\nplatforms:";
  const ProgramResult sound = run({"validate", changed("platforms:", terrain)});
  EXPECT_EQ(sound.status, 3);
  for (const char* const name : {"a.tif", "b.tif", "s.tif", "c.tif"})
    EXPECT_THAT(sound.out, HasSubstr(name)) << sound.out;
  // Beside an error of the scenario itself.
  std::string text = readFile(folder_ / "changed.yaml");
  writeFile(folder_ / "wrong.yaml", text.replace(text.find("power_w: 1000\n"), 13, "power_w: -1"));
  const ProgramResult wrong = run({"validate", folder_ / "wrong.yaml"});
  EXPECT_EQ(wrong.status, 3);
  for (const char* const part : {"power_w", "a.tif", "b.tif", "s.tif", "c.tif"})
    EXPECT_THAT(wrong.out, HasSubstr(part)) << wrong.out;
}

TEST_F(Validate, ReportsMemoryOfTheField) {
  const json work = json::parse(run({"validate", shippedScenario("quick.yaml"), "--json"}).out).at("work");
  EXPECT_EQ(work.at("steps"), 5);
  EXPECT_DOUBLE_EQ(work.at("step_mib"), 40 * 40 * 20 * 4 / 1048576.0);  // one channel
  // at least the sum and the volume of the channel, at most ten times as much
  EXPECT_GT(work.at("volumes_mib"), 2 * work.at("step_mib").get<double>());
  EXPECT_LT(work.at("volumes_mib"), 10 * work.at("step_mib").get<double>());
  EXPECT_DOUBLE_EQ(work.at("memory_mib"),
                   work.at("volumes_mib").get<double>() + work.at("emitters_mib").get<double>());
  EXPECT_EQ(work.at("terrain_mib"), 0);
  EXPECT_EQ(json::parse(run({"info", shippedScenario("quick.yaml"), "--json"}).out).at("work").at("step_mib"),
            work.at("step_mib"));
}

TEST_F(Validate, HasWarningsOfFilesInItsJsonToo) {
  const TemporaryFolder folder;
  std::string cuts = "NAME a\nGAIN 15\n";
  for (const char* const plane : {"HORIZONTAL", "VERTICAL"}) {
    cuts += plane + std::string(" 360\n");
    for (int angle = 0; angle < 360; ++angle) cuts += std::to_string(angle) + " 0\n";
  }
  folder.write("a.msi", cuts);
  const ProgramResult result =
      run({"validate", shippedScenario("quick.yaml"), "--json", "--set",
           "emitters.radar.antenna={pattern: file, file: " + (folder / "a.msi") + "}"});
  EXPECT_THAT(result.err, HasSubstr("its GAIN has no unit and is taken as dBd"));
  const json problems = json::parse(result.out).at("problems");
  int told = 0;
  for (const json& problem : problems) {
    if (problem.at("message").get<std::string>().find("a.msi: its GAIN has no unit") == std::string::npos)
      continue;
    ++told;
    EXPECT_EQ(problem.at("severity"), "warning");
  }
  EXPECT_EQ(told, 1);
}

TEST_F(Validate, EstimatesTimeByVoxelsModelsAndThreads) {
  const std::string scenario = shippedScenario("jacksboro.yaml");
  const auto workOf = [&](const std::vector<std::string>& more) {
    return json::parse(
               run(joined({"validate", scenario, "--json", "--threads", "1", "--set", "duration_s=0"}, more))
                   .out)
        .at("work");
  };
  const json coarse = workOf({"--set", "region.dims=[40, 40, 20]"});
  const json fine = workOf({"--set", "region.dims=[80, 80, 40]"});
  EXPECT_GT(fine.at("time_s"), 4 * coarse.at("time_s").get<double>()) << "as the columns";
  EXPECT_LT(fine.at("time_s"), 8 * coarse.at("time_s").get<double>()) << "as the voxels";
  EXPECT_GT(coarse.at("terrain_mib"), 0.1);
  const json itm =
      workOf({"--set", "region.dims=[80, 80, 40]", "--set", "emitters.search radar.propagation=itm"});
  EXPECT_GT(itm.at("time_s"), 2 * fine.at("time_s").get<double>());
  EXPECT_EQ(itm.at("threads"), 1);
  EXPECT_THAT(run({"validate", scenario, "--threads", "1"}).out,
              HasSubstr("on 1 thread, within a factor of 5"));
}

TEST_F(Validate, RefusesAFieldThatDoesNotFitIntoTheMemory) {
  if (kIsSanitized) GTEST_SKIP() << "the sanitizers reserve more address space than the limit";
  const ProgramResult result =
      run({"validate", shippedScenario("quick.yaml"), "--set", "region.dims=[512, 512, 256]"},
          "ulimit -v 1500000;");
  EXPECT_EQ(result.status, 1) << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("the field of 512 x 512 x 256 voxels"));
  EXPECT_THAT(result.out, testing::HasSubstr("fewer voxels (region.dims) or emitters take less"));
  // 4096 x 4096 columns alone are 2 GiB
  const ProgramResult wide =
      run({"validate", shippedScenario("quick.yaml"), "--set", "region.dims=[4096, 4096, 2]"},
          "ulimit -v 1500000;");
  EXPECT_EQ(wide.status, 1) << wide.err;
  EXPECT_THAT(wide.out, testing::ContainsRegex(
                            "quick.yaml: error: the field of 4096 x 4096 x 2 voxels, .* needs up to "));
  const TemporaryFolder folder;
  EXPECT_EQ(run({"simulate", shippedScenario("quick.yaml"), "--set", "region.dims=[512, 512, 256]", "-o",
                 folder / "o"},
                "ulimit -v 1500000;")
                .status,
            result.status)
      << "one cause, one status";
}

TEST_F(Validate, ReportsLocationAndSeverityOfEveryProblem) {
  const std::string file = changed("power_w: 1000\n", "power_w: -1000\n    colour: red\n");
  const ProgramResult text = run({"validate", file});
  EXPECT_EQ(text.status, 3);
  EXPECT_THAT(text.out, testing::ContainsRegex(file + ":[0-9]+:[0-9]+: error: "));

  const ProgramResult result = run({"validate", file, "--json"});
  EXPECT_EQ(result.status, 3);
  const json report = json::parse(result.out);
  EXPECT_EQ(report.at("ok"), false);
  ASSERT_EQ(report.at("problems").size(), 2U) << result.out;
  for (const json& problem : report.at("problems")) {
    EXPECT_EQ(problem.at("file"), file);
    EXPECT_GT(problem.at("line"), 0);
    EXPECT_GT(problem.at("column"), 0);
    EXPECT_EQ(problem.at("severity"), "error");
    EXPECT_TRUE(problem.at("message").is_string());
  }
}

TEST_F(Validate, ChecksTheEditsOfTheCommandLine) {
  const std::string file = shippedScenario("jacksboro.yaml");
  EXPECT_EQ(run({"validate", file, "--set", "emitters.search radar.power_w=500", "--set",
                 "region.dims=[20, 20, 10]"})
                .status,
            0);
  const ProgramResult unknown = run({"validate", file, "--set", "emitters.serch radar.power_w=500"});
  EXPECT_EQ(unknown.status, 3);
  EXPECT_THAT(
      unknown.out,
      HasSubstr("emitters.serch radar.power_w=500: error: there is no emitter 'serch radar'; allowed"));
  EXPECT_THAT(unknown.out, HasSubstr("'jammer'; did you mean 'search radar'?\n"));
  const ProgramResult value = run({"validate", file, "--set", "atmosphere.k_factor=99", "--json"});
  EXPECT_EQ(value.status, 3);
  EXPECT_EQ(json::parse(value.out).at("problems").at(0).at("file"), "atmosphere.k_factor=99");
  EXPECT_THAT(errorOfRun({"validate", file, "--set", "atmosphere.k_factor"}, 2),
              HasSubstr("write PATH=VALUE"));
}

TEST_F(Validate, FindsRegionsBeyondTheElevationData) {
  const std::string dem = shippedScenario("data/jacksboro.tif");
  const std::string file = changed("platforms:", "terrain: {files: ['" + dem + "']}\nplatforms:");
  const ProgramResult result = run({"validate", file});
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.out, HasSubstr("1600 columns"));
}

TEST_F(Validate, FindsPlatformsBelowTheGround) {
  std::string text = readFile(shippedScenario("jacksboro.yaml"));
  const std::string agl = "longitude_deg: -84.24167, height_agl_m: 15";
  ASSERT_NE(text.find(agl), std::string::npos);
  text.replace(text.find(agl), agl.size(), "longitude_deg: -84.24167, height_msl_m: 500");
  for (const char* name : {"data/jacksboro.tif", "data/helicopter.csv", "data/sector_450mhz.msi"}) {
    const std::string path = name;
    text.replace(text.find(path), path.size(), shippedScenario(path));
  }
  const std::string file = folder_ / "below.yaml";
  writeFile(file, text);
  const ProgramResult result = run({"validate", file});
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.out, HasSubstr("ridge site"));
  EXPECT_EQ(result.out.find("ridge site"), result.out.rfind("ridge site")) << "told once";
}

TEST_F(Validate, FindsAntennasAtTheGroundThatTheParabolicEquationCannotMarch) {
  const std::string file = folder_ / "ship.yaml";
  writeFile(file, R"(schema_version: 1
name: ship
region:
  origin: {latitude_deg: 36, longitude_deg: -60}
  size_m: [20000, 20000, 100]
  dims: [10, 10, 10]
ground: {kind: sea}
platforms:
  - {name: ship, position: {latitude_deg: 36, longitude_deg: -60, height_msl_m: 0}}
emitters:
  - name: beacon
    platform: ship
    kind: transmitter
    frequency_hz: 1.0e9
    power_w: 1
    polarization: horizontal
    antenna: {pattern: isotropic}
    propagation: parabolic_equation
)");
  const ProgramResult result = run({"validate", file});
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.out, HasSubstr("error: emitter 'beacon': 'parabolic_equation': antenna 0 m above the "
                                    "ground; expected above 0"));
  EXPECT_THAT(errorOfRun({"profile", file, "--emitter", "beacon", "--to", "36.05,-60,20"}, 3),
              HasSubstr("emitter 'beacon': 'parabolic_equation': antenna 0 m above the ground"));
  EXPECT_EQ(run({"validate", file, "--set", "platforms.ship.position.height_msl_m=10"}).status, 0);
}

TEST_F(Validate, ReportsErrorOfEachPlatformOnceWithItsSteps) {
  const std::string dem = shippedScenario("data/jacksboro.tif");
  writeFile(folder_ / "track.csv",
            "t_s,latitude_deg,longitude_deg,height_msl_m\n0,36.3,-84.2,3000\n4,36.3,-84.2,-100\n");
  const std::string file = folder_ / "low.yaml";
  writeFile(file, R"(schema_version: 1
name: low
duration_s: 4
step_s: 1
region:
  origin: {latitude_deg: 36.3, longitude_deg: -84.2}
  size_m: [2000, 2000, 3000]
  dims: [4, 4, 4]
terrain: {files: [')" +
                      dem + R"(']}
platforms:
  - {name: cellar, position: {latitude_deg: 36.3, longitude_deg: -84.2, height_msl_m: 1}}
  - {name: diver, track: {file: track.csv}}
  - {name: mine, position: {latitude_deg: 36.301, longitude_deg: -84.2, height_msl_m: 2}}
emitters:
  - {name: e, platform: cellar, kind: transmitter, frequency_hz: 1.0e9, power_w: 1, antenna: {pattern: isotropic}}
)");
  const ProgramResult result = run({"validate", file});
  EXPECT_EQ(result.status, 3);
  for (const char* platform : {"'cellar'", "'diver'", "'mine'"}) {
    const std::size_t first = result.out.find(platform);
    EXPECT_NE(first, std::string::npos) << platform;
    EXPECT_EQ(first, result.out.rfind(platform)) << platform;
  }
  EXPECT_THAT(result.out, HasSubstr(" (at 1 of 5 steps)\n"));
}

TEST_F(Validate, ReportsAFaultyValueOfAPlacedReceiverWithItsLine) {
  for (const char* gain : {".nan", "1e9", "90", "x"}) {
    const ProgramResult result = run({"validate", shippedScenario("quick.yaml"), "--set",
                                      std::string("receivers=[{name: rx, platform: mast, gain_dbi: ") + gain +
                                          ", center_frequency_hz: 1e9, bandwidth_hz: 1e6}]"});
    EXPECT_EQ(result.status, 3);
    EXPECT_THAT(result.out, testing::HasSubstr("'gain_dbi'")) << result.err;
    EXPECT_EQ(result.err, "");
  }
}

}  // namespace
}  // namespace emscape::test
