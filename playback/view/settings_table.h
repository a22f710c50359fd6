/// The rows of viewSettings() while they are made.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "emscape/base/error.h"
#include "playback/view/view_settings.h"

namespace emscape::playback {

/// The table while it is made. Functions that begin with `with` complete the last setting.
class SettingsTable {
 public:
  static constexpr int kMaxText = 1 << 20;
  std::vector<ViewSetting> rows;

  /// A setting that is a member. @param member  returns it for a view: bool, number, text, list of texts, or
  /// an enumeration in the order of the choices
  template <class Member>
  SettingsTable& member(const char* key, const document::ValueSpec& of, Member member, const char* meaning) {
    using Value = std::decay_t<decltype(member(std::declval<ViewState&>()))>;
    if constexpr (std::is_enum_v<Value>) {
      return add(
          key, of, meaning,
          [member, names = of.choices](const ViewState& view) {
            return names[static_cast<std::size_t>(member(view))];
          },
          [member, names = of.choices](ViewState& view, const SettingValue& value) {
            const auto found = std::find(names.begin(), names.end(), std::get<std::string>(value));
            member(view) = static_cast<Value>(found - names.begin());
          });
    } else {
      return add(key, of, meaning, member, [member](ViewState& view, const SettingValue& value) {
        member(view) = std::get<Value>(value);
      });
    }
  }
  /// A member that has a text.
  template <class Member, class Parse, class Write>
  SettingsTable& parsed(const char* key, const document::ValueSpec& of, Member member, Parse parse,
                        Write write, const char* meaning) {
    return add(
        key, of, meaning, [member, write](const ViewState& view) { return write(member(view)); },
        [member, parse](ViewState& view, const SettingValue& value) {
          member(view) = parse(std::get<std::string>(value));
        });
  }
  /// A list whose items have texts.
  template <class Member, class Parse>
  SettingsTable& parsedList(const char* key, int max_items, Member member, Parse parse, const char* meaning) {
    return add(
        key, document::spec::listOf(textSpec(1), 0, max_items), meaning,
        [member](const ViewState& view) {
          std::vector<std::string> texts;
          for (const auto& item : member(view)) texts.push_back(toString(item));
          return texts;
        },
        [member, parse, max_items](ViewState& view, const SettingValue& value) {
          const std::size_t count = std::get<std::vector<std::string>>(value).size();
          if (count > static_cast<std::size_t>(max_items)) {
            throw Error(ErrorCode::bad_input,
                        fmt::format("{} values: expected at most {}", count, max_items));
          }
          std::decay_t<decltype(member(view))> items;
          for (const std::string& text : std::get<std::vector<std::string>>(value))
            items.push_back(parse(text));
          member(view) = std::move(items);
        });
  }
  /// A setting of view files alone, which view_file.cpp reads and writes.
  SettingsTable& stored(const char* key, const char* meaning) {
    return add(key, document::spec::simple(document::ValueType::object), meaning, {}, {});
  }

  SettingsTable& withEffect(bool ViewChange::*affects) {
    rows.back().affects = affects;
    return *this;
  }
  /// The texts of the documentation, if they do not follow from type and default.
  SettingsTable& withTexts(const char* value, const char* of_default) {
    rows.back().value_text = value;
    rows.back().default_text = of_default;
    return *this;
  }
  SettingsTable& withOption(const char* name, const char* help) {
    rows.back().option = name;
    rows.back().option_help = help;
    return *this;
  }
  SettingsTable& withVerb(const char* verb, const char* argument, const char* help) {
    rows.back().verb = verb;
    rows.back().argument = argument;
    rows.back().verb_help = help;
    return *this;
  }
  SettingsTable& withAction(const char* name, const char* keys) {
    rows.back().action = name;
    rows.back().keys = keys;
    return *this;
  }
  SettingsTable& withChange(void (*change)(ViewState& view, const std::string& text)) {
    rows.back().change = [change](ViewState& view, const SettingValue& value) {
      change(view, std::get<std::string>(value));
    };
    return *this;
  }

  static document::ValueSpec textSpec(int min_characters = 0) {
    document::ValueSpec value = document::spec::textOf(document::ValueType::text, kMaxText);
    value.min_items = min_characters;
    return value;
  }

 private:
  SettingsTable& add(const char* key, const document::ValueSpec& of, const char* meaning,
                     std::function<SettingValue(const ViewState&)> get,
                     std::function<void(ViewState&, const SettingValue&)> set) {
    ViewSetting& row = rows.emplace_back();
    row.key = key;
    row.spec = of;
    row.meaning = meaning;
    row.get = std::move(get);
    row.set = row.change = std::move(set);
    return *this;
  }
};

inline document::ValueSpec switchSpec() {
  return document::spec::simple(document::ValueType::boolean);
}
template <class Enum>
document::ValueSpec choiceOf() {
  const auto names = namesOf(Enum());
  return document::spec::choice({names.begin(), names.end()});
}

/// Rows of what tells where the field is, and in which units.
void addReferences(SettingsTable& table);

}  // namespace emscape::playback
