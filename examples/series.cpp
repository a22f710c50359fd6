// Computes a scenario's field every ten seconds of its first minute and writes it for ParaView; what an
// earlier run has finished is not computed again.
//   series SCENARIO FOLDER
#include <emscape/emscape.h>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  using namespace emscape;
  if (argc != 3) {
    std::fprintf(stderr, "usage: series SCENARIO FOLDER\n");
    return 2;
  }
  try {
    const auto loaded = playback::loadScenarioWithTerrain(argv[1]);
    playback::FieldSeries series(loaded, scenario::timesOf(0, 60, 10), {});

    playback::SeriesOptions options;
    options.folder = argv[2];
    options.formats = {"vti"};
    options.existing = playback::SeriesOptions::Existing::resume;
    const playback::SeriesResult result = playback::writeSeries(series, options);
    std::printf("%d steps, %d of them computed now\n", result.steps, result.steps_computed);
    for (std::size_t c = 0; c < result.channels.size(); ++c) {
      std::printf("%s: %.1f..%.1f\n", result.channels[c].c_str(), result.ranges[c].min, result.ranges[c].max);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "series: %s\n", error.what());
    return 1;
  }
}
