/// Output of `emscape profile`: a table or JSON.
#pragma once

#include <string>
#include <vector>

#include "emscape/emfield/link/path_budget.h"
#include "emscape/render/picture/image.h"
#include "emscape/scenario/model/snapshot.h"
#include "report/json.h"

namespace emscape::report {

/// The path by another model, or the reason of its refusal.
struct Comparison {
  propagation::PropagationModel model = propagation::PropagationModel::free_space;
  std::string refusal;  ///< empty: the budget is valid
  emfield::PathBudget budget;
};

struct ProfileReport {
  std::string scenario;         ///< its file, as it was named
  scenario::Snapshot snapshot;  ///< its last platform is the point
  scenario::TerrainPtr terrain;
  int emitter = 0;
  emfield::PathBudget budget;
  std::vector<Comparison> compared;
};

/// A point, an emitter, and the models whose paths are compared with that of the emitter's own.
struct ProfileRequest {
  int emitter = 0;
  scenario::SitePosition to;
  double time_s = 0;
  std::vector<propagation::PropagationModel> models;
  std::string option = "--to",
              agl_option = "--agl";  ///< of the point and of heights above ground, in messages
};

/// Explains the path from an emitter to a point. @param file  of the scenario, for the report
/// @throws Error (bad_input) for a point below the ground and a path over missing terrain
ProfileReport profileReport(const std::string& file, const scenario::Scenario& scenario,
                            const ProfileRequest& request);

/// The keys are documented in docs/command-line.md. null: no field (shadow of `horizon`).
Json toJson(const ProfileReport& report);
std::string profileText(const ProfileReport& report);
/// Draws the loss over range and height if one of the models provides it, otherwise the path over the
/// terrain.
/// @throws Error (other) naming the file
void plotPath(const ProfileReport& report, render::ImageSize size, const std::string& file);

}  // namespace emscape::report
