/// Speed of the propagation models on one core.
#pragma once

#include <string>
#include <vector>

namespace emscape::app {

/// Evaluations a second of one model in one case.
struct ModelTiming {
  std::string model;
  std::string what;  ///< description of one evaluation
  double evaluations_per_s = 0;
  double ratio = 0;  ///< of this speed to that of `ratio_to`, in the same run; 0: none
  std::string ratio_to;
};

/// Delta-Bullington over kColumnCount columns of kColumnHeights receivers along a profile: columns at once,
/// as the field computes them, and path by path.
struct ColumnTiming {
  int posts = 0;         ///< of the terrain profile
  double top_msl_m = 0;  ///< of the heights
  double paths_ms = 0;
  double columns_ms = 0;
  double max_difference_db = 0;

  double ratio() const { return paths_ms / columns_ms; }
};

constexpr int kColumnCount = 200, kColumnHeights = 100;
constexpr int kItmPosts = 300;

/// Times all models: CPU time of the calling thread, fastest of `repeats` runs.
std::vector<ModelTiming> timeModels(int repeats);
/// Times the columns in single precision.
std::vector<ColumnTiming> timeColumns(int repeats);

}  // namespace emscape::app
