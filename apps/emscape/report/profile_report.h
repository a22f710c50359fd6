/// Output of `emscape profile`: a table or JSON.
#pragma once

#include <string>
#include <vector>

#include "apps/emscape/common/console.h"
#include "emscape/emfield/link/path_budget.h"

namespace emscape::app {

/// The path by another model, or the reason of its refusal.
struct Comparison {
  propagation::PropagationModel model = propagation::PropagationModel::free_space;
  std::string refusal;  ///< empty: the budget is valid
  emfield::PathBudget budget;
};

struct ProfileReport {
  std::string scenario;
  std::string time_utc;
  scenario::Emitter emitter;
  emfield::PathBudget budget;
  std::vector<Comparison> compared;
};

/// The keys are documented in docs/command-line.md. null: no field (shadow of `horizon`).
Json toJson(const ProfileReport& report);
void printAsTable(const ProfileReport& report);

}  // namespace emscape::app
