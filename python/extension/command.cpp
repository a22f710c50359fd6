/// The command line in this process.
#include "apps/emscape/common/command_line.h"
#include "python/extension/module.h"

namespace emscape::python {

void bindCommand(nb::module_& module) {
  module.def(
      "command",
      [](const std::vector<std::string>& arguments, const ProgressCall& progress) {
        refuseForkedProcess();
        const ProgressSink sink = progressSink(progress);
        const nb::gil_scoped_release unlocked;
        const app::CommandResult result = app::commandResult(arguments, sink);
        return std::pair(result.status, result.json);
      },
      nb::arg("arguments"), nb::arg("progress").none(),
      "Exit status and JSON of a subcommand that succeeds or whose check fails; raises Error else.");
  module.def(
      "run_command_line",
      [](std::vector<std::string> words) {
        refuseForkedProcess();
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        const nb::gil_scoped_release unlocked;
        return app::runCommandLine(static_cast<int>(words.size()), argv.data());
      },
      nb::arg("words"), "Runs the program: prints, takes over signals and the log. The exit status.");
  module.def("set_program_command", &app::setProgramCommand, nb::arg("words"));
}

}  // namespace emscape::python
