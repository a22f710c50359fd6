#include "apps/view/parts/opening.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/view/files/recordings.h"
#include "apps/view/values/refusal_text.h"
#include "emscape/base/error.h"
#include "emscape/playback/frames/inputs.h"
#include "emscape/scenario/file/scenario_file.h"
#include "playback/series/series_scenario.h"
#include "playback/view/view_file.h"

namespace emscape::view {
namespace {

using scenario::Edit;

/// Why edits do not apply to a scenario; empty: they do.
std::string faultOfEdits(const std::string& file, const std::vector<Edit>& edits) {
  const scenario::ParseResult parsed = scenario::parseScenario(file, edits);
  if (parsed.scenario) return "";
  for (const scenario::Problem& problem : parsed.problems) {
    if (problem.severity != scenario::Severity::warning) return refusalText(problem.message, edits);
  }
  return "it is not valid";
}

/// Removes edits that no longer apply to the scenario.
void checkScenario(const std::string& file, std::vector<Edit>& edits, std::vector<std::string>& left_out) {
  playback::requireScenarioFile(file);
  if (faultOfEdits(file, edits).empty()) return;
  scenario::loadScenario(file);  // throws its errors
  std::vector<Edit> kept;
  for (const Edit& edit : edits) {
    kept.push_back(edit);
    const std::string fault = faultOfEdits(file, kept);
    if (fault.empty()) continue;
    kept.pop_back();
    left_out.push_back(fmt::format("the edit {} is left out, as it does not apply to {}: {}",
                                   scenario::toString(edit), file, fault));
  }
  edits = kept;
}

void checkInput(const ViewOptions& options, Opening& opening) {
  switch (playback::inputKindOf(options.view.input)) {
    case playback::InputKind::scenario:
      checkScenario(options.view.input, opening.options.view.edits, opening.left_out);
      break;
    case playback::InputKind::volume:
      if (!options.view.scenario.empty()) {
        checkScenario(options.view.scenario, opening.options.view.edits, opening.left_out);
      }
      break;
    case playback::InputKind::mesh:
      render::checkCellSettings(options.view.settings);
      if (!options.view.scenario.empty()) {
        checkScenario(options.view.scenario, opening.options.view.edits, opening.left_out);
      }
      break;
    case playback::InputKind::elevation:
    case playback::InputKind::antenna:
    case playback::InputKind::recording:  // became a scenario
      throw Error(ErrorCode::bad_input, {options.view.input, 0, 0},
                  "neither a scenario nor a volume: open the scenario that names it");
  }
}

}  // namespace

Opening prepareOpening(const OpenRequest& asked, const ViewOptions& present) {
  OpenRequest request = asked;
  Opening opening;
  std::string made_of;
  ImportNote note;
  if (playback::inputKindOf(request.file) ==
      playback::InputKind::recording) {  // throws if there is no such file
    made_of = request.file;
    request.file = importRecordingFile(request.file, note);
  }
  opening.options = present;
  ViewOptions& options = opening.options;
  using playback::JsonContent;
  switch (playback::jsonContentOf(request.file)) {
    case JsonContent::transfer:
      if (present.view.input.empty()) {
        throw Error(ErrorCode::bad_input, {request.file, 0, 0},
                    "colours, which need a volume: open a scenario or volumes first");
      }
      opening.colors = request.file;
      return opening;
    case JsonContent::view:
      if (present.view.input.empty()) {
        throw Error(ErrorCode::bad_input, {request.file, 0, 0},
                    "a view of some input: open the scenario or the volumes first");
      }
      options.view = playback::readViewState(request.file);
      playback::setInput(options.view, present.view);
      if (options.view.open_panels.empty()) options.view.open_panels = present.view.open_panels;
      options.state = request.file;
      options.fits_labels = false;
      options.offers_kept_view = false;
      break;
    case JsonContent::other:
    case JsonContent::header:  // checkInput() refuses these two
    case JsonContent::series:
      if (request.view) options.view = *request.view;
      playback::setInput(options.view, present.view);
      if (request.file != present.view.input) options.view.mesh.clear();  // chosen for that scenario
      options.view.input = request.file;
      options.view.scenario = request.scenario;
      options.state.clear();
      options.fits_labels = !request.view;
      options.offers_kept_view = !request.view;
      break;
  }
  if (!made_of.empty() || options.view.input != present.view.input) {
    options.stream.reset();
    options.made_of = made_of;
    options.made_note = note;
    opening.imports = !made_of.empty();
  }
  options.view.transfer_file.clear();
  options.unsaved_edits = request.unsaved_edits;
  opening.restores = request.restores;
  playback::addOwnScenario(options.view);
  checkInput(options, opening);
  for (const std::string& file : playback::missingMapFiles(options.view)) {
    std::vector<std::string>& places = options.view.places;
    places.erase(std::remove(places.begin(), places.end(), file), places.end());
    if (options.view.drape == file) options.view.drape.clear();
    opening.left_out.push_back(fmt::format("{} is left out of the map: no such file", file));
  }
  if (!opening.left_out.empty()) options.state.clear();
  return opening;
}

}  // namespace emscape::view
