/// A comparison of two scenarios as a table, JSON and sections of a report.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "report/json.h"
#include "report/maps/map_options.h"
#include "study/compare/compare.h"
#include "study/report/map_folder.h"

namespace emscape::report {

/// @param maps  of A, of which the folder is to have the changes
/// @throws Error (usage) as MapFolder::requireReplaceable()
void requireReplaceable(const study::MapFolder& folder, const std::vector<study::CoverageMap>& maps);

/// A comparison of two scenarios whose maps and report are written into a folder.
class ScenarioComparison {
 public:
  /// Checks everything that can be checked before the work.
  /// @param maps    names and values as on the command line
  /// @param areas   of changed areas that are explained, for gained and lost each
  /// @param name_b  of B in the report's title
  /// @throws Error (usage, bad_input)
  ScenarioComparison(std::shared_ptr<const scenario::Scenario> a, std::shared_ptr<const scenario::Scenario> b,
                     const MapOptions& maps, int areas, const std::string& folder, const std::string& name_b);

  const study::ComparedScenario& a() const { return a_; }
  const study::ComparedScenario& b() const { return b_; }
  const study::MapGrid& grid() const { return *grid_; }
  const study::CoverageRequest& request() const { return request_.coverage; }

  study::Comparison compute(const emfield::FieldOptions& options, const ProgressSink& progress);
  /// Logs the warnings and completes the folder. @return the text of report.json
  std::string finish(const study::Comparison& comparison);

 private:
  study::ComparedScenario a_, b_;
  study::CompareRequest request_;
  std::shared_ptr<const study::MapGrid> grid_;
  std::unique_ptr<study::MapFolder> folder_;
};

/// Logs the warnings and completes the folder of a comparison. @return the text of report.json
std::string finishComparison(study::MapFolder& folder, const study::Comparison& comparison,
                             const study::ComparedScenario& a, const study::ComparedScenario& b,
                             const std::string& quantity);

std::string comparisonText(const study::Comparison& comparison, const std::string& quantity);

}  // namespace emscape::report
