/// emscape check: the propagation models against reference figures.
#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "apps/emscape/common/command.h"
#include "apps/emscape/common/console.h"
#include "apps/emscape/common/interrupt.h"
#include "emfield/check/reference_check.h"
#include "emscape/base/error.h"

namespace emscape::app {
namespace {

using emfield::DatasetCheck;
using emfield::FigureCheck;
using emfield::ReferenceDataset;
using emfield::ReferenceFolder;

/// A dataset that was run.
struct Outcome {
  const ReferenceDataset* dataset;
  DatasetCheck check;
};

Json toJson(const FigureCheck& figure) {
  return {{"figure", figure.figure},       {"max_abs_error", figure.max_abs_error},
          {"tolerance", figure.tolerance}, {"unit", figure.unit},
          {"pass", figure.pass()},         {"worst_line", figure.worst_line}};
}

void printAsJson(const std::vector<Outcome>& checked, const std::vector<std::string>& not_checked,
                 const ReferenceFolder& folder, bool pass) {
  Json datasets = Json::array();
  for (const Outcome& outcome : checked) {
    const FigureCheck& main = outcome.check.figures.front();
    Json figures = Json::array();
    for (const FigureCheck& figure : outcome.check.figures) figures.push_back(toJson(figure));
    datasets.push_back({{"name", outcome.dataset->name},
                        {"cases", outcome.check.cases},
                        {"max_abs_error", main.max_abs_error},
                        {"tolerance", main.tolerance},
                        {"unit", main.unit},
                        {"pass", outcome.check.pass()},
                        {"figures", figures}});
  }
  printJson({{"datasets", datasets},
             {"pass", pass},
             {"not_checked", not_checked},
             {"absent", folder.absent},
             {"unknown", folder.unknown}});
}

void printRow(const std::string& name, int cases, const FigureCheck& figure) {
  print("{:<40} {:>6}  {:<32} {:>10.3g} {:>10.3g} {:<9} {}\n", name, cases > 0 ? std::to_string(cases) : "",
        figure.figure, figure.max_abs_error, figure.tolerance, figure.unit,
        figure.pass() ? "pass" : fmt::format("MISS (line {})", figure.worst_line));
}

void printAsTable(const std::vector<Outcome>& checked, const std::vector<std::string>& not_checked,
                  const ReferenceFolder& folder) {
  print("{:<40} {:>6}  {:<32} {:>10} {:>10} {:<9} {}\n", "dataset", "cases", "figure", "max error",
        "tolerance", "unit", "result");
  for (const Outcome& outcome : checked) {
    const auto& figures = outcome.check.figures;
    printRow(outcome.dataset->name, outcome.check.cases, figures.front());
    for (std::size_t i = 1; i < figures.size(); ++i) printRow("", 0, figures[i]);
  }
  for (const std::string& name : not_checked) print("{:<40} not checked: no model answers to it\n", name);
  for (const std::string& name : folder.absent) print("{:<40} not checked: absent\n", name);
  for (const std::string& name : folder.unknown) print("{:<40} not checked: unknown\n", name);
}

int check(const std::string& dir, const GlobalOptions& global) {
  const ReferenceFolder folder = emfield::findDatasets(dir);
  std::vector<Outcome> checked;
  std::vector<std::string> not_checked;
  for (const ReferenceDataset* dataset : folder.present) {
    stopIfInterrupted();
    if (dataset->check == nullptr) {
      not_checked.push_back(dataset->name);
      continue;
    }
    checked.push_back({dataset, dataset->check(folder.root / dataset->name)});
  }
  // a folder without a dataset that could be checked has not passed
  const bool pass =
      !checked.empty() && std::all_of(checked.begin(), checked.end(),
                                      [](const Outcome& outcome) { return outcome.check.pass(); });

  if (global.json) {
    printAsJson(checked, not_checked, folder, pass);
  } else {
    printAsTable(checked, not_checked, folder);
  }
  return pass ? 0 : static_cast<int>(ErrorCode::check_failed);
}

}  // namespace

void addCheck(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command =
      app.add_subcommand("check", "Compare the propagation models with a folder of reference figures");
  command->fallthrough();
  command->footer(R"(
Runs every known dataset of the folder and shows its largest difference from the reference and the tolerance. Datasets without a
model, absent and unknown datasets are listed and skipped.

Examples:
  emscape check reference
  emscape check reference/pe         one family only
  emscape check reference --json     {"datasets": [{"name", "cases", "max_abs_error", "tolerance", "unit", "pass"}], "pass"}

Exit status: 0 if every dataset that was run is within its tolerance, 5 if one is not or none of the datasets has a model, 3 for
a folder without known datasets and for a file that is malformed.)");
  auto dir = std::make_shared<std::string>();
  command->add_option("DIR", *dir, "Folder of datasets, one per folder; or of one family")->required();
  command->callback([dir, &global, &action] { action = [dir, &global] { return check(*dir, global); }; });
}

}  // namespace emscape::app
