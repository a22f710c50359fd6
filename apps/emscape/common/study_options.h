/// Options and look-ups shared by the what-if subcommands.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "apps/emscape/common/command.h"
#include "emscape/base/error.h"
#include "emscape/scenario/model/quantities.h"
#include "scenario/file/named_items.h"

namespace emscape::app {

/// Index of a named item of a scenario. @throws Error (usage) that lists the existing names
template <class Item>
int namedIndex(const std::vector<Item>& items, const std::string& name, const char* option, const char* kind,
               const std::string& file) {
  if (const auto index = scenario::findNamed(items, name)) return static_cast<int>(*index);
  throw Error(ErrorCode::usage, fmt::format("{}: no {} '{}' in {}; it has {}", option, kind, name, file,
                                            scenario::quotedNames(items)));
}

/// Indices of the named items, each once; all items if no values are given.
/// @param values  of addNamesOption(): a value that is a name is that name; any other one is a list
/// @throws Error (usage) that lists the existing names
template <class Item>
std::vector<int> namedIndices(const std::vector<Item>& items, const std::vector<std::string>& values,
                              const char* option, const char* kind, const std::string& file) {
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

/// Adds -o FILE.png|.svg|.csv|.json, which may be given several times.
void addStudyOutputs(CLI::App& command, std::vector<std::string>& files);

/// Contents of these files.
struct StudyOutputs {
  std::function<void(const std::string&file)> plot, csv;
  std::function<std::string()> json;
};
/// Writes each file in the format of its extension. @throws Error
void writeStudyOutputs(const std::vector<std::string>& files, const StudyOutputs& outputs);

/// Adds --threshold. @param threshold  NAN: not given
void addThresholdOption(CLI::App& command, double& threshold);
/// The threshold, or the default of the quantity.
/// @throws Error (usage) if there is neither, and for a probability outside 0..1
double thresholdOf(double threshold, scenario::Quantity quantity);

}  // namespace emscape::app
