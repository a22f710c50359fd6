#include "report/maps/output_files.h"

#include <fmt/core.h>

#include <system_error>

#include "base/files/descriptor.h"
#include "base/files/own_file.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "render/annotate/text_setter.h"
#include "study/sweep/results/study_folder.h"
#include "volume/volume_json.h"

namespace emscape::report {
namespace {

namespace fs = std::filesystem;

bool isSame(const fs::path& a, const fs::path& b) {
  std::error_code failed;
  if (fs::exists(a, failed) && fs::exists(b, failed)) return fs::equivalent(a, b, failed);
  // An absolute path, because weakly_canonical() leaves a name in the working folder relative.
  return fs::weakly_canonical(fs::absolute(a, failed), failed) ==
         fs::weakly_canonical(fs::absolute(b, failed), failed);
}

/// @param file  of scenario::filesOf()
std::string whatIs(const std::string& file, const scenario::Scenario& scenario) {
  return file == scenario.file ? "the scenario" : "a file that the scenario names";
}

[[noreturn]] void refuse(const NamedFile& output, const std::string& what) {
  throw Error(ErrorCode::usage, fmt::format("{}: {} is {}", output.name, output.file, what));
}

}  // namespace

std::vector<NamedFile> outputsOf(const std::string& option, const std::vector<std::string>& files) {
  std::vector<NamedFile> outputs;
  for (const std::string& file : files) outputs.push_back({option, file});
  return outputs;
}

void checkOutputs(const std::vector<NamedFile>& named, const std::vector<NamedFile>& inputs,
                  const std::vector<std::shared_ptr<const scenario::Scenario>>& scenarios,
                  bool replaces_any) {
  std::vector<NamedFile> outputs = named;
  for (const NamedFile& output : named) {
    const std::string ending = fs::path(output.file).extension();
    if (ending == ".raw" || ending == ".nvdb")
      outputs.push_back({output.name, volume::sidecarOf(output.file).string()});
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const NamedFile& output = outputs[i];
    if (output.file.empty()) continue;
    for (std::size_t other = 0; other < i; ++other) {
      if (!outputs[other].file.empty() && isSame(output.file, outputs[other].file))
        refuse(output, "also the output of " + outputs[other].name);
    }
    std::error_code ignored;
    const bool is_link = fs::is_symlink(output.file, ignored);  // perhaps of nothing
    if (!is_link && !fs::is_regular_file(output.file, ignored)) continue;
    for (const NamedFile& input : inputs) {
      if (!input.file.empty() && isSame(output.file, input.file)) refuse(output, input.name);
    }
    for (const auto& scenario : scenarios) {
      for (const std::string& file : scenario::filesOf(*scenario)) {
        if (!file.empty() && isSame(output.file, file)) refuse(output, whatIs(file, *scenario));
      }
    }
    const std::string foreign = replaces_any ? "" : foreignText(output.file);
    if (!foreign.empty()) refuse(output, foreign);
  }
}

void requireFolders(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    if (!file.empty()) openFolderOf(file);
  }
}

void checkStudyFolder(const fs::path& folder, const study::StudySpec& study, const std::string& option,
                      const std::vector<NamedFile>& others) {
  std::vector<NamedFile> outputs, inputs{{"the study", study.file}};
  for (const std::string& file : study.files) inputs.push_back({"a file that the study names", file});
  for (const std::string& name : study::StudyFolder::results(study))
    outputs.push_back({option, (folder / name).string()});
  outputs.insert(outputs.end(), others.begin(), others.end());
  checkOutputs(outputs, inputs, {study.base});
}

void checkMapFolder(const fs::path& folder,
                    const std::vector<std::shared_ptr<const scenario::Scenario>>& scenarios,
                    const std::string& option) {
  render::requireFonts();  // a report has pictures
  std::vector<NamedFile> reports;
  for (const char* name : {"study.json", "report.json", "report.html"})
    reports.push_back({option, (folder / name).string()});
  checkOutputs(reports, {}, scenarios);
  for (const auto& scenario : scenarios) {
    for (const std::string& file : scenario::filesOf(*scenario)) {
      std::error_code failed;
      const fs::path target = fs::canonical(file, failed);
      if (!failed && isSame(target.parent_path(), folder / "maps") && isOwn(target)) {
        throw Error(ErrorCode::usage,
                    fmt::format("{}: {} is {}, which a map could replace; use another folder", option, file,
                                whatIs(file, *scenario)));
      }
    }
  }
}

}  // namespace emscape::report
