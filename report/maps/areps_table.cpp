#include "report/maps/areps_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/files/file_reading.h"
#include "emscape/base/error.h"
#include "recording/common/text.h"
#include "report/maps/areps_files.h"

namespace emscape::report {
namespace {

constexpr std::uintmax_t kMaxArepsBytes = std::uintmax_t{256} << 20;
constexpr double kMaxCount = 10000;  ///< of ranges, and of heights
constexpr double kCentibels = 10;

class ArepsReader {
 public:
  ArepsReader(const std::string& file, const std::string& text) : file_(file), lines_(text) {}

  ArepsTable read() {
    for (std::string line; std::getline(lines_, line);) {
      ++line_;
      const std::string_view text = interop::trimmed(std::string_view(line).substr(0, line.find('#')));
      if (text.empty()) continue;
      if (text.front() == '[') {
        is_loss_ = interop::lowerCase(std::string(text)) == "[apm loss data]";
      } else if (const std::size_t at = text.find('='); at != std::string_view::npos) {
        takeKey(interop::lowerCase(std::string(interop::trimmed(text.substr(0, at)))), text.substr(at + 1));
      } else if (is_loss_) {
        takeRow(text);
      }
    }
    return finish();
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(ErrorCode::bad_input, {file_, line_, 0}, reason);
  }

  void takeKey(const std::string& key, std::string_view value) {
    // A unit may follow the number.
    value = interop::trimmed(value);
    const auto number = interop::numberIn(value.substr(0, value.find_first_of(" \t")));
    if (!number) return;
    if (is_loss_ && (key == "invalidvalue" || key == "groundvalue")) without_value_.push_back(*number);
    if (key == "bearing angle" || key == "bearing") table_.bearing_deg = *number;
    if (key == "rmax") table_.max_range_m = *number;
    if (key == "hmin") table_.min_height_m = *number;
    if (key == "hmax") table_.max_height_m = *number;
    if (key == "nrout") table_.ranges = countIn(key, *number);
    if (key == "nzout") steps_ = countIn(key, *number);
  }

  int countIn(const std::string& key, double number) const {
    if (number < 1 || number > kMaxCount || number != std::floor(number))
      fail(fmt::format("'{}' is {:g}, not a whole number of 1 to {:g}", key, number, kMaxCount));
    return static_cast<int>(number);
  }

  void takeRow(std::string_view text) {
    for (const std::string& word : interop::wordsOf(text)) {
      const auto value = interop::numberIn(word);
      if (!value) return;  // "Height(m) ..." above the rows
      if (table_.loss_db.size() >= kMaxCount * kMaxCount) fail("more losses than ranges and heights can be");
      const bool is_told =
          std::find(without_value_.begin(), without_value_.end(), *value) == without_value_.end();
      table_.loss_db.push_back(is_told ? static_cast<float>(*value / kCentibels) : std::nanf(""));
    }
  }

  ArepsTable finish() {
    const char* const missing = table_.ranges == 0          ? "Nrout"
                                : steps_ == 0               ? "Nzout"
                                : !(table_.max_range_m > 0) ? "Rmax"
                                : table_.loss_db.empty()    ? "the section [Apm Loss Data]"
                                                            : nullptr;
    if (missing != nullptr)
      fail(fmt::format("{} is missing: this is no text file of AREPS, or one without losses", missing));
    const auto width = static_cast<std::size_t>(table_.ranges), rows = table_.loss_db.size() / width;
    // Programs write one row more than Nzout says, for the lowest height.
    if (table_.loss_db.size() % width != 0 || (rows != steps_ && rows != steps_ + 1) || rows < 2) {
      fail(fmt::format("{} losses are not Nrout x (Nzout + 1) = {} x {}", table_.loss_db.size(), width,
                       steps_ + 1));
    }
    if (!(table_.max_height_m > table_.min_height_m)) fail("Hmax is not above Hmin");
    table_.heights = static_cast<int>(rows);
    return std::move(table_);
  }

  const std::string& file_;
  std::istringstream lines_;
  int line_ = 0;
  bool is_loss_ = false;
  std::size_t steps_ = 0;
  std::vector<double> without_value_{-32766, -32767};
  ArepsTable table_ = [] {
    ArepsTable empty;
    empty.bearing_deg = std::nan("");
    return empty;
  }();
};

}  // namespace

double ArepsTable::at_db(double range_m, double height_m) const {
  // Points that are rounded out of the table are at its edge.
  constexpr double kRounding = 1e-6;
  const double x = range_m / max_range_m * ranges - 1;
  const double y = (height_m - min_height_m) / (max_height_m - min_height_m) * (heights - 1);
  if (!(x >= -kRounding && x <= ranges - 1 + kRounding && y >= -kRounding && y <= heights - 1 + kRounding))
    return std::nan("");
  const auto cellOf = [](double at, int count, double& part) {
    const double first = std::clamp(std::floor(at + kRounding), 0.0, std::max(count - 2.0, 0.0));
    part = std::clamp(at - first, 0.0, 1.0);
    if (part < kRounding) part = 0;
    if (part > 1 - kRounding) part = 1;
    return static_cast<std::size_t>(first);
  };
  double u = 0, v = 0;
  const std::size_t i = cellOf(x, ranges, u), k = cellOf(y, heights, v);
  double sum_db = 0;
  for (const std::size_t row : {std::size_t{0}, std::size_t{1}}) {
    for (const std::size_t column : {std::size_t{0}, std::size_t{1}}) {
      const double weight = (row == 0 ? 1 - v : v) * (column == 0 ? 1 - u : u);
      if (weight > 0) sum_db += weight * loss_db[(k + row) * static_cast<std::size_t>(ranges) + i + column];
    }
  }
  return sum_db;
}

ArepsTable parseAreps(const std::string& file, const std::string& text) {
  return ArepsReader(file, text).read();
}

ArepsTable readAreps(const std::string& file) {
  return parseAreps(file, readWholeText(file, kMaxArepsBytes));
}

ArepsComparison compareAreps(const study::VerticalDiagram& diagram, const scenario::Scenario& scenario,
                             const ArepsTable& table) {
  ArepsComparison result;
  double sum_db = 0, squares_db2 = 0;
  const std::size_t width = diagram.ranges_m.size();
  for (std::size_t k = 0; k < diagram.heights_m.size(); ++k) {
    for (std::size_t i = 0; i < width; ++i) {
      const double ours_db = arepsLoss_db(diagram, scenario, diagram.cuts.front().values[k * width + i]);
      const double theirs_db = table.at_db(diagram.ranges_m[i], diagram.heights_m[k]);
      const bool has_ours = std::isfinite(ours_db), has_theirs = std::isfinite(theirs_db);
      if (has_ours && !has_theirs) ++result.only_ours;
      if (has_theirs && !has_ours) ++result.only_theirs;
      if (!has_ours || !has_theirs) continue;
      const double difference_db = ours_db - theirs_db;
      ++result.points;
      sum_db += difference_db;
      squares_db2 += difference_db * difference_db;
      if (result.points > 1 && std::abs(difference_db) <= std::abs(result.largest_db)) continue;
      result.largest_db = difference_db;
      result.range_m = diagram.ranges_m[i];
      result.height_m = diagram.heights_m[k];
    }
  }
  if (result.points == 0) return result;
  const auto count = static_cast<double>(result.points);
  result.mean_db = sum_db / count;
  result.deviation_db = std::sqrt(std::max(squares_db2 / count - result.mean_db * result.mean_db, 0.0));
  return result;
}

std::string arepsComparisonText(const ArepsComparison& comparison, const std::string& file) {
  if (comparison.points == 0)
    return fmt::format(
        "loss less that of {}: no point has both; --range and --max-height choose the points\n", file);
  return fmt::format(
      "loss less that of {}: mean {:+.2f} dB, standard deviation {:.2f} dB, largest {:+.1f} dB at {:.0f} m "
      "and "
      "{:.0f} m height; {} points, {} only here, {} only there\n",
      file, comparison.mean_db, comparison.deviation_db, comparison.largest_db, comparison.range_m,
      comparison.height_m, comparison.points, comparison.only_ours, comparison.only_theirs);
}

Json arepsComparisonJson(const ArepsComparison& comparison, const std::string& file) {
  Json json{{"file", file},
            {"points", comparison.points},
            {"only_here", comparison.only_ours},
            {"only_there", comparison.only_theirs}};
  for (const auto& [key, value] : {std::pair{"mean_db", comparison.mean_db},
                                   {"deviation_db", comparison.deviation_db},
                                   {"largest_db", comparison.largest_db},
                                   {"largest_range_m", comparison.range_m},
                                   {"largest_height_msl_m", comparison.height_m}})
    json[key] = comparison.points > 0 ? Json(value) : Json();
  return json;
}

}  // namespace emscape::report
