// Readers of scenarios and of the files that they name, except elevation.
#include <algorithm>
#include <limits>

#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/clock.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/scenario/model/target.h"
#include "scenario/air/refractivity_file.h"
#include "scenario/antenna/shapes.h"
#include "scenario/map/point_table.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/files.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;
using scenario::Edit;

void checkProblems(const scenario::ParseResult& result) {
  for (const scenario::Problem& problem : result.problems) checkFuzzMessage(problem.message);
}

/// The program's next operation: the instant at the first step, without ground.
void useScenario(const std::shared_ptr<const scenario::Scenario>& scenario) {
  if (scenario) scenario::snapshotAt(scenario, nullptr, scenario::timesOf(scenario->clock).front());
}

/// The contents of all files of a folder with one of the endings.
std::vector<std::string> contentsOf(const fs::path& folder, const std::vector<std::string>& endings) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    for (const std::string& ending : endings) {
      if (entry.path().extension() == ending) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> contents;
  for (const fs::path& file : files) contents.push_back(readFile(file));
  return contents;
}

std::vector<std::string> scenarioSeeds() {
  std::vector<std::string> seeds = contentsOf(sourceFile("scenarios"), {".yaml"});
  for (std::string& broken : contentsOf(sourceFile("tests/scenario/broken"), {".yaml"}))
    seeds.push_back(std::move(broken));
  seeds.push_back(R"({"schema_version": 1, "name": "json", "epoch": "2026-06-01T06:00:00Z", "duration_s": 4,
"step_s": 1, "region": {"origin": {"latitude_deg": 52, "longitude_deg": 5, "height_msl_m": 0},
"size_m": [20000, 20000, 5000], "dims": [40, 40, 20]},
"platforms": [{"name": "mast", "position": {"latitude_deg": 52.05, "longitude_deg": 5.06, "height_agl_m": 50}}],
"emitters": [{"name": "transmitter", "platform": "mast", "kind": "transmitter", "frequency_hz": 1e8,
"power_w": 1000, "antenna": {"pattern": "isotropic"}}]})");
  return seeds;
}

/// Lines of PATH=VALUE, applied together.
void readEdits(const std::string& text) {
  static const std::shared_ptr<const scenario::Scenario> base =
      scenario::loadScenario(shippedScenario("links.yaml"));
  std::vector<Edit> edits;
  for (std::size_t begin = 0; begin < text.size() && edits.size() < 8;) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    edits.push_back(scenario::parseEdit(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  const scenario::ParseResult result = scenario::editScenario(*base, edits);
  checkProblems(result);
  useScenario(result.scenario);
}

/// A small scenario, whose only platform follows the input.
void writeTracked(const fs::path& folder) {
  writeFile(folder / "tracked.json",
            R"({"schema_version": 1, "name": "tracked", "epoch": "2026-06-01T06:00:00Z", "duration_s": 4,
"step_s": 1, "region": {"origin": {"latitude_deg": 52, "longitude_deg": 5, "height_msl_m": 0},
"size_m": [20000, 20000, 5000], "dims": [40, 40, 20]},
"platforms": [{"name": "aircraft", "track": {"file": "input.csv"}}],
"emitters": [{"name": "transmitter", "platform": "aircraft", "kind": "transmitter", "frequency_hz": 1e8,
"power_w": 1000, "antenna": {"pattern": "isotropic"}}]})");
}

void readTracked(const fs::path& file, const std::string&) {
  const scenario::ParseResult result = scenario::parseScenario(file.parent_path() / "tracked.json");
  checkProblems(result);
  useScenario(result.scenario);
}

const FuzzTargetsAdded added({
    {"scenario", "input.yaml",
     [](const fs::path& file, const std::string&) {
       const scenario::ParseResult result = scenario::parseScenario(file);
       checkProblems(result);
       useScenario(result.scenario);
     },
     scenarioSeeds, copyScenarios, scenario::scenarioJsonSchema},
    {"set",
     "",
     [](const fs::path&, const std::string& bytes) { readEdits(bytes); },
     [] {
       return std::vector<std::string>{
           "emitters.radar.power_w=500",
           "region.dims.2=10\nduration_s=1",
           "platforms.helicopter.track=null\nplatforms.helicopter.position={latitude_deg: 36.5, "
           "longitude_deg: -84.2, height_msl_m: 900}",
           "output.quantities=[power_density_dbwm2, snr_db]",
           "emitters.\"a=b\".power_w=[1, {}]",
           "receivers=[]",
           "targets.0=null",
           "terrain=null",
           "atmosphere={refraction: exponential}",
           "atmosphere.refractivity={kind: evaporation, height_m: 12}"};
     },
     {},
     scenario::scenarioJsonSchema},
    {"times", "",
     [](const fs::path&, const std::string& text) {
       scenario::parseTimes(text, {"2026-06-01T06:00:00Z", 120, 0.5});
     },
     [] {
       return std::vector<std::string>{"0:120:0.5", "1:4", "2.5"};
     }},
    {"track_csv", "input.csv", readTracked,
     [] {
       return std::vector<std::string>{readFile(sourceFile("tests/scenario/data/track.csv")),
                                       readFile(sourceFile("scenarios/data/helicopter.csv")),
                                       "t_s,latitude_deg,longitude_deg,height_agl_m,heading_deg,pitch_deg,"
                                       "roll_deg\n0,52,5,100,10,1,2\n4,52.1,5.1,200,350,-1,0\n"};
     },
     writeTracked},
    {"rcs_csv", "input.csv", [](const fs::path& file, const std::string&) { scenario::readRcsTable(file); },
     [] { return std::vector<std::string>{readFile(sourceFile("scenarios/data/helicopter_rcs.csv"))}; }},
    {"antenna_csv", "input.csv",
     [](const fs::path& file, const std::string&) { scenario::readAntenna(file, 20); },
     [] {
       return std::vector<std::string>{
           "azimuth_deg,elevation_deg,gain_db\n-180,-90,-30\n0,-90,-10\n180,-90,-30\n-180,90,-30\n0,90,0\n"
           "180,90,-30\n",
           "Freq "
           "[GHz];Phi[deg];Theta[deg];dB(GainTotal)[]\n3;0;0;-3\n3;0;90;5,5\n3;0;180;-9\n3;90;0;-3\n3;90;"
           "90;1\n3;90;180;-9\n"};
     }},
    {"antenna_nsma", "input.adf",
     [](const fs::path& file, const std::string&) { scenario::readAntenna(file, 20); },
     [] {
       return std::vector<std::string>{
           "REVNUM:,NSMA WG16.99.050\nANTMAN:,Acme\nGUNITS:,DBD/DBR\nMDGAIN:,15\nELWIDT:,8\nELTILT:,4\n"
           "PATCUT:,H\nPOLARI:,V/V\nNUPOIN:,4\nFSTLST:,-180,90\n-180,-30\n-90,-20\n0,0\n90,-20\n"
           "PATCUT:,V\nPOLARI:,V/"
           "V\nNUPOIN:,4\nFSTLST:,-180,90\n-180,-30\n-90,-20\n0,0\n90,-20\nENDFIL:,EOF\n"};
     }},
    {"antenna_stk", "input.ant",
     [](const fs::path& file, const std::string&) { scenario::readAntenna(file, 20); },
     [] {
       return std::vector<std::string>{
           "stk.v.11.0\nThetaPhiPattern\nAngleUnits Degrees\nNumberOfPoints 6\nPatternData\n0 0 30\n90 0 "
           "3\n180 0 "
           "-9\n0 90 30\n90 90 3\n180 90 -9\n",
           "stk.v.4.3\nSymmetricPattern\nAngleUnits Radians\nPatternData\n0 30\n0.5 10\n1 0\n"};
     }},
    {"antenna_splat_az", "input.az",
     [](const fs::path& file, const std::string&) { scenario::readAntenna(file, 20); },
     [] { return std::vector<std::string>{"45.0\n0 1.0\n90 0.5\n180 0.1 ; back\n270 0.5\n"}; }},
    {"antenna_splat_el", "input.el",
     [](const fs::path& file, const std::string&) { scenario::readAntenna(file, 20); },
     [] { return std::vector<std::string>{"1.1 130.0\n-10.0 0.172\n0 0.95\n1 1.0\n90 0.2\n"}; }},
    {"points_csv", "input.csv",
     [](const fs::path& file, const std::string&) { scenario::readPointTable(file); },
     [] {
       return std::vector<std::string>{"name,latitude_deg,longitude_deg,owner\nhill,52.5,5.25,A\n",
                                       "Name;Lat;Lon\nhill;52,5;5,25\n", "lat\tlon\n52.5\t5.25\n",
                                       "name,mgrs,height_agl_m\nhill,16S GF 50751 44164,30\n",
                                       "lat;lon\n36d30'36\"N;84 12 0 W\n"};
     }},
    {"antenna_msi", "input.msi",
     [](const fs::path& file, const std::string&) {
       scenario::readAntenna(file, std::numeric_limits<double>::quiet_NaN());
     },
     [] {
       return std::vector<std::string>{readFile(sourceFile("tests/scenario/data/sector.msi")),
                                       readFile(sourceFile("scenarios/data/sector_450mhz.msi"))};
     }},
    {"refractivity_csv", "input.csv",
     [](const fs::path& file, const std::string&) {
       scenario::isRefractivityCsv(file);
       for (const std::string& warning : scenario::readRefractivity(file).warnings) checkFuzzMessage(warning);
     },
     [] {
       return std::vector<std::string>{
           "height_msl_m,m_units\n0,330\n100,320\n", "n_units,height_msl_m\n330,0\n290,1000\n",
           "range_m,height_msl_m,m_units\n0,0,330\n0,10,320\n1000,0,330\n1000,30,320\n",
           "latitude_deg,longitude_deg,height_msl_m,m_units\n52,5,0,330\n52,5,10,320\n52,6,0,330\n52,6,9,3\n",
           "height_msl_m,pressure_hpa,temperature_k,relative_humidity_percent\n0,1013,288,80\n90,1000,287,"
           "60\n"};
     }},
    {"sounding", "input.txt",
     [](const fs::path& file, const std::string&) {
       scenario::isSoundingFile(file);
       for (const std::string& warning : scenario::readSounding(file, {}).warnings) checkFuzzMessage(warning);
     },
     [] {
       return std::vector<std::string>{
           "#USM00072649 2023 11 18 12 1102    5 ncdc-nws ncdc-nws  448500  -935700\n"
           "21 -9999  99100   288B   10B  780  -9999   300    15 \n"
           "10 -9999  92500   830B   50B  600  -9999   310    60 \n"
           "20 -9999  85000  1520B   20B  400  -9999   320    80 \n"
           "10 -9999  70000  3100B  -80B  300  -9999   300   100 \n"
           "10 -9999  50000  5700B -220B  200  -9999   290   150 \n",
           "72200 Test Observations at 12Z 02 Jul 2020\n\n----------------------------\n"
           "   PRES   HGHT   TEMP   DWPT   RELH   MIXR\n    hPa     m      C      C      %    g/kg\n"
           "------------------------------\n 1000.0     94\n  998.0    112   25.0   20.0     74  15.01\n"
           "  925.0    780   22.4   10.4     47   8.65\n\nStation latitude: 39.5\nStation longitude: -84.2\n",
           "time,longitude,latitude,pressure_hPa,geopotential height_m,temperature_C,dew point "
           "temperature_C,relative humidity_%\n2020-07-02 11:02:03,-84.25,39.5,998.0,112,25.0,20.0,74\n"
           "2020-07-02 11:12:03,-84.25,39.5,850.0,1500,18.0,,39\n",
           "%TITLE%\n OAX   200702/1200\n\n LEVEL HGHT TEMP DWPT WDIR WSPD\n-----\n%RAW%\n 955.00, 520.00, "
           "22.00, 18.00, 90.00, 10.00\n 925.62, 770.00, 20.38, -9999.00, 90.00, 10.00\n%END%\n"};
     }},
});

}  // namespace
}  // namespace emscape::test
