/// Tables of reference figures: text separated by commas, semicolons or tabs, with a line of column names.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "emscape/base/error.h"

namespace emscape::emfield {

/// A file of reference cases, one per row. Every error names file and line.
class ReferenceTable {
 public:
  /// @param columns  required names; the file may have other columns
  /// @throws Error (bad_input) if the file cannot be read, a column is missing, a row has too many or too few
  /// cells, or if there is no row
  ReferenceTable(const std::filesystem::path& file, const std::vector<std::string_view>& columns);

  bool hasColumn(std::string_view column) const;
  /// Names of the columns, in the file's order.
  const std::vector<std::string>& columns() const { return names_; }
  int rows() const { return static_cast<int>(rows_.size()); }
  /// @param row     0..rows() - 1
  /// @param column  one of the names in the first line
  /// @throws Error (bad_input) if the column is missing or the cell is not a finite number
  double number(int row, std::string_view column) const;
  /// @throws Error (bad_input) also if it is not a whole number
  int integer(int row, std::string_view column) const;
  const std::string& text(int row, std::string_view column) const;
  /// The cell is not empty.
  bool has(int row, std::string_view column) const { return !text(row, column).empty(); }
  /// Of a row, for messages.
  SourceLocation location(int row) const;

 private:
  struct Row {
    int line;
    std::vector<std::string> cells;
  };
  std::string file_;
  std::vector<std::string> names_;
  std::vector<Row> rows_;
};

/// A terrain profile of evenly spaced posts.
struct ReferenceProfile {
  double step_m = 0;
  std::vector<double> heights_msl_m;
};

/// Reads profiles.csv: no names, one profile per row: n_intervals, step_m, h_0, ..., h_n.
/// @throws Error (bad_input) that names file and line
std::vector<ReferenceProfile> readReferenceProfiles(const std::filesystem::path& file);

}  // namespace emscape::emfield
