#include "apps/common/command_line.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <sstream>
#include <string>

#include "apps/common/arguments.h"
#include "apps/common/command.h"
#include "apps/common/components.h"
#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "base/geodesy/gdal_environment.h"
#include "base/limits/address_limit.h"
#include "base/text/failure_text.h"
#include "base/threads.h"
#include "emscape/base/cuda/device.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
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
  addDevicesOption(app, global.devices);
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

std::string optionText(const CLI::App& app, Hint hint) {
  const CLI::App* last = &app;
  while (!last->get_subcommands().empty()) last = last->get_subcommands().front();
  switch (hint) {
    case Hint::none:
      break;
    case Hint::allow_missing_terrain:
      if (last->get_option_no_throw("--allow-missing-terrain") != nullptr)
        return " (--allow-missing-terrain draws holes)";
      break;
  }
  return "";
}

namespace {

int fail(ErrorCode code, const std::string& message) {
  printMessage("emscape: error: {}\n", message);
  return static_cast<int>(code);
}

/// @param app  null: no command line has been parsed
int run(const Action& action, const CLI::App* const& app) {
  try {
    const int status = action();
    finishResult();
    return status;
  } catch (const Stopped&) {
    printMessage("emscape: stopped by signal {}; finished files are kept\n", caughtSignal());
    return 128 + caughtSignal();
  } catch (const Error& error) {
    return fail(error.code(), error.what() + (app != nullptr ? optionText(*app, error.hint()) : ""));
  } catch (const std::bad_alloc& error) {
    return fail(ErrorCode::other, failureText(error) + "; fewer voxels, pixels, emitters or times take less");
  } catch (const std::exception& error) {
    return fail(ErrorCode::other, failureText(error));
  } catch (...) {
    return fail(ErrorCode::other, "unknown exception");
  }
}

/// The words of the command line that are subcommands: "emscape exposure".
std::string commandOf(const CLI::App& app) {
  std::string words = app.get_name();
  for (const CLI::App* last = &app; !last->get_subcommands().empty();) {
    last = last->get_subcommands().front();
    words += " " + last->get_name();
  }
  return words;
}

/// Parses the command line; returns an exit status if there is nothing to run.
/// @param words  reversed, as CLI11 takes them
int parseAndReport(CLI::App& app, std::vector<std::string> words) {
  try {
    app.parse(std::move(words));
    checkValues(app);
    return -1;
  } catch (const CLI::Success& help) {
    std::ostringstream text;
    app.exit(help, text, text);
    printResult(text.str());
    return 0;
  } catch (const CLI::ParseError& error) {
    const std::string command = commandOf(app);
    printMessage("emscape: error: {}\nTry {}'{} --help'.\n", messageOf(app, error),
                 command == app.get_name() ? "'emscape SUBCOMMAND --help' or " : "", command);
    return static_cast<int>(ErrorCode::usage);
  }
}

/// Where few threads can be started, loops run on one, and the others are left to those that need them.
/// @param wanted  threads of loops; 0: one per core
/// @return false where few can be started
bool allowThreads(int wanted) {
  // OpenVDB has four threads, Pango for a moment as many; others write files and show the progress.
  constexpr int kFurther = 8;
  setThreadLimit(wanted);
  const int count = threadCount() - 1 + kFurther;
  // Stacks of threads that have ended stay in the address space for a while.
  if (hasAddressLimit() || startableThreads(count) == count) return true;
  logInfo("few threads can be started (ulimit -u, or the limit of a container): computing on one");
  spareThreads();
  setThreadLimit(1);
  return false;
}

}  // namespace

struct CommandLine::Impl {
  CLI::App app{
      "Computes the electromagnetic environment of a scenario as a volume that changes with time, and shows "
      "it.",
      "emscape"};
  GlobalOptions global;
  Action action;
};

CommandLine::CommandLine(const AddSubcommands& addSubcommands) : impl_(std::make_unique<Impl>()) {
  CLI::App& app = impl_->app;
  app.footer(kFooter);
  app.set_version_flag("--version", std::function<std::string()>(versionText),
                       "Print version, compiler, instruction sets and GPU, and exit");
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  addGlobalOptions(app, impl_->global);
  addLicences(app, impl_->global);
  addSubcommands(app, impl_->global, impl_->action);
  readWholeNumbersAsDecimal(app);
}
CommandLine::~CommandLine() = default;

const CLI::App& CommandLine::parser() const {
  return impl_->app;
}

void CommandLine::parse(const std::vector<std::string>& arguments) {
  try {
    impl_->app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // reversed for CLI11
    checkValues(impl_->app);
  } catch (const CLI::Success&) {
    throw Error(ErrorCode::usage, "help and version are texts of the program, without a result");
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::usage, messageOf(impl_->app, error));
  }
}

int runCommandLine(const std::vector<std::string>& words, const AddSubcommands& addSubcommands) {
  openStandardStreams();
  std::unique_ptr<CommandLine> line;  // also for the text of an error
  const CLI::App* app = nullptr;
  return run(
      [&] {
        line = std::make_unique<CommandLine>(addSubcommands);
        CommandLine::Impl& parsed = *line->impl_;
        app = &parsed.app;
        if (const int status = parseAndReport(parsed.app, {words.rbegin(), words.rend()}); status >= 0)
          return status;
        installLog(parsed.global);
        const bool has_threads = allowThreads(parsed.global.threads);
        setDeviceLimit(parsed.global.devices);
        handleSignals();
        Work work(&stopFlag());  // a signal stops the loops of every subcommand
        const WorkScope scope(&work);
        const auto shown = has_threads ? std::make_unique<const WorkLine>(parsed.global, work) : nullptr;
        return parsed.action();
      },
      app);
}

int runProgram(const std::vector<std::string>& words, const AddSubcommands& addSubcommands) {
  spareAddresses();
  gdal::ignoreEnvironment();
  const int status = runCommandLine(words, addSubcommands);
  if (status == 0) return 0;
  // After a netCDF file could not be written to a full disk, HDF5 crashes in its exit handler. Nothing else
  // is left to do here.
  std::fflush(nullptr);
  std::_Exit(status);
}

}  // namespace emscape::app
