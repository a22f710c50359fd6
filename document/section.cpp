#include "document/section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "document/schema_check.h"

namespace emscape::document {

namespace {

constexpr double kFaulty = std::numeric_limits<double>::quiet_NaN();

double numberIn(const DocumentNode& node, const ValueSpec& spec) {
  if (node.kind != NodeKind::scalar || node.quoted) return kFaulty;
  const std::optional<double> value = numberOf(node.text);
  return value && rangeFault("", node.text, *value, spec).empty() ? *value : kFaulty;
}

std::vector<double> numbersIn(const DocumentNode& node, const ValueSpec& spec) {
  std::vector<double> numbers;
  for (const DocumentNodePtr& item : node.items) numbers.push_back(numberIn(*item, *spec.item));
  return numbers;
}

NodeKind kindOf(ValueType type) {
  if (type == ValueType::object) return NodeKind::map;
  return type == ValueType::list ? NodeKind::sequence : NodeKind::scalar;
}

}  // namespace

Section::Section(const std::string& file, const DocumentNode* node, const ObjectSpec& spec)
    : file_(&file), node_(node), spec_(&spec) {
  if (spec.discriminator.empty()) return;
  const std::string value = text(spec.discriminator);
  const std::vector<std::string>& choices = spec.find(spec.discriminator, nullptr)->value.choices;
  if (std::find(choices.begin(), choices.end(), value) != choices.end()) variant_ = value;
}

const KeySpec& Section::row(const std::string& key) const {
  const KeySpec* found = spec_->find(key, variant_.empty() ? nullptr : &variant_);
  if (found == nullptr) found = spec_->find(key, nullptr);  // a key of another variant: not given here
  if (found == nullptr) throw std::logic_error("the table has no key '" + key + "' in " + spec_->name);
  return *found;
}

const DocumentNode* Section::find(const std::string& key) const {
  const ValueSpec& value = row(key).value;
  const NodeKind kind = kindOf(value.type);
  if (node_ == nullptr) return nullptr;
  for (const MapEntry& entry : node_->entries) {
    if (entry.key != key) continue;
    const bool is_in_place = value.object != nullptr && entry.value->kind == NodeKind::map;
    return entry.value->kind == kind || is_in_place ? entry.value.get() : nullptr;
  }
  return nullptr;
}

bool Section::has(const std::string& key) const {
  return find(key) != nullptr;
}

bool Section::sound() const {
  ProblemList unheard;
  return node_ != nullptr && checkObject(*file_, *node_, *spec_, unheard);
}

double Section::number(const std::string& key) const {
  if (const DocumentNode* node = find(key)) return numberIn(*node, row(key).value);
  const double* fallback = std::get_if<double>(&row(key).default_value);
  return fallback != nullptr ? *fallback : kFaulty;
}

std::optional<double> Section::optionalNumber(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return number(key);
}

int Section::integer(const std::string& key) const {
  const double value = number(key);
  return std::isnan(value) ? 0 : static_cast<int>(value);
}

std::optional<bool> Section::optionalBoolean(const std::string& key) const {
  const DocumentNode* node = find(key);
  return node == nullptr || node->quoted ? std::nullopt : booleanOf(node->text);
}

std::string Section::text(const std::string& key) const {
  if (const DocumentNode* node = find(key)) return node->text;
  const std::string* fallback = std::get_if<std::string>(&row(key).default_value);
  return fallback != nullptr ? *fallback : "";
}

int Section::choiceIndex(const std::string& key) const {
  const std::vector<std::string>& choices = row(key).value.choices;
  const auto found = std::find(choices.begin(), choices.end(), text(key));
  return found == choices.end() ? 0 : static_cast<int>(found - choices.begin());
}

Section Section::section(const std::string& key) const {
  const DocumentNode* node = find(key);
  return Section(*file_, node != nullptr && node->kind == NodeKind::map ? node : nullptr,
                 *row(key).value.object);
}

std::vector<Section> Section::sections(const std::string& key) const {
  std::vector<Section> all;
  const DocumentNode* list = find(key);
  if (list == nullptr) return all;
  for (const DocumentNodePtr& item : list->items)
    all.emplace_back(*file_, item.get(), *row(key).value.item->object);
  return all;
}

std::vector<double> Section::numbers(const std::string& key) const {
  const DocumentNode* list = find(key);
  return list == nullptr ? std::vector<double>{} : numbersIn(*list, row(key).value);
}

std::vector<std::string> Section::texts(const std::string& key) const {
  std::vector<std::string> all;
  if (const DocumentNode* list = find(key)) {
    for (const DocumentNodePtr& item : list->items) all.push_back(item->text);
  } else if (const auto* fallback = std::get_if<std::vector<std::string>>(&row(key).default_value)) {
    all = *fallback;
  }
  return all;
}

std::vector<std::vector<double>> Section::numberLists(const std::string& key) const {
  std::vector<std::vector<double>> all;
  const DocumentNode* list = find(key);
  if (list == nullptr) return all;
  for (const DocumentNodePtr& item : list->items) all.push_back(numbersIn(*item, *row(key).value.item));
  return all;
}

SourceLocation Section::location() const {
  return locationAt(node_ == nullptr ? TextPosition{} : node_->position);
}

SourceLocation Section::locationOf(const std::string& key) const {
  const DocumentNode* node = find(key);
  return node == nullptr ? location() : locationAt(node->position);
}

SourceLocation Section::locationOf(const std::string& key, std::size_t item) const {
  const DocumentNode* list = find(key);
  return list == nullptr || item >= list->items.size() ? locationOf(key)
                                                       : locationAt(list->items[item]->position);
}

}  // namespace emscape::document
