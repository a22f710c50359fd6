/// Options shared by the what-if subcommands.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/common/command.h"
#include "apps/common/view_arguments.h"
#include "report/maps/map_options.h"

namespace emscape::app {

/// Adds -o FILE.png|.svg|.csv|.json, which may be given several times.
void addStudyOutputs(CLI::App& command, std::vector<std::string>& files);

/// Contents of these files.
struct StudyOutputs {
  std::function<void(const std::string&file)> plot, csv;
  std::function<std::string()> json;
};
/// Writes each file in the format of its extension. @throws Error
void writeStudyOutputs(const std::vector<std::string>& files, const StudyOutputs& outputs);

/// Adds --threshold. @param threshold  NAN: not given
void addThresholdOption(CLI::App& command, double& threshold);

/// Adds the options of coverage maps. @param options, view  must live as long as the command; the caller
/// applies the view's to the options
void addMapOptions(CLI::App& command, report::MapOptions& options, ViewArguments& view);

}  // namespace emscape::app
