/// Checks, before any work, of the files that a command is to write.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"
#include "study/sweep/definition/study_file.h"

namespace emscape::report {

/// An input or an output of a command.
struct NamedFile {
  std::string name;  ///< of an output the option: "--csv"; of an input what it is: "the study"
  std::string file;  ///< empty: not given
};

/// The outputs of an option that may be given several times.
std::vector<NamedFile> outputsOf(const std::string& option, const std::vector<std::string>& files);

/// Checks that outputs, with the .json beside volumes of the formats raw and nvdb, are different, and none of
/// the inputs. Files are the same if they have the same identity, or the same name if they do not exist.
/// Files that isOwn() denies are not replaced.
/// @param scenarios     inputs, with the files that they name
/// @param replaces_any  true: files that exist are the caller's business
/// @throws Error (usage) that names the option and the file
void checkOutputs(const std::vector<NamedFile>& named, const std::vector<NamedFile>& inputs,
                  const std::vector<std::shared_ptr<const scenario::Scenario>>& scenarios,
                  bool replaces_any = false);

/// Before long work. @throws Error (other) that names the first file whose folder does not exist
void requireFolders(const std::vector<std::string>& files);

/// Checks the folder of a study. @param option  name of the folder, for messages  @param others  further
/// outputs
/// @throws Error (usage) as checkOutputs()
void checkStudyFolder(const std::filesystem::path& folder, const study::StudySpec& study,
                      const std::string& option, const std::vector<NamedFile>& others = {});

/// Checks the folder of `coverage` or `compare`.
/// @param scenarios  inputs, with the files that they name  @param option  name of the folder, for the
/// message
/// @throws Error (usage) as checkOutputs() for the reports, and for an input in the folder's maps/ that
/// isOwn()
void checkMapFolder(const std::filesystem::path& folder,
                    const std::vector<std::shared_ptr<const scenario::Scenario>>& scenarios,
                    const std::string& option);

}  // namespace emscape::report
