#include "scenario/file/source.h"

#include <fmt/format.h>

#include <algorithm>

#include "document/edit_path.h"
#include "document/number_edit.h"
#include "document/text_file.h"
#include "scenario/file/schema.h"

namespace emscape::scenario {

namespace {

using document::DocumentNodePtr;
using document::ResolvedPath;

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

bool isNull(const std::string& value) {
  const std::string word = trimmed(value);
  return word == "null" || word == "Null" || word == "NULL" || word == "~";
}

/// The value of an edit; null: removal.
DocumentNodePtr valueOf(const Edit& edit) {
  if (trimmed(edit.value).empty()) {
    throw Error(ErrorCode::bad_input, "the value is empty; null removes a key, \"\" is the empty text");
  }
  if (isNull(edit.value)) return nullptr;
  document::ProblemList problems;
  const DocumentNodePtr value = document::readDocument("", document::checkedUtf8("", edit.value), problems);
  const std::vector<document::Problem> faults = problems.inOrder();
  if (!faults.empty()) throw Error(ErrorCode::bad_input, "the value is " + faults.front().message);
  return value;
}

/// True if a path refers to the value of the other path or to a part of it.
bool leadsInto(const std::string& outer, const std::string& inner) {
  return inner.compare(0, outer.size(), outer) == 0 &&
         (inner.size() == outer.size() || inner[outer.size()] == '.');
}

/// Index of the last edit of a path before `end` that can be repeated independently of the edits after it;
/// npos if there is none.
std::size_t lastEditOf(const std::string& path, const std::vector<MadeEdit>& edits, std::size_t end) {
  for (std::size_t i = end; i-- > 0;) {
    if (edits[i].moves_paths) break;
    if (edits[i].edit.path == path) return i;
    if (leadsInto(edits[i].edit.path, path) || leadsInto(path, edits[i].edit.path)) break;
  }
  return std::string::npos;
}

/// Drops the edit that added an item, and those within it, if the paths of the later edits do not depend on
/// it. @return false if there is none
bool forgetAddedItem(std::vector<MadeEdit>& edits, const std::string& path) {
  std::size_t i = edits.size();
  while (i > 0 && !edits[i - 1].moves_paths && !(edits[i - 1].adds && edits[i - 1].edit.path == path)) --i;
  if (i == 0 || edits[i - 1].moves_paths) return false;
  const auto added = edits.begin() + static_cast<std::ptrdiff_t>(i - 1);
  edits.erase(std::remove_if(added, edits.end(),
                             [&](const MadeEdit& made) { return leadsInto(path, made.edit.path); }),
              edits.end());
  return true;
}

/// The edit that changed the value of a path, as the file has it; null if there is none.
const MadeEdit* changeOf(const std::string& path, const std::vector<MadeEdit>& edits) {
  const std::size_t last = lastEditOf(path, edits, edits.size());
  const bool is_changed = last != std::string::npos && edits[last].before && !isNull(edits[last].edit.value);
  return is_changed ? &edits[last] : nullptr;
}

/// Adds an edit to the list. A repeated edit of a value replaces the earlier one, and a value that was added
/// and then removed leaves no edit.
void remember(std::vector<MadeEdit>& edits, MadeEdit made) {
  if (made.moves_paths && isNull(made.edit.value) && forgetAddedItem(edits, made.edit.path)) return;
  const std::size_t last =
      made.moves_paths ? std::string::npos : lastEditOf(made.edit.path, edits, edits.size());
  if (last == std::string::npos) {
    edits.push_back(std::move(made));
    return;
  }
  const bool was_removed = isNull(edits[last].edit.value), is_removed = isNull(made.edit.value);
  if (!was_removed && !is_removed) {
    made.adds = edits[last].adds;
    made.before = edits[last].before;
    edits[last] = std::move(made);
  } else if (is_removed && edits[last].adds) {
    edits.erase(edits.begin() + static_cast<std::ptrdiff_t>(last));
  } else if (was_removed != is_removed) {
    const std::size_t before = is_removed ? lastEditOf(made.edit.path, edits, last) : std::string::npos;
    if (before != std::string::npos && isNull(edits[before].edit.value)) {
      edits.erase(edits.begin() + static_cast<std::ptrdiff_t>(last));
    } else {
      edits.push_back(std::move(made));
    }
  }
}

/// Reads a text that was changed in one span: nothing else may have changed.
DocumentNodePtr readEdited(const document::EditedText& text, const DocumentNodePtr& before,
                           const ResolvedPath& path, const DocumentNodePtr& value) {
  document::ProblemList problems;
  DocumentNodePtr root = document::readDocument(text.file(), text.text(), problems);
  const DocumentNodePtr wanted = document::withValueAt(before, path.steps, value);
  if (!root || problems.hasErrors() || !document::sameValue(*root, *wanted)) {
    throw Error(ErrorCode::bad_input,
                "the file is written in a way that cannot be edited here; edit the file");
  }
  return root;
}

/// The keys of a new item with its name, which is that of the path.
DocumentNodePtr namedItem(const ResolvedPath& path, const DocumentNodePtr& value) {
  if (!value || value->kind != document::NodeKind::map) throw Error(ErrorCode::bad_input, path.missing);
  const auto given = std::find_if(value->entries.begin(), value->entries.end(),
                                  [](const document::MapEntry& entry) { return entry.key == "name"; });
  auto item = std::make_shared<document::DocumentNode>(*value);
  if (given != value->entries.end()) {
    if (given->value->text == path.new_name) return item;
    throw Error(ErrorCode::bad_input, fmt::format("the new item is '{}' in the path and '{}' in its 'name'",
                                                  path.new_name, given->value->text));
  }
  auto name = std::make_shared<document::DocumentNode>();
  name->kind = document::NodeKind::scalar;
  name->text = path.new_name;
  name->quoted = true;
  item->entries.insert(item->entries.begin(), {"name", {}, std::move(name)});
  return item;
}

void apply(ScenarioSource& source, const Edit& edit) {
  ResolvedPath path = document::resolvePath(edit.path, source.root, scenarioSpec());
  DocumentNodePtr value = valueOf(edit);
  if (!path.missing.empty()) value = namedItem(path, value);
  const Edit made{path.text, edit.value};
  const MadeEdit* const changed = changeOf(path.text, source.edits);
  const bool is_taken_back = changed != nullptr && value && document::sameValue(*changed->before, *value);
  if (is_taken_back) value = changed->before;
  const bool is_item = std::holds_alternative<std::size_t>(path.steps.back());
  if (!value && path.required) {
    throw Error(ErrorCode::bad_input, fmt::format("{} must be given; it cannot be removed", path.name));
  }
  if (is_item && !value && !path.is_list_required) {  // an optional list without items is not given
    const document::NodePath list(path.steps.begin(), path.steps.end() - 1);
    if (document::valueAt(source.root, list)->items.size() == 1) path.steps = list;
  }
  ScenarioSource edited;
  edited.text = source.text;
  if (value || path.exists) {
    const std::string& text = source.text.text();
    const document::Splice splice = document::spliceFor(text, source.root, path.steps, value);
    edited.root = document::withNumberSpliced(text, source.root, path.steps, value, splice);
    edited.text.apply(splice, toString(made));
    if (edited.text.text().size() > kMaxScenarioBytes) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("the scenario would have {} bytes, more than the allowed {}",
                              edited.text.text().size(), kMaxScenarioBytes));
    }
    if (!edited.root) edited.root = readEdited(edited.text, source.root, path, value);
  } else {
    edited.root = source.root;
  }
  const bool is_name = !is_item && std::get<std::string>(path.steps.back()) == "name";
  const DocumentNodePtr parent =
      document::valueAt(source.root, document::NodePath(path.steps.begin(), path.steps.end() - 1));
  const bool adds =
      !path.missing.empty() || (!path.exists && parent && parent->kind == document::NodeKind::map);
  if (is_taken_back) {
    source.edits.erase(source.edits.begin() + (changed - source.edits.data()));
  } else {
    const DocumentNodePtr before = path.exists ? document::valueAt(source.root, path.steps) : nullptr;
    const bool is_scalar = before && before->kind == document::NodeKind::scalar && !is_name;
    remember(source.edits, {made, is_name || (is_item && !value), adds, is_scalar ? before : nullptr});
  }
  source.text = std::move(edited.text);
  source.root = std::move(edited.root);
}

}  // namespace

bool isAdded(const ScenarioSource& source, const std::string& path) {
  const std::size_t last = lastEditOf(path, source.edits, source.edits.size());
  return last != std::string::npos && source.edits[last].adds;
}

void applyEdit(ScenarioSource& source, const Edit& edit) {
  try {
    apply(source, edit);
  } catch (const Error& error) {
    throw Error(error.code(), {toString(edit), 0, 0}, error.message());
  }
}

Edit parseEdit(const std::string& text) {
  const std::size_t end = document::endOfPath(text);
  if (end == std::string::npos || end == 0) {
    throw Error(ErrorCode::usage,
                fmt::format("'{}' is not an edit; write PATH=VALUE, such as atmosphere.k_factor=1.5", text));
  }
  return {text.substr(0, end), text.substr(end + 1)};
}

std::string pathStep(const std::string& name) {
  return document::pathStep(name);
}

std::string toString(const Edit& edit) {
  return edit.path + "=" + edit.value;
}

bool operator==(const Edit& a, const Edit& b) {
  return a.path == b.path && a.value == b.value;
}

const std::vector<std::string>& warningsOf(const Scenario& scenario) {
  static const std::vector<std::string> kNone;
  return scenario.source ? scenario.source->warnings : kNone;
}

std::string changeCountOf(const Scenario& scenario) {
  const std::size_t count = scenario.edits().size();
  return count == 0 ? "" : fmt::format("{} value{} changed", count, count == 1 ? "" : "s");
}

std::string titleOf(const Scenario& scenario) {
  const std::string changes = changeCountOf(scenario);
  return scenario.name + (changes.empty() ? "" : " (" + changes + ")");
}

std::string changesOf(const Scenario& scenario) {
  std::string text;
  for (const Edit& edit : scenario.edits())
    text += (text.empty() ? "changed: " : "\nchanged: ") + toString(edit);
  return text;
}

}  // namespace emscape::scenario
