#include "emfield/check/reference_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include "base/files/file_reading.h"
#include "document/csv.h"
#include "emscape/base/log.h"
#include "emscape/base/work.h"

namespace emscape::emfield {
namespace {

struct Line {
  int number;
  std::vector<std::string> cells;
};

/// The lines of a file that are neither blank nor comments, cut at commas.
std::vector<Line> readLines(const std::filesystem::path& file) {
  const std::string text = readWholeText(file);
  document::CsvReader reader(text, document::separatorOf(text));
  std::vector<Line> lines;
  for (document::CsvRow row; reader.next(row);) {
    lines.push_back({row.line, {}});
    for (const document::CsvCell& cell : row.cells) lines.back().cells.emplace_back(cell.text);
  }
  if (const std::string unended = reader.unendedWarning(file.string(), "a row"); !unended.empty())
    logWarning(unended);
  return lines;
}

double parseNumber(const std::string& cell, const SourceLocation& location, std::string_view what) {
  double value = 0;
  const char* end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(cell.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    throw Error(ErrorCode::bad_input, location, fmt::format("{}: '{}' is not a finite number", what, cell));
  }
  return value;
}

}  // namespace

ReferenceTable::ReferenceTable(const std::filesystem::path& file,
                               const std::vector<std::string_view>& columns)
    : file_(file.string()) {
  std::vector<Line> lines = readLines(file);
  if (lines.size() < 2) {
    throw Error(ErrorCode::bad_input, {file_, 0, 0},
                "no cases; expected column names and a row for each case");
  }
  names_ = lines.front().cells;
  for (const std::string_view column : columns) {
    if (!hasColumn(column)) {
      throw Error(ErrorCode::bad_input, {file_, lines.front().number, 0},
                  fmt::format("column '{}' is missing", column));
    }
  }
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].cells.size() != names_.size()) {
      throw Error(ErrorCode::bad_input, {file_, lines[i].number, 0},
                  fmt::format("{} cells where the first line names {} columns", lines[i].cells.size(),
                              names_.size()));
    }
    rows_.push_back({lines[i].number, std::move(lines[i].cells)});
  }
}

double ReferenceTable::number(int row, std::string_view column) const {
  return parseNumber(text(row, column), location(row), column);
}

bool ReferenceTable::hasColumn(std::string_view column) const {
  return std::find(names_.begin(), names_.end(), column) != names_.end();
}

int ReferenceTable::integer(int row, std::string_view column) const {
  const double value = number(row, column);
  if (value != std::trunc(value) || std::fabs(value) > 1e9) {
    throw Error(ErrorCode::bad_input, location(row),
                fmt::format("{}: '{}' is not a whole number", column, text(row, column)));
  }
  return static_cast<int>(value);
}

const std::string& ReferenceTable::text(int row, std::string_view column) const {
  checkpoint();  // of the loops over rows
  const auto name = std::find(names_.begin(), names_.end(), column);
  if (name == names_.end()) {
    throw Error(ErrorCode::bad_input, {file_, 1, 0}, fmt::format("column '{}' is missing", column));
  }
  return rows_.at(static_cast<std::size_t>(row)).cells[static_cast<std::size_t>(name - names_.begin())];
}

SourceLocation ReferenceTable::location(int row) const {
  return {file_, rows_.at(static_cast<std::size_t>(row)).line, 0};
}

std::vector<ReferenceProfile> readReferenceProfiles(const std::filesystem::path& file) {
  std::vector<ReferenceProfile> profiles;
  for (const Line& line : readLines(file)) {
    const SourceLocation location{file.string(), line.number, 0};
    const double intervals = parseNumber(line.cells[0], location, "n_intervals");
    if (!(intervals >= 1) || line.cells.size() != intervals + 3) {
      throw Error(ErrorCode::bad_input, location,
                  fmt::format("n_intervals is {} but {} heights follow; expected one more than intervals",
                              line.cells[0], static_cast<long long>(line.cells.size()) - 2));
    }
    ReferenceProfile& profile = profiles.emplace_back();
    profile.step_m = parseNumber(line.cells[1], location, "step_m");
    if (profile.step_m <= 0) {
      throw Error(ErrorCode::bad_input, location, fmt::format("step_m: {} is not above 0 m", profile.step_m));
    }
    for (std::size_t i = 2; i < line.cells.size(); ++i) {
      profile.heights_msl_m.push_back(parseNumber(line.cells[i], location, fmt::format("h_{}", i - 2)));
    }
  }
  return profiles;
}

}  // namespace emscape::emfield
