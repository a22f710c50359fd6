/// The subcommands of emscape, one file each.
#pragma once

#include "apps/common/command.h"

namespace emscape::app {

void addValidate(CLI::App& app, const GlobalOptions& global, Action& action);
void addInfo(CLI::App& app, const GlobalOptions& global, Action& action);
void addTerrain(CLI::App& app, const GlobalOptions& global, Action& action);
void addSimulate(CLI::App& app, const GlobalOptions& global, Action& action);
void addRender(CLI::App& app, const GlobalOptions& global, Action& action);
void addProfile(CLI::App& app, const GlobalOptions& global, Action& action);
void addLink(CLI::App& app, const GlobalOptions& global, Action& action);
void addCoverage(CLI::App& app, const GlobalOptions& global, Action& action);
void addVertical(CLI::App& app, const GlobalOptions& global, Action& action);
void addBlockage(CLI::App& app, const GlobalOptions& global, Action& action);
void addExposure(CLI::App& app, const GlobalOptions& global, Action& action);
void addCompare(CLI::App& app, const GlobalOptions& global, Action& action);
void addStudy(CLI::App& app, const GlobalOptions& global, Action& action);
void addImport(CLI::App& app, const GlobalOptions& global, Action& action);
void addExport(CLI::App& app, const GlobalOptions& global, Action& action);
void addLive(CLI::App& app, const GlobalOptions& global, Action& action);
void addPlay(CLI::App& app, const GlobalOptions& global, Action& action);
void addCheck(CLI::App& app, const GlobalOptions& global, Action& action);

/// Adds all of them, with those that start another program: view and bench.
void addSubcommands(CLI::App& app, const GlobalOptions& global, Action& action);

}  // namespace emscape::app
