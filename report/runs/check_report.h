/// The propagation models against reference figures, as JSON and text.
#pragma once

#include <string>
#include <vector>

#include "emfield/check/reference_check.h"
#include "emscape/base/progress.h"
#include "report/json.h"

namespace emscape::report {

struct CheckReport {
  /// A dataset that was run.
  struct Outcome {
    const emfield::ReferenceDataset* dataset;
    emfield::DatasetCheck check;
  };
  emfield::ReferenceFolder folder;
  std::vector<Outcome> checked;
  std::vector<std::string> not_checked;  ///< datasets without a model
  struct Unreadable {
    std::string name, fault;
  };
  std::vector<Unreadable> unreadable;

  /// True if datasets were run, all were readable and are within their tolerances.
  bool pass() const;
};

/// Runs the datasets of a folder. @param progress  called before each; an exception that it throws ends the
/// work
/// @throws Error (bad_input) for a folder without known datasets
CheckReport checkReport(const std::string& folder, const ProgressSink& progress);
Json toJson(const CheckReport& report);
std::string checkText(const CheckReport& report);

}  // namespace emscape::report
