#include "scenario/refractivity_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

#include "document/csv.h"
#include "document/text_file.h"
#include "emscape/base/error.h"
#include "scenario/antenna/text.h"

namespace emscape::scenario {
namespace {

using namespace propagation;
using document::CsvCell;
using document::CsvRow;

constexpr const char* kHeader = "height_msl_m and m_units or n_units, with range_m for several profiles";
constexpr double kMinN = 0, kMaxN = 500;

struct Columns {
  std::optional<std::size_t> range, height, m, n;
  std::size_t count = 0;
};

Columns columnsOf(const std::string& file, const CsvRow& header) {
  Columns columns;
  columns.count = header.cells.size();
  for (std::size_t i = 0; i < columns.count; ++i) {
    const CsvCell& cell = header.cells[i];
    std::optional<std::size_t>* column = cell.text == "range_m"        ? &columns.range
                                         : cell.text == "height_msl_m" ? &columns.height
                                         : cell.text == "m_units"      ? &columns.m
                                         : cell.text == "n_units"      ? &columns.n
                                                                       : nullptr;
    if (column == nullptr || column->has_value()) {
      throw Error(ErrorCode::bad_input, {file, header.line, cell.column},
                  fmt::format("{} column '{}'; the header has {}", column ? "second" : "unknown", cell.text,
                              kHeader));
    }
    *column = i;
  }
  if (!columns.height || columns.m.has_value() == columns.n.has_value()) {
    throw Error(ErrorCode::bad_input, {file, header.line, 1}, fmt::format("the header has {}", kHeader));
  }
  return columns;
}

/// M falls over the last 500 m of a profile of more than 1 km: as N does.
bool looksLikeN(const RefractivityProfile& profile) {
  const double top_m = profile.levels.back().height_msl_m;
  return top_m - profile.levels.front().height_msl_m > 1000 && profile.at(top_m) < profile.at(top_m - 500);
}

}  // namespace

RefractivityFile readRefractivity(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(ErrorCode::bad_input, fmt::format("{}: cannot be read", file));
  const std::string text =
      document::checkedUtf8(file, {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()});
  document::CsvReader reader(text);
  CsvRow row;
  if (!reader.next(row))
    throw Error(ErrorCode::bad_input, {file, 1, 1},
                fmt::format("the file is empty; its header has {}", kHeader));
  const Columns columns = columnsOf(file, row);

  std::vector<double> ranges_m;
  std::vector<std::vector<RefractivityLevel>> levels;
  const auto number = [&](std::size_t column, const char* name) {
    const std::optional<double> value = numberIn(row.cells[column].text);
    if (value && std::isfinite(*value)) return *value;
    throw Error(ErrorCode::bad_input, {file, row.line, row.cells[column].column},
                fmt::format("{} is '{}', not a number", name, row.cells[column].text));
  };
  const auto finish = [&] {
    if (levels.empty() || (levels.back().size() >= 2 && levels.back().size() <= 256)) return;
    throw Error(
        ErrorCode::bad_input, {file, row.line, 0},
        fmt::format("the profile that ends here has {} levels; expected 2 .. 256", levels.back().size()));
  };
  while (reader.next(row)) {
    if (row.cells.size() != columns.count) {
      throw Error(ErrorCode::bad_input, {file, row.line, row.cells.front().column},
                  fmt::format("{} values, but the header names {} columns", row.cells.size(), columns.count));
    }
    const double range_m = columns.range ? number(*columns.range, "range_m") : 0;
    if (ranges_m.empty() || range_m != ranges_m.back()) {
      finish();
      if (!ranges_m.empty() && range_m < ranges_m.back()) {
        throw Error(ErrorCode::bad_input, {file, row.line, row.cells[*columns.range].column},
                    fmt::format("range_m is {} behind {}; ranges ascend", range_m, ranges_m.back()));
      }
      ranges_m.push_back(range_m);
      levels.emplace_back();
    }
    RefractivityLevel level;
    level.height_msl_m = number(*columns.height, "height_msl_m");
    if (columns.m) {
      level.m_units = number(*columns.m, "m_units");
    } else {
      const double n = number(*columns.n, "n_units");
      if (!(n >= kMinN && n <= kMaxN)) {
        throw Error(ErrorCode::bad_input, {file, row.line, row.cells[*columns.n].column},
                    fmt::format("n_units is {}; allowed are {} to {}", n, kMinN, kMaxN));
      }
      level.m_units = n + kFlatteningGradient_m * level.height_msl_m;
    }
    levels.back().push_back(level);
    if (const std::string fault = faultOfLevel(levels.back(), levels.back().size() - 1); !fault.empty()) {
      throw Error(ErrorCode::bad_input, {file, row.line, row.cells[*columns.height].column}, fault);
    }
  }
  if (levels.empty())
    throw Error(ErrorCode::bad_input, {file, reader.lines(), 0}, "no levels; expected 2 .. 256");
  finish();

  RefractivityFile read;
  std::vector<RefractivityProfile> profiles;
  for (std::vector<RefractivityLevel>& of_profile : levels)
    profiles.push_back(profileOfLevels(std::move(of_profile)));
  if (columns.m && std::any_of(profiles.begin(), profiles.end(), looksLikeN)) {
    read.warnings.push_back(fmt::format(
        "{}: m_units falls with height at the top: these look like N-units (column n_units)", file));
  }
  read.air = RefractivityAlongPath(std::move(ranges_m), std::move(profiles));
  if (read.air.pointwise()) {
    read.warnings.push_back(
        fmt::format("{}: neighbouring profiles differ in their numbers of levels: interpolated at each "
                    "height, which shows two faint "
                    "ducts halfway between two",
                    file));
  }
  return read;
}

}  // namespace emscape::scenario
