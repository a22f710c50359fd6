/// Items of a scenario by their names.
#pragma once

#include <fmt/core.h>

#include <string>
#include <vector>

#include "emscape/base/error.h"
#include "scenario/file/named_items.h"

namespace emscape::view {

/// Index of the item with a name. @param kind  of the items, for the message
/// @throws Error (bad_input) that lists the names of the scenario's items
template <class Item>
std::size_t indexOfNamed(const std::vector<Item>& items, const std::string& name, const char* kind) {
  if (const auto index = scenario::findNamed(items, name)) return *index;
  throw Error(ErrorCode::bad_input,
              fmt::format("there is no {} '{}'; the scenario has {}", kind, name, scenario::namesOf(items)));
}

}  // namespace emscape::view
