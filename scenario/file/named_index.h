/// Items of a scenario that options name.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "emscape/base/error.h"
#include "scenario/model/named_items.h"

namespace emscape::scenario {

/// Index of a named item. @param option, kind, file  for the message: of the name, the items, the scenario
/// @throws Error (usage) that lists the existing names
template <class Item>
int namedIndex(const std::vector<Item>& items, const std::string& name, const std::string& option,
               const char* kind, const std::string& file) {
  if (const auto index = findNamed(items, name)) return static_cast<int>(*index);
  if (name.empty())
    throw Error(ErrorCode::usage,
                items.empty()
                    ? fmt::format("{} is required, but {} has no {}", option, file, kind)
                    : fmt::format("{} is required: of {}, one of {}", option, file, quotedNames(items)));
  throw Error(ErrorCode::usage,
              fmt::format("{}: no {} '{}' in {}; it has {}", option, kind, name, file, quotedNames(items)));
}

/// Indices of the named items, each once; all items if no values are given.
/// @param values  of as on the command line: one that is a name is that name, any other one a list with
/// commas
/// @throws Error (usage) that lists the existing names
template <class Item>
std::vector<int> namedIndices(const std::vector<Item>& items, const std::vector<std::string>& values,
                              const std::string& option, const char* kind, const std::string& file) {
  std::vector<int> indices;
  const auto add = [&](const std::string& name) {
    const int index = namedIndex(items, name, option, kind, file);
    if (std::find(indices.begin(), indices.end(), index) == indices.end()) indices.push_back(index);
  };
  for (std::size_t i = 0; values.empty() && i < items.size(); ++i) indices.push_back(static_cast<int>(i));
  for (const std::string& value : values) {
    const bool is_name =
        std::any_of(items.begin(), items.end(), [&](const Item& item) { return item.name == value; });
    std::istringstream list(value);
    if (is_name) {
      add(value);
    } else {
      for (std::string name; std::getline(list, name, ',');) add(name);
    }
  }
  return indices;
}

}  // namespace emscape::scenario
