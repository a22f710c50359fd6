#include "report/maps/exposure_report.h"

#include <cmath>
#include <map>

#include "base/files/whole_file.h"
#include "base/text/csv_cell.h"
#include "base/text/quantity_text.h"
#include "report/text.h"
#include "report/warnings.h"

namespace emscape::report {
namespace {

using study::Exposure;
using study::ExposureRow;
using study::ExposureSummary;

Json summaryJson(const ExposureSummary& summary, bool is_emitter) {
  Json json{{"name", summary.name},
            {"max", number(summary.max)},
            {"max_time_s", std::isfinite(summary.max) ? Json(summary.max_time_s) : Json(nullptr)},
            {"first_s", number(summary.first_s)},
            {"fraction", number(summary.fraction)},
            {"unknown_fraction", summary.unknown_fraction},
            {"longest_gap_s", summary.longest_gap_s},
            {"cumulative_probability", number(summary.cumulative_probability)},
            {"cumulative_first_s", number(summary.cumulative_first_s)}};
  if (is_emitter) json["best_fraction"] = summary.best_fraction;
  return json;
}

Json bestName(const Exposure& exposure, const ExposureRow& row) {
  return row.best < 0 ? Json(nullptr) : Json(exposure.names[static_cast<std::size_t>(row.best)]);
}

/// "terrain 62 %, noise 38 %": what decides in rows below the threshold; empty: not known.
std::string causesText(const Exposure& exposure) {
  std::map<emfield::PathCause, int> counts;
  int all = 0;
  for (const ExposureRow& row : exposure.rows) {
    if (!row.decides) continue;
    ++counts[*row.decides];
    ++all;
  }
  std::string text;
  for (const auto& [cause, count] : counts)
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", toString(cause), 100.0 * count / all);
  return text;
}

}  // namespace

Json exposureJson(const Exposure& exposure) {
  const study::ExposureRequest& request = exposure.request;
  Json json{{"scenario", exposure.scenario},
            {"platform", exposure.platform},
            {"quantity", scenario::info(request.quantity).name},
            {"unit", exposure.unit},
            {"threshold", request.threshold},
            {"radar_look", toString(request.look)},
            {"cross_section", exposure.cross_section},
            {"clutter", exposure.clutter},
            {"emitters", exposure.names},
            {"together", summaryJson(exposure.together, false)}};
  json["each"] = Json::array();
  for (const ExposureSummary& summary : exposure.each) json["each"].push_back(summaryJson(summary, true));
  json["rows"] = Json::array();
  for (const ExposureRow& row : exposure.rows) {
    Json each = Json::array();
    for (const double value : row.each) each.push_back(number(value));
    json["rows"].push_back({{"time_s", row.time_s},
                            {"latitude_deg", number(row.latitude_deg)},
                            {"longitude_deg", number(row.longitude_deg)},
                            {"height_msl_m", number(row.height_msl_m)},
                            {"height_agl_m", number(row.height_agl_m)},
                            {"value", number(row.value)},
                            {"state", study::toString(row.state)},
                            {"each", each},
                            {"best", bestName(exposure, row)},
                            {"decides", row.decides ? Json(toString(*row.decides)) : Json(nullptr)},
                            {"cumulative_probability", number(row.cumulative_probability)}});
  }
  json["warnings"] = joinedWarnings(exposure.warnings);
  return json;
}

std::string exposureText(const Exposure& exposure) {
  Text out;
  const study::ExposureRequest& request = exposure.request;
  out.add("Exposure of '{}' in {}, t = {:g} to {:g} s: {} >= {}\n", exposure.platform, exposure.scenario,
          exposure.rows.front().time_s, exposure.rows.back().time_s, scenario::info(request.quantity).name,
          quantityText(request.threshold, exposure.unit));
  if (!exposure.cross_section.empty()) {
    out.add("Radars look {}; cross section: {}\n",
            request.look == scenario::RadarAim::target ? "at the platform" : "as their scan points",
            exposure.cross_section);
  }
  out.add("ground cover: {}\n", exposure.clutter);
  out.add("  {:<22} {:>9} {:>8} {:>8} {:>9} {:>9} {:>14} {:>8} {:>12} {:>11}\n", "emitter", "max", "at s",
          "first s", "reached", "unknown", "longest gap s", "best", "in any look", "from s");
  const auto row = [&](const ExposureSummary& summary, const std::string& best) {
    const bool has_value = std::isfinite(summary.max);
    const auto percents = [](double part) {
      return std::isnan(part) ? "-" : fmt::format("{:.1f} %", 100 * part);
    };
    out.add("  {:<22} {:>9} {:>8} {:>8} {:>9} {:>9} {:>14g} {:>8} {:>12} {:>11}\n", summary.name,
            has_value ? fmt::format("{:.4g}", summary.max) : "-",
            has_value ? fmt::format("{:g}", summary.max_time_s) : "-",
            summary.first_s ? fmt::format("{:g}", *summary.first_s) : "never", percents(summary.fraction),
            percents(summary.unknown_fraction), summary.longest_gap_s, best,
            std::isfinite(summary.cumulative_probability)
                ? fmt::format("{:.4f}", summary.cumulative_probability)
                : "-",
            !std::isfinite(summary.cumulative_probability) ? "-"
            : summary.cumulative_first_s                   ? fmt::format("{:g}", *summary.cumulative_first_s)
                                                           : "never");
  };
  for (const ExposureSummary& summary : exposure.each) {
    row(summary, fmt::format("{:.0f} %", 100 * summary.best_fraction));
  }
  row(exposure.together, "");
  const std::string causes = causesText(exposure);
  if (!causes.empty())
    out.add("Where it is below the threshold, by the number of times, decide: {}\n", causes);
  if (std::isfinite(exposure.together.cumulative_probability)) {
    out.add(
        "first s: when one look reaches the threshold; in any look: the probability of a detection in all "
        "looks "
        "so far, from s: when that reaches it.\n");
  }
  if (exposure.together.unknown_fraction > 0) {
    out.add(
        "Unknown where a path crosses missing terrain and no other emitter reaches the threshold; 'reached' "
        "is of the known time.\n");
  }
  return out.take();
}

void writeExposureCsv(const Exposure& exposure, const std::string& file) {
  const auto text = [](double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string();
  };
  writeWhole(file, [&](std::ostream& out) {
    out << "time_s,latitude_deg,longitude_deg,height_msl_m,height_agl_m,"
        << scenario::info(exposure.request.quantity).name;
    for (const std::string& name : exposure.names) out << "," << csvCell(name);
    out << ",best,cumulative_probability,state,decides\n";
    for (const ExposureRow& row : exposure.rows) {
      const auto decimals = [](double value, int count) {
        return std::isfinite(value) ? fmt::format("{:.{}f}", value, count) : std::string();
      };
      out << fmt::format("{:.10g},{},{},{},{},{}", row.time_s, decimals(row.latitude_deg, 7),
                         decimals(row.longitude_deg, 7), decimals(row.height_msl_m, 2),
                         decimals(row.height_agl_m, 2), text(row.value));
      for (const double value : row.each) out << "," << text(value);
      const std::string best = row.best < 0 ? "" : exposure.names[static_cast<std::size_t>(row.best)];
      out << "," << csvCell(best) << "," << text(row.cumulative_probability) << ","
          << study::toString(row.state) << "," << (row.decides ? toString(*row.decides) : "") << "\n";
    }
  });
}

}  // namespace emscape::report
