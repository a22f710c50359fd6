#include "apps/emscape/subcommands.h"

#include "apps/common/sibling_program.h"

namespace emscape::app {
namespace {

/// A subcommand whose arguments, also --help, are those of another program, so that this one links neither
/// OpenGL nor the benchmarks.
void addProgram(CLI::App& app, const char* name, const char* description, const SiblingProgram& program,
                const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand(name, description);
  command->set_help_flag();
  command->prefix_command();
  command->callback([command, &program, &global, &action] {
    action = [command, &program, &global]() -> int { becomeProgram(program, global, command->remaining()); };
  });
}

}  // namespace

void addSubcommands(CLI::App& app, const GlobalOptions& global, Action& action) {
  addValidate(app, global, action);
  addInfo(app, global, action);
  addTerrain(app, global, action);
  addSimulate(app, global, action);
  addRender(app, global, action);
  addProgram(app, "view", "Show a scenario or volumes in a window", kViewProgram, global, action);
  addProfile(app, global, action);
  addLink(app, global, action);
  addCoverage(app, global, action);
  addVertical(app, global, action);
  addBlockage(app, global, action);
  addExposure(app, global, action);
  addCompare(app, global, action);
  addStudy(app, global, action);
  addImport(app, global, action);
  addExport(app, global, action);
  addLive(app, global, action);
  addPlay(app, global, action);
  addCheck(app, global, action);
  addProgram(app, "bench", "Measure speed, and the error of interpolated pixels", kBenchProgram, global,
             action);
}

}  // namespace emscape::app
