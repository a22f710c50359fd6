/// The report of a study.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "emscape/study/study_folder.h"

namespace emscape::study {

/// The extremes of a measure over the variants that were computed; NaN if none has a value.
struct MeasureSummary {
  std::string name, unit;
  double min = 0, max = 0, mean = 0;
  std::size_t min_variant = 0, max_variant = 0;
};

struct StudySummary {
  std::vector<MeasureSummary> measures;
  std::vector<std::string> sites;  ///< of a search: those that are chosen together
  double sites_value = 0;          ///< the measure of them together
};

/// Writes the report: the study, extremes of each measure with their variants, each measure over each
/// parameter, and up to 500 variants as a table; of a search for sites, those that are chosen.
/// @throws Error (other) that names the file
StudySummary writeStudyReport(const std::filesystem::path& file, const StudySpec& study,
                              const StudyPlan& plan, const StudyResults& results);

}  // namespace emscape::study
