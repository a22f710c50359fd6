#include "scenario/file/save_scenario.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>

#include "base/files/file_reading.h"
#include "base/files/folder.h"
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

/// Another name for a file that the text names.
using NewName = std::function<std::string(const std::string& name)>;

/// The text with other names of files.
std::string textWith(const ScenarioSource& source, const NewName& newName) {
  const std::string& text = source.text.text();
  ValueSpec root;
  root.type = document::ValueType::object;
  root.object = &scenarioSpec();
  std::vector<Splice> splices;
  NodePath at_root;
  forEachFileName(source.root, root, at_root, [&](const NodePath& path, const DocumentNode& node) {
    const std::string name = newName(node.text);
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

fs::path folderOf(const ScenarioSource& source) {
  return fs::absolute(source.text.file()).parent_path().lexically_normal();
}

const ScenarioSource& sourceOf(const Scenario& scenario) {
  if (!scenario.source) {
    throw Error(ErrorCode::bad_input, "the scenario was not read from a file: there is no text to save");
  }
  return *scenario.source;
}

/// A folder beside a file for copies: NAME_files, or with a number if that one has other files of these
/// names.
fs::path folderForCopies(const fs::path& file, const std::map<std::string, std::string>& text_of_name) {
  for (int n = 1;; ++n) {
    const fs::path folder =
        file.parent_path() / (file.stem().string() + "_files" + (n > 1 ? "_" + std::to_string(n) : ""));
    const bool is_free = std::all_of(text_of_name.begin(), text_of_name.end(), [&](const auto& each) {
      const fs::path copy = folder / each.first;
      return !fs::exists(fs::symlink_status(copy)) || readWholeText(copy) == each.second;
    });
    if (is_free) return folder;
  }
}

}  // namespace

std::string scenarioTextIn(const Scenario& scenario, const fs::path& folder) {
  const ScenarioSource& source = sourceOf(scenario);
  const fs::path to = fs::absolute(folder).lexically_normal();
  if (folderOf(source) == to) return source.text.text();
  try {
    return textWith(source, [&](const std::string& name) { return renamed(name, folderOf(source), to); });
  } catch (const Error& error) {
    throw Error(error.code(), {scenario.file, 0, 0},
                "the files that it names cannot be named from " + folder.string() + ": " + error.message());
  }
}

void saveScenario(const Scenario& scenario, const std::string& file) {
  const std::string text = scenarioTextIn(scenario, fs::absolute(file).parent_path());
  writeWhole(
      file, [&text](std::ostream& stream) { stream << text; }, Replaces::any);
}

void saveWithFiles(const Scenario& scenario, const std::string& file) {
  const ScenarioSource& source = sourceOf(scenario);
  const fs::path from = folderOf(source), to = fs::absolute(file).lexically_normal();
  std::map<std::string, std::string> text_of_name;  // of files of the scenario's own folder
  const auto isOwn = [&](const std::string& name) {
    const fs::path relative = fs::path(name).lexically_normal();
    return relative.is_relative() && *relative.begin() != ".." && fs::is_regular_file(from / relative);
  };
  textWith(source, [&](const std::string& name) {
    if (isOwn(name)) text_of_name[fs::path(name).filename().string()] = readWholeText(from / name);
    return name;
  });
  const fs::path folder = folderForCopies(to, text_of_name);
  if (!text_of_name.empty()) makeFolderIn(to.parent_path(), folder.filename());  // no symbolic link
  for (const auto& [name, text] : text_of_name) {
    if (!fs::exists(folder / name))
      writeWhole(
          folder / name, [&text = text](std::ostream& stream) { stream << text; }, Replaces::nothing);
  }
  const std::string text = textWith(source, [&](const std::string& name) {
    return isOwn(name) ? (folder.filename() / fs::path(name).filename()).generic_string()
                       : renamed(name, from, to.parent_path());
  });
  writeWhole(
      file, [&text](std::ostream& stream) { stream << text; }, Replaces::any);
}

}  // namespace emscape::scenario
