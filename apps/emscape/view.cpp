/// emscape view: starts emscape-view, a separate program, so that this one needs no OpenGL.
#include "apps/emscape/common/command.h"
#include "apps/emscape/common/window_program.h"

namespace emscape::app {

void addView(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand("view", "Show a scenario or volumes in a window");
  command->set_help_flag();  // the window's own help
  command->prefix_command();
  command->callback([command, &global, &action] {
    action = [command, &global]() -> int { becomeWindow(global, command->remaining()); };
  });
}

}  // namespace emscape::app
