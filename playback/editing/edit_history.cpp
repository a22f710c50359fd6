#include "playback/editing/edit_history.h"

#include <utility>

#include "base/text/shell_word.h"

namespace emscape::playback {

ScenarioPtr edited(const ScenarioPtr& scenario, const std::vector<scenario::Edit>& edits) {
  auto result = std::make_shared<scenario::Scenario>(*scenario);
  result->set(edits);
  // The hash is that of the text.
  return result->hash == scenario->hash ? scenario : result;
}

EditHistory::EditHistory(ScenarioPtr scenario)
    : stack_(std::move(scenario)), saved_hash_(stack_.state()->hash) {}

void EditHistory::set(const std::vector<scenario::Edit>& edits) {
  adopt(edited(scenario(), edits));
}

void EditHistory::adopt(ScenarioPtr edited) {
  if (edited != scenario()) stack_.set(std::move(edited));
}

void EditHistory::endDrag() {
  const ScenarioPtr* begin = stack_.dragged();
  begin != nullptr && (*begin)->hash == scenario()->hash ? stack_.cancelDrag() : stack_.endDrag();
}

void EditHistory::undo() {
  endDrag();
  stack_.undo();
}

void EditHistory::redo() {
  endDrag();
  stack_.redo();
}

bool EditHistory::isModified() const {
  return scenario()->hash != saved_hash_;
}

std::string commandText(const std::string& subcommand, const scenario::Scenario& scenario) {
  std::string command = "emscape " + subcommand + " " + shellWord(scenario.file);
  for (const scenario::Edit& edit : scenario.edits()) command += " --set " + shellWord(toString(edit));
  return command;
}

}  // namespace emscape::playback
