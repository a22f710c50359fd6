/// The plan of a study and its merged results, as JSON and text.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "report/json.h"
#include "study/sweep/results/part_computer.h"
#include "study/sweep/results/study_report.h"

namespace emscape::report {

/// Measured times (s) of a variant, by its difference from the preceding one; 0 for classes that do not
/// occur.
struct VariantTimes {
  double first_s = 0;  ///< with nothing kept
  std::array<double, study::kChangeClasses> by_class{};
};

/// The expected cost of a study.
struct PlanReport {
  const study::LoadedStudy* loaded;
  int parts = 0, jobs = 0;
  VariantTimes times;
  double expected_s = 0;
  double single_runs_s = 0;  ///< if each variant were a study of its own
  double bytes = 0;          ///< of the results
};

/// Computes one variant of each kind.
/// @param loading_s  time that loading the study took
/// @param progress   called before each variant; an exception that it throws ends the work; may be empty
/// @throws Error (usage) for a number of parts that the study cannot have
PlanReport planReport(const study::LoadedStudy& loaded, int parts, int jobs, double loading_s,
                      const std::string& backend, const ProgressSink& progress);
Json toJson(const PlanReport& plan);
std::string planText(const PlanReport& plan);

/// The joined parts of a study.
struct StudyReport {
  const study::LoadedStudy* loaded;
  std::string folder;
  int parts = 0;
  std::vector<int> missing_parts;
  std::vector<std::string> warnings;
  study::StudySummary summary;
};

/// Joins the parts that exist, and writes results.csv, results.nc and report.html.
/// @throws Error (bad_input) for a damaged part; (other) naming a file that cannot be written
StudyReport mergeParts(const study::LoadedStudy& loaded, const study::StudyFolder& folder);
Json toJson(const StudyReport& report);
std::string studyText(const StudyReport& report);

}  // namespace emscape::report
