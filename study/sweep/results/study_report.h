/// The report of a study.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/sweep/results/study_folder.h"

namespace emscape::study {

/// The extremes of a measure over the computed variants; NaN if none has a value.
struct MeasureSummary {
  std::string name, unit;
  double min = 0, max = 0, mean = 0;
  std::size_t min_variant = 0, max_variant = 0;
};

struct StudySummary {
  std::vector<MeasureSummary> measures;
  std::vector<std::string> sites;  ///< of a search: the chosen sites
  double sites_value = 0;          ///< the measure for all chosen sites together
};

/// Writes the report: the study, extremes of each measure with their variants, each measure over each
/// parameter, and up to 500 variants as a table; of a search for sites, the chosen sites.
/// @throws Error (other) that names the file
StudySummary writeStudyReport(const std::filesystem::path& file, const StudySpec& study,
                              const StudyPlan& plan, const StudyResults& results);

}  // namespace emscape::study
