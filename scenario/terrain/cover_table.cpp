#include "scenario/terrain/cover_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "base/files/file_reading.h"
#include "document/csv.h"
#include "document/text_file.h"
#include "document/text_lines.h"
#include "emscape/scenario/terrain/land_cover.h"

namespace emscape::scenario {
namespace {

using document::CsvCell;
using document::CsvRow;

constexpr std::size_t kMaxCoverTableBytes = std::size_t{1} << 20;
constexpr std::size_t kMaxClasses = 250;
constexpr double kMaxClutter_m = 100;
constexpr const char* kColumns[] = {"code", "name", "clutter_height_m", "zone", "land", "color"};

/// Reads the rows of one table.
class TableReader {
 public:
  TableReader(const std::string& file, std::string_view text)
      : file_(file), reader_(text, document::separatorOf(text)) {}

  std::vector<CoverClass> read() {
    CsvRow header;
    if (!reader_.next(header)) fail({file_, 0, 0}, "is empty; " + expected());
    for (const char* const column : kColumns) {
      const auto cell = std::find_if(header.cells.begin(), header.cells.end(),
                                     [&](const CsvCell& each) { return each.text == column; });
      if (cell == header.cells.end())
        fail({file_, header.line, 1}, fmt::format("there is no column '{}'; {}", column, expected()));
      places_.push_back(static_cast<std::size_t>(cell - header.cells.begin()));
    }
    std::vector<CoverClass> classes;
    std::set<int> codes;
    while (reader_.next(row_)) {
      if (row_.cells.size() != header.cells.size())
        fail({file_, row_.line, 1},
             fmt::format("the row has {} cells; the header has {}", row_.cells.size(), header.cells.size()));
      classes.push_back(readClass());
      if (!codes.insert(classes.back().code).second)
        fail(locationOf(0), fmt::format("code {} has a row already", classes.back().code));
      if (classes.size() > kMaxClasses) fail(locationOf(0), fmt::format("more than {} classes", kMaxClasses));
    }
    if (classes.empty()) fail({file_, header.line, 1}, "there is no class; " + expected());
    return classes;
  }

 private:
  static std::string expected() {
    return "a table of classes has the columns code,name,clutter_height_m,zone,land,color";
  }
  [[noreturn]] static void fail(const SourceLocation& location, const std::string& problem) {
    throw Error(ErrorCode::bad_input, location, problem);
  }
  const CsvCell& cell(std::size_t column) const { return row_.cells[places_[column]]; }
  SourceLocation locationOf(std::size_t column) const { return {file_, row_.line, cell(column).column}; }

  CoverClass readClass() const {
    CoverClass read;
    const std::optional<double> code = document::numberIn(cell(0).text);
    if (!code || *code != static_cast<int>(*code) || *code < 0 || *code > 65535)
      fail(locationOf(0), fmt::format("code '{}' is not a whole number from 0 to 65535", cell(0).text));
    read.code = static_cast<int>(*code);
    read.name = cell(1).text;
    const std::optional<double> height_m = document::numberOrCommaIn(cell(2).text);
    if (!height_m || !(*height_m >= 0 && *height_m <= kMaxClutter_m))
      fail(locationOf(2),
           fmt::format("clutter_height_m '{}' is not within 0 to {:g} m", cell(2).text, kMaxClutter_m));
    read.clutter_height_m = *height_m;
    read.zone = choice<CoverZone>(3);
    if (!cell(4).text.empty()) read.kind = choice<LandKind>(4);
    read.color = color();
    return read;
  }

  template <class Enum>
  Enum choice(std::size_t column) const {
    std::string known;
    int value = 0;
    for (const char* const name : namesOf(Enum())) {
      if (cell(column).text == name) return static_cast<Enum>(value);
      known += (value++ > 0 ? ", " : "") + std::string(name);
    }
    fail(locationOf(column),
         fmt::format("{} '{}' is not one of {}", kColumns[column], cell(column).text, known));
  }

  std::uint32_t color() const {
    const std::string_view text = cell(5).text;
    const bool is_color = text.size() == 7 && text[0] == '#' &&
                          text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string_view::npos;
    if (!is_color) fail(locationOf(5), fmt::format("color '{}' is not of the form #rrggbb", text));
    const auto rgb = static_cast<std::uint32_t>(std::stoul(std::string(text.substr(1)), nullptr, 16));
    return 0xFF000000U | (rgb & 0xFFU) << 16 | (rgb & 0xFF00U) | rgb >> 16;
  }

  const std::string& file_;
  document::CsvReader reader_;
  std::vector<std::size_t> places_;  ///< of kColumns
  CsvRow row_;
};

}  // namespace

std::vector<CoverClass> readCoverTable(const std::string& file) {
  const std::string text =
      document::checkedUtf8(file, readWholeText(file, kMaxCoverTableBytes), "a table of classes");
  return TableReader(file, text).read();
}

const std::vector<CoverClass>& coverTable(CoverTable table) {
  static const std::vector<std::vector<CoverClass>> tables = [] {
    std::vector<std::vector<CoverClass>> all;
    for (const char* const name : namesOf(CoverTable()))
      all.push_back(TableReader(name, kCoverTables[all.size()]).read());
    return all;
  }();
  return tables[static_cast<std::size_t>(table)];
}

}  // namespace emscape::scenario
