/// emscape bench: benchmarks.
#include "apps/bench/bench.h"

namespace emscape::app {

void addBench(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* bench = app.add_subcommand("bench", "Measure speed, and the error of interpolated pixels");
  bench->fallthrough();
  bench->footer("\n'emscape bench SUBCOMMAND --help' describes each.");
  bench->require_subcommand(1);
  addBenchCells(*bench, global, action);
  addBenchCoverage(*bench, global, action);
  addBenchField(*bench, global, action);
  addBenchMarch(*bench, global, action);
  addBenchModels(*bench, global, action);
  addBenchReconstruction(*bench, global, action);
  addBenchRender(*bench, global, action);
  addBenchView(*bench, global, action);
}

}  // namespace emscape::app
