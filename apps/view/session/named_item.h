/// Items of a scenario by their names.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "emscape/base/error.h"

namespace emscape::view {

/// Index of the item with a name. @param kind  of the items, for the message
/// @throws Error (bad_input) that lists the names of the scenario's items
template <class Item>
std::size_t indexOfNamed(const std::vector<Item>& items, const std::string& name, const char* kind) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  if (found != items.end()) return static_cast<std::size_t>(found - items.begin());
  std::string known;
  for (const Item& item : items) known += (known.empty() ? "'" : ", '") + item.name + "'";
  throw Error(ErrorCode::bad_input,
              fmt::format("there is no {} '{}'; the scenario has {}", kind, name, known));
}

}  // namespace emscape::view
