#include "apps/emscape/command.h"

#include "emscape/base/error.h"

namespace emscape::app {

void addSetOption(CLI::App& command, std::vector<scenario::Edit>& edits) {
  const auto take = [&edits](const std::vector<std::string>& texts) {
    try {
      for (const std::string& text : texts) edits.push_back(scenario::parseEdit(text));
    } catch (const Error& error) {
      throw CLI::ValidationError("--set", error.message());
    }
  };
  command
      .add_option_function<std::vector<std::string>>("--set", take,
                                                     "PATH=VALUE: changes a value of the scenario, such as "
                                                     "emitters.NAME.power_w=500; null removes a key; may "
                                                     "be given several times")
      ->allow_extra_args(false);
}

}  // namespace emscape::app
