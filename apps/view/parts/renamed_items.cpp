#include "apps/view/parts/renamed_items.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

namespace emscape::view {
namespace {

/// The item to which an edit gives a name.
std::optional<RenamedItem> renamedBy(const scenario::Edit& edit) {
  const std::size_t list_end = edit.path.find('.'), item_end = edit.path.rfind('.');
  if (list_end == item_end || edit.path.substr(item_end) != ".name") return std::nullopt;
  const auto quoted = nlohmann::json::parse(edit.value, nullptr, false);
  RenamedItem item;
  item.list = edit.path.substr(0, list_end);
  item.now = quoted.is_string() ? quoted.get<std::string>() : edit.value;
  item.path_before = edit.path.substr(0, item_end);
  item.path_now = item.list + "." + scenario::pathStep(item.now);
  return item;
}

}  // namespace

std::vector<RenamedItem> renamedItems(const scenario::Scenario& before, const scenario::Scenario& now) {
  std::vector<RenamedItem> renamed;
  const auto compare = [&](const std::string& list, const auto& old_items, const auto& items) {
    if (old_items.size() != items.size()) return;
    const auto has = [](const auto& list_of_items, const std::string& name) {
      return std::any_of(list_of_items.begin(), list_of_items.end(),
                         [&name](const auto& item) { return item.name == name; });
    };
    for (std::size_t i = 0; i < items.size(); ++i) {
      const std::string &old_name = old_items[i].name, &name = items[i].name;
      if (old_name == name || has(items, old_name) || has(old_items, name)) continue;
      renamed.push_back({list, old_name, name, list + "." + scenario::pathStep(old_name),
                         list + "." + scenario::pathStep(name)});
    }
  };
  compare("emitters", before.emitters, now.emitters);
  compare("platforms", before.platforms, now.platforms);
  compare("receivers", before.receivers, now.receivers);
  compare("receivers", before.placed_receivers, now.placed_receivers);
  compare("targets", before.targets, now.targets);
  return renamed;
}

std::string renamedPath(const std::vector<RenamedItem>& items, const std::string& path) {
  for (const RenamedItem& item : items) {
    const std::size_t length = item.path_before.size();
    const bool is_within =
        path.compare(0, length, item.path_before) == 0 && (path.size() == length || path[length] == '.');
    if (is_within) return item.path_now + path.substr(length);
  }
  return path;
}

std::string nameAfter(const std::vector<scenario::Edit>& edits, const std::string& list, std::string name) {
  for (const scenario::Edit& edit : edits) {
    const std::optional<RenamedItem> item = renamedBy(edit);
    if (item && item->path_before == list + "." + scenario::pathStep(name)) name = item->now;
  }
  return name;
}

std::set<std::string> editedPaths(const std::vector<scenario::Edit>& edits) {
  std::set<std::string> paths;
  for (const scenario::Edit& edit : edits) {
    paths.insert(edit.path);
    const std::optional<RenamedItem> item = renamedBy(edit);
    if (!item) continue;
    std::set<std::string> renamed;
    for (const std::string& path : paths) renamed.insert(renamedPath({*item}, path));
    paths = std::move(renamed);
  }
  return paths;
}

}  // namespace emscape::view
