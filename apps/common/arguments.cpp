#include "apps/common/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "document/schema_check.h"

namespace emscape::app {
namespace {

/// A number without trailing zeros: CLI11 writes 360.000000.
std::string shortNumber(const std::string& text) {
  double value = 0;
  return CLI::detail::lexical_cast(text, value) ? fmt::format("{:.10g}", value) : text;
}

bool isWhole(const CLI::Option& option) {
  return option.get_type_name().find("INT") != std::string::npos;
}

bool isSwitch(const CLI::Option& option) {
  return option.get_type_name() == "BOOLEAN";
}

/// The option of a subcommand or of one of its parents; null: none has it.
const CLI::Option* optionOf(const CLI::App& app, const std::string& name) {
  const CLI::Option* found = nullptr;
  for (const CLI::App* of = &app; of != nullptr && found == nullptr; of = of->get_parent())
    found = of->get_option_no_throw(name);
  return found;
}

/// "whole number" for options of integers, else "number".
/// @param app  subcommand; the option belongs to it or to one of its parents
std::string numberName(const CLI::App& app, const std::string& option) {
  const CLI::Option* const found = optionOf(app, option);
  return found != nullptr && isWhole(*found) ? "whole number" : "number";
}

/// Rewrites CLI11's message about a value in the form of the program's own: option, value, allowed values.
/// @param app  the subcommand that the options belong to
std::string plainMessage(const CLI::App& app, const std::string& message) {
  const auto startsWith = [](const std::string& text, const std::string& start) {
    return text.compare(0, start.size(), start) == 0;
  };
  const std::string conversion = "Could not convert: ", value = "Value ";
  if (const std::size_t equals = message.find(" = ");
      startsWith(message, conversion) && equals != std::string::npos) {
    const std::string name = message.substr(conversion.size(), equals - conversion.size());
    if (const CLI::Option* option = optionOf(app, name); option != nullptr && isSwitch(*option))
      return fmt::format("{}: '{}' must be on or off", name, message.substr(equals + 3));
    return fmt::format("{}: '{}' is not a {}", name, message.substr(equals + 3), numberName(app, name));
  }
  const std::size_t colon = message.find(": ");
  if (!startsWith(message, "--") || colon == std::string::npos) return message;
  const std::string name = message.substr(0, colon), rest = message.substr(colon + 2);
  const std::string received = " required but received ";
  if (const std::size_t at = rest.find(received);
      at != std::string::npos && (startsWith(rest, "At Most ") || startsWith(rest, "At least "))) {
    const std::size_t number = rest.rfind(' ', at - 1) + 1;
    const std::string allowed = rest.substr(number, at - number);
    return fmt::format("{} takes {} value{}, not {}", name, allowed, allowed == "1" ? "" : "s",
                       rest.substr(at + received.size()));
  }
  const std::string in_range = " not in range ", to = " to ", in_names = " not in {";
  const std::size_t range = rest.rfind(in_range), names = rest.rfind(in_names);
  if (startsWith(rest, "1 required ") && rest.rfind(" missing") == rest.size() - 8)
    return name + " needs a value";
  if (startsWith(rest, value) && range != std::string::npos && range >= value.size()) {
    const std::string bounds = rest.substr(range + in_range.size());
    const std::size_t split = bounds.find(to);
    if (split == std::string::npos) return message;
    return fmt::format("{}: '{}' must be a {} from {} to {}", name,
                       rest.substr(value.size(), range - value.size()), numberName(app, name),
                       shortNumber(bounds.substr(0, split)), shortNumber(bounds.substr(split + to.size())));
  }
  if (names == std::string::npos || rest.back() != '}') return message;
  std::string allowed;
  for (const char c : rest.substr(names + in_names.size(), rest.size() - names - in_names.size() - 1))
    allowed += c == ',' ? std::string(", ") : std::string(1, c);
  return fmt::format("{}: '{}' must be one of {}", name, rest.substr(0, names), allowed);
}

/// CLI11 takes the word after an option as its value even if it is the name of an option.
/// @return the error's text for the first option whose value is missing in this way
std::optional<std::string> missingValue(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_expected_max() == 0) continue;  // flags
    for (const std::string& text : option->results()) {
      if (text.rfind("--", 0) != 0) continue;
      for (const CLI::App* of = &app; of != nullptr; of = of->get_parent()) {
        if (of->get_option_no_throw(text) != nullptr)
          return fmt::format("{} needs a value, but '{}' follows", option->get_name(), text);
      }
    }
  }
  return std::nullopt;
}

bool isExtras(const CLI::ParseError& error) {
  return error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
}

}  // namespace

void readWholeNumbersAsDecimal(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (!isWhole(*option)) continue;
    option->transform(CLI::Validator(
        [](std::string& text) {
          const std::size_t sign = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
          const std::size_t first = text.find_first_not_of('0', sign);
          if (first == sign + 1 && std::isalpha(static_cast<unsigned char>(text[first])) != 0)
            return "'" + text + "' is not a decimal number";
          const bool is_decimal = text.find_first_not_of("0123456789", sign) == std::string::npos;
          if (is_decimal && first != std::string::npos) text.erase(sign, first - sign);
          return std::string();
        },
        ""));
  }
  for (CLI::App* subcommand : app.get_subcommands({})) readWholeNumbersAsDecimal(*subcommand);
}

std::string messageOf(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* last = &app;
  while (!last->get_subcommands().empty()) last = last->get_subcommands().front();
  if (const auto missing = missingValue(*last)) return *missing;
  std::vector<std::string> words = app.remaining(true);
  words.erase(std::remove(words.begin(), words.end(), "--"), words.end());  // CLI11 puts it behind the words
  if (last->get_require_subcommand_min() == 0) {
    if (words.empty() || !isExtras(error)) return plainMessage(*last, error.what());
    return fmt::format("unexpected argument{} '{}'", words.size() == 1 ? "" : "s", fmt::join(words, "', '"));
  }
  for (const std::string& word : words) {
    if (word.empty() || word.front() == '-') continue;
    std::vector<std::string> names;
    for (const CLI::App* subcommand : last->get_subcommands({})) names.push_back(subcommand->get_name());
    std::error_code ignored;
    const std::string hint = std::filesystem::is_regular_file(word, ignored)
                                 ? "; it is a file: `emscape info` describes it, `emscape view` shows it"
                                 : document::didYouMean(word, names);
    return "there is no subcommand '" + word + "'" + hint;
  }
  return plainMessage(*last, error.what());
}

void checkValues(const CLI::App& app) {
  if (const auto missing = missingValue(app)) throw CLI::ValidationError(*missing);
  for (const CLI::Option* option : app.get_options()) {
    const auto is_empty = [](const std::string& text) { return text.empty(); };
    if (std::any_of(option->results().begin(), option->results().end(), is_empty))
      throw CLI::ValidationError(option->get_name(), "the value is empty");
    static const std::set<std::string> kSwitch{"on", "off", "true", "false", "yes", "no", "1", "0"};
    for (const std::string& text : option->results()) {
      if (isSwitch(*option) && kSwitch.count(text) == 0)
        throw CLI::ValidationError(option->get_name(), "'" + text + "' must be on or off");
      if (option->get_expected_max() == 0 && text != "true" && text != "false")
        throw CLI::ValidationError(option->get_name(), "takes no value, not '" + text + "'");
    }
    if (option->get_type_name().rfind("FLOAT", 0) != 0) continue;
    for (const std::string& text : option->results()) {
      double value = 0;
      if (!CLI::detail::lexical_cast(text, value) || std::isfinite(value)) continue;
      throw CLI::ValidationError(option->get_name(), "'" + text + "' is not a number");
    }
  }
  for (const CLI::App* subcommand : app.get_subcommands()) checkValues(*subcommand);
}

}  // namespace emscape::app
