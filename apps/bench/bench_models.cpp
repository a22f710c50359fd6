/// emscape bench models: evaluations per second of each propagation model.
#include <fmt/core.h>

#include <memory>

#include "apps/bench/bench.h"
#include "apps/bench/model_timings.h"
#include "apps/common/console.h"

namespace emscape::app {
namespace {

Json toJson(const ModelTiming& timing) {
  Json json{{"model", timing.model}, {"what", timing.what}, {"evaluations_per_s", timing.evaluations_per_s}};
  if (timing.ratio > 0) {
    json["ratio"] = timing.ratio;
    json["ratio_to"] = timing.ratio_to;
  }
  return json;
}

Json toJson(const ColumnTiming& timing) {
  return {{"columns", kColumnCount},
          {"heights", kColumnHeights},
          {"posts", timing.posts},
          {"top_msl_m", timing.top_msl_m},
          {"path_by_path_ms", timing.paths_ms},
          {"columns_ms", timing.columns_ms},
          {"ratio", timing.ratio()},
          {"max_difference_db", timing.max_difference_db}};
}

int benchModels(int repeats, const GlobalOptions& global) {
  const std::vector<ModelTiming> models = timeModels(repeats);
  const std::vector<ColumnTiming> columns = timeColumns(repeats);
  if (global.json) {
    Json of_models = Json::array(), of_columns = Json::array();
    for (const ModelTiming& timing : models) of_models.push_back(toJson(timing));
    for (const ColumnTiming& timing : columns) of_columns.push_back(toJson(timing));
    printJson({{"device", "cpu"},
               {"threads", 1},
               {"repeats", repeats},
               {"models", of_models},
               {"diffraction_columns", of_columns}});
    return 0;
  }
  print("one core, CPU time, fastest of {} runs\n\n{:<12} {:<58} {:>12} {:>10}\n", repeats, "model",
        "one evaluation", "per second", "us");
  for (const ModelTiming& timing : models) {
    print("{:<12} {:<58} {:>12.0f} {:>10.3f}{}\n", timing.model, timing.what, timing.evaluations_per_s,
          1e6 / timing.evaluations_per_s,
          timing.ratio > 0 ? fmt::format("  {:.2f} x {}", timing.ratio, timing.ratio_to) : "");
  }
  print(
      "\ndelta-Bullington, {} columns x {} heights, float\n{:>6} {:>10} {:>16} {:>10} {:>8} "
      "{:>15}\n",
      kColumnCount, kColumnHeights, "posts", "heights m", "path by path ms", "columns ms", "ratio",
      "difference dB");
  for (const ColumnTiming& timing : columns) {
    print("{:>6} {:>10.0f} {:>16.2f} {:>10.3f} {:>8.1f} {:>15.1e}\n", timing.posts, timing.top_msl_m,
          timing.paths_ms, timing.columns_ms, timing.ratio(), timing.max_difference_db);
  }
  return 0;
}

}  // namespace

void addBenchModels(CLI::App& bench, const GlobalOptions& global, Action& action) {
  CLI::App* command = bench.add_subcommand("models", "Time the propagation models on one core");
  command->fallthrough();
  command->footer(R"(
Evaluations per second of each model, and columns of delta-Bullington at once against path by path, over synthetic hills that
are the same in every run. Times are the CPU time of one thread.

Example:
  emscape bench models --json     {"device", "models": [{"model", "what", "evaluations_per_s"}], "diffraction_columns": [...]})");
  auto repeats = std::make_shared<int>(5);
  command->add_option("--repeats", *repeats, "Runs of each; the fastest is reported")
      ->check(CLI::Range(1, 1000));
  command->callback(
      [repeats, &global, &action] { action = [repeats, &global] { return benchModels(*repeats, global); }; });
}

}  // namespace emscape::app
