#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "document/schema.h"

namespace emscape::document {

namespace {

using Json = nlohmann::ordered_json;

/// A bound, without a decimal point if it is a whole number.
Json number(double value) {
  return value == std::floor(value) && std::abs(value) < 1e15 ? Json(static_cast<long long>(value))
                                                              : Json(value);
}

class SchemaWriter {
 public:
  Json write(const ObjectSpec& root, const std::string& title, const std::string& description) {
    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"title", title},
                   {"description", description}};
    schema.update(object(root));
    schema["$defs"] = definitions_;
    return schema;
  }

 private:
  Json valueOf(const ValueSpec& spec) {
    switch (spec.type) {
      case ValueType::number:
      case ValueType::integer:
        return numeric(spec);
      case ValueType::boolean:
        return {{"type", "boolean"}};
      case ValueType::text:
      case ValueType::file:
        return orObject({{"type", "string"}, {"minLength", spec.min_items}, {"maxLength", spec.max_items}},
                        spec);
      case ValueType::timestamp:
        return {{"type", "string"},
                {"format", "date-time"},
                {"pattern", R"(^\d{4}-\d{2}-\d{2}[T ]\d{2}:\d{2}:\d{2}(\.\d+)?(Z|[+-]\d{2}(:?\d{2})?)$)"}};
      case ValueType::choice:
        return {{"enum", spec.choices}};
      case ValueType::object:
        return reference(*spec.object);
      case ValueType::list:
        break;
    }
    Json list = {{"type", "array"},
                 {"items", valueOf(*spec.item)},
                 {"minItems", spec.min_items},
                 {"maxItems", spec.max_items}};
    if (spec.items_differ) list["uniqueItems"] = true;
    return list;
  }

  Json numeric(const ValueSpec& spec) {
    Json json = {{"type", spec.type == ValueType::integer ? "integer" : "number"}};
    if (std::isfinite(spec.minimum))
      json[spec.minimum_excluded ? "exclusiveMinimum" : "minimum"] = number(spec.minimum);
    if (std::isfinite(spec.maximum)) json["maximum"] = number(spec.maximum);
    if (!spec.unit.empty()) json["x-unit"] = spec.unit;
    return orObject(json, spec);
  }

  /// A value, or what is allowed instead.
  Json orObject(const Json& json, const ValueSpec& spec) {
    Json others = Json::array();
    if (!spec.choices.empty()) others.push_back({{"enum", spec.choices}});
    if (spec.object != nullptr) others.push_back(reference(*spec.object));
    if (others.empty()) return json;
    others.insert(others.begin(), json);
    return {{"anyOf", others}};
  }

  Json key(const KeySpec& row) {
    Json json = valueOf(row.value);
    if (!row.description.empty()) json["description"] = row.description;
    if (const double* value = std::get_if<double>(&row.default_value)) json["default"] = number(*value);
    if (const auto* text = std::get_if<std::string>(&row.default_value)) {
      json["default"] = row.value.type == ValueType::boolean ? Json(*text == "true") : Json(*text);
    }
    if (const auto* texts = std::get_if<std::vector<std::string>>(&row.default_value))
      json["default"] = *texts;
    return json;
  }

  Json reference(const ObjectSpec& spec) {
    std::string name = spec.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    if (!definitions_.contains(name)) {
      definitions_[name] = nullptr;  // keeps the order of first use
      Json definition = object(spec);
      definitions_[name] = std::move(definition);
    }
    return {{"$ref", "#/$defs/" + name}};
  }

  Json object(const ObjectSpec& spec) {
    if (spec.discriminator.empty()) return variant(spec, nullptr);
    // if-then instead of oneOf, so that validators report the faulty key.
    const KeySpec& discriminator = *spec.find(spec.discriminator, nullptr);
    Json variants = Json::array();
    for (const std::string& choice : discriminator.value.choices) {
      const Json condition = {{"required", Json::array({discriminator.name})},
                              {"properties", {{discriminator.name, {{"const", choice}}}}}};
      variants.push_back({{"if", condition}, {"then", variant(spec, &choice)}});
    }
    return {{"type", "object"},
            {"required", Json::array({discriminator.name})},
            {"properties", {{discriminator.name, key(discriminator)}}},
            {"allOf", std::move(variants)}};
  }

  /// @param choice  the discriminator's value; null for an object without one
  Json variant(const ObjectSpec& spec, const std::string* choice) {
    Json json = {{"type", "object"}, {"additionalProperties", false}};
    Json properties = Json::object(), required = Json::array();
    for (const KeySpec& row : spec.keys) {
      if (spec.find(row.name, choice) != &row) continue;
      properties[row.name] = key(row);
      if (row.required) required.push_back(row.name);
    }
    json["properties"] = std::move(properties);
    if (!required.empty()) json["required"] = std::move(required);
    for (const auto& group : spec.exactly_one_of) {
      Json alternatives = Json::array();
      for (const std::string& name : group) alternatives.push_back({{"required", Json::array({name})}});
      json["oneOf"] = std::move(alternatives);
    }
    for (const auto& [name, companion] : spec.goes_with)
      json["dependentRequired"][name] = Json::array({companion});
    return json;
  }

  Json definitions_ = Json::object();
};

}  // namespace

std::string jsonSchema(const ObjectSpec& root, const std::string& title, const std::string& description) {
  return SchemaWriter().write(root, title, description).dump(2) + "\n";
}

}  // namespace emscape::document
