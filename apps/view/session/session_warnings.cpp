/// The warnings about files, the scenario and the models of the field on screen.
#include <algorithm>
#include <utility>

#include "apps/view/session/session.h"
#include "emscape/scenario/file/scenario_file.h"
#include "report/warnings.h"
#include "scenario/model/step_check.h"

namespace emscape::view {

/// Finds the warnings of the edited scenario, in the background.
void Session::checkScenario() {
  if (!edits_ || isDragging() || edits_->scenario() == checked_scenario_) return;
  checked_scenario_ = edits_->scenario();
  jobs_.run([this, checked = checked_scenario_]() -> BackgroundJobs::Finish {
    std::vector<std::string> warnings;
    for (const scenario::Problem& problem : scenario::editScenario(*checked, {}).problems) {
      if (problem.severity == scenario::Severity::warning) {
        warnings.push_back(toString(problem.location) + ": " + problem.message);
      }
    }
    return [this, warnings] {
      scenario_warnings_ = warnings;
      files_->messages->remove(warnings);  // of the scenario as it was opened, which may be edited
    };
  });
}

/// Finds the steps at which a platform cannot be where it is, over the ground of the picture, in the
/// background.
void Session::checkSteps() {
  const playback::LivePicture* const shown = picture();
  if (shown == nullptr || options_.stream || isDragging() || shown->scenario == nullptr ||
      shown->scenario == stepped_scenario_)
    return;
  stepped_scenario_ = shown->scenario;
  jobs_.run([this, checked = stepped_scenario_, terrain = shown->terrain]() -> BackgroundJobs::Finish {
    constexpr std::size_t kChecked = 100'000;  // positions, in half a second
    const std::size_t all = checked->platforms.size() * scenario::timesOf(checked->clock).size();
    const int every = static_cast<int>(all / kChecked) + 1;
    std::vector<std::string> warnings;
    for (const scenario::StepFault& fault : scenario::faultsOfSteps(*checked, terrain.get(), every))
      warnings.push_back("there is no field at some steps: " + fault.text());
    return [this, warnings] { step_warnings_ = warnings; };
  });
}

/// Joins the warnings of the models of many emitters, in the background.
void Session::joinModelWarnings(double now_s) {
  constexpr double kInterval_s = 0.5;  // of a playing series, whose fields have different warnings
  if (status_.warnings == joined_warnings_ || now_s - joined_at_s_ < kInterval_s) return;
  joined_at_s_ = now_s;
  const auto before = std::exchange(joined_warnings_, status_.warnings);
  if (before && joined_warnings_ && *before == *joined_warnings_) return;
  jobs_.run([this, warnings = joined_warnings_]() -> BackgroundJobs::Finish {
    auto lines = warnings ? report::joinedWarnings(*warnings) : std::vector<std::string>();
    return [this, lines = std::move(lines)] { model_warnings_ = lines; };
  });
}

void Session::tellImport() {
  if (isImported()) tell(importText());
}

/// What was assumed for the scenario of a recording, as far as it is still true; empty: it is none.
std::string Session::importText() const {
  const auto isOn = [](const scenario::Emitter& emitter) { return emitter.enabled; };
  const bool is_silent =
      !edits_ || std::none_of(scenario()->emitters.begin(), scenario()->emitters.end(), isOn);
  return options_.made_note.text(is_silent);
}

bool Session::takeWarnings(double now_s) {
  checkScenario();
  checkSteps();
  joinModelWarnings(now_s);
  std::vector<std::string> warnings;
  // A scenario that is read again, as the reference of a comparison, logs its warnings again.
  const std::string import = importText(), import_before = std::exchange(import_text_, import);
  if (!import.empty()) warnings.push_back(import);
  if (import != import_before && notice_.text == import_before) notice_ = {};  // no longer true
  for (const auto& lines : {files_->messages->lines(), scenario_warnings_, step_warnings_, model_warnings_}) {
    for (const std::string& line : lines) {
      if (std::find(warnings.begin(), warnings.end(), line) == warnings.end()) warnings.push_back(line);
    }
  }
  return std::exchange(warnings_, warnings) != warnings;
}

}  // namespace emscape::view
