/// Computing parts of a study in this process.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/emscape/common/command.h"
#include "apps/emscape/study/study_plan.h"
#include "emscape/base/progress.h"
#include "study/sweep/study_folder.h"

namespace emscape::app {

/// Computes parts one after another; keeps the fields between parts.
class PartComputer {
 public:
  /// @param loaded, folder  must outlive the object; the folder has begun
  PartComputer(const LoadedStudy& loaded, const study::StudyFolder& folder, const GlobalOptions& global);

  /// Computes the missing variants of a part.
  /// @throws Error, playback::Stopped; finished variants are kept
  void compute(int part, const ProgressSink& progress);

 private:
  const study::StudyFolder& folder_;
  std::unique_ptr<study::VariantFiles> files_;
  std::unique_ptr<study::StudyRunner> runner_;
  std::string machine_;
};

/// Computes parts one after another. @param progress  over all of them
void computeParts(PartComputer& computer, const std::vector<int>& parts, const ProgressSink& progress);

}  // namespace emscape::app
