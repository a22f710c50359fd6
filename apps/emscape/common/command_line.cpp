#include "apps/emscape/common/command_line.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <sstream>
#include <string>

#include "apps/emscape/common/arguments.h"
#include "apps/emscape/common/command.h"
#include "apps/emscape/common/components.h"
#include "apps/emscape/common/console.h"
#include "apps/emscape/common/interrupt.h"
#include "base/text/failure_text.h"
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
    return fail(ErrorCode::other, "out of memory; fewer voxels, pixels, emitters or times take less");
  } catch (const std::exception& error) {
    return fail(ErrorCode::other, failureText(error));
  } catch (...) {
    return fail(ErrorCode::other, "unknown exception");
  }
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
    readWholeNumbersAsDecimal(app);
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
  if (line.app.got_subcommand("view")) {  // it would replace the process
    const std::string program =
        program_command.empty() ? "emscape" : fmt::format("{}", fmt::join(program_command, " "));
    throw Error(ErrorCode::usage,
                fmt::format("'view' has no result; start the window as a program: {} view ...", program));
  }
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
