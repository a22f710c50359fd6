/// emscape_manual FOLDER: writes the manual pages and the shell completion of the programs, from their
/// parsers.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>

#include "apps/bench/bench.h"
#include "apps/common/version.h"
#include "apps/emscape/subcommands.h"
#include "apps/manual/completion.h"
#include "apps/manual/manual_page.h"
#include "base/files/folder.h"
#include "base/files/whole_file.h"
#ifdef EMSCAPE_WITH_VIEW
#include "apps/view/view_parser.h"
#endif

namespace emscape::manual {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  makeFolder(file.parent_path());
  writeWhole(
      file, [&](std::ostream& out) { out << text; }, Replaces::any);
}

CommandDescription& subcommandOf(CommandDescription& program, const std::string& name) {
  const auto found = std::find_if(program.subcommands.begin(), program.subcommands.end(),
                                  [&](const CommandDescription& command) { return command.name == name; });
  if (found == program.subcommands.end()) throw std::logic_error("emscape has no subcommand " + name);
  return *found;
}

/// The command line of emscape; view and bench have the options of the programs that they start.
CommandDescription describeProgram() {
  CommandDescription program = describe(app::CommandLine(app::addSubcommands).parser());
  CommandDescription benchmarks = describe(app::CommandLine(app::addBench).parser());
  subcommandOf(program, "bench") = subcommandOf(benchmarks, "bench");
  CommandDescription& view = subcommandOf(program, "view");
#ifdef EMSCAPE_WITH_VIEW
  const std::string summary = view.summary;
  view = describe(*view::viewParser());
  view.name = "view";
  view.summary = summary;
#else
  program.subcommands.erase(program.subcommands.begin() + (&view - program.subcommands.data()));
#endif
  return program;
}

void writeAll(const fs::path& folder) {
  const CommandDescription program = describeProgram();
  for (const ManualPage& page : manualPages(program, app::kVersion))
    write(folder / "man" / page.file, page.text);
  write(folder / "completion" / program.name, bashCompletion(program));
  write(folder / "completion" / ("_" + program.name), zshCompletion(program));
}

}  // namespace
}  // namespace emscape::manual

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: emscape_manual FOLDER\n");
    return 2;
  }
  try {
    emscape::manual::writeAll(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "emscape_manual: error: %s\n", error.what());
    return 1;
  }
}
