#include "apps/view/values/edit_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/view/values/position_text.h"
#include "base/text/quantity_text.h"
#include "emscape/base/error.h"
#include "playback/editing/renamed_items.h"
#include "scenario/file/parameters.h"

namespace emscape::view {
namespace {

using scenario::Parameter;
using scenario::ParameterGroup;

const Parameter* parameterAt(const ParameterGroup& group, const std::string& path) {
  for (const Parameter& parameter : group.parameters) {
    if (parameter.path == path) return &parameter;
  }
  for (const ParameterGroup& inner : group.groups) {
    if (const Parameter* const found = parameterAt(inner, path)) return found;
  }
  return nullptr;
}

/// The end of the step of a path that begins at a position; a name with points stands in double quotes.
std::size_t stepEnd(const std::string& path, std::size_t begin) {
  const bool is_quoted = begin < path.size() && path[begin] == '"';
  const std::size_t from = is_quoted ? path.find('"', begin + 1) : begin;
  return std::min(path.size(), path.find('.', std::min(path.size(), from)));
}

/// A value as the panel shows it.
std::string shownValue(const Parameter& parameter, const std::string& value) {
  constexpr int kDigits = 7;
  char* rest = nullptr;
  const double number = std::strtod(value.c_str(), &rest);
  const bool is_number = parameter.type == Parameter::Type::number && !value.empty() && *rest == '\0';
  if (is_number) return withDegreeSigns(quantityText(number, parameter.unit, kDigits));
  const auto choice = std::find(parameter.choices.begin(), parameter.choices.end(), value);
  if (choice != parameter.choices.end())
    return parameter.titles[static_cast<std::size_t>(choice - parameter.choices.begin())];
  const auto quoted = nlohmann::json::parse(value, nullptr, false);
  return quoted.is_string() ? quoted.get<std::string>() : value;
}

std::string editText(const scenario::Scenario& original, const scenario::Edit& edit) {
  const std::string& path = edit.path;
  std::size_t end = stepEnd(path, 0);
  const std::string list = path.substr(0, end);
  const bool is_named =
      (list == "emitters" || list == "platforms" || list == "receivers" || list == "targets") &&
      end < path.size();
  const std::size_t name_begin = end + 1;
  if (is_named) end = stepEnd(path, name_begin);
  if (is_named && end == path.size()) {
    const std::string kind = list.substr(0, list.size() - 1);
    return fmt::format("{} {}: {}", kind, path.substr(name_begin),
                       edit.value == "null" ? "removed" : "added");
  }
  try {
    const ParameterGroup group = scenario::parametersOf(original, path.substr(0, end));
    const Parameter* const parameter = parameterAt(group, path);
    if (parameter == nullptr) return toString(edit);
    const std::string name = (is_named ? group.name : group.title) + ", " + parameter->name;
    const std::string before = shownValue(*parameter, parameter->value),
                      after = edit.value == "null" ? "by default" : shownValue(*parameter, edit.value);
    return before.empty() || before == after ? fmt::format("{}: {}", name, after)
                                             : fmt::format("{}: {} → {}", name, before, after);
  } catch (const Error&) {
    return toString(edit);  // of an item that was added
  }
}

}  // namespace

std::vector<std::string> editTexts(const scenario::Scenario& original,
                                   const std::vector<scenario::Edit>& edits) {
  std::vector<std::string> texts;
  std::vector<playback::RenamedItem> former;  // their names in the original
  for (const scenario::Edit& edit : edits) {
    texts.push_back(editText(original, {playback::renamedPath(former, edit.path), edit.value}));
    if (const auto item = playback::renamedBy(edit))
      former.push_back({item->list, item->now, item->before, item->path_now,
                        playback::renamedPath(former, item->path_before)});
  }
  return texts;
}

}  // namespace emscape::view
