// The command line: parsed, not run.
#include <algorithm>
#include <memory>

#include "apps/bench/bench.h"
#include "apps/emscape/subcommands.h"
#include "playback/view/view_settings.h"
#include "tests/fuzz/fuzz_target.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;

/// Arguments, one per line, as a shell hands them over: without zero bytes.
std::vector<std::string> argumentsOf(const std::string& bytes) {
  std::string text = bytes;
  std::replace(text.begin(), text.end(), '\0', '\n');
  std::vector<std::string> arguments;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    arguments.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return arguments;
}

void parseCommandLine(const std::string& bytes) {
  constexpr int kInputsPerParser = 1000;
  static std::unique_ptr<app::CommandLine> emscape, benchmarks;
  static int inputs = 0;
  if (inputs++ % kInputsPerParser == 0) {
    emscape = std::make_unique<app::CommandLine>(app::addSubcommands);
    benchmarks = std::make_unique<app::CommandLine>(app::addBench);
  }
  const std::vector<std::string> arguments = argumentsOf(bytes);
  const bool is_bench = !arguments.empty() && arguments.front() == "bench";
  (is_bench ? benchmarks : emscape)->parse(arguments);
}

const FuzzTargetsAdded added({
    {"command_line", "", [](const fs::path&, const std::string& bytes) { parseCommandLine(bytes); },
     [] {
       return std::vector<std::string>{
           "validate\na.yaml\n--set\nregion.dims.2=10\n--json",
           "info\na.vti",
           "simulate\na.yaml\n-o\nout\n--format\nvdb,nvdb,vti,raw\n--quantity\nsnr_db,occupancy\n--times\n"
           "0:10:0.5\n--resume\n--mesh\nterrain:12,5\n--threads\n2\n-q",
           "render\na.yaml\n-o\na.png\n-o\na.mp4\n--size\n640x480\n--mode\nmida\n--rays\nadaptive\n--camera\n"
           "orbit:azimuth_deg=20\n--plane\nhorizontal:altitude_m=500\n--range\n-120:0\n--fps\n25\n--realtime",
           "view\na.yaml\n--scale\n2\n--script\na.jsonl",
           "profile\na.yaml\n--emitter\nradar\n--to\n52,5,100",
           "link\na.yaml\n--times\n0:4",
           "coverage\na.yaml\n-o\nout\n--heights\nagl:30,150;msl:500\n--products\ncovered,margin\n--cell\n200"
           "\n--area\nbbox:5,52,6,53\n--crs\nutm\n--format\ncog,png,gpkg,geojson,nc,kmz,czml\n--threshold\n0."
           "5",
           "vertical\na.yaml\n--emitter\nradar\n--azimuth\n10\n-o\na.png",
           "exposure\na.yaml\n--platform\nhelicopter",
           "compare\na\nb\n-o\nout",
           "study\na.yaml\n-o\nout\n--jobs\n2\n--parts\n4\n--resume",
           "import\na.acmi\nb.pcap\n-o\na.yaml\n--emitters\nd.yaml\n--region\n52,5,80\n--times\n0:9\n--"
           "only\nF*",
           "export\na.yaml\n-o\na.pcap\n--step\n2",
           "check\nreference\n--backend\ncpu",
           "bench\nfield\na.yaml\n--frames\n3",
           "--version"};
     }},
    {"value_range", "", [](const fs::path&, const std::string& text) { playback::parseRange(text); },
     [] {
       return std::vector<std::string>{"-120:0", "1e-3:2.5"};
     }},
});

}  // namespace
}  // namespace emscape::test
