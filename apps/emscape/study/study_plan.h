/// A loaded study and its plan.
#pragma once

#include <string>
#include <vector>

#include "apps/emscape/common/command.h"
#include "apps/emscape/version.h"
#include "study/sweep/study_plan.h"

namespace emscape::app {

/// A study with everything derived from its file.
struct LoadedStudy {
  study::StudySpec spec;
  scenario::TerrainPtr terrain;
  study::StudyPlan plan;

  /// @param tries_values  see loadStudy()
  LoadedStudy(const std::string& file, const std::vector<scenario::Edit>& edits, bool tries_values)
      : spec(study::loadStudy(file, edits, kVersion, tries_values)),
        terrain(study::loadTerrain(*spec.base, spec.area)),
        plan(study::planStudy(spec, terrain)) {}
  LoadedStudy(const LoadedStudy&) = delete;
  LoadedStudy& operator=(const LoadedStudy&) = delete;
};

/// @throws Error (usage) unless the number of parts is between 1 and the number of variants
void checkParts(int parts, std::size_t variants);

/// Prints the plan, with the measured time of one variant of each kind.
/// @param loading_s  time that loading the study took
/// @return the exit status
int showPlan(const LoadedStudy& loaded, int parts, int jobs, double loading_s, const GlobalOptions& global);

}  // namespace emscape::app
