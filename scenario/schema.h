/// The table of the scenario format: every key with its type, unit, range, default and meaning. The checks,
/// their messages and the JSON Schema all come from it.
#pragma once

#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace emscape::scenario {

struct ObjectSpec;

enum class ValueType { number, integer, text, choice, timestamp, file, object, list };

/// What a value may be.
struct ValueSpec {
  ValueType type = ValueType::text;
  std::string unit;                                           ///< number
  double minimum = -std::numeric_limits<double>::infinity();  ///< number, integer
  double maximum = std::numeric_limits<double>::infinity();
  bool minimum_excluded = false;
  std::vector<std::string> choices;       ///< choice
  const ObjectSpec* object = nullptr;     ///< object
  std::shared_ptr<const ValueSpec> item;  ///< list
  int fewest_items = 0;                   ///< list; text, file: characters
  int most_items = 0;
  bool items_differ = false;  ///< list: no two items are equal, nor are their names where they are objects

  ValueSpec from(double lowest) const;  ///< with this minimum
  ValueSpec above(double bound) const;  ///< with this minimum, itself excluded
  ValueSpec to(double highest) const;   ///< with this maximum
  ValueSpec distinct() const;           ///< with items_differ
};

/// One key of an object.
struct KeySpec {
  std::string name;
  ValueSpec value;
  bool required = false;
  nlohmann::json default_value;  ///< null: none
  std::string description;
  std::vector<std::string>
      only_for;  ///< values of the object's discriminator to which this row applies; empty: all
};

/// A set of keys.
struct ObjectSpec {
  std::string name;           ///< as messages and the JSON Schema's definitions call it
  std::string discriminator;  ///< key whose choice says which other keys apply; empty: none
  std::vector<KeySpec> keys;
  std::vector<std::vector<std::string>> exactly_one_of = {};        ///< groups of which one key must be given
  std::vector<std::pair<std::string, std::string>> goes_with = {};  ///< first only beside second

  /// The row of a key, or null. @param variant  the discriminator's value; null: any
  const KeySpec* find(const std::string& key, const std::string* variant) const;
};

/// Forms of antenna that a scenario can ask for, in the order of the table's choices.
enum class AntennaForm { isotropic, gaussian, sinc, cosecant2, phased_array, file, cuts };
const char* toString(AntennaForm form);

/// The whole file.
const ObjectSpec& scenarioSpec();
/// A row of a track file: the same table for its columns.
const ObjectSpec& trackRowSpec();

/// Unit of a value, or of the values in a list.
const std::string& unitOf(const ValueSpec& value);

/// Name of a key without its unit's suffix: power for power_w (W).
std::string stemOf(const KeySpec& key);

}  // namespace emscape::scenario
