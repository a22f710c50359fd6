/// A scenario that is edited step by step, with undo and redo.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"
#include "playback/editing/undo_stack.h"

namespace emscape::playback {

using ScenarioPtr = std::shared_ptr<const scenario::Scenario>;

/// Applies edits to a scenario and checks them together. Returns the same object if the edits change no text.
/// Any thread may call it. @throws Error (bad_input) as Scenario::set()
ScenarioPtr edited(const ScenarioPtr& scenario, const std::vector<scenario::Edit>& edits);

/// Every state is an immutable scenario, so that a solver may still read one that was undone. The last 1000
/// steps can be undone; of large scenarios fewer, as many as take about 64 MiB, but at least 10. For one
/// thread.
class EditHistory {
 public:
  /// @param scenario  not null
  explicit EditHistory(ScenarioPtr scenario);

  const ScenarioPtr& scenario() const { return stack_.state(); }
  /// The edits from the scenario's file to scenario(), as Scenario::edits().
  std::vector<scenario::Edit> edits() const { return scenario()->edits(); }

  /// Applies edits, checked together, as one step. Edits that change no text make no step.
  /// @throws Error (bad_input) as Scenario::set(); nothing is changed then
  void set(const std::vector<scenario::Edit>& edits);
  void set(const std::string& path, const std::string& value) { set({{path, value}}); }
  /// The same with the result of edited() for scenario().
  void adopt(ScenarioPtr edited);

  /// All edits until endDrag() are one step; no step if the drag ends where it began.
  void beginDrag() { stack_.beginDrag(); }
  void endDrag();
  /// Reverts to the state at the beginning of the drag.
  void cancelDrag() { stack_.cancelDrag(); }

  /// As UndoStack::stepsBack().
  std::size_t stepsBack() const { return stack_.stepsBack(); }
  /// As UndoStack::stepsMade().
  long long stepsMade() const { return stack_.stepsMade(); }
  bool canUndo() const { return stack_.canUndo(); }
  bool canRedo() const { return stack_.canRedo(); }
  /// As UndoStack::stepsTo().
  int stepsTo(const ScenarioPtr& scenario) const { return stack_.stepsTo(scenario); }
  void undo();
  void redo();

  /// True if scenario() differs from the scenario of the constructor or of the last markSaved().
  bool isModified() const;
  /// Marks scenario() as saved.
  void markSaved() { saved_hash_ = scenario()->hash; }

 private:
  void keepWithinMemory();

  UndoStack<ScenarioPtr> stack_;
  std::string saved_hash_;
};

/// A command line that makes the same edits: `emscape render scenarios/a.yaml --set
/// 'emitters.jammer.power_w=5'`, quoted for a POSIX shell.
/// @param subcommand  of emscape
std::string commandText(const std::string& subcommand, const scenario::Scenario& scenario);

}  // namespace emscape::playback
