/// A scenario that is edited step by step, with undo and redo.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/playback/undo_stack.h"
#include "emscape/scenario/scenario.h"

namespace emscape::playback {

using ScenarioPtr = std::shared_ptr<const scenario::Scenario>;

/// A scenario with values changed, checked together; the same object where the edits change no text. Any
/// thread may call it. @throws Error (bad_input) as Scenario::set()
ScenarioPtr edited(const ScenarioPtr& scenario, const std::vector<scenario::Edit>& edits);

/// Every state is a scenario of its own that nobody changes, so that a solver may still read one that was
/// undone. One thread uses it.
class EditHistory {
 public:
  /// @param scenario  not null
  explicit EditHistory(ScenarioPtr scenario);

  const ScenarioPtr& scenario() const { return stack_.state(); }
  /// What leads from the scenario's file to scenario(), as Scenario::edits().
  std::vector<scenario::Edit> edits() const { return scenario()->edits(); }

  /// Changes values, checked together, in one step; edits that change no text are none.
  /// @throws Error (bad_input) as Scenario::set(); nothing is changed then
  void set(const std::vector<scenario::Edit>& edits);
  void set(const std::string& path, const std::string& value) { set({{path, value}}); }
  /// The same with what edited() made of scenario().
  void adopt(ScenarioPtr edited);

  /// From here to endDrag() all edits are one step; none if the drag ends where it began.
  void beginDrag() { stack_.beginDrag(); }
  void endDrag();
  /// Back to where the drag began.
  void cancelDrag() { stack_.cancelDrag(); }

  /// As UndoStack::stepsMade().
  long long stepsMade() const { return stack_.stepsMade(); }
  bool canUndo() const { return stack_.canUndo(); }
  bool canRedo() const { return stack_.canRedo(); }
  void undo();
  void redo();

  /// Whether scenario() differs from what was given to the constructor or marked last.
  bool isModified() const;
  /// scenario() is saved now.
  void markSaved() { saved_hash_ = scenario()->hash; }

 private:
  UndoStack<ScenarioPtr> stack_;
  std::string saved_hash_;
};

/// A word as a POSIX shell takes it unchanged: in single quotes where it needs them.
std::string shellWord(const std::string& text);
/// A command line that makes the same edits: `emscape render scenarios/a.yaml --set
/// 'emitters.jammer.power_w=5'`, quoted for a POSIX shell.
/// @param subcommand  of emscape
std::string commandText(const std::string& subcommand, const scenario::Scenario& scenario);

}  // namespace emscape::playback
