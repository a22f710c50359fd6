#include "playback/editing/renamed_items.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <unordered_set>

namespace emscape::playback {
namespace {

/// True if an edit gives an item's name to a key that refers to items of the list.
bool isReference(const scenario::Edit& edit, const RenamedItem& item) {
  const std::string& path = edit.path;
  const auto endsWith = [&path](const std::string& suffix) {
    return path.size() > suffix.size() &&
           path.compare(path.size() - suffix.size(), suffix.size(), suffix) == 0;
  };
  const bool is_platform = endsWith(".platform") || endsWith(".scan.victim");
  if (item.list == "platforms"
          ? !is_platform
          : path != (item.list == "emitters" ? "output.wanted_emitter" : "output.receiver"))
    return false;
  const auto quoted = nlohmann::json::parse(edit.value, nullptr, false);
  return (quoted.is_string() ? quoted.get<std::string>() : edit.value) == item.now;
}

/// True if items of a list have other places after an edit.
bool removesItem(const scenario::Edit& edit, const std::string& list) {
  return edit.value == "null" && edit.path.compare(0, list.size() + 1, list + ".") == 0 &&
         edit.path.find('.', list.size() + 1) == std::string::npos;
}

/// Index of the rename that gave an item its name; the number of edits: there is none.
std::size_t earlierRename(const std::vector<scenario::Edit>& edits, const RenamedItem& item) {
  for (std::size_t i = edits.size(); i-- > 0;) {
    if (removesItem(edits[i], item.list)) break;
    const std::optional<RenamedItem> earlier = renamedBy(edits[i]);
    if (earlier && earlier->path_now == item.path_before) return i;
    if (earlier ? earlier->path_before == item.path_now : edits[i].path == item.path_now)
      break;  // another item had the name
  }
  return edits.size();
}

/// Drops a rename with the references that it changed; later edits get the item's former name.
void dropRename(std::vector<scenario::Edit>& edits, std::size_t at) {
  const RenamedItem item = *renamedBy(edits[at]);
  const std::string former = item.path_before.substr(item.list.size() + 1);
  const RenamedItem back{item.list, item.now, former, item.path_now, item.path_before};
  std::size_t end = at + 1;
  while (end < edits.size() && isReference(edits[end], item)) ++end;
  edits.erase(edits.begin() + static_cast<std::ptrdiff_t>(at),
              edits.begin() + static_cast<std::ptrdiff_t>(end));
  for (std::size_t i = at; i < edits.size(); ++i) {
    if (removesItem(edits[i], item.list)) break;
    if (isReference(edits[i], item)) edits[i].value = former;
    edits[i].path = renamedPath({back}, edits[i].path);
  }
}

}  // namespace

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

std::vector<RenamedItem> renamedItems(const scenario::Scenario& before, const scenario::Scenario& now) {
  std::vector<RenamedItem> renamed;
  const auto compare = [&](const std::string& list, const auto& old_items, const auto& items) {
    if (old_items.size() != items.size()) return;
    const auto namesOf = [](const auto& some) {
      std::unordered_set<std::string_view> names;
      for (const auto& item : some) names.insert(item.name);
      return names;
    };
    const auto old_names = namesOf(old_items), names = namesOf(items);
    for (std::size_t i = 0; i < items.size(); ++i) {
      const std::string &old_name = old_items[i].name, &name = items[i].name;
      if (old_name == name || names.count(old_name) > 0 || old_names.count(name) > 0) continue;
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

std::vector<scenario::Edit> foldedEdits(const std::vector<scenario::Edit>& edits) {
  std::vector<scenario::Edit> folded;
  std::optional<RenamedItem> last;  // rename that was folded, with its references
  for (const scenario::Edit& edit : edits) {
    if (last && isReference(edit, *last) && std::find(folded.begin(), folded.end(), edit) != folded.end())
      continue;
    last.reset();
    const std::optional<RenamedItem> item = renamedBy(edit);
    const std::size_t at = item ? earlierRename(folded, *item) : folded.size();
    if (at == folded.size()) {
      folded.push_back(edit);
      continue;
    }
    const RenamedItem earlier = *renamedBy(folded[at]);
    for (std::size_t i = at + 1; i < folded.size(); ++i) {
      if (isReference(folded[i], earlier)) folded[i].value = edit.value;
      folded[i].path = renamedPath({*item}, folded[i].path);
    }
    folded[at].value = edit.value;
    last = item;
    if (earlier.path_before == item->path_now) dropRename(folded, at);
  }
  return folded;
}

std::vector<scenario::Edit> editsWithout(const std::vector<scenario::Edit>& edits, const std::string& path) {
  std::vector<scenario::Edit> kept = foldedEdits(edits);
  std::string without = path;  // with the name that the item has at the edit
  const auto isWithin = [&](const std::string& edited) {
    return edited.compare(0, without.size(), without) == 0 &&
           (edited.size() == without.size() || edited[without.size()] == '.');
  };
  for (std::size_t i = kept.size(); i-- > 0;) {
    const std::optional<RenamedItem> item = renamedBy(kept[i]);
    if (item && without == item->path_now) without = item->path_before;
    if (!isWithin(kept[i].path)) continue;
    if (item) {
      dropRename(kept, i);
    } else {
      kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return kept;
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

}  // namespace emscape::playback
