#include "scenario/source.h"

#include <fmt/format.h>

#include <algorithm>

#include "document/edit_path.h"
#include "document/text_file.h"
#include "scenario/schema.h"

namespace emscape::scenario {

namespace {

using document::DocumentNodePtr;
using document::ResolvedPath;

/// The value that an edit gives; null: it removes.
DocumentNodePtr valueOf(const Edit& edit) {
  const std::size_t begin = edit.value.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) {
    throw Error(ErrorCode::bad_input, "the value is empty; null removes a key, \"\" is the empty text");
  }
  const std::string word = edit.value.substr(begin, edit.value.find_last_not_of(" \t\r\n") - begin + 1);
  if (word == "null" || word == "Null" || word == "NULL" || word == "~") return nullptr;
  document::ProblemList problems;
  const DocumentNodePtr value = document::readDocument("", document::checkedUtf8("", edit.value), problems);
  const std::vector<document::Problem> faults = problems.inOrder();
  if (!faults.empty()) throw Error(ErrorCode::bad_input, "the value is " + faults.front().message);
  return value;
}

/// Whether a path leads to the other's value or into it.
bool leadsInto(const std::string& outer, const std::string& inner) {
  return inner.compare(0, outer.size(), outer) == 0 &&
         (inner.size() == outer.size() || inner[outer.size()] == '.');
}

/// Adds an edit to those made. An earlier one of the same path is forgotten, unless one in between depends on
/// it.
void remember(std::vector<Edit>& edits, Edit edit) {
  for (std::size_t i = edits.size(); i-- > 0;) {
    if (edits[i].path == edit.path) {
      edits.erase(edits.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    const std::string& path = edits[i].path;
    const std::size_t point = path.rfind('.');
    const bool renames = point != std::string::npos && path.substr(point) == ".name";
    if (renames || leadsInto(path, edit.path) || leadsInto(edit.path, path)) break;
  }
  edits.push_back(std::move(edit));
}

void apply(ScenarioSource& source, const Edit& edit) {
  const ResolvedPath path = document::resolvePath(edit.path, source.root, scenarioSpec());
  const DocumentNodePtr value = valueOf(edit);
  const Edit made{path.text, edit.value};
  if (!value && path.required) {
    throw Error(ErrorCode::bad_input, fmt::format("{} must be given; it cannot be removed", path.name));
  }
  ScenarioSource edited;
  edited.text = source.text;
  edited.root = source.root;
  if (value || path.exists) {
    const std::string& text = source.text.text();
    edited.text.apply(document::spliceFor(text, source.root, path.steps, value), toString(made));
    if (edited.text.text().size() > kMaxScenarioBytes) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("the scenario would have {} bytes, more than the allowed {}",
                              edited.text.text().size(), kMaxScenarioBytes));
    }
    document::ProblemList problems;
    edited.root = document::readDocument(edited.text.file(), edited.text.text(), problems);
    // The text is changed at one place, and must then mean what was asked for: nothing else may have changed.
    const DocumentNodePtr wanted = document::withValueAt(source.root, path.steps, value);
    if (!edited.root || problems.hasErrors() || !document::sameValue(*edited.root, *wanted)) {
      throw Error(ErrorCode::bad_input,
                  "the file is written in a way that cannot be edited here; edit the file");
    }
  }
  remember(source.edits, made);
  source.text = std::move(edited.text);
  source.root = std::move(edited.root);
}

}  // namespace

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

std::string toString(const Edit& edit) {
  return edit.path + "=" + edit.value;
}

bool operator==(const Edit& a, const Edit& b) {
  return a.path == b.path && a.value == b.value;
}

}  // namespace emscape::scenario
