#include "apps/emscape/common/command_line.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <optional>
#include <sstream>
#include <string>

#include "apps/emscape/common/command.h"
#include "apps/emscape/common/components.h"
#include "apps/emscape/common/console.h"
#include "apps/emscape/common/interrupt.h"
#include "base/failure_text.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"

namespace emscape::app {
namespace {

constexpr const char* kFooter = R"(
Examples:
  emscape validate scenarios/jacksboro.yaml
  emscape simulate scenarios/jacksboro.yaml -o out --format vdb,vti --times 0:10:0.5
  emscape render scenarios/jacksboro.yaml -o jacksboro.mp4 --size 1280x720
  emscape info out/jacksboro_0001.vdb --json

Exit status: 0 done, 1 another error, 2 usage, 3 bad input, 4 device, 5 a check failed,
128 + N stopped by signal N (130 after Ctrl-C; finished files are kept).)";

void addGlobalOptions(CLI::App& app, GlobalOptions& global) {
  app.add_option("--backend", global.backend, "Processor: auto, cpu or cuda")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}))
      ->capture_default_str();
  app.add_option("--threads", global.threads, "Threads to use; 0: one per core")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app.add_flag("--json", global.json, "Print only the result, as JSON, on standard output");
  app.add_flag("--quiet,-q", global.quiet, "Print only warnings and errors, no progress or messages");
}

/// To be called after the global options are added, since it depends on --json.
void addLicences(CLI::App& app, const GlobalOptions& global) {
  const auto print_licences = [&global] {
    throw CLI::CallForVersion(global.json ? billOfMaterials().dump(2) : licencesText(), 0);
  };
  app.add_flag_callback("--licences", print_licences,
                        "Print the licences of Emscape and of all that is linked, and exit; with --json as a "
                        "CycloneDX bill of materials");
}

}  // namespace

std::string optionText(Hint hint) {
  switch (hint) {
    case Hint::none:
      break;
    case Hint::allow_missing_terrain:
      return " (--allow-missing-terrain draws holes)";
  }
  return "";
}

namespace {

int fail(ErrorCode code, const std::string& message) {
  printMessage("emscape: error: {}\n", message);
  return static_cast<int>(code);
}

int run(const Action& action) {
  try {
    const int status = action();
    finishResult();
    return status;
  } catch (const playback::Stopped&) {
    printMessage("emscape: stopped by signal {}; finished files are kept\n", caughtSignal());
    return 128 + caughtSignal();
  } catch (const Error& error) {
    return fail(error.code(), error.what() + optionText(error.hint()));
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::other, "out of memory; use fewer voxels (region.dims), channels or --cache-mib");
  } catch (const std::exception& error) {
    return fail(ErrorCode::other, failureText(error));
  } catch (...) {
    return fail(ErrorCode::other, "unknown exception");
  }
}

/// A number without trailing zeros: CLI11 writes 360.000000.
std::string shortNumber(const std::string& text) {
  double value = 0;
  return CLI::detail::lexical_cast(text, value) ? fmt::format("{:.10g}", value) : text;
}

/// "whole number" for options of integers, else "number".
/// @param app  subcommand; the option belongs to it or to one of its parents
std::string numberName(const CLI::App& app, const std::string& option) {
  const CLI::Option* found = nullptr;
  for (const CLI::App* of = &app; of != nullptr && found == nullptr; of = of->get_parent())
    found = of->get_option_no_throw(option);
  const bool is_whole = found != nullptr && found->get_type_name().find("INT") != std::string::npos;
  return is_whole ? "whole number" : "number";
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
    return fmt::format("{}: '{}' is not a {}", name, message.substr(equals + 3), numberName(app, name));
  }
  const std::string unexpected = "The following argument was not expected: ";
  if (startsWith(message, unexpected))
    return fmt::format("unexpected argument '{}'", message.substr(unexpected.size()));
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

/// The parser's message. Where CLI11 asks for a subcommand, it names the unknown word.
std::string messageOf(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* last = &app;
  while (!last->get_subcommands().empty()) last = last->get_subcommands().front();
  if (const auto missing = missingValue(*last)) return *missing;
  if (last->get_require_subcommand_min() == 0) return plainMessage(*last, error.what());
  for (const std::string& word : app.remaining(true)) {
    if (!word.empty() && word.front() != '-') return "there is no subcommand '" + word + "'";
  }
  return plainMessage(*last, error.what());
}

/// Rejects missing values, empty ones, which CLI11 takes as 0 or as none, and 'nan' and 'inf', which it
/// accepts as numbers.
/// @throws CLI::ValidationError naming the first such option of the program or its subcommands
void checkValues(const CLI::App& app) {
  if (const auto missing = missingValue(app)) throw CLI::ValidationError(*missing);
  for (const CLI::Option* option : app.get_options()) {
    const auto is_empty = [](const std::string& text) { return text.empty(); };
    if (std::any_of(option->results().begin(), option->results().end(), is_empty))
      throw CLI::ValidationError(option->get_name(), "the value is empty");
    if (option->get_type_name().rfind("FLOAT", 0) != 0) continue;
    for (const std::string& text : option->results()) {
      double value = 0;
      if (!CLI::detail::lexical_cast(text, value) || std::isfinite(value)) continue;
      throw CLI::ValidationError(option->get_name(), "'" + text + "' is not a number");
    }
  }
  for (const CLI::App* subcommand : app.get_subcommands()) checkValues(*subcommand);
}

/// Parses the command line; returns an exit status if there is nothing to run.
int parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    checkValues(app);
    return -1;
  } catch (const CLI::Success& help) {
    std::ostringstream text;
    app.exit(help, text, text);
    printResult(text.str());
    return 0;
  } catch (const CLI::ParseError& error) {
    printMessage("emscape: error: {}\nTry 'emscape --help' or 'emscape SUBCOMMAND --help'.\n",
                 messageOf(app, error));
    return static_cast<int>(ErrorCode::usage);
  }
}

/// Parses for a host program, which has its own help and version texts.
/// @throws Error (usage)
void parse(CLI::App& app, const std::vector<std::string>& arguments) {
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them reversed
    checkValues(app);
  } catch (const CLI::Success&) {
    throw Error(ErrorCode::usage, "help and version are texts of the program, without a result");
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::usage, messageOf(app, error));
  }
}

/// The parser with all subcommands, and the variables it fills.
struct CommandLine {
  CLI::App app{
      "Computes the electromagnetic environment of a scenario as a volume that changes with time, and shows "
      "it.",
      "emscape"};
  GlobalOptions global;
  Action action;

  CommandLine() {
    app.footer(kFooter);
    app.set_version_flag("--version", std::function<std::string()>(versionText),
                         "Print version, compiler, instruction sets and GPU, and exit");
    app.require_subcommand(1);
    app.option_defaults()->always_capture_default();

    addGlobalOptions(app, global);
    addLicences(app, global);
    addValidate(app, global, action);
    addInfo(app, global, action);
    addSimulate(app, global, action);
    addRender(app, global, action);
    addView(app, global, action);
    addProfile(app, global, action);
    addLink(app, global, action);
    addCoverage(app, global, action);
    addVertical(app, global, action);
    addExposure(app, global, action);
    addCompare(app, global, action);
    addStudy(app, global, action);
    addCheck(app, global, action);
    addBench(app, global, action);
  }
};

std::vector<std::string> program_command;

}  // namespace

int runCommandLine(int argc, char** argv) {
  openStandardStreams();
  return run([&] {
    CommandLine line;
    if (const int status = parse(line.app, argc, argv); status >= 0) return status;
    installLog(line.global);
    setThreadLimit(line.global.threads);
    handleSignals();
    return line.action();
  });
}

std::shared_ptr<const CLI::App> commandLineParser() {
  const auto line = std::make_shared<const CommandLine>();
  return {line, &line->app};
}

struct CommandLineCheck::Impl {
  CommandLine line;
};

CommandLineCheck::CommandLineCheck() : impl_(std::make_unique<Impl>()) {}
CommandLineCheck::~CommandLineCheck() = default;

void CommandLineCheck::parse(const std::vector<std::string>& arguments) {
  app::parse(impl_->line.app, arguments);
}

CommandResult commandResult(const std::vector<std::string>& arguments, const ProgressSink& progress) {
  CommandLine line;
  parse(line.app, arguments);
  line.global.json = true;
  line.global.quiet = true;
  line.global.progress = progress;
  struct ThreadLimitRemoved {
    ~ThreadLimitRemoved() { setThreadLimit(0); }
  } at_end;
  const CapturedResult captured;
  const int status = line.action();
  return {status, captured.text()};
}

void setProgramCommand(const std::vector<std::string>& words) {
  program_command = words;
}

const std::vector<std::string>& programCommand() {
  return program_command;
}

}  // namespace emscape::app
