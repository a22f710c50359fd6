/// The subcommands of `emscape bench`, one file each.
#pragma once

#include "apps/common/command.h"

namespace emscape::app {

/// Adds `bench` with all its subcommands.
void addBench(CLI::App& app, const GlobalOptions& global, Action& action);

void addBenchCells(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchCoverage(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchField(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchMarch(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchModels(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchRender(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchReconstruction(CLI::App& bench, const GlobalOptions& global, Action& action);
void addBenchView(CLI::App& bench, const GlobalOptions& global, Action& action);

}  // namespace emscape::app
