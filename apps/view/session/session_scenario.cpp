/// Verbs of the scenario: edits and undo.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/view/session/session.h"
#include "apps/view/values/refusal_text.h"
#include "apps/view/values/shown_quantity.h"
#include "base/files/json_writing.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "scenario/file/new_items.h"
#include "scenario/file/parameters.h"
#include "scenario/model/named_items.h"

namespace emscape::view {
namespace {

/// The name of the shown quantity of a computed scenario.
std::string quantityOf(const playback::ViewState& view, const scenario::Scenario& scenario) {
  return view.quantity.empty() ? scenario.output.quantities.front() : view.quantity;
}

/// {"edits": ["PATH=VALUE", ..]}
std::vector<scenario::Edit> editsOf(const Json& list) {
  std::vector<scenario::Edit> edits;
  for (const Json& edit : list) edits.push_back(scenario::parseEdit(edit.get<std::string>()));
  return edits;
}

}  // namespace

std::vector<scenario::Edit> movesOf(const scenario::Scenario& scenario, const std::string& platform,
                                    double latitude_deg, double longitude_deg) {
  const scenario::Platform& moved =
      scenario.platforms[scenario::indexOfNamed(scenario.platforms, platform, "platform")];
  if (moved.track.size() > 1) {
    throw Error(ErrorCode::bad_input, fmt::format("'{}' cannot be put elsewhere: it moves along {}", platform,
                                                  moved.track_file.empty() ? "its track" : moved.track_file));
  }
  const std::string path = "platforms." + scenario::pathStep(platform) + ".position.";
  return {{path + "latitude_deg", fmt::format("{:.7f}", latitude_deg)},
          {path + "longitude_deg", fmt::format("{:.7f}", longitude_deg)}};
}

playback::ScenarioPtr Session::original() const {
  const playback::ScenarioPtr shown = scenario();
  if (original_of_ == shown) return original_;
  original_ = shown;
  try {
    if (shown && shown->source) original_ = scenario::withEdits(*shown, {});
  } catch (const Error&) {  // the file has a fault that the edits mend
  }
  original_of_ = shown;
  return original_;
}

void Session::changeScenario(const std::vector<scenario::Edit>& edits) {
  requireScenario();
  requireMovable(edits);
  edit_queue_.set(edits);
  edit_queue_.begin(*edits_);
}

void Session::drag(const std::vector<scenario::Edit>& edits) {
  if (!edits_) return;
  try {
    requireMovable(edits);
  } catch (const Error& error) {
    if (notice_.text != error.message()) tell(error.message(), true);
    return;
  }
  edit_queue_.drag(edits);
  edit_queue_.begin(*edits_);
}

void Session::endDrag() {
  edit_queue_.endDrag();
  if (!std::exchange(dragging_, false)) return;
  if (transfer_) transfer_->endDrag();
  noteSteps();
}

void Session::cancelDrag() {
  edit_queue_.cancelDrag();
  if (!isDraggingPlane()) return;
  planes_.cancelDrag();
  showPlanes();
}

void Session::takeEdits() {
  if (!edits_) return;
  const playback::ScenarioPtr before = edits_->scenario();
  for (const playback::EditQueue::Outcome& outcome : edit_queue_.update(*edits_)) {
    touched_ = true;
    if (!outcome.error.empty()) {
      rejection_ = Rejection{outcome.edits, refusalText(outcome.error, outcome.edits)};
      tell(rejection_->message, true);
      continue;
    }
    if (rejection_ && notice_.text == rejection_->message) notice_ = {};
    rejection_.reset();
    for (const scenario::Edit& edit : outcome.edits) {
      log_.write("edit", {{"path", edit.path}, {"value", edit.value}});
      if (!hasItem(*before, edit.path) && hasItem(*edits_->scenario(), edit.path)) selected_ = edit.path;
    }
  }
  noteSteps();
  if (edits_->scenario() != shown_scenario_) showEdits();
}

void Session::noteSteps() {
  if (edits_) undo_order_.note(History::scenario, edits_->stepsMade(), edits_->stepsBack());
  if (transfer_) undo_order_.note(History::transfer, transfer_->stepsMade(), transfer_->stepsBack());
  undo_order_.note(History::planes, planes_.stepsMade(), planes_.stepsBack());
}

void Session::askUndo(bool undo) {
  endDrag();
  endPlaneDrag();
  if (edit_queue_.isBusy()) {
    edit_queue_.then([this, undo] { undoOrRedo(undo); });
  } else {
    undoOrRedo(undo);
  }
}

void Session::undoOrRedo(bool undo) {
  noteSteps();
  const std::optional<History> history = undo ? undo_order_.undo() : undo_order_.redo();
  if (history == History::scenario) {
    undo ? edits_->undo() : edits_->redo();
    showEdits();
  } else if (history == History::transfer) {
    changeTransfer([undo](playback::TransferEditor& editor) { undo ? editor.undo() : editor.redo(); });
  } else if (history == History::planes) {
    undo ? planes_.undo() : planes_.redo();
    showPlanes();
  }
}

/// Selection, followed platform, range rings and channel keep their items, which have another name now; those
/// of items that are gone end.
void Session::followNames(const std::vector<playback::RenamedItem>& renamed) {
  selected_ = playback::renamedPath(renamed, selected_);
  for (const playback::RenamedItem& item : renamed) {
    if (item.list == "platforms" && view_.follow == item.before) view_.follow = item.now;
    if (item.list != "emitters") continue;
    for (playback::RangeRings& rings : view_.range_rings) {
      if (rings.emitter == item.before) rings.emitter = item.now;
    }
    for (std::string* quantity : {&view_.quantity, &last_shown_.quantity}) {
      const std::size_t at = quantity->find(':');
      if (at != std::string::npos && quantity->substr(at + 1) == item.before)
        *quantity = quantity->substr(0, at + 1) + item.now;
    }
  }
  if (!scenario::findNamed(shown_scenario_->platforms, view_.follow)) view_.follow.clear();
  std::vector<playback::RangeRings>& rings = view_.range_rings;
  rings.erase(std::remove_if(rings.begin(), rings.end(),
                             [this](const playback::RangeRings& each) {
                               return !scenario::findNamed(shown_scenario_->emitters, each.emitter);
                             }),
              rings.end());
}

void Session::showEdits() {
  showScenario(playback::renamedItems(*shown_scenario_, *edits_->scenario()));
}

/// @param renamed  items that the user's edits have given another name
void Session::showScenario(const std::vector<playback::RenamedItem>& renamed) {
  touched_ = true;
  const playback::ScenarioPtr before = std::exchange(shown_scenario_, edits_->scenario());
  view_.edits = edits_->edits();
  followNames(renamed);
  indexStreamed();
  watchFiles();
  setTimelineScenario();
  if (computedScenario()) {
    // Without a choice by the user the scenario's first quantity is shown, as in `render`.
    const std::string quantity = quantityOf(view_, *before), field = fieldName(quantity);
    const std::string missing = missingQuantity(*shown_scenario_, view_.quantity);
    if (!missing.empty()) view_.quantity.clear();
    const std::string now = quantityOf(view_, *shown_scenario_);
    if (!missing.empty()) tell(fmt::format("{}; {} is shown instead", missing, now), true);
    if (now != quantity) {
      leaveField(field);
      playback::dropColors(view_);
    }
  }
  live_.show(view_, shown_scenario_, isDragging() ? playback::Patience::kShort : playback::Patience::kNone);
}

std::vector<Verb> Session::scenarioVerbs() {
  return {
      {"set",
       {{"path", kText}, {"value", ArgumentType::any}},
       "Changes a value of the scenario, as `--set PATH=VALUE` does; a new name also where others refer to "
       "it",
       [](Session& session, const Command& command) {
         const Json& value = command.arguments["value"];
         const std::string text = value.is_string() ? value.get<std::string>() : dumpJson(value);
         session.changeScenario(editsWithReferences(session.requireScenario(), {command.text("path"), text}));
       }},
      {"set_together",
       {{"edits", ArgumentType::texts}},
       "Changes several values, a list of PATH=VALUE, in one step and checked together",
       [](Session& session, const Command& command) {
         session.changeScenario(editsOf(command.arguments["edits"]));
       }},
      {"choose",
       {{"path", kText}, {"value", kText}},
       "Chooses another antenna pattern, scan or propagation model, with common values for what it needs",
       [](Session& session, const Command& command) {
         session.changeScenario(scenario::editsForChoice(session.requireScenario(), command.text("path"),
                                                         command.text("value")));
       }},
      {"move",
       {{"platform", kText}, {"latitude_deg"}, {"longitude_deg"}},
       "Moves a platform; its height is kept",
       [](Session& session, const Command& command) {
         session.changeScenario(movesOf(session.requireScenario(), command.text("platform"),
                                        command.number("latitude_deg"), command.number("longitude_deg")));
       }},
      {"undo",
       {},
       "Undoes the last change of the scenario or of the colours",
       [](Session& session, const Command&) { session.askUndo(true); }},
      {"redo",
       {},
       "Redoes the change that was undone",
       [](Session& session, const Command&) { session.askUndo(false); }},
  };
}

}  // namespace emscape::view
