/// Items of a scenario by their names.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/error.h"

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
std::string quotedNames(const std::vector<Item>& items) {
  std::string names;
  for (const Item& item : items) names += (names.empty() ? "'" : ", '") + item.name + "'";
  return names.empty() ? "none" : names;
}

/// Index of the item with a name. @param kind  of the items, for the message
/// @throws Error (bad_input) that lists the names of the scenario's items
template <class Item>
std::size_t indexOfNamed(const std::vector<Item>& items, const std::string& name, const char* kind) {
  if (const auto index = findNamed(items, name)) return *index;
  throw Error(ErrorCode::bad_input,
              fmt::format("there is no {} '{}'; the scenario has {}", kind, name, quotedNames(items)));
}

}  // namespace emscape::scenario
