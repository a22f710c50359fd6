#include "scenario/file/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "document/edit_path.h"
#include "document/text_edit.h"
#include "propagation/registry/model_info.h"
#include "scenario/file/parameter_words.h"
#include "scenario/file/schema.h"
#include "scenario/file/source.h"

namespace emscape::scenario {
namespace {

using document::DocumentNode;
using document::DocumentNodePtr;
using document::NodeKind;
using document::ResolvedPath;
using document::ValueType;

/// A common value for a key that a choice requires and that has no default.
constexpr std::array<std::pair<const char*, const char*>, 21> kCommonValues{{
    {"beamwidth_az_deg", "10"},
    {"beamwidth_el_deg", "10"},
    {"gain_dbi", "25"},
    {"columns", "16"},
    {"rows", "16"},
    {"rate_rpm", "10"},
    {"width_deg", "60"},
    {"rate_deg_s", "20"},
    {"elevation_step_deg", "5"},
    {"bars", "3"},
    {"dwells", "[{azimuth_deg: 0, elevation_deg: 0, duration_s: 1}]"},
    {"receiver", "{noise_figure_db: 4, bandwidth_hz: 1.0e6}"},
    {"duct_height_m", "14"},
    {"gradient_m_per_km", "118"},
    {"base_m", "200"},
    {"top_m", "300"},
    {"deficit_m_units", "40"},
    {"air_temperature_k", "288.15"},
    {"sea_temperature_k", "288.15"},
    {"relative_humidity_percent", "80"},
    {"wind_m_s", "5"},
}};

const DocumentNodePtr& rootOf(const Scenario& scenario) {
  if (!scenario.source || !scenario.source->root) {
    throw Error(ErrorCode::bad_input, "the scenario was not read from a file: its values cannot be edited");
  }
  return scenario.source->root;
}

const DocumentNode* childOf(const DocumentNode* node, const std::string& key) {
  if (node == nullptr) return nullptr;
  for (const document::MapEntry& entry : node->entries) {
    if (entry.key == key && entry.value->kind != NodeKind::null) return entry.value.get();
  }
  return nullptr;
}

/// The choice on which the other keys depend; empty if it is not given, or there is none.
std::string variantOf(const ObjectSpec& spec, const DocumentNode* node) {
  const DocumentNode* chosen = spec.discriminator.empty() ? nullptr : childOf(node, spec.discriminator);
  return chosen != nullptr ? chosen->text : std::string();
}

bool isIn(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

/// True if the chosen model reads the settings of a model; false if it is not the name of a model.
bool enters(const propagation::ModelInfo& settings_of, const std::string& chosen_name) {
  const propagation::ModelInfo* const chosen = propagation::modelNamed(chosen_name);
  return chosen != nullptr && propagation::settingsEnter(settings_of, *chosen);
}

std::string textOf(const document::DefaultValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.10g}", *number);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
    return fmt::format("[{}]", fmt::join(*texts, ", "));
  }
  return "";
}

Parameter::Type typeOf(const document::ValueSpec& spec) {
  const bool is_numeric = spec.type == ValueType::number || spec.type == ValueType::integer;
  if (is_numeric && !spec.choices.empty()) return Parameter::Type::text;
  switch (spec.type) {
    case ValueType::number:
      return Parameter::Type::number;
    case ValueType::integer:
      return Parameter::Type::integer;
    case ValueType::boolean:
      return Parameter::Type::boolean;
    case ValueType::choice:
      return Parameter::Type::choice;
    case ValueType::list:
      return Parameter::Type::list;
    default:
      return Parameter::Type::text;
  }
}

class GroupBuilder {
 public:
  explicit GroupBuilder(const Scenario& scenario) : scenario_(scenario) {}

  ParameterGroup build(const std::string& name, const std::string& path, const ObjectSpec& spec,
                       const DocumentNode* node) const {
    const bool is_of_model = propagation::modelNamed(name) != nullptr;
    ParameterGroup group{name, (is_of_model ? "settings of " : "") + wordsOf(name, name).name, path, {}, {}};
    const std::string variant = variantOf(spec, node);
    for (const KeySpec& row : spec.keys) {
      if (!applies(spec, row, node, variant)) continue;
      const DocumentNode* child = childOf(node, row.name);
      const std::string child_path = path.empty() ? row.name : path + "." + row.name;
      if (row.value.type == ValueType::object) {
        group.groups.push_back(build(row.name, child_path, *row.value.object, child));
      } else {
        group.parameters.push_back(parameter(spec, row, child_path, child));
      }
    }
    return group;
  }

 private:
  static bool applies(const ObjectSpec& spec, const KeySpec& row, const DocumentNode* node,
                      const std::string& variant) {
    if (!spec.discriminator.empty() && variant.empty()) return row.name == spec.discriminator;
    if (!row.only_for.empty() && !isIn(row.only_for, variant)) return false;
    // A default of an absent object that has no defaults for all of its keys.
    const bool has_default = !std::holds_alternative<std::monostate>(row.default_value);
    const auto isRequired = [](const KeySpec& key) { return key.required; };
    if (node == nullptr && has_default && spec.discriminator.empty() &&
        std::any_of(spec.keys.begin(), spec.keys.end(), isRequired))
      return false;
    const bool is_given = childOf(node, row.name) != nullptr;
    for (const auto& group : spec.exactly_one_of) {
      if (isIn(group, row.name) && !is_given) return false;
    }
    for (const auto& [key, beside] : spec.goes_with) {
      if (row.name == key && childOf(node, beside) == nullptr) return false;
    }
    const propagation::ModelInfo* const settings_of = propagation::modelNamed(row.name);
    if (spec.find("propagation", nullptr) == nullptr || settings_of == nullptr) return true;
    const DocumentNode* model = childOf(node, "propagation");
    return enters(*settings_of, model != nullptr ? model->text : toString(Emitter{}.propagation.model));
  }

  Parameter parameter(const ObjectSpec& spec, const KeySpec& row, const std::string& path,
                      const DocumentNode* node) const {
    Parameter result;
    result.path = path;
    result.key = row.name;
    const KeyWords words = wordsOf(row.name, document::stemOf(row));
    result.name = words.name;
    result.is_expert = words.is_expert;
    result.unit = document::unitOf(row.value);
    result.description = row.description;
    result.type = typeOf(row.value);
    result.minimum = row.value.minimum;
    result.minimum_excluded = row.value.minimum_excluded;
    result.maximum = row.value.maximum;
    result.choices = row.value.type == ValueType::list ? row.value.item->choices : row.value.choices;
    result.required = row.required;
    result.is_given = node != nullptr;
    result.default_value = textOf(row.default_value);
    if (node == nullptr) {
      result.value = result.default_value;
    } else {
      result.value = node->kind == NodeKind::scalar ? node->text : document::flowText(*node, /*json=*/false);
      // Keys instead of a number.
      if (node->kind == NodeKind::map) result.type = Parameter::Type::text;
    }
    if (row.name == "platform" || row.name == "victim") offerNames(scenario_.platforms, result);
    if (spec.name == "output" && row.name == "receiver") offerNames(scenario_.receivers, result);
    if (row.name == "wanted_emitter") offerNames(scenario_.emitters, result);
    if (result.titles.empty()) {
      for (const std::string& choice : result.choices) result.titles.push_back(titleOf(row.name, choice));
    }
    return result;
  }

  template <class Items>
  static void offerNames(const Items& items, Parameter& parameter) {
    parameter.type = Parameter::Type::choice;
    for (const auto& item : items) parameter.choices.push_back(item.name);
    parameter.titles = parameter.choices;
  }

  const Scenario& scenario_;
};

std::string commonValueOf(const std::string& key, const std::string& choice) {
  for (const auto& [name, value] : kCommonValues) {
    if (name == key) return value;
  }
  throw Error(ErrorCode::bad_input,
              fmt::format("'{}' needs '{}', which has no common value: set all of it in one edit, such as "
                          "antenna={{pattern: file, file: NAME}}",
                          choice, key));
}

}  // namespace

ParameterGroup parametersOf(const Scenario& scenario, const std::string& path) {
  const DocumentNodePtr& root = rootOf(scenario);
  const ResolvedPath found = document::resolvePath(path, root, scenarioSpec());
  if (!found.missing.empty()) throw Error(ErrorCode::bad_input, found.missing);
  if (found.spec->type != ValueType::object) {
    throw Error(ErrorCode::bad_input, fmt::format("{} is not a set of keys", found.name));
  }
  const DocumentNodePtr node = document::valueAt(root, found.steps);
  const auto* key = std::get_if<std::string>(&found.steps.back());
  const DocumentNode* name = key == nullptr ? childOf(node.get(), "name") : nullptr;
  return GroupBuilder(scenario).build(name != nullptr  ? name->text
                                      : key != nullptr ? *key
                                                       : path,
                                      path, *found.spec->object, node.get());
}

std::vector<Edit> editsForChoice(const Scenario& scenario, const std::string& path,
                                 const std::string& choice) {
  std::vector<Edit> edits{{path, choice}};
  const DocumentNodePtr& root = rootOf(scenario);
  const ResolvedPath found = document::resolvePath(path, root, scenarioSpec());
  const std::size_t end = path.rfind('.');
  if (end == std::string::npos) return edits;
  const std::string parent_path = path.substr(0, end), key = path.substr(end + 1);
  const ResolvedPath parent = document::resolvePath(parent_path, root, scenarioSpec());
  const ObjectSpec* spec = parent.spec->object;
  if (spec == nullptr) return edits;
  const DocumentNodePtr node = document::valueAt(root, parent.steps);
  if (key == "propagation") {
    for (const propagation::ModelInfo& model : propagation::models()) {
      if (!enters(model, choice) && childOf(node.get(), model.name) != nullptr)
        edits.push_back({parent_path + "." + model.name, "null"});
    }
  }
  if (key != spec->discriminator) return edits;
  for (const KeySpec& row : spec->keys) {
    const bool is_given = childOf(node.get(), row.name) != nullptr;
    const KeySpec* applying = spec->find(row.name, &choice);
    if (is_given && applying == nullptr) {
      edits.push_back({parent_path + "." + row.name, "null"});
    } else if (!is_given && applying == &row && row.required && row.name != key) {
      edits.push_back({parent_path + "." + row.name, commonValueOf(row.name, choice)});
    }
  }
  return edits;
}

}  // namespace emscape::scenario
