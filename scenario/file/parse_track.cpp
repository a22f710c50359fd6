#include <fmt/format.h>

#include <algorithm>

#include "document/csv.h"
#include "document/schema_check.h"
#include "emscape/base/work.h"
#include "recording/common/text.h"
#include "scenario/file/parse_sections.h"

namespace emscape::scenario {

namespace {

using document::CsvCell;
using document::CsvReader;
using document::CsvRow;

constexpr int kMaxFaults = 50;

class TrackReader {
 public:
  TrackReader(const std::string& file, const SourceLocation& named_at, ProblemList& problems)
      : file_(file), named_at_(named_at), problems_(problems) {}

  TrackFile read(const std::string& text) {
    if (isOfAnotherProgram(text)) return {};
    CsvReader reader(text);
    for (CsvRow row; faults_ <= kMaxFaults && reader.next(row);) {
      if (columns_.empty()) {
        readHeader(row.cells, row.line);
        if (faults_ > 0) return {};
      } else {
        readRow(row.cells, row.line);
      }
    }
    if (columns_.empty()) {
      fault(1, 1, "the track file is empty; it begins with " + header());
    } else if (faults_ == 0 && points_.size() < 2) {
      fault(reader.lines(), 0,
            fmt::format("the track has {} row{}; it needs at least 2", points_.size(),
                        points_.size() == 1 ? "" : "s"));
    }
    TrackFile track;
    track.points = std::move(points_);
    if (std::string unended = reader.unendedText("a row"); !unended.empty())
      track.warnings.push_back(std::move(unended));
    return track;
  }

 private:
  static std::string header() { return "a header line such as t_s,latitude_deg,longitude_deg,height_msl_m"; }

  void fault(int line, int column, const std::string& message) {
    if (++faults_ < kMaxFaults) {
      problems_.addErrorElsewhere(named_at_, {file_, line, column}, message);
    } else if (faults_ == kMaxFaults) {
      problems_.addErrorElsewhere(named_at_, {file_, line, column},
                                  message + " (further faults of this file are not reported)");
    }
  }

  /// Reports a table with columns of which none is one of the format.
  bool isOfAnotherProgram(const std::string& text) {
    CsvReader reader(text, document::separatorOf(text));
    CsvRow row;
    if (!reader.next(row) || row.cells.size() < 2) return false;
    std::string names;
    for (const CsvCell& cell : row.cells) {
      const std::string name = interop::lowerCase(std::string(cell.text));
      if (name.rfind("t_s", 0) == 0 || trackRowSpec().find(name, nullptr) != nullptr) return false;
      names += (names.empty() ? "" : ", ") + interop::printableText(std::string(cell.text));
    }
    fault(row.line, 1,
          fmt::format(
              "the table has no columns with names that are known for time and position; 'columns' of "
              "the track names them: columns: \"time=NAME,latitude=NAME,longitude=NAME,height=NAME:ft\", "
              "with position=NAME for MGRS, UTM or both coordinates in one column; where several columns "
              "make it, join them in one first. It has {}",
              names));
    return true;
  }

  void readHeader(const std::vector<CsvCell>& cells, int line) {
    if (const auto found = document::headerFault(cells)) {
      fault(line, found->column, found->message);
      return;
    }
    const ObjectSpec& spec = trackRowSpec();
    std::vector<std::string> seen;
    bool has_unknown = false;
    for (const CsvCell& cell : cells) {
      const std::string name(cell.text);
      const KeySpec* key = spec.find(name, nullptr);
      if (key == nullptr) {
        fault(line, cell.column, document::unknownKeyMessage(name, spec, nullptr));
        has_unknown = true;
      } else if (has(seen, name)) {
        fault(line, cell.column, fmt::format("column '{}' occurs twice", name));
      }
      seen.push_back(name);
      columns_.push_back(key);
    }
    if (has_unknown) return;  // they may be the missing ones
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

  void readRow(const std::vector<CsvCell>& cells, int line) {
    checkpoint();
    if (cells.size() != columns_.size()) {
      fault(line, cells[std::min(cells.size(), columns_.size() + 1) - 1].column,
            fmt::format("{} values, but the header names {} columns", cells.size(), columns_.size()));
      return;
    }
    TrackPoint point;
    bool sound = true;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string text(cells[i].text);
      const auto value = document::numberOf(text);
      const std::string quoted_name = "'" + columns_[i]->name + "'";
      const std::string wrong = value ? document::rangeFault(quoted_name, text, *value, columns_[i]->value)
                                      : fmt::format("{} must be a number ({}), not '{}'", quoted_name,
                                                    columns_[i]->value.unit, text.substr(0, 40));
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

TrackFile parseTrack(const std::string& file, const std::string& bytes, const SourceLocation& named_at,
                     ProblemList& problems) {
  const WorkPart part("reading " + file, 0, 0);
  try {
    return TrackReader(file, named_at, problems).read(document::checkedUtf8(file, bytes, "a track"));
  } catch (const Error& error) {
    problems.addErrorElsewhere(named_at, error.location(), error.message());
    return {};
  }
}

}  // namespace emscape::scenario
