/// A loaded study, and computing its parts.
#pragma once

#include <functional>
#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "study/sweep/results/study_folder.h"

namespace emscape::study {

/// A study with everything derived from its file.
struct LoadedStudy {
  StudySpec spec;
  scenario::TerrainPtr terrain;
  StudyPlan plan;

  /// @param tries_values  see loadStudy()
  LoadedStudy(const std::string& file, const std::vector<scenario::Edit>& edits, bool tries_values);
  LoadedStudy(const LoadedStudy&) = delete;
  LoadedStudy& operator=(const LoadedStudy&) = delete;

  /// Its folder. The study must outlive it.
  StudyFolder folder(const std::filesystem::path& path) const;
};

/// @throws Error (usage) unless the number of parts is between 1 and the number of variants
void checkParts(int parts, std::size_t variants);

/// Computes parts one after another; keeps the fields between parts.
class PartComputer {
 public:
  /// @param loaded, folder  must outlive the object; the folder has begun  @param backend  auto, cpu or cuda
  PartComputer(const LoadedStudy& loaded, const StudyFolder& folder, const std::string& backend);

  /// Computes the missing variants of a part.
  /// @param progress  an exception that it throws ends the work
  /// @throws Error; finished variants are kept
  void compute(int part, const ProgressSink& progress);
  /// Computes the parts whose numbers come in. @param isComplete  called after each
  void serve(std::istream& in, const std::function<void(int part)>& isComplete, const ProgressSink& progress);

 private:
  const StudyFolder& folder_;
  std::unique_ptr<VariantFiles> files_;
  std::unique_ptr<StudyRunner> runner_;
  std::string machine_;
};

/// Processes that compute parts.
struct PartWorkers {
  int jobs = 1;                      ///< 1: this process
  std::vector<std::string> command;  ///< see computeInProcesses()
};

/// Computes parts. @param progress  over all of them; an exception that it throws ends the work
void computeParts(const LoadedStudy& loaded, const StudyFolder& folder, const std::vector<int>& parts,
                  const std::string& backend, const PartWorkers& workers, const ProgressSink& progress);

}  // namespace emscape::study
