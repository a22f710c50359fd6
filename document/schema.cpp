#include "document/schema.h"

#include <algorithm>
#include <cctype>

namespace emscape::document {

namespace spec {

ValueSpec number(const std::string& unit) {
  ValueSpec spec;
  spec.type = ValueType::number;
  spec.unit = unit;
  return spec;
}

ValueSpec simple(ValueType type) {
  ValueSpec spec;
  spec.type = type;
  return spec;
}

ValueSpec textOf(ValueType type, int max_characters) {
  ValueSpec spec = simple(type);
  spec.min_items = 1;
  spec.max_items = max_characters;
  return spec;
}

ValueSpec choice(std::vector<std::string> choices) {
  ValueSpec spec = simple(ValueType::choice);
  spec.choices = std::move(choices);
  return spec;
}

ValueSpec object(const ObjectSpec& fields) {
  ValueSpec spec = simple(ValueType::object);
  spec.object = &fields;
  return spec;
}

ValueSpec listOf(const ValueSpec& item, int min_items, int max_items) {
  ValueSpec spec = simple(ValueType::list);
  spec.item = std::make_shared<ValueSpec>(item);
  spec.min_items = min_items;
  spec.max_items = max_items;
  return spec;
}

KeySpec required(std::string name, ValueSpec value, std::string description, Variants only_for) {
  return {std::move(name), std::move(value), true, {}, std::move(description), std::move(only_for)};
}

KeySpec optional(std::string name, ValueSpec value, std::string description, Variants only_for) {
  return {std::move(name), std::move(value), false, {}, std::move(description), std::move(only_for)};
}

KeySpec byDefault(std::string name, ValueSpec value, DefaultValue default_value, std::string description,
                  Variants only_for) {
  return {std::move(name),          std::move(value),       false,
          std::move(default_value), std::move(description), std::move(only_for)};
}

}  // namespace spec

ValueSpec ValueSpec::from(double lowest) const {
  ValueSpec spec = *this;
  spec.minimum = lowest;
  return spec;
}

ValueSpec ValueSpec::above(double bound) const {
  ValueSpec spec = from(bound);
  spec.minimum_excluded = true;
  return spec;
}

ValueSpec ValueSpec::to(double highest) const {
  ValueSpec spec = *this;
  spec.maximum = highest;
  return spec;
}

ValueSpec ValueSpec::distinct() const {
  ValueSpec spec = *this;
  spec.items_differ = true;
  return spec;
}

ValueSpec ValueSpec::printable() const {
  ValueSpec spec = *this;
  spec.is_printable = true;
  return spec;
}

ValueSpec ValueSpec::orWord(std::string word) const {
  ValueSpec spec = *this;
  spec.choices.push_back(std::move(word));
  return spec;
}

ValueSpec ValueSpec::orObject(const ObjectSpec& fields) const {
  ValueSpec spec = *this;
  spec.object = &fields;
  return spec;
}

const KeySpec* ObjectSpec::find(const std::string& key, const std::string* variant) const {
  for (const KeySpec& row : keys) {
    const bool applies = row.only_for.empty() || variant == nullptr ||
                         std::find(row.only_for.begin(), row.only_for.end(), *variant) != row.only_for.end();
    if (row.name == key && applies) return &row;
  }
  return nullptr;
}

const std::string& unitOf(const ValueSpec& value) {
  return value.item ? unitOf(*value.item) : value.unit;
}

std::string stemOf(const KeySpec& key) {
  const auto letters = [](const std::string& text) {
    std::string kept;
    for (const char c : text) {
      if (c != '_' && c != '/' && c != '-' && c != ' ')
        kept += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return kept;
  };
  const std::string unit = letters(unitOf(key.value));
  for (std::size_t bar = key.name.find('_'); !unit.empty() && bar != std::string::npos;
       bar = key.name.find('_', bar + 1)) {
    if (letters(key.name.substr(bar)) == unit) return key.name.substr(0, bar);
  }
  return key.name;
}

}  // namespace emscape::document
