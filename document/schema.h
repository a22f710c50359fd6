/// Tables of document formats: every key with its type, unit, range, default and meaning. The checks, their
/// messages and the JSON Schema are derived from the table.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace emscape::document {

struct ObjectSpec;

enum class ValueType { number, integer, boolean, text, choice, timestamp, file, object, list };

/// Type and limits of a value.
struct ValueSpec {
  ValueType type = ValueType::text;
  std::string unit;                                           ///< number
  double minimum = -std::numeric_limits<double>::infinity();  ///< number, integer
  double maximum = std::numeric_limits<double>::infinity();
  bool minimum_excluded = false;
  std::vector<std::string> choices;       ///< choice; number, integer: words that are allowed instead
  const ObjectSpec* object = nullptr;     ///< object; number, file: keys that are allowed instead
  std::shared_ptr<const ValueSpec> item;  ///< list
  int min_items = 0;                      ///< list; text, file: characters
  int max_items = 0;
  bool is_printable = false;  ///< text: without control characters (tabs, line ends) and noncharacters
  bool items_differ = false;  ///< list: no two items are equal; objects have different names

  ValueSpec from(double lowest) const;  ///< with this minimum
  ValueSpec above(double bound) const;  ///< with this minimum, excluded
  ValueSpec to(double highest) const;   ///< with this maximum
  ValueSpec distinct() const;           ///< with items_differ
  ValueSpec printable() const;          ///< with is_printable
  /// A number, or this word instead.
  ValueSpec orWord(std::string word) const;
  /// A number or file, or these keys instead. Keeps a pointer to `fields`, which must outlive the table.
  ValueSpec orObject(const ObjectSpec& fields) const;
};

/// Default of a key: none, a number, a text (choice, text) or a list of texts.
using DefaultValue = std::variant<std::monostate, double, std::string, std::vector<std::string>>;

/// One key of an object.
struct KeySpec {
  std::string name;
  ValueSpec value;
  bool required = false;
  DefaultValue default_value;
  std::string description;
  std::vector<std::string>
      only_for;  ///< values of the object's discriminator to which this row applies; empty: all
};

/// A set of keys.
struct ObjectSpec {
  std::string name;           ///< in messages and in the JSON Schema's definitions
  std::string discriminator;  ///< key whose value selects the variant; empty: none
  std::vector<KeySpec> keys;
  std::vector<std::vector<std::string>> exactly_one_of = {};  ///< groups of which one key must be given
  std::vector<std::pair<std::string, std::string>> goes_with =
      {};  ///< the first key is allowed only with the second
  std::vector<std::pair<std::string, std::string>> elsewhere =
      {};  ///< keys that are looked for here, and where they are

  /// The row of a key, or null. @param variant  the discriminator's value; null: any
  const KeySpec* find(const std::string& key, const std::string* variant) const;
};

/// Functions that build a table.
namespace spec {

ValueSpec number(const std::string& unit = "");
ValueSpec simple(ValueType type);
/// @param type  text or file, of 1 to max_characters characters
ValueSpec textOf(ValueType type, int max_characters);
ValueSpec choice(std::vector<std::string> choices);
/// Keeps a pointer to `fields`, which must outlive the table.
ValueSpec object(const ObjectSpec& fields);
ValueSpec listOf(const ValueSpec& item, int min_items, int max_items);

using Variants = std::vector<std::string>;
KeySpec required(std::string name, ValueSpec value, std::string description, Variants only_for = {});
KeySpec optional(std::string name, ValueSpec value, std::string description, Variants only_for = {});
KeySpec byDefault(std::string name, ValueSpec value, DefaultValue default_value, std::string description,
                  Variants only_for = {});

}  // namespace spec

/// Unit of a value, or of the values in a list.
const std::string& unitOf(const ValueSpec& value);

/// Name of a key without its unit's suffix: power for power_w (W).
std::string stemOf(const KeySpec& key);

/// The JSON Schema (draft 2020-12) of a format.
std::string jsonSchema(const ObjectSpec& root, const std::string& title, const std::string& description);

}  // namespace emscape::document
