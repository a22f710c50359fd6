// emscape info: signals, refractivity.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/apps/program.h"
#include "tests/support/sanitizers.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

const char* const kSurfaceBased = "height_msl_m,m_units\n0,330\n200,353.6\n300,313.6\n";

TEST(Info, EndsAtFirstSignal) {
  const TemporaryFolder folder;
  const std::string pipe = folder / "never_written.tif";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  // The pipe itself is refused.
  const std::string list = folder.write(
      "list.vrt",
      "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><SRS>EPSG:4326</SRS>"
      "<GeoTransform>5, 0.1, 0, 52, 0, -0.1</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\">"
      "<SimpleSource><SourceFilename relativeToVRT=\"1\">never_written.tif</SourceFilename>"
      "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>");
  RunningProgram info({"info", list});
  int writer = -1;  // can be opened once the program reads
  for (int n = 0; n < 1000 && writer < 0; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    writer = open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  }
  EXPECT_GE(writer, 0);
  info.signal(SIGTERM);
  const ProgramResult result = info.wait();
  EXPECT_EQ(result.status, 128 + SIGTERM);
  EXPECT_EQ(result.err, "emscape: stopped by signal 15\n");
  close(writer);
}

TEST(Info, NamesAListOnceAndKeepsEachTextOnALine) {
  const TemporaryFolder folder;
  const std::string file = folder.write("two\nlines.yaml", readFile(quick()));
  const std::string out = run({"info", file}).out;
  EXPECT_THAT(out, HasSubstr("two\\nlines.yaml\"\n"));
  EXPECT_THAT(out, HasSubstr("emitters:\n  -\n    name: radar\n"));
  EXPECT_EQ(out.find("emitters:"), out.rfind("emitters:"));
}

TEST(Info, MissingLibraryOfOpenVdbIsNamedWithItsPackage) {
  const TemporaryFolder folder;
  const std::string copy = folder / "bin/emscape", said = folder / "said.txt";
  std::filesystem::create_directory(folder / "bin");
  std::filesystem::copy_file(besideThisProgram("emscape"), copy);  // without lib/emscape beside bin/
  const std::string volume = folder.write("volume.vdb", "");
  EXPECT_NE(std::system((copy + " info " + volume + " 2>" + said).c_str()), 0);
  EXPECT_THAT(readFile(said), AllOf(HasSubstr("emscape_vdb.so"), HasSubstr("libopenvdb10.0")));
  EXPECT_EQ(std::system((copy + " validate " + quick() + " >" + said).c_str()), 0) << "needs no OpenVDB";
}

TEST(InfoOfRefractivity, ListsDuctsOfAProfile) {
  const TemporaryFolder folder;
  const std::string file = folder.write("air.csv", kSurfaceBased);
  const json report = json::parse(runWell({"info", file, "--json", "--plot", folder / "air.png"}).out);
  EXPECT_EQ(report.at("kind"), "refractivity");
  const json& duct = report.at("profiles").at(0).at("ducts").at(0);
  EXPECT_EQ(duct.at("kind"), "surface-based");
  EXPECT_EQ(duct.at("top_msl_m"), 300);
  EXPECT_EQ(duct.at("strength_m_units"), 40);
  EXPECT_EQ(duct.at("trapped_modes").at(1).at("modes"), 42);  // at 3 GHz
  EXPECT_GT(std::filesystem::file_size(folder / "air.png"), 10000u);
  EXPECT_THAT(run({"info", file}).out, HasSubstr("kind: surface-based"));
}

TEST(InfoOfRefractivity, ListsEveryFileWithItsHeights) {
  const TemporaryFolder folder;
  EXPECT_THAT(run({"info", folder.write("air.csv", "height_msl_m,M_units\n0,330\n")}).err,
              HasSubstr("air.csv:1:14: unknown column 'M_units'; the header has height_msl_m and m_units"));
}

TEST(Info, NamesDescribedTables) {
  const TemporaryFolder folder;
  const ProgramResult track =
      run({"info", folder.write("track.csv", "t_s,latitude_deg,longitude_deg,height_msl_m\n0,50,6,100\n")});
  EXPECT_EQ(track.status, 3);
  EXPECT_THAT(track.err,
              HasSubstr("track.csv:1:1: no pair of angles among the columns 't_s', 'latitude_deg'"));
  EXPECT_THAT(track.err, HasSubstr("a table of a pattern has columns such as"));
  EXPECT_THAT(run({"info", folder.write("rcs.csv", "azimuth_deg;elevation_deg;rcs_dbsm\n")}).err,
              HasSubstr("rcs.csv:1:1: no gain, directivity or attenuation among the columns"));
}

TEST(Info, ReportsBytesThatAreNotUtf8AsReplacements) {
  const TemporaryFolder folder;
  const std::string file = folder.write("s\xE9.yaml", readFile(quick()));
  EXPECT_THAT(json::parse(run({"info", file, "--json"}).out).at("file").get<std::string>(),
              HasSubstr("/s\xEF\xBF\xBD.yaml"));
  const std::string broken = folder.write("b\xE9.yaml", "name: 1\n");
  const json problems = json::parse(run({"validate", broken, "--json"}).out).at("problems");
  EXPECT_THAT(problems.at(0).at("file").get<std::string>(), HasSubstr("/b\xEF\xBF\xBD.yaml"));
  EXPECT_EQ(run({"render", file, "-o", folder / "o\xE9.png", "--size", "64x48", "--json"}).status, 0);
  runWell({"coverage", file, "-o", folder / "maps", "--format", "czml", "--cell", "4000"});
  EXPECT_THAT(readFile(folder / "maps/study.json"), HasSubstr("/s\xEF\xBF\xBD.yaml"));
}

TEST(InfoOfRefractivity, ReadsSoundingsByTheirContent) {
  const TemporaryFolder folder;
  const ProgramResult result =
      runWell({"info",
               folder.write("USM00072649-data.txt",
                            "#USM00072649 2023 11 18 00 2303    2 ncdc-nws           448497  -935647\n"
                            "21     0  98107B  290    65B  350   143   360     0 \n"
                            "20    33  95916   476B   60B  325   152   224    73 \n"),
               "--json"});
  EXPECT_EQ(json::parse(result.out).at("profiles").at(0).at("levels"), 2);
}

TEST(InfoOfRefractivity, IsPartOfAScenario) {
  const TemporaryFolder folder;
  const std::string file = folder.write("duct.yaml", R"(schema_version: 1
name: duct
region: {origin: {latitude_deg: 36, longitude_deg: -84}, size_m: [1000, 1000, 1000], dims: [4, 4, 4]}
atmosphere: {refractivity: {kind: evaporation_duct, duct_height_m: {mean: 14, deviation: 3}, members: 10}}
platforms: [{name: site, position: {latitude_deg: 36, longitude_deg: -84, height_msl_m: 100}}]
emitters:
  - {name: r, platform: site, kind: transmitter, frequency_hz: 1.0e10, power_w: 10, antenna: {pattern: isotropic}}
)");
  const json report =
      json::parse(runWell({"info", file, "--json", "--plot", folder / "duct.svg"}).out).at("refractivity");
  EXPECT_EQ(report.at("profiles").at(0).at("ducts").at(0).at("kind"), "evaporation");
  EXPECT_EQ(report.at("profiles").at(0).at("ducts").at(0).at("trapped_modes").at(0).at("frequency_hz"), 1e10);
  EXPECT_EQ(report.at("members").at("count"), 10);
  EXPECT_LT(report.at("members").at("duct_top_msl_m").at(0), 14);
  EXPECT_EQ(readFile(folder / "duct.svg"), [&] {
    run({"info", file, "--plot", folder / "again.svg"});
    return readFile(folder / "again.svg");
  }());
}

TEST(Info, ListsTheChoicesOfModelsAsValidateDoes) {
  const TemporaryFolder folder;
  const std::string file = folder.write("march.yaml", R"(schema_version: 1
name: march
region: {origin: {latitude_deg: 36, longitude_deg: -84}, size_m: [1000, 1000, 1000], dims: [4, 4, 4]}
platforms: [{name: site, position: {latitude_deg: 36, longitude_deg: -84, height_msl_m: 100}}]
emitters:
  - {name: r, platform: site, kind: transmitter, frequency_hz: 1.0e9, power_w: 10, antenna: {pattern: isotropic},
     propagation: parabolic_equation}
)");
  const json choices = json::parse(run({"info", file, "--json"}).out).at("choices");
  ASSERT_FALSE(choices.empty());
  EXPECT_EQ(choices.at(0).at("emitter"), "r");
  EXPECT_EQ(choices, json::parse(run({"validate", file, "--json"}).out).at("choices"));
  EXPECT_THAT(run({"info", file}).out, HasSubstr("choices:\n  -\n    emitter: r\n"));
}

TEST(Info, AHeaderOfValuesDescribesThem) {
  const TemporaryFolder folder;
  runWell({"simulate", quick(), "-o", folder / "out", "--format", "raw,nvdb", "--times", "0"});
  for (const std::string ending : {".raw", ".nvdb"}) {
    std::string file;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out"))
      if (entry.path().extension() == ending) file = entry.path().string();
    const ProgramResult of_values = run({"info", file, "--json"}),
                        of_header = run({"info", file + ".json", "--json"});
    EXPECT_EQ(of_header.status, 0) << of_header.err;
    EXPECT_EQ(of_header.out, of_values.out);
  }
}

TEST(InfoOfRefractivity, RefusesAPlotOfOtherFiles) {
  const TemporaryFolder folder;
  EXPECT_THAT(errorOfRun({"info", quick(), "--plot", folder / "x.png"}, 2),
              HasSubstr("--plot draws refractivity"));
  EXPECT_EQ(run({"info", quick(), "--plot", folder / "x.pdf"}).status, 2);
  EXPECT_EQ(run({"info", folder.write("air.csv", "height_msl_m,m_units\n0,330\n")}).status, 3);
}

TEST(Info, RefusesAVolumeThatDoesNotFitBeforeItReadsItsValues) {
  if (kIsSanitized) GTEST_SKIP() << "the sanitizers reserve more address space than the limit";
  const TemporaryFolder folder;
  const std::string extent = "\"0 1023 0 1023 0 1023\"";
  const std::string file = folder.write(
      "a.vti", "<VTKFile type=\"ImageData\"><ImageData WholeExtent=" + extent +
                   " Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece Extent=" + extent +
                   "><PointData><DataArray type=\"UInt8\" Name=\"a\" format=\"ascii\">1 2 3</DataArray>"
                   "</PointData></Piece></ImageData></VTKFile>\n");
  EXPECT_THAT(errorOfRun({"info", file}, 1, "ulimit -v 1000000;"),
              testing::HasSubstr("a.vti: array a of 1073741824 values needs up to 5120 MiB"));
}

TEST(Info, EntriesBesideTheVolumesEndNoReading) {
  const TemporaryFolder folder;
  ASSERT_EQ(run({"simulate", quick(), "--times", "0", "-o", folder / "s"}).status, 0);
  std::filesystem::create_symlink("loop", folder / "s/loop");
  std::filesystem::create_symlink("nowhere", folder / "s/a.vdb");
  runWell({"info", folder / "s"});
}

}  // namespace
}  // namespace emscape::test
