/// The subcommands of `emscape bench`, one file each.
#pragma once

#include "apps/emscape/common/command.h"

namespace emscape::app {

void addBenchCells(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchCoverage(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchField(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchMarch(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchModels(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchRender(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchReconstruction(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchView(CLI::App& bench, const GlobalOptions& global, Action& action);

}  // namespace emscape::app
