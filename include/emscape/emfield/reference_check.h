/// Compares the models with a folder of reference figures: what `emscape check DIR` runs.
///
/// A dataset is a line in the table of reference_check.cpp and a function in one of this folder's files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace emscape::emfield {

/// The largest difference of one figure from its reference, over all cases.
struct FigureCheck {
  std::string figure;  ///< "A_db"
  double tolerance = 0;
  std::string unit;  ///< of tolerance and difference; "relative" for ratios
  double max_abs_error = 0;
  int worst_line = 0;  ///< line of the case with the largest difference; 0 if all agree exactly

  bool pass() const { return max_abs_error <= tolerance; }

  /// Takes one case in. A value that is not a number counts as infinitely wrong.
  void compare(double computed, double expected, int line);
  /// The difference relative to `expected` (absolute where that is 0).
  void compareRelative(double computed, double expected, int line);
};

/// What became of one dataset. The first figure is the dataset's own; others stand beside it.
struct DatasetCheck {
  int cases = 0;
  std::vector<FigureCheck> figures;

  bool pass() const;
};

/// A dataset that is known by name.
struct ReferenceDataset {
  std::string name;  ///< of its folder or file below DIR: "itm_p2p", "radar/knife_edge_J_nu_derived.csv"
  /// @param path  DIR/name
  /// @throws Error (bad_input) with file:line for a file that is malformed
  /// Null where no model answers to it.
  DatasetCheck (*check)(const std::filesystem::path& path) = nullptr;
};

/// All datasets that are known, in the order in which they are checked.
const std::vector<ReferenceDataset>& referenceDatasets();

/// What a folder holds.
struct ReferenceFolder {
  std::vector<const ReferenceDataset*> present;  ///< known, with a model or without one
  std::vector<std::string> absent;               ///< known, not in the folder
  std::vector<std::string> unknown;              ///< in the folder, not known
};

/// @throws Error (bad_input) if it is no folder, or if no dataset that is known lies in it
ReferenceFolder lookInto(const std::filesystem::path& folder);

}  // namespace emscape::emfield
