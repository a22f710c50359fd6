#include "scenario/file/save_scenario.h"

#include <algorithm>
#include <filesystem>

#include "base/files/whole_file.h"
#include "document/text_edit.h"
#include "emscape/scenario/file/scenario_file.h"
#include "scenario/file/schema.h"
#include "scenario/file/source.h"

namespace emscape::scenario {

namespace {

namespace fs = std::filesystem;
using document::DocumentNode;
using document::DocumentNodePtr;
using document::NodePath;
using document::Splice;

/// Converts a file name from relative to one folder to relative to another; absolute names are kept.
std::string renamed(const std::string& name, const fs::path& from, const fs::path& to) {
  if (fs::path(name).is_absolute()) return name;
  return fs::absolute(from / name).lexically_normal().lexically_relative(to).generic_string();
}

/// Calls visit(path, node) for every file name in a value.
template <class Visit>
void forEachFileName(const DocumentNodePtr& node, const ValueSpec& spec, NodePath& path, const Visit& visit) {
  if (spec.type == document::ValueType::file && node->kind == document::NodeKind::scalar) visit(path, *node);
  for (std::size_t i = 0; i < node->items.size() && spec.item; ++i) {
    path.emplace_back(i);
    forEachFileName(node->items[i], *spec.item, path, visit);
    path.pop_back();
  }
  for (const document::MapEntry& entry : node->entries) {
    const KeySpec* key = spec.object == nullptr ? nullptr : spec.object->find(entry.key, nullptr);
    if (key == nullptr) continue;
    path.emplace_back(entry.key);
    forEachFileName(entry.value, key->value, path, visit);
    path.pop_back();
  }
}

/// The text with file names relative to another folder.
std::string textFor(const ScenarioSource& source, const fs::path& folder) {
  const std::string& text = source.text.text();
  const fs::path old_folder = fs::absolute(source.text.file()).parent_path().lexically_normal();
  if (old_folder == folder) return text;
  ValueSpec root;
  root.type = document::ValueType::object;
  root.object = &scenarioSpec();
  std::vector<Splice> splices;
  NodePath at_root;
  forEachFileName(source.root, root, at_root, [&](const NodePath& path, const DocumentNode& node) {
    const std::string name = renamed(node.text, old_folder, folder);
    if (name == node.text) return;
    auto value = std::make_shared<DocumentNode>();
    value->kind = document::NodeKind::scalar;
    value->text = name;
    splices.push_back(document::spliceFor(text, source.root, path, value));
  });
  std::sort(splices.begin(), splices.end(),
            [](const Splice& a, const Splice& b) { return a.begin > b.begin; });
  std::string moved = text;
  for (const Splice& splice : splices) moved.replace(splice.begin, splice.end - splice.begin, splice.text);
  return moved;
}

}  // namespace

std::string scenarioTextIn(const Scenario& scenario, const fs::path& folder) {
  if (!scenario.source) {
    throw Error(ErrorCode::bad_input, "the scenario was not read from a file: there is no text to save");
  }
  try {
    return textFor(*scenario.source, fs::absolute(folder).lexically_normal());
  } catch (const Error& error) {
    throw Error(error.code(), {scenario.file, 0, 0},
                "the files that it names cannot be named from " + folder.string() + ": " + error.message());
  }
}

void saveScenario(const Scenario& scenario, const std::string& file) {
  const std::string text = scenarioTextIn(scenario, fs::absolute(file).parent_path());
  writeWhole(file, [&text](std::ostream& stream) { stream << text; });
}

}  // namespace emscape::scenario
