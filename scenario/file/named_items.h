/// Items of a scenario by their names.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace emscape::scenario {

/// Index of the item with a name; none: there is no such item.
template <class Item>
std::optional<std::size_t> findNamed(const std::vector<Item>& items, const std::string& name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  if (found == items.end()) return std::nullopt;
  return static_cast<std::size_t>(found - items.begin());
}

/// The names in quotation marks, separated by commas; "none" if there are no items.
template <class Item>
std::string namesOf(const std::vector<Item>& items) {
  std::string names;
  for (const Item& item : items) names += (names.empty() ? "'" : ", '") + item.name + "'";
  return names.empty() ? "none" : names;
}

}  // namespace emscape::scenario
