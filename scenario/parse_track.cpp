#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>

#include "document/schema_check.h"
#include "scenario/parse_sections.h"

namespace emscape::scenario {

namespace {

constexpr int kMostFaults = 50;

/// A cell of a line, without the blanks around it.
struct Cell {
  std::string text;
  int column = 1;  ///< where it begins, in characters from 1
};

std::vector<Cell> split(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<Cell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::string_view cell = line.substr(begin, end - begin);
    const std::size_t first = std::min(cell.find_first_not_of(kBlanks), cell.size());
    const std::size_t last = cell.find_last_not_of(kBlanks);
    const std::size_t column_from = begin + (first < cell.size() ? first : 0);
    cells.push_back({std::string(first < cell.size() ? cell.substr(first, last - first + 1) : ""),
                     static_cast<int>(document::characterCount(line.substr(0, column_from))) + 1});
    begin = end + 1;
  }
  return cells;
}

class TrackReader {
 public:
  TrackReader(const std::string& file, const SourceLocation& named_at, ProblemList& problems)
      : file_(file), named_at_(named_at), problems_(problems) {}

  std::vector<TrackPoint> read(const std::string& text) {
    int number = 1;
    for (std::size_t begin = 0; begin < text.size() && faults_ <= kMostFaults; ++number) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      const std::string_view line = std::string_view(text).substr(begin, end - begin);
      begin = end + 1;
      const std::size_t first = line.find_first_not_of(" \t\r");
      if (first == std::string_view::npos || line[first] == '#') continue;
      if (columns_.empty()) {
        readHeader(split(line), number);
        if (faults_ > 0) return {};
      } else {
        readRow(split(line), number);
      }
    }
    if (columns_.empty()) {
      fault(1, 1, "the track file is empty; it begins with " + header());
    } else if (faults_ == 0 && points_.size() < 2) {
      fault(number - 1, 0, fmt::format("the track has {} rows; it needs at least 2", points_.size()));
    }
    return std::move(points_);
  }

 private:
  static std::string header() { return "a header line such as t_s,latitude_deg,longitude_deg,height_msl_m"; }

  void fault(int line, int column, const std::string& message) {
    if (++faults_ < kMostFaults) {
      problems_.addErrorElsewhere(named_at_, {file_, line, column}, message);
    } else if (faults_ == kMostFaults) {
      problems_.addErrorElsewhere(named_at_, {file_, line, column},
                                  message + " (further faults of this file are not told)");
    }
  }

  void readHeader(const std::vector<Cell>& cells, int line) {
    const ObjectSpec& spec = trackRowSpec();
    std::vector<std::string> seen;
    for (const Cell& cell : cells) {
      const KeySpec* key = spec.find(cell.text, nullptr);
      if (key == nullptr) {
        std::vector<std::string> meant;
        fault(line, cell.column, document::unknownKeyMessage(cell.text, spec, nullptr, &meant));
        seen.insert(seen.end(), meant.begin(), meant.end());
      } else if (has(seen, cell.text)) {
        fault(line, cell.column, fmt::format("column '{}' stands here twice", cell.text));
      }
      seen.push_back(cell.text);
      columns_.push_back(key);
    }
    for (const KeySpec& key : spec.keys) {
      if (key.required && !has(seen, key.name)) {
        fault(line, 1, fmt::format("missing column '{}'; write {}", key.name, header()));
      }
    }
    const auto& heights = spec.exactly_one_of.front();
    const auto count =
        std::count_if(heights.begin(), heights.end(), [&](const std::string& h) { return has(seen, h); });
    if (count != 1) {
      fault(line, 1,
            fmt::format("the track must have exactly one of the columns '{}' and '{}'", heights[0],
                        heights[1]));
    }
  }

  static bool has(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  void readRow(const std::vector<Cell>& cells, int line) {
    if (cells.size() != columns_.size()) {
      fault(line, cells[std::min(cells.size(), columns_.size() + 1) - 1].column,
            fmt::format("{} values, but the header names {} columns", cells.size(), columns_.size()));
      return;
    }
    TrackPoint point;
    bool sound = true;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto value = document::numberOf(cells[i].text);
      const std::string quoted_name = "'" + columns_[i]->name + "'";
      const std::string wrong =
          value ? document::rangeFault(quoted_name, cells[i].text, *value, columns_[i]->value)
                : fmt::format("{} must be a number ({}), not '{}'", quoted_name, columns_[i]->value.unit,
                              cells[i].text.substr(0, 40));
      if (!wrong.empty()) {
        fault(line, cells[i].column, wrong);
        sound = false;
      } else {
        store(columns_[i]->name, *value, point);
      }
    }
    if (!sound) return;
    if (!points_.empty() && point.t_s <= points_.back().t_s) {
      const auto time =
          std::find_if(columns_.begin(), columns_.end(), [](const KeySpec* k) { return k->name == "t_s"; });
      fault(line, cells[static_cast<std::size_t>(time - columns_.begin())].column,
            fmt::format("'t_s' is {}, not above the {} s of the row before", point.t_s, points_.back().t_s));
      return;
    }
    points_.push_back(point);
  }

  static void store(const std::string& column, double value, TrackPoint& point) {
    if (column == "t_s") point.t_s = value;
    if (column == "latitude_deg") point.position.latitude_deg = value;
    if (column == "longitude_deg") point.position.longitude_deg = value;
    if (column == "height_msl_m") point.position.height_msl_m = value;
    if (column == "height_agl_m") point.position.height_agl_m = value;
    if (column == "heading_deg") point.heading_deg = value;
    if (column == "pitch_deg") point.pitch_deg = value;
    if (column == "roll_deg") point.roll_deg = value;
  }

  const std::string& file_;
  const SourceLocation& named_at_;
  ProblemList& problems_;
  std::vector<const KeySpec*> columns_;
  std::vector<TrackPoint> points_;
  int faults_ = 0;
};

}  // namespace

std::vector<TrackPoint> parseTrack(const std::string& file, const std::string& bytes,
                                   const SourceLocation& named_at, ProblemList& problems) {
  try {
    return TrackReader(file, named_at, problems).read(document::checkedUtf8(file, bytes));
  } catch (const Error& error) {
    problems.addErrorElsewhere(named_at, error.place(), error.message());
    return {};
  }
}

}  // namespace emscape::scenario
