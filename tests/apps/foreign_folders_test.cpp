// Folders of others: files of the user in an output folder stay, links in it are refused, and names of files
// in a scenario or study reach no network.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "tests/apps/program.h"
#include "tests/support/listener.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

/// The subcommands that write into a folder, with the shortest work. @param folder  has study.yaml
std::vector<Arguments> writersInto(const TemporaryFolder& folder) {
  const Arguments maps{"--cell", "2000",       "--heights", "agl:100",  "--times",
                       "0",      "--products", "covered",   "--format", "cog"};
  std::vector<Arguments> writers{
      {"simulate", quick(), "--times", "0", "-o", folder / "out"},
      {"coverage", quick(), "-o", folder / "out"},
      {"compare", quick(), "--set-b", "emitters.radar.power_w=1", "-o", folder / "out"},
      {"study", folder / "study.yaml", "--keep", "maps", "-o", folder / "out"}};
  for (const std::size_t n : {1u, 2u}) writers[n].insert(writers[n].end(), maps.begin(), maps.end());
  return writers;
}

/// study.yaml, whose terms are in `more`.
void writeStudy(const TemporaryFolder& folder,
                const std::string& more = "sweep: {emitters.radar.power_w: {values: [1, 2]}}") {
  folder.write("study.yaml", "schema_version: 1\nscenario: " + quick() + "\ntimes: 0\ncell_m: 5000\n" + more +
                                 "\nmeasures:\n  - {name: covered, height: \"agl:300\"}\n");
}

TEST(ForeignFolder, SLOW_FilesOfTheUserThatAreNamedLikePartsAreKept) {
  const TemporaryFolder folder;
  writeStudy(folder);
  std::vector<std::string> kept;
  for (const std::string inner : {"out/", "out/maps/", "out/parts/", "out/variants/0/"}) {
    for (int n = 0; n < 4; ++n) kept.push_back(inner + "backup.tar.gz.part-0" + std::to_string(n));
    for (const char* name :
         {"archive.zip.part-99999", "Holiday film.part-22222.aux.xml", "notes.part-31337-journal",
          "quick_0001.vdb.part-999999999-00000000", "report.html.part-999999999"}) {
      kept.push_back(inner + name);
    }
  }
  for (const std::string& file : kept) folder.write(file, "data");
  const fs::path empty = folder.path() / "out/folder.part-54321";
  fs::create_directory(empty);
  for (const Arguments& arguments : writersInto(folder)) {
    runWell(arguments);
    for (const std::string& file : kept)
      EXPECT_EQ(readFile(folder / file), "data") << arguments[0] << ": " << file;
    EXPECT_TRUE(fs::is_directory(empty)) << arguments[0];
    EXPECT_THAT(folder.files(), testing::Not(testing::Contains(HasSubstr("emscape.part-"))));
  }
}

TEST(ForeignFolder, FilesOfTheUserThatAreNamedLikeMapsAreNamedAndStay) {
  const Arguments coverage{"coverage", quick(),      "--cell",  "2000",     "--heights", "agl:100", "--times",
                           "0",        "--products", "covered", "--format", "cog,nc",    "-o"};
  for (const std::string file :
       {"covered_agl100m_t0s.tif", "covered_agl100m_t0s.tif.aux.xml", "coverage.nc"}) {
    const TemporaryFolder folder;
    folder.write("out/maps/" + file, "mine");
    Arguments arguments = coverage;
    arguments.push_back(folder / "out");
    EXPECT_THAT(errorOfRun(arguments, 2),
                HasSubstr("out/maps/" + file + ": is a file that emscape did not write"));
    EXPECT_EQ(folder.files(), std::vector<std::string>{"out/maps/" + file});
    EXPECT_EQ(readFile(folder / ("out/maps/" + file)), "mine");
  }
}

TEST(ForeignFolder, SLOW_NoMapIsReplacedIfAnotherFileIsOfTheUser) {
  const Arguments maps{"--cell", "4000",       "--heights",     "agl:100,200", "--times",
                       "0",      "--products", "covered,count", "--format",    "cog,png,nc"};
  const std::pair<Arguments, std::string> writers[] = {
      {{"coverage", quick()}, "count_agl200m_t0s"},
      {{"compare", quick(), "--set-b", "emitters.radar.power_w=1"}, "count_difference_agl200m_t0s"}};
  for (const auto& [command, last] : writers) {
    const TemporaryFolder folder;
    Arguments arguments = command;
    arguments.insert(arguments.end(), maps.begin(), maps.end());
    arguments.insert(arguments.end(), {"-o", folder / "out", "--set", "emitters.radar.power_w=1000"});
    runWell(arguments);
    arguments.back() = "emitters.radar.power_w=10";
    const auto contents = [&folder] {
      std::map<std::string, std::string> all;
      for (const std::string& file : folder.files()) all[file] = readFile(folder / file);
      return all;
    };
    for (const std::string& name : {last + ".tif.aux.xml", last + ".tif.ovr", last + ".png",
                                    command[0] + ".nc", command[0] + ".nc.aux.xml"}) {
      const std::string file = "out/maps/" + name,
                        own = fs::exists(folder / file) ? readFile(folder / file) : "";
      folder.write(file, "mine");
      const auto before = contents();
      EXPECT_THAT(errorOfRun(arguments, 2), HasSubstr(name + ": is a file that emscape did not write"));
      EXPECT_EQ(contents(), before);
      if (own.empty())
        fs::remove(folder / file);
      else
        folder.write(file, own);
    }
    runWell(arguments);
  }
}

TEST(ForeignFolder, SLOW_MapsOfCoverageStayWhenCompareWritesIntoTheirFolder) {
  const TemporaryFolder folder;
  const Arguments maps{"--cell",     "4000",    "--heights", "agl:100", "--times", "0",
                       "--products", "covered", "--format",  "cog",     "-o",      folder / "out"};
  Arguments coverage{"coverage", quick()}, compare{"compare", quick(), "--set-b", "emitters.radar.power_w=1"};
  for (Arguments* const arguments : {&coverage, &compare}) {
    arguments->insert(arguments->end(), maps.begin(), maps.end());
    runWell(*arguments);
  }
  for (const char* const name : {"covered_agl100m_t0s.tif", "covered_change_agl100m_t0s.tif"})
    EXPECT_TRUE(fs::exists(folder / ("out/maps/" + std::string(name)))) << name;
}

TEST(ForeignFolder, MapsOfEarlierAndOfUnfinishedRunsAreReplaced) {
  const TemporaryFolder folder;
  const Arguments coverage{"coverage", quick(),   "--cell", "2000",        "--heights",
                           "agl:100",  "--times", "0",      "--products",  "covered",
                           "--format", "cog,nc",  "-o",     folder / "out"};
  runWell(coverage);
  const std::vector<std::string> files = folder.files();
  const std::string labels = folder / "out/maps/covered_agl100m_t0s.tif.aux.xml", own = readFile(labels);
  writeFile(labels, "<PAMDataset/>");  // of a GIS program
  EXPECT_THAT(errorOfRun(coverage, 2), HasSubstr("aux.xml: is a file that emscape did not write"));
  EXPECT_EQ(readFile(labels), "<PAMDataset/>");
  fs::rename(labels, folder / "mine.xml");
  runWell(coverage);
  EXPECT_EQ(readFile(labels), own);
  fs::remove(folder / "mine.xml");
  fs::remove(folder.path() / "out/study.json");  // as after a run that was killed
  runWell(coverage);
  EXPECT_EQ(folder.files(), files);
}

TEST(ForeignFolder, SLOW_OutputsThatTheUserChangedAreNamedAndStay) {
  const TemporaryFolder folder;
  writeStudy(folder);
  const std::string links = shippedScenario("links.yaml"), out = folder / "out/";
  const Arguments maps{"coverage",   quick(),   "--cell", "2000",     "--heights",
                       "agl:100",    "--times", "0",      "--format", "gpkg,kmz,czml,geojson",
                       "--products", "covered", "-o",     out};
  const Arguments study{"study", folder / "study.yaml", "-o", out, "--slurm", out + "job.sh"};
  const std::pair<Arguments, std::vector<std::string>> writers[] = {
      {maps,
       {"maps/coverage.gpkg", "maps/coverage.kmz", "maps/coverage.czml", "maps/coverage.geojson",
        "report.html"}},
      {study, {"job.sh", "job.sh.merge.sh"}},
      {{"render", quick(), "--size", "64x48", "--times", "0:1:1", "-o", out + "frames", "-o", out + "a.mp4"},
       {"frames/quick_0002.png", "a.mp4"}},
      {{"vertical", quick(), "--emitter", "radar", "--azimuth", "30", "--grid", "20,20", "--areps", out, "-o",
        out + "v.csv", "-o", out + "v.svg", "-o", out + "v.json"},
       {"radar_APM_30.txt", "v.csv", "v.svg", "v.json"}},
      {{"compare", quick(), "--set-b", "emitters.radar.power_w=1", "--cell", "4000", "--heights", "agl:100",
        "--times", "0", "--format", "png", "-o", out, "--volume", out + "d.raw"},
       {"d.raw", "d.raw.json"}}};
  for (const auto& [arguments, names] : writers) {
    fs::remove_all(out);
    fs::create_directory(out);
    runWell(arguments);
    runWell(arguments);
    for (const std::string& name : names) {
      const std::string own = readFile(out + name), changed = own + "\nmine, not Emscape's";
      ASSERT_NE(own, "") << name;
      writeFile(out + name, changed);
      EXPECT_THAT(errorOfRun(arguments, 2),
                  AllOf(HasSubstr(name), HasSubstr("a file that emscape did not write")));
      EXPECT_EQ(readFile(out + name), changed) << name;
      writeFile(out + name, own);
    }
    runWell(arguments);
  }
}

TEST(ForeignFolder, SLOW_FilesInInnerFoldersOfAStudyAreNamedAndStay) {
  for (const std::string name : {"parts/part_00001.csv", "parts/part_00001.rows",
                                 "variants/0/covered_agl300m_t0s.tif", "results.nc"}) {
    const TemporaryFolder folder;
    writeStudy(folder);
    folder.write("out/" + name, "mine");
    const Arguments study{"study", folder / "study.yaml", "--keep", "maps", "-o", folder / "out"};
    EXPECT_THAT(errorOfRun(study, 2), AllOf(HasSubstr(name), HasSubstr("a file that emscape did not write")));
    EXPECT_EQ(readFile(folder / ("out/" + name)), "mine");
    fs::remove(folder / ("out/" + name));
    Arguments again = study;
    if (fs::exists(folder / "out/manifest.json")) again.push_back("--resume");
    runWell(again);
  }
}

TEST(ForeignFolder, AVolumeThatMentionsEmscapeIsOfTheUser) {
  const TemporaryFolder folder;
  const std::string volume = "<VTKFile type=\"ImageData\"><!-- compared with Emscape --></VTKFile>";
  folder.write("d.vti", volume);
  EXPECT_THAT(errorOfRun({"compare", quick(), "--set-b", "emitters.radar.power_w=1", "-o", folder / "out",
                          "--volume", folder / "d.vti"},
                         2),
              HasSubstr("d.vti is a file that emscape did not write"));
  EXPECT_EQ(readFile(folder / "d.vti"), volume);
}

TEST(ForeignFolder, PartsAndScriptsThatCannotBeAreToldBeforeAFileIsWritten) {
  const TemporaryFolder folder;
  writeStudy(folder);
  const std::vector<std::string> files = folder.files();
  EXPECT_THAT(
      errorOfRun({"study", folder / "study.yaml", "-o", folder / "out", "--slurm", folder / "no/job.sh"}, 1),
      HasSubstr("the folder " + (folder / "no") + " does not exist"));
  EXPECT_EQ(folder.files(), files);
  runWell({"study", folder / "study.yaml", "-o", folder / "out", "--chunks", "2"});
  EXPECT_THAT(
      errorOfRun({"study", folder / "study.yaml", "-o", folder / "out", "--chunks", "1", "--resume"}, 3),
      HasSubstr("the folder's study has 2 parts, not 1"));
}

TEST(ForeignFolder, SLOW_LinksAreRefusedByNameAndNothingIsWrittenThroughThem) {
  const std::vector<std::string> links_of[] = {
      {"out/series.lock"},
      {"out/.maps.lock", "out/maps"},
      {"out/.maps.lock", "out/maps"},
      {"out/.study.lock", "out/.manifest.lock", "out/parts", "out/parts/part_00001.rows", "out/variants",
       "out/variants/0"}};
  for (std::size_t writer = 0; writer < std::size(links_of); ++writer) {
    for (const std::string& link : links_of[writer]) {
      for (const char* const target : {"home/file", "home/none"}) {
        const TemporaryFolder folder;
        writeStudy(folder);
        folder.write("home/file", "precious");
        fs::create_directories((folder.path() / link).parent_path());
        fs::create_symlink(folder / target, folder / link);
        const Arguments arguments = writersInto(folder)[writer];
        const ProgramResult result = run(arguments);
        const std::string trial = arguments[0] + ", " + link + " to " + target;
        EXPECT_EQ(result.status, 1) << trial << ": " << result.err;
        EXPECT_THAT(result.err, AllOf(HasSubstr(link + ": cannot "),
                                      HasSubstr("it is a symbolic link, which is not followed")))
            << trial;
        EXPECT_TRUE(fs::is_symlink(folder / link)) << trial;
        for (const std::string& file : folder.files()) {
          if (file.rfind("home", 0) == 0) {
            EXPECT_EQ(file, "home/file") << trial;
            EXPECT_EQ(readFile(folder / file), "precious") << trial;
          }
        }
      }
    }
  }
}

TEST(ForeignFolder, AJournalThatIsALinkRunsNoCommandOfAStranger) {
  const TemporaryFolder folder;
  writeStudy(folder);
  writeFile(folder / "bashrc", "true\n");
  fs::create_directories(folder / "out/parts");
  fs::create_symlink("../../bashrc", folder / "out/parts/part_00001.rows");
  EXPECT_THAT(errorOfRun({"study", "study.yaml", "-o", "out"}, 1, "cd " + folder.path().string() + ";"),
              HasSubstr("out/parts/part_00001.rows: cannot write: it is a symbolic link"));
  EXPECT_EQ(readFile(folder / "bashrc"), "true\n");
}

/// Names that GDAL takes for its drivers and virtual file systems, of files that a stranger has made in the
/// folder.
std::vector<std::string> namesWithPrefixes(const TemporaryFolder& folder, const std::string& url) {
  std::vector<std::string> names;
  for (const std::string prefix : {"", "GTIFF_DIR:1:", "CSV:", "vrt://"}) {
    names.push_back(prefix + "/vsicurl/" + url + "x.tif");
    if (!prefix.empty()) folder.write(names.back(), "x");
  }
  return names;
}

TEST(ForeignFolder, SLOW_NamesOfFilesReachNoNetwork) {
  const TemporaryFolder folder;
  const Listener listener;
  const std::string there = "cd " + folder.path().string() + "; export GDAL_HTTP_TIMEOUT=1 PROJ_NETWORK=ON;";
  const std::string scenario = readFile(quick());
  const auto with = [&](const std::string& old, const std::string& text) {
    std::string changed = scenario;
    changed.replace(changed.find(old), old.size(), text);
    return changed;
  };
  const std::string isotropic = "{pattern: isotropic}";
  for (const std::string& name : namesWithPrefixes(folder, listener.url())) {
    const std::string quoted = "'" + name + "'";
    folder.write("terrain.yaml", scenario + "terrain: {files: [" + quoted + "], vertical_datum: egm96}\n");
    folder.write("antenna.yaml", with(isotropic, "{pattern: file, file: " + quoted + "}"));
    folder.write("track.yaml", with("position: {latitude_deg: 52.05, longitude_deg: 5.06, height_agl_m: 50}",
                                    "track: {file: " + quoted + "}"));
    folder.write("air.yaml",
                 scenario + "atmosphere: {refractivity: {kind: profile, file: " + quoted + "}}\n");
    writeStudy(folder, "sites: {platform: mast, candidates: " + quoted + ", choose: 1}");
    folder.write("over.yaml", "schema_version: 1\nscenario: " + quick() +
                                  "\ntimes: 0\ncell_m: 5000\nsweep: {emitters.radar.power_w: {values: [1, "
                                  "2]}}\nmeasures:\n  - {name: covered, height: \"agl:300\", over: " +
                                  quoted + "}\n");
    const std::vector<Arguments> readers{{"validate", "terrain.yaml"},
                                         {"validate", "antenna.yaml"},
                                         {"validate", "track.yaml"},
                                         {"validate", "air.yaml"},
                                         {"info", name},
                                         {"render", name, "-o", "a.png"},
                                         {"coverage", name, "-o", "out"},
                                         {"study", "study.yaml", "--plan"},
                                         {"study", "over.yaml", "--plan"}};
    for (const Arguments& arguments : readers) {
      const ProgramResult result = run(arguments, there);
      EXPECT_THAT(result.status, AnyOf(2, 3)) << arguments[0] << " " << arguments[1] << ": " << result.err;
      EXPECT_FALSE(listener.wasReached()) << arguments[0] << " " << name << ": " << result.err;
    }
  }
}

TEST(ForeignFolder, CoordinateSystemsReachNoNetwork) {
  const TemporaryFolder folder;
  const Listener listener;
  folder.write("a.asc", "ncols 2\nnrows 2\nxllcorner 4.5\nyllcorner 51.5\ncellsize 0.5\n1 2\n3 4\n");
  folder.write("a.vrt",
               "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><SRS>+proj=longlat +ellps=bessel +nadgrids=" +
                   listener.url() +
                   "g.tif</SRS><GeoTransform>4.5, 0.5, 0, 52.5, 0, -0.5</GeoTransform>"
                   "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename "
                   "relativeToVRT=\"1\">a.asc</SourceFilename><SourceBand>1</SourceBand></SimpleSource>"
                   "</VRTRasterBand></VRTDataset>");
  folder.write("s.yaml", readFile(quick()) + "terrain: {files: [a.vrt], vertical_datum: egm96}\n");
  run({"validate", folder / "s.yaml"}, "export PROJ_NETWORK=ON;");
  EXPECT_FALSE(listener.wasReached());
}

}  // namespace
}  // namespace emscape::test
