/// Compares the models with reference data, for `emscape check DIR`.
///
/// Each dataset has a row in the table of reference_check.cpp and a function in a file of emfield/check/.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace emscape::emfield {

/// The largest difference of one quantity from its reference, over all cases.
struct FigureCheck {
  std::string figure;  ///< "A_db"
  double tolerance = 0;
  std::string unit;  ///< of tolerance and difference; "relative" for ratios
  double max_abs_error = 0;
  int worst_line = 0;  ///< line of the case with the largest difference; 0 if all agree exactly

  bool pass() const { return max_abs_error <= tolerance; }

  /// Adds one case. A NaN counts as an infinite difference.
  void compare(double computed, double expected, int line);
  /// The difference relative to `expected` (absolute where that is 0).
  void compareRelative(double computed, double expected, int line);
};

/// Result of one dataset. The first figure is the dataset's main one; others are additional.
struct DatasetCheck {
  int cases = 0;
  std::vector<FigureCheck> figures;

  bool pass() const;
};

/// A known dataset.
struct ReferenceDataset {
  std::string name;  ///< of its folder or file below DIR: "itm_p2p", "radar/knife_edge_J_nu_derived.csv"
  /// @param path  of the folder or file
  /// @throws Error (bad_input) with file:line for a file that is malformed
  /// Null if there is no model for it.
  DatasetCheck (*check)(const std::filesystem::path& path) = nullptr;
};

/// All datasets that are known, in the order in which they are checked.
const std::vector<ReferenceDataset>& referenceDatasets();

/// The datasets of a folder.
struct ReferenceFolder {
  std::filesystem::path root;                    ///< to which the names are relative
  std::vector<const ReferenceDataset*> present;  ///< known; some have no model
  std::vector<std::string> absent;               ///< known, not in the folder
  std::vector<std::string> unknown;              ///< in the folder, not known
};

/// @param folder  the folder of all datasets, or of one family, such as "reference/radar": names then begin
/// with the family
/// @throws Error (bad_input) if it is not a folder, or if it contains no known dataset
ReferenceFolder findDatasets(const std::filesystem::path& folder);

}  // namespace emscape::emfield
