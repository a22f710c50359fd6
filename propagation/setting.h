/// A setting of a propagation model with its name in files. The scenario schema, its validation and the
/// comparison of two scenarios are derived from these rows.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "emscape/propagation/settings.h"

namespace emscape::propagation {

struct Setting {
  std::string key;
  std::string description;           ///< one line
  std::vector<std::string> choices;  ///< names of an enumeration's values, in its order; empty: a number
  std::string unit;                  ///< of a number
  double min = 0, max = 0;           ///< of a number, both allowed
  bool has_auto = false;             ///< a number may be `auto` in files, which is 0 here
  bool is_whole = false;             ///< only whole numbers are allowed
  /// The number, or the index of the choice.
  double (*get)(const ModelSettings&) = nullptr;
  void (*set)(ModelSettings&, double value) = nullptr;
};

/// @tparam group   member of ModelSettings: &ModelSettings::itm
/// @tparam member  of the group: &ItmSettings::form
template <auto group, auto member>
Setting settingRow(std::string key, std::string description) {
  Setting setting;
  setting.key = std::move(key);
  setting.description = std::move(description);
  setting.get = [](const ModelSettings& all) { return static_cast<double>((all.*group).*member); };
  setting.set = [](ModelSettings& all, double value) {
    auto& target = (all.*group).*member;
    using Value = std::decay_t<decltype(target)>;
    if constexpr (std::is_enum_v<Value>) {
      target = static_cast<Value>(static_cast<int>(value));
    } else {
      target = value;
    }
  };
  return setting;
}

template <auto group, auto member>
Setting numberSetting(std::string key, std::string unit, double min, double max, std::string description) {
  Setting setting = settingRow<group, member>(std::move(key), std::move(description));
  setting.unit = std::move(unit);
  setting.min = min;
  setting.max = max;
  return setting;
}

/// A number that the model chooses by default.
/// @param min  > 0
template <auto group, auto member>
Setting automaticSetting(std::string key, std::string unit, double min, double max, std::string description) {
  Setting setting =
      numberSetting<group, member>(std::move(key), std::move(unit), min, max, std::move(description));
  setting.has_auto = true;
  return setting;
}

/// One of the names of the member's enumeration.
template <auto group, auto member>
Setting choiceSetting(std::string key, std::string description) {
  Setting setting = settingRow<group, member>(std::move(key), std::move(description));
  const auto names = namesOf(std::decay_t<decltype(ModelSettings().*group.*member)>());
  setting.choices.assign(names.begin(), names.end());
  return setting;
}

}  // namespace emscape::propagation
