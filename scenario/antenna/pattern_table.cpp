/// CSV tables of patterns as programs of field computation and measurement write them: columns of theta and
/// phi, or azimuth and elevation, and gain, directivity or attenuation, among others that are ignored.
///
/// A name is read without its unit, "Theta[deg]", "theta_deg" or "dB(GainTotal)[]". Theta is from the zenith,
/// phi counter-clockwise from boresight, if the maximum is nearer to theta = 90 degrees; it is from
/// boresight, phi from the left upwards, if the maximum is nearer to theta = 0.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "document/csv.h"
#include "document/text_lines.h"
#include "emscape/base/units.h"
#include "scenario/antenna/sphere.h"

namespace emscape::scenario {
namespace {

using document::CsvCell;

enum class Meaning { none, azimuth, elevation, theta, phi, gain, attenuation, frequency };

struct TableColumn {
  std::string title;  ///< as in the file
  std::string name, unit;
  Meaning meaning = Meaning::none;
  std::size_t index = 0;
};

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

/// Letters and digits only.
std::string plain(std::string_view text) {
  std::string result;
  for (const char c : lowerCase(text)) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) result += c;
  }
  return result;
}

/// "Theta [deg.]" is theta in deg, "dB(GainTotal)[]" gaintotal in db, "gain_dbi" gain in dbi.
TableColumn columnOf(const CsvCell& cell, std::size_t index) {
  TableColumn column;
  column.title = std::string(cell.text);
  column.index = index;
  std::string text = lowerCase(cell.text);
  if (const std::size_t bracket = text.find('['); bracket != std::string::npos) {
    column.unit = plain(std::string_view(text).substr(bracket));
    text.resize(bracket);
  }
  for (const char* function : {"db(", "abs(", "dir("}) {
    if (text.rfind(function, 0) != 0) continue;
    if (column.unit.empty() && text.rfind("db(", 0) == 0) column.unit = "db";
    text = text.substr(std::string_view(function).size());
    text = text.substr(0, text.find(')'));
  }
  if (const std::size_t bracket = text.find('('); bracket != std::string::npos) {
    if (column.unit.empty()) column.unit = plain(std::string_view(text).substr(bracket));
    text.resize(bracket);
  }
  if (column.unit.empty()) {
    for (const char* unit : {"_dbi", "_dbd", "_db", "_deg", "_degrees", "_rad", " dbi", " db", " deg"}) {
      const std::size_t length = std::string_view(unit).size();
      if (text.size() <= length || text.compare(text.size() - length, length, unit) != 0) continue;
      column.unit = plain(unit);
      text.resize(text.size() - length);
      break;
    }
  }
  column.name = plain(text);
  static const std::pair<const char*, Meaning> kNames[] = {
      {"azimuth", Meaning::azimuth},
      {"az", Meaning::azimuth},
      {"elevation", Meaning::elevation},
      {"el", Meaning::elevation},
      {"theta", Meaning::theta},
      {"phi", Meaning::phi},
      {"gain", Meaning::gain},
      {"gaintotal", Meaning::gain},
      {"realizedgaintotal", Meaning::gain},
      {"totalgain", Meaning::gain},
      {"realizedgain", Meaning::gain},
      {"directivity", Meaning::gain},
      {"dir", Meaning::gain},
      {"dirtotal", Meaning::gain},
      {"relativegain", Meaning::gain},
      {"normalizedgain", Meaning::gain},
      {"pattern", Meaning::gain},
      {"attenuation", Meaning::attenuation},
      {"loss", Meaning::attenuation},
      {"freq", Meaning::frequency},
      {"frequency", Meaning::frequency},
  };
  for (const auto& [name, meaning] : kNames) {
    if (column.name == name) column.meaning = meaning;
  }
  return column;
}

class PatternTable {
 public:
  explicit PatternTable(const std::string& file) : text_(file) {}

  PatternFile read() {
    const char separator = document::separatorOf(text_.text());
    document::CsvReader reader(text_.text(), separator);
    document::CsvRow row;
    if (!reader.next(row))
      throw Error(ErrorCode::bad_input, {text_.file(), 1, 1}, "no header line; " + wanted());
    line_ = row.line;
    readHeader(row.cells);
    while (reader.next(row)) {
      line_ = row.line;
      readRow(row.cells);
    }
    PatternFile pattern = made();
    if (std::string unended = reader.unendedWarning(text_.file(), "a row"); !unended.empty())
      pattern.warnings.push_back(std::move(unended));
    return pattern;
  }

 private:
  static std::string wanted() {
    return "a table of a pattern has columns such as azimuth_deg,elevation_deg,attenuation_db or "
           "theta_deg,phi_deg,gain_dbi";
  }

  [[noreturn]] void fail(const CsvCell& cell, const std::string& message) const {
    throw Error(ErrorCode::bad_input, {text_.file(), line_, cell.column}, message);
  }

  void readHeader(const std::vector<CsvCell>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const TableColumn column = columnOf(cells[i], i);
      TableColumn* const place =
          column.meaning == Meaning::azimuth || column.meaning == Meaning::phi        ? &first_
          : column.meaning == Meaning::elevation || column.meaning == Meaning::theta  ? &second_
          : column.meaning == Meaning::gain || column.meaning == Meaning::attenuation ? &value_
                                                                                      : nullptr;
      if (column.meaning == Meaning::frequency) frequency_ = i;
      if (place == nullptr) {
        ignored_.push_back(column.title);
      } else if (place->meaning == Meaning::none) {
        *place = column;
      } else if (place == &value_) {
        ignored_.push_back(column.title);
      } else {
        fail(cells[i], fmt::format("columns '{}' and '{}' are the same angle", place->title, column.title));
      }
    }
    columns_ = cells.size();
    const bool is_pair = (first_.meaning == Meaning::azimuth && second_.meaning == Meaning::elevation) ||
                         (first_.meaning == Meaning::phi && second_.meaning == Meaning::theta);
    if (!is_pair || value_.meaning == Meaning::none) {
      std::string titles;
      for (const CsvCell& cell : cells)
        titles += (titles.empty() ? "'" : ", '") + std::string(cell.text) + "'";
      fail(cells.front(), fmt::format("{} among the columns {}; {}",
                                      !is_pair ? "no pair of angles" : "no gain, directivity or attenuation",
                                      titles, wanted()));
    }
  }

  void readRow(const std::vector<CsvCell>& cells) {
    if (cells.size() != columns_)
      fail(cells.front(), fmt::format("{} values, but the header names {} columns", cells.size(), columns_));
    SphereRow row;
    row.line = line_;
    row.first_deg = angleIn(cells[first_.index], first_, 360);
    row.second_deg = angleIn(cells[second_.index], second_, second_.meaning == Meaning::elevation ? 90 : 180);
    const CsvCell& cell = cells[value_.index];
    row.gain_db = numberIn(cell, value_);
    if (std::abs(row.gain_db) > kMaxAttenuation_db) {
      fail(cell, fmt::format("{} is {}; allowed are -{} to {} dB", value_.title, row.gain_db,
                             kMaxAttenuation_db, kMaxAttenuation_db));
    }
    if (value_.meaning == Meaning::attenuation && row.gain_db < 0)
      fail(cell,
           fmt::format("{} is {}; attenuations are 0 or above: is it gain_db?", value_.title, row.gain_db));
    if (frequency_) frequencies_.insert(std::string(cells[*frequency_].text));
    rows_.push_back(row);
  }

  double numberIn(const CsvCell& cell, const TableColumn& column) const {
    const std::optional<double> value = document::numberOrCommaIn(cell.text);
    if (!value) fail(cell, fmt::format("{} is '{}', not a number", column.title, cell.text));
    return *value;
  }

  double angleIn(const CsvCell& cell, const TableColumn& column, double limit_deg) const {
    const double value = numberIn(cell, column);
    const double angle_deg = column.unit.rfind("rad", 0) == 0 ? radToDeg(value) : value;
    if (std::abs(angle_deg) > limit_deg + 1e-6) {
      fail(cell, fmt::format("{} is {:g} deg; allowed are -{} to {} deg", column.title, angle_deg, limit_deg,
                             limit_deg));
    }
    return angle_deg;
  }

  PatternFile made() {
    const SourceLocation file{text_.file(), 0, 0};
    if (rows_.empty()) throw Error(ErrorCode::bad_input, file, "the pattern has no rows");
    if (frequencies_.size() > 1) {
      throw Error(ErrorCode::bad_input, file,
                  fmt::format("the table has {} frequencies; give the rows of one", frequencies_.size()));
    }
    PatternFile pattern;
    pattern.format = "table of a pattern";
    pattern.name = "measured pattern";
    noteIgnored(pattern, "columns", ignored_);
    const auto by_value = [](const SphereRow& a, const SphereRow& b) { return a.gain_db < b.gain_db; };
    double max_db = std::max_element(rows_.begin(), rows_.end(), by_value)->gain_db;
    const double min_db = std::min_element(rows_.begin(), rows_.end(), by_value)->gain_db;
    if (value_.meaning == Meaning::attenuation) {
      requireMaximum(min_db, file, "table");
      for (SphereRow& row : rows_) row.gain_db = -row.gain_db;
      max_db = -min_db;
    } else {
      readGain(pattern, min_db, max_db);
    }
    SphereAngles angles = SphereAngles::azimuth_elevation;
    if (second_.meaning == Meaning::theta) {
      const double theta_deg = std::abs(std::max_element(rows_.begin(), rows_.end(), by_value)->second_deg);
      angles = theta_deg < 45 ? SphereAngles::theta_from_boresight : SphereAngles::theta_from_zenith;
      pattern.notes.push_back(
          theta_deg < 45
              ? "the maximum is near theta = 0: theta is from boresight, phi from the left, 0, upwards, 90"
              : "the maximum is not near theta = 0: theta is from the zenith, phi counter-clockwise from "
                "boresight");
    } else {
      pattern.notes.push_back("azimuth is clockwise from boresight, elevation upwards");
    }
    fillFromSphere(angles, std::move(rows_), text_.file(), pattern);
    return pattern;
  }

  void readGain(PatternFile& pattern, double min_db, double max_db) const {
    constexpr double kRelative_db = 0.05;  // the maximum of gains relative to it
    const bool has_unit = value_.unit.rfind("db", 0) == 0;
    if (!has_unit && min_db >= 0 && max_db <= 1) {
      throw Error(
          ErrorCode::bad_input, {text_.file(), 0, 0},
          fmt::format("all values of '{}' are from 0 to 1, as those of a linear gain; give them in dB "
                      "and name the column gain_db or gain_dbi",
                      value_.title));
    }
    // Averaged over all directions no gain is above 0 dBi.
    constexpr double kHighest_db = 75, kWhole_deg = 170;
    const auto by_angle = [](const SphereRow& a, const SphereRow& b) { return a.second_deg < b.second_deg; };
    const auto [lowest, highest] = std::minmax_element(rows_.begin(), rows_.end(), by_angle);
    const bool is_whole = highest->second_deg - lowest->second_deg >= kWhole_deg;
    if (!has_unit && min_db >= 0 && (is_whole || max_db > kHighest_db)) {
      throw Error(
          ErrorCode::bad_input, {text_.file(), 0, 0},
          fmt::format("the values of '{}' have no unit, are never below 0 and reach {:.4g}, as those of "
                      "a linear gain; give them in dB and name the column gain_db or gain_dbi",
                      value_.title, max_db));
    }
    if (!has_unit)
      pattern.warnings.push_back(text_.file() + ": '" + value_.title + "' has no unit; taken as dB");
    if (value_.unit == "dbi") {
      pattern.gain_dbi = max_db;
    } else if (value_.unit == "dbd") {
      pattern.gain_dbi = max_db + kDipoleGain_dbi;
    } else if (std::abs(max_db) > kRelative_db) {
      pattern.gain_dbi = max_db;
      pattern.notes.push_back(fmt::format("the largest value of '{}', {:g} dB, is taken as the gain in dBi",
                                          value_.title, max_db));
    }
    if (value_.name.rfind("dir", 0) == 0)
      pattern.notes.push_back("the directivity is taken as the gain: the antenna is without losses");
  }

  const document::TextLines text_;
  int line_ = 0;
  std::size_t columns_ = 0;
  TableColumn first_, second_, value_;
  std::optional<std::size_t> frequency_;
  std::set<std::string> frequencies_;
  std::vector<SphereRow> rows_;
  std::vector<std::string> ignored_;
};

}  // namespace

PatternFile readTablePattern(const std::string& file) {
  return PatternTable(file).read();
}

}  // namespace emscape::scenario
