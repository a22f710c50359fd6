#include "playback/editing/edit_history.h"

#include <algorithm>
#include <utility>

#include "base/text/shell_word.h"
#include "scenario/file/source.h"

namespace emscape::playback {
namespace {

constexpr std::size_t kHistoryBytes = std::size_t{64} << 20;
constexpr std::size_t kMinSteps = 10;

/// Memory of a state (bytes), roughly: its texts with their nodes, and its tracks. All else is small, or
/// shared by the states.
std::size_t bytesOf(const scenario::Scenario& scenario) {
  constexpr std::size_t kPerCharacter = 20;
  std::size_t bytes = scenario.source ? kPerCharacter * scenario.source->text.text().size() : 0;
  for (const scenario::Platform& platform : scenario.platforms)
    bytes += platform.track.size() * sizeof(scenario::TrackPoint);
  return bytes;
}

}  // namespace

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
  if (edited == scenario()) return;
  stack_.set(std::move(edited));
  keepWithinMemory();
}

void EditHistory::endDrag() {
  const ScenarioPtr* begin = stack_.dragged();
  begin != nullptr && (*begin)->hash == scenario()->hash ? stack_.cancelDrag() : stack_.endDrag();
  keepWithinMemory();
}

void EditHistory::keepWithinMemory() {
  stack_.keep(std::max(kMinSteps, kHistoryBytes / (1 + bytesOf(*scenario()))));
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
