#include "playback/series/series_scenario.h"

#include <algorithm>
#include <filesystem>

#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/scenario/file/scenario_file.h"
#include "playback/series/series_journal.h"
#include "playback/series/series_state.h"

namespace emscape::playback {
namespace {

namespace fs = std::filesystem;

bool isOfSeries(const fs::path& input, const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(input, ignored) || input.extension() == ".pvd" ||
         SeriesJournal(folder).files().count(input.filename().string()) > 0;
}

/// The reason why the scenario is not that of the series; empty if it is.
std::string obstacleOf(const std::string& file, const std::vector<scenario::Edit>& edits,
                       const SeriesState& state) {
  std::error_code error;
  if (!fs::exists(file, error))
    return error ? "cannot be reached: " + error.message() : "is not there any more";
  const auto found = scenario::parseScenario(file, edits).scenario;
  if (!found || state.recipe.value("scenario hash", Json()) != found->hash) return "has changed since";
  const std::vector<std::string> files = scenario::filesOf(*found);
  const auto missing = std::find_if(files.begin(), files.end(),
                                    [&](const std::string& name) { return !fs::exists(name, error); });
  return missing == files.end() ? "" : "names " + *missing + ", which is not there any more";
}

}  // namespace

void addOwnScenario(ViewState& view) {
  std::error_code ignored;
  const fs::path input = view.input;
  const fs::path folder = fs::is_directory(input, ignored) ? input : input.parent_path();
  const bool is_candidate = view.scenario.empty() && view.edits.empty() && fs::exists(input, ignored) &&
                            fs::exists(folder / "series.json", ignored);
  if (!is_candidate) return;
  try {
    if (inputKindOf(view.input) != InputKind::volume && inputKindOf(view.input) != InputKind::mesh) return;
    const auto state = readSeriesState(folder.empty() ? "." : folder);
    if (!state || state->scenario_file.empty() || !isOfSeries(input, folder)) return;
    const std::string file = (folder / state->scenario_file).string();
    std::vector<scenario::Edit> edits;
    for (const std::string& edit : state->edits) edits.push_back(scenario::parseEdit(edit));
    const std::string obstacle = obstacleOf(file, edits, *state);
    if (!obstacle.empty()) {
      return logWarning(view.input + ": is drawn without its scenario, " + file + ", which " + obstacle);
    }
    view.scenario = file;
    view.edits = edits;
  } catch (const Error& error) {
    logWarning(view.input + ": is drawn without its scenario: " + error.message());
  }
}

}  // namespace emscape::playback
