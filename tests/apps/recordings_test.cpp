// emscape export and import: files, JSON keys on which other programs rely, and errors. What becomes of
// objects and beams is tested in tests/interop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(Recordings, ScenarioGoesThereAndBackWithoutFaults) {
  const TemporaryFolder folder;
  const ProgramResult exported =
      run({"export", shippedScenario("jamming.yaml"), "-o", folder / "a.pcap", "--step", "5", "--json"});
  ASSERT_EQ(exported.status, 0) << exported.err;
  const json told = json::parse(exported.out);
  for (const char* key : {"file", "format", "emitter_database", "records", "platforms", "emitters"})
    EXPECT_TRUE(told.contains(key)) << key;
  const ProgramResult imported = run({"import", folder / "a.pcap", "-o", folder / "b.yaml", "--emitters",
                                      told["emitter_database"].get<std::string>(), "--json"});
  ASSERT_EQ(imported.status, 0) << imported.err;
  const json result = json::parse(imported.out);
  for (const char* key :
       {"scenario", "tracks", "track_files", "format", "epoch", "begin_s", "end_s", "duration_s", "types",
        "emitters", "left_out", "records", "bad", "first_bad", "torn", "ignored", "notes"}) {
    EXPECT_TRUE(result.contains(key)) << key;
  }
  EXPECT_EQ(result["bad"], 0);
  const ProgramResult checked = run({"validate", folder / "b.yaml"});
  EXPECT_EQ(checked.status, 0) << checked.out;
}

TEST(Recordings, TableTellsWhatWasLeftOut) {
  const TemporaryFolder folder;
  const std::string file = folder.write(
      "a.acmi",
      "FileType=text/acmi/tacview\nFileVersion=2.2\n1,T=5|52|0,Type=Sea+Watercraft,Name=Boat,Fuel=3\n"
      "2,T=5|52|0,Type=Navaid+Static+Bullseye\n#10\n1,T=5.01|52|0\nzzz\n#20\n1,T=5.02");
  const ProgramResult result = run({"import", file, "-o", folder / "b.yaml"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("left out: scenery"));
  EXPECT_THAT(result.out, HasSubstr("navigation radar"));
  EXPECT_THAT(result.out,
              HasSubstr("1 record could not be read, the first: line 7: 'zzz' is no hexadecimal id"));
  EXPECT_THAT(result.out, HasSubstr("the recording ends too early: line 9 has no end"));
  EXPECT_THAT(result.out, HasSubstr("not used: property Fuel (1)"));
}

TEST(Recordings, FaultsNameFileValueAndRemedy) {
  const TemporaryFolder folder;
  const std::string other = folder.write("a.txt", "hello\n");
  const std::string out = folder / "b.yaml";
  const auto errorOf = [](const Arguments& arguments, int status) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, status) << result.err;
    return result.err;
  };
  EXPECT_THAT(errorOf({"import", other, "-o", out}, 3), HasSubstr("a.txt: no recording of a known format"));
  EXPECT_THAT(errorOf({"import", folder / "none", "-o", out}, 3),
              HasSubstr("none: cannot read: no such file"));
  EXPECT_THAT(errorOf({"import", other, "-o", out, "--times", "5"}, 2),
              HasSubstr("--times '5' is not BEGIN:END"));
  EXPECT_THAT(errorOf({"import", other, "-o", out, "--region", "95,0,10"}, 2),
              HasSubstr("--region '95,0,10' is not auto"));
  EXPECT_THAT(errorOf({"export", shippedScenario("quick.yaml"), "-o", folder / "a.hla"}, 2),
              HasSubstr("it ends in .zip.acmi, .acmi, .pcap, .asi"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(Recordings, FilesThatExistAreReplacedOnlyWithForce) {
  const TemporaryFolder folder;
  const std::string flight = folder.write(
      "a.acmi",
      "FileType=text/acmi/tacview\nFileVersion=2.2\n1,T=5|52|3000,Type=Air+FixedWing,Name=F-14\n#10\n"
      "1,T=5.01|52\n");
  const std::string scenario = folder / "b.yaml", track = folder / "b_tracks/f-14.csv";
  const std::string recording = folder / "c.acmi", database = folder / "c.acmi.emitters.yaml";
  const Arguments import{"import", flight, "-o", scenario};
  const Arguments write{"export", shippedScenario("quick.yaml"), "-o", recording};
  const auto expectKept = [&](Arguments arguments, const std::string& file) {
    const std::vector<std::string> files = folder.files();
    std::filesystem::create_directories(std::filesystem::path(file).parent_path());
    writeFile(file, "mine\n");
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(file + " exists; --force replaces it, another --output keeps it"));
    EXPECT_EQ(readFile(file), "mine\n");
    arguments.emplace_back("--force");
    EXPECT_EQ(run(arguments).status, 0);
    EXPECT_NE(readFile(file), "mine\n");
  };
  expectKept(import, scenario);
  std::filesystem::remove(scenario);
  expectKept(import, track);
  expectKept(write, recording);
  std::filesystem::remove(recording);
  expectKept(write, database);
}

}  // namespace
}  // namespace emscape::test
