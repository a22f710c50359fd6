/// Random edits of scenarios, made from the table of the format.
#pragma once

#include <algorithm>
#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "document/document.h"
#include "document/schema.h"

namespace emscape::scenario {

using document::DocumentNode;
using document::KeySpec;
using document::ObjectSpec;
using document::ValueSpec;
using document::ValueType;

/// Makes random values, most of them sound, and paths.
class RandomEdits {
 public:
  explicit RandomEdits(unsigned seed) : random_(seed) {}

  std::string valueFor(const ValueSpec& spec) {
    switch (spec.type) {
      case ValueType::number:
        return numberText(std::uniform_real_distribution<double>(std::max(spec.minimum, -1e6),
                                                                 std::min(spec.maximum, 1e6))(random_));
      case ValueType::integer:
        return std::to_string(std::uniform_int_distribution<int>(
            static_cast<int>(spec.minimum), static_cast<int>(std::min(spec.maximum, 64.0)))(random_));
      case ValueType::boolean:
        return below(2) == 0 ? "true" : "false";
      case ValueType::choice:
        return spec.choices[below(spec.choices.size())];
      case ValueType::timestamp:
        return "2027-01-01T00:00:00Z";
      case ValueType::text:
      case ValueType::file:
        return std::vector<std::string>{
            "word", "two words", "\"12\"", "'a: b'", "\"tab\\t\"", "\xC3\xA9"}[below(6)];
      case ValueType::list: {
        std::string text;
        const int count =
            spec.min_items == spec.max_items ? spec.max_items : spec.min_items + static_cast<int>(below(2));
        for (int i = 0; i < count; ++i) text += (i == 0 ? "" : ", ") + valueFor(*spec.item);
        return "[" + text + "]";
      }
      case ValueType::object: {
        std::string text;
        for (const KeySpec& key : spec.object->keys) {
          if (!key.required || !key.only_for.empty()) continue;
          text += (text.empty() ? "" : ", ") + key.name + ": " + valueFor(key.value);
        }
        return "{" + text + "}";
      }
    }
    return "";
  }

  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }
  std::string junk() {
    static const std::string kPieces[] = {"emitters", ".",  "=",  "\"",  "name", "{",     "}",    "[",
                                          "]",        ": ", ", ", "&a ", "*a",   "!!x ",  "#",    "\n",
                                          "\t",       "|",  ">",  "0",   "-1",   "1e999", "null", "~",
                                          "\xC3\xA9", "'",  "\\", "- ",  "? ",   "%"};
    std::string text;
    for (std::size_t i = 1 + below(6); i > 0; --i) text += kPieces[below(std::size(kPieces))];
    return text;
  }

 private:
  static std::string numberText(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
  }
  std::mt19937 random_;
};

/// Calls visit(path, spec) for every key of the table that applies to a document, whether it is given or not.
inline void forEachPath(const DocumentNode* node, const ObjectSpec& spec, const std::string& prefix,
                        const std::function<void(const std::string&, const ValueSpec&)>& visit) {
  const auto child = [&](const std::string& key) -> const DocumentNode* {
    if (node == nullptr) return nullptr;
    for (const auto& entry : node->entries) {
      if (entry.key == key) return entry.value.get();
    }
    return nullptr;
  };
  const DocumentNode* discriminator = spec.discriminator.empty() ? nullptr : child(spec.discriminator);
  for (const KeySpec& key : spec.keys) {
    if (spec.find(key.name, discriminator == nullptr ? nullptr : &discriminator->text) != &key) continue;
    const std::string path = prefix + key.name;
    visit(path, key.value);
    const DocumentNode* value = child(key.name);
    if (key.value.type == ValueType::object) forEachPath(value, *key.value.object, path + ".", visit);
    if (key.value.type != ValueType::list || value == nullptr) continue;
    for (std::size_t i = 0; i < value->items.size(); ++i) {
      std::string step = std::to_string(i);
      for (const auto& entry : value->items[i]->entries) {
        if (entry.key == "name") step = entry.value->text;
      }
      if (key.value.item->type == ValueType::object) {
        forEachPath(value->items[i].get(), *key.value.item->object, path + "." + step + ".", visit);
      } else {
        visit(path + "." + step, *key.value.item);
      }
    }
  }
}

}  // namespace emscape::scenario
