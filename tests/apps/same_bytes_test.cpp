// Files do not depend on the number of threads, and contain neither the time of day nor anything random.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

/// Runs a command with one thread and with three, into separate folders, and compares all files.
/// @param arguments  "OUT" in them becomes the folder
void expectSameBytes(const Arguments& arguments) {
  const TemporaryFolder one, three;
  for (const auto& [folder, threads] : {std::pair(&one, "1"), std::pair(&three, "3")}) {
    Arguments with{"--threads", threads, "--quiet"};
    for (std::string argument : arguments) {
      if (argument.compare(0, 3, "OUT") == 0) argument.replace(0, 3, folder->path().string());
      with.push_back(argument);
    }
    runWell(with);
  }
  ASSERT_FALSE(one.files().empty());
  ASSERT_EQ(one.files(), three.files());
  for (const std::string& file : one.files())
    EXPECT_TRUE(readFile(one / file) == readFile(three / file)) << arguments.front() << ": " << file;
}

TEST(SameBytes, VolumesInEveryFormat) {
  expectSameBytes({"simulate", shippedScenario("jamming.yaml"), "-o", "OUT/series", "--format",
                   "vdb,nvdb,vti,raw", "--quantity",
                   "power_density_dbwm2,detection_probability,dominant_emitter", "--set",
                   "region.dims=[40, 40, 16]", "--times", "20:40:20"});
}

TEST(SameBytes, FieldsOnMeshes) {
  expectSameBytes({"simulate", shippedScenario("jamming.yaml"), "-o", "OUT/series", "--mesh", "terrain:6",
                   "--set", "region.dims=[24, 24, 16]", "--times", "40"});
}

TEST(SameBytes, Pictures) {
  expectSameBytes({"render", quick(), "-o", "OUT/frames", "--size", "160x120", "--times", "0:2:1"});
}

TEST(SameBytes, Videos) {
  if (std::system("command -v ffmpeg >/dev/null") != 0) GTEST_SKIP() << "ffmpeg is not installed";
  expectSameBytes({"render", quick(), "-o", "OUT/film.mp4", "--size", "160x120", "--times", "0:4:1"});
}

TEST(SameBytes, SLOW_MapsOfCoverage) {
  expectSameBytes({"coverage", shippedScenario("jamming.yaml"), "-o", "OUT/maps", "--cell", "500", "--times",
                   "40", "--format", "cog,png,gpkg,geojson,nc,kmz,czml"});
}

TEST(SameBytes, Studies) {
  const TemporaryFolder folder;
  const std::string study =
      folder.write("study.yaml", "schema_version: 1\nscenario: " + shippedScenario("jamming.yaml") +
                                     R"(
times: 40
cell_m: 1000
sweep:
  emitters.stand-off jammer.power_w: {log: {from: 1, to: 1000, count: 6}}
measures:
  - {name: covered, height: "agl:300"}
)");
  expectSameBytes({"study", study, "-o", "OUT/study"});
}

/// What makes GDAL write other bytes does not, given in some way.
/// @param other  shell commands before the program
void expectSameMaps(const TemporaryFolder& folder, const std::string& other) {
  const auto filesWith = [&](const std::string& name, const std::string& commands) {
    runWell({"coverage", quick(), "-o", folder / name, "--cell", "1000", "--products", "covered,value",
             "--times", "0", "--format", "cog,gpkg"},
            commands);
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder / (name + "/maps")))
      files[entry.path().filename().string()] = readFile(entry.path());
    return files;
  };
  const auto usual = filesWith("usual", "");
  EXPECT_EQ(usual.size(), 4u) << "with the labels of the index";
  EXPECT_TRUE(usual == filesWith("other", other));
}

TEST(SameBytes, DoNotDependOnVariablesOfGdal) {
  const TemporaryFolder folder;
  expectSameMaps(folder,
                 "export GDAL_PAM_ENABLED=NO GTIFF_POINT_GEO_IGNORE=YES GDAL_TIFF_ENDIANNESS=BIG "
                 "GDAL_NUM_THREADS=ALL_CPUS GDAL_TIFF_INTERNAL_MASK=YES OGR_SQLITE_JOURNAL=WAL "
                 "OGR_SQLITE_PRAGMA=journal_mode=WAL GPKG_ADD_DEFINITION_12_063=YES GDAL_SKIP=GTiff;");
}

TEST(SameBytes, DoNotDependOnGdalsFileOfOptions) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "home/.gdal");
  const std::string log = folder / "gdal.log";
  folder.write(
      "home/.gdal/gdalrc",
      "[configoptions]\nOGR_SQLITE_JOURNAL=WAL\nGDAL_PAM_ENABLED=NO\nGPKG_ADD_DEFINITION_12_063=YES\n"
      "CPL_DEBUG=ON\nCPL_LOG=" +
          log + "\n");
  expectSameMaps(folder, "export HOME=" + (folder / "home") + ";");
  EXPECT_FALSE(std::filesystem::exists(log));
}

}  // namespace
}  // namespace emscape::test
