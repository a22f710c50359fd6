#include "apps/view/values/edit_text.h"

#include <fmt/format.h>

#include "apps/view/values/position_text.h"
#include "base/text/quantity_text.h"
#include "emscape/base/error.h"
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

std::string withUnit(const Parameter& parameter, const std::string& value) {
  constexpr int kDigits = 7;
  char* rest = nullptr;
  const double number = std::strtod(value.c_str(), &rest);
  const bool is_number = parameter.type == Parameter::Type::number && !value.empty() && *rest == '\0';
  return is_number ? withDegreeSigns(quantityText(number, parameter.unit, kDigits)) : value;
}

}  // namespace

std::string editText(const scenario::Scenario& scenario, const scenario::Edit& edit) {
  const std::string& path = edit.path;
  std::size_t end = stepEnd(path, 0);
  const std::string list = path.substr(0, end);
  const bool is_named = (list == "emitters" || list == "platforms") && end < path.size();
  if (is_named) end = stepEnd(path, end + 1);
  try {
    const ParameterGroup group = scenario::parametersOf(scenario, path.substr(0, end));
    const Parameter* const parameter = parameterAt(group, path);
    if (parameter == nullptr) return toString(edit);
    const std::string name = (is_named ? group.name : group.title) + ", " + parameter->name;
    if (edit.value == "null") return name + ": by default";
    const std::string before = withUnit(*parameter, parameter->value),
                      after = withUnit(*parameter, edit.value);
    return before.empty() || before == after ? fmt::format("{}: {}", name, after)
                                             : fmt::format("{}: {} → {}", name, before, after);
  } catch (const Error&) {
    return toString(edit);  // of an item that the scenario does not have
  }
}

}  // namespace emscape::view
