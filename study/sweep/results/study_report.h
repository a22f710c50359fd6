/// The report of a study.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "study/sweep/results/study_folder.h"

namespace emscape::study {

/// A measure over the computed variants; NaN if none has a value.
struct MeasureSummary {
  std::string name, unit;
  double min = 0, max = 0, mean = 0;
  std::size_t min_variant = 0, max_variant = 0;  ///< the first ones
  std::size_t with_max = 0;                      ///< variants that have the maximum
  /// Standard deviation, and the values below which 5, 50 and 95 % of the variants are.
  double deviation = NAN, percentile_5 = NAN, median = NAN, percentile_95 = NAN;
};

struct ChosenSite {
  std::string name;
  double latitude_deg = 0, longitude_deg = 0;
  bool is_at_sea_level = false;  ///< the ground there, which may be water
};

struct StudySummary {
  std::vector<MeasureSummary> measures;
  std::vector<ChosenSite> sites;  ///< of a search: the chosen sites
  double sites_value = 0;         ///< the measure for all chosen sites together
  std::size_t equal_sites = 0;    ///< other candidates that would do as well in place of a chosen site
};

/// "3 other candidates would do as well"
std::string equalSitesText(const StudySummary& summary);

/// Writes the report: the study, extremes of each measure with their variants, each measure over each
/// parameter, and up to 500 variants as a table; of a search for sites, the chosen sites, and beside the
/// report sites.geojson with all candidates.
/// @throws Error (other) that names the file
StudySummary writeStudyReport(const std::filesystem::path& file, const StudySpec& study,
                              const StudyPlan& plan, const StudyResults& results);

}  // namespace emscape::study
