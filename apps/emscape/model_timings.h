/// How fast the propagation models are on one core.
#pragma once

#include <string>
#include <vector>

namespace emscape::app {

/// Evaluations a second of one model in one case.
struct ModelTiming {
  std::string model;
  std::string what;  ///< what one evaluation is
  double evaluations_per_s = 0;
  double ratio = 0;  ///< against `ratio_to`, from the same run; 0: compared with nothing
  std::string ratio_to;
};

/// A plane of delta-Bullington, kPlaneRanges x kPlaneHeights, in one walk and path by path.
struct PlaneTiming {
  int posts = 0;         ///< of the terrain profile
  double top_msl_m = 0;  ///< of the heights
  double paths_ms = 0;
  double plane_ms = 0;
  double largest_difference_db = 0;

  double ratio() const { return paths_ms / plane_ms; }
};

constexpr int kPlaneRanges = 200, kPlaneHeights = 100;
constexpr int kItmPosts = 300;

/// All models, CPU time of the calling thread, the fastest of `repeats` runs.
std::vector<ModelTiming> timeModels(int repeats);
/// In double precision.
std::vector<PlaneTiming> timePlanes(int repeats);

}  // namespace emscape::app
