/// emscape check: the propagation models against reference figures.
#include <memory>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/emscape/subcommands.h"
#include "emscape/base/error.h"
#include "report/runs/check_report.h"

namespace emscape::app {
namespace {

int check(const std::string& dir, const GlobalOptions& global) {
  const StoppableLoops stoppable;
  const report::CheckReport report = report::checkReport(dir, stopIfInterrupted);
  if (global.json) {
    printJson(report::toJson(report));
  } else {
    printResult(report::checkText(report));
  }
  if (!report.unreadable.empty()) return static_cast<int>(ErrorCode::bad_input);
  return report.pass() ? 0 : static_cast<int>(ErrorCode::check_failed);
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
a folder without known datasets and if a dataset cannot be read; the others are run.)");
  auto dir = std::make_shared<std::string>();
  command->add_option("DIR", *dir, "Folder of datasets, one per folder; or of one family")->required();
  command->callback([dir, &global, &action] { action = [dir, &global] { return check(*dir, global); }; });
}

}  // namespace emscape::app
