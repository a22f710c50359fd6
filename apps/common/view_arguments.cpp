#include "apps/common/view_arguments.h"

#include <algorithm>
#include <cstdint>

#include "emscape/base/error.h"

namespace emscape::app {

using playback::ViewSetting;
using playback::ViewState;

void ViewArguments::addTo(CLI::App& command, const std::vector<std::string>& but) {
  for (const ViewSetting& setting : playback::viewSettings()) {
    const bool is_left_out = std::find(but.begin(), but.end(), setting.option) != but.end();
    if (!setting.option.empty() && !is_left_out) add(command, setting);
  }
}

void ViewArguments::addSomeTo(CLI::App& command, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) add(command, playback::settingOfKey(key));
}

void ViewArguments::add(CLI::App& command, const ViewSetting& setting) {
  const std::string &name = setting.option, &help = setting.option_help;
  const auto take = [this, &setting](const auto& value) { given_.emplace_back(&setting, value); };
  const std::string usual = setting.isSwitch() || setting.isNumber() ? setting.text(ViewState{}) : "";
  if (setting.isSwitch() && usual == "off") {
    command.add_flag_function(
        name, [take](std::int64_t count) { take(count > 0); }, help);
  } else if (setting.isSwitch()) {
    command.add_option_function<bool>(name, take, help)->default_str(usual);
  } else if (setting.isNumber()) {
    CLI::Option* option = command.add_option_function<double>(name, take, help);
    if (usual == "nan") return;
    option->check(CLI::Range(setting.spec.minimum, setting.spec.maximum))->default_str(usual);
  } else if (setting.isListOfTexts()) {
    command.add_option_function<std::vector<std::string>>(name, take, help)->allow_extra_args(false);
  } else {
    CLI::Option* option = command.add_option_function<std::string>(name, take, help);
    if (setting.isChoice()) option->check(CLI::IsMember(setting.spec.choices));
  }
}

void ViewArguments::apply(ViewState& view) const {
  // Another field first, since values of the former one are dropped with it.
  for (const bool is_of_field : {true, false}) {
    for (const auto& [setting, value] : given_) {
      if ((setting->affects == &playback::ViewChange::field) != is_of_field) continue;
      try {
        setting->change(view, value);
      } catch (const Error& error) {
        if (error.code() == ErrorCode::usage && !setting->isListOfTexts()) throw;
        throw Error(ErrorCode::usage, setting->option + ": " + error.message());
      }
    }
  }
}

}  // namespace emscape::app
