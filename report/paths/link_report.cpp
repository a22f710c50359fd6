#include "report/paths/link_report.h"

#include <algorithm>
#include <cmath>

#include "base/files/whole_file.h"
#include "base/text/csv_cell.h"
#include "emfield/excess/clutter_text.h"
#include "emfield/link/path_verdict.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "emscape/scenario/file/scenario_file.h"
#include "propagation/registry/model_info.h"
#include "report/text.h"
#include "scenario/file/named_index.h"
#include "scenario/scan/scan_sampling.h"

namespace emscape::report {
namespace {

using emfield::Detection;
using emfield::DetectionRow;
using emfield::kDetected;
using emfield::Link;
using emfield::LinkRow;
using emfield::PathRow;
using scenario::Scenario;

/// Maximum rows of a table per pair.
constexpr std::size_t kTableRows = 21;

/// The first time at which all looks so far detect with the threshold's probability.
std::optional<double> firstByLooks_s(const Detection& detection) {
  for (const DetectionRow& row : detection.rows)
    if (row.cumulative_probability >= kDetected) return row.time_s;
  return std::nullopt;
}

/// A value in a table; "-" without one.
std::string cell(double value, int decimals = 1) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

/// Kilometres; a path that does not exist has none.
std::string rangeCell(const PathRow& row) {
  return row.has_path ? cell(row.range_m / 1000, 3) : "-";
}

std::string timeText(const std::optional<double>& time_s) {
  return time_s ? fmt::format("{:g}", *time_s) : "never";
}

Json pathJson(const PathRow& row) {
  return {{"time_s", row.time_s},
          {"active", row.active},
          {"range_m", row.has_path ? Json(row.range_m) : Json(nullptr)},
          {"power_density_dbwm2", number(row.power_density_dbwm2)},
          {"pattern_db", number(row.pattern_db)},
          {"off_axis_deg", row.has_path ? Json(radToDeg(row.off_axis_rad)) : Json(nullptr)},
          {"blocked", row.is_blocked},
          {"verdict", row.verdict}};
}

Json toJson(const LinkRow& row) {
  Json json = pathJson(row);
  json["received_power_dbm"] = number(row.received_power_dbm);
  json["interference_dbm"] = number(row.interference_dbm);
  json["noise_dbm"] = row.noise_dbm;
  json["sinr_db"] = number(row.sinr_db);
  json["jammer_to_signal_db"] = number(row.jammer_to_signal_db);
  json["received"] = row.is_received;
  return json;
}

Json toJson(const DetectionRow& row) {
  Json json = pathJson(row);
  json["rcs_dbsm"] = number(ratioToDb(row.rcs_m2));
  json["look_pattern_db"] = number(row.look_pattern_db);
  json["snr_db"] = number(row.snr_db);
  if (row.radial_speed_mps) {
    json["sclnr_db"] = number(row.sclnr_db);
    json["radial_speed_mps"] = number(*row.radial_speed_mps);
  }
  json["jammer_to_signal_db"] = number(row.jammer_to_signal_db);
  json["detection_probability"] = row.detection_probability;
  json["looks"] = row.looks;
  json["cumulative_probability"] = row.cumulative_probability;
  return json;
}

template <class Row>
Json rowsJson(const std::vector<Row>& rows) {
  Json json = Json::array();
  for (const Row& row : rows) json.push_back(toJson(row));
  return json;
}

/// Calls add_row(row, path) for evenly spaced rows including the last one, and prints their total number.
/// @param pathOf   the path's text of a row
/// @param add_row  gets an empty path if it equals that of the row above
template <class Row, class PathOf, class AddRow>
void addThinned(Text& out, const std::vector<Row>& rows, const PathOf& pathOf, const AddRow& add_row) {
  const std::size_t step = std::max<std::size_t>((rows.size() + kTableRows - 2) / (kTableRows - 1), 1);
  std::string last;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i % step != 0 && i + 1 != rows.size()) continue;
    const std::string path = pathOf(rows[i]);
    add_row(rows[i], path == last ? "" : path);
    last = path;
  }
  if (step > 1) out.add("  one row in {} of {} times; --csv and --json have all\n", step, rows.size());
}

/// The path, and whether the beam is there: a clear path alone does not say that there is a signal.
std::string pathText(const PathRow& row, double pattern_db) {
  const bool misses = row.has_path && row.active && pattern_db < emfield::kBeamMisses_db;
  if (!misses) return row.path;
  std::string text = row.path;
  if (!text.empty() && text.back() == '.') text.pop_back();
  return text + "; the beam misses.";
}

const std::string& emitterName(const NamedLinks& links, int emitter) {
  return links.scenario->emitters[static_cast<std::size_t>(emitter)].name;
}
const scenario::PlacedReceiver& receiverOf(const NamedLinks& links, const Link& link) {
  return links.scenario->placed_receivers[static_cast<std::size_t>(link.receiver)];
}
const std::string& targetName(const NamedLinks& links, const Detection& detection) {
  return links.scenario->targets[static_cast<std::size_t>(detection.target)].name;
}

/// Smallest and largest finite value of the rows, such as "-92.1 .. -60.3".
template <class Row, class Value>
std::string rangeText(const std::vector<Row>& rows, const Value& valueOf) {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const Row& row : rows) {
    const double value = valueOf(row);
    if (!std::isfinite(value)) continue;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  return lowest > highest ? "-" : fmt::format("{:.1f} .. {:.1f}", lowest, highest);
}

template <class Row>
double blockedShare(const std::vector<Row>& rows) {
  const auto blocked = std::count_if(rows.begin(), rows.end(), [](const Row& row) { return row.is_blocked; });
  return static_cast<double>(blocked) / static_cast<double>(std::max<std::size_t>(rows.size(), 1));
}

void addLinkSummary(Text& out, const NamedLinks& links) {
  if (links.report.links.empty()) return;
  out.add("Links\n  {:<22} {:<22} {:>19} {:>17} {:>8} {:>8} {:>9} {:>8}\n", "emitter", "receiver",
          "received power dBm", "SINR dB", "first s", "last s", "received", "blocked");
  for (const Link& link : links.report.links) {
    const bool is_judged = receiverOf(links, link).hasThreshold();
    out.add("  {:<22} {:<22} {:>19} {:>17} {:>8} {:>8} {:>9} {:>8}\n", emitterName(links, link.emitter),
            receiverOf(links, link).name,
            rangeText(link.rows, [](const LinkRow& row) { return row.received_power_dbm; }),
            rangeText(link.rows, [](const LinkRow& row) { return row.sinr_db; }),
            is_judged ? timeText(link.firstReceived_s()) : "-",
            is_judged ? timeText(link.lastReceived_s()) : "-",
            is_judged ? fmt::format("{:.0f} %", 100 * link.receivedShare()) : "-",
            fmt::format("{:.0f} %", 100 * blockedShare(link.rows)));
  }
  out.add("\n");
}

void addDetectionSummary(Text& out, const NamedLinks& links) {
  if (links.report.detections.empty()) return;
  out.add("Targets\n  {:<22} {:<22} {:>17} {:>15} {:>14} {:>11} {:>8}\n", "radar", "target", "SNR dB",
          "detected from s", "cumulative Pd", "0.5 from s", "blocked");
  for (const Detection& detection : links.report.detections) {
    out.add("  {:<22} {:<22} {:>17} {:>15} {:>14} {:>11} {:>8}\n", emitterName(links, detection.radar),
            targetName(links, detection),
            rangeText(detection.rows, [](const DetectionRow& row) { return row.snr_db; }),
            timeText(detection.firstDetection_s()), cell(detection.rows.back().cumulative_probability, 3),
            timeText(firstByLooks_s(detection)), fmt::format("{:.0f} %", 100 * blockedShare(detection.rows)));
  }
  out.add(
      "  detected from: the first time at which one look detects with a probability of 0.5 or more; 0.5 "
      "from: all "
      "looks so far\n\n");
}

void addLink(Text& out, const NamedLinks& links, const Link& link) {
  const scenario::PlacedReceiver& receiver = receiverOf(links, link);
  out.add("'{}' at receiver '{}'\n", emitterName(links, link.emitter), receiver.name);
  out.add("  {:>8} {:>9} {:>9} {:>10} {:>10} {:>16} {:>10} {:>9} {:>8} {:>9}  {}\n", "time s", "range km",
          "beam dB", "off it deg", "power dBm", "interference dBm", "noise dBm", "SINR dB", "J/S dB",
          "received", "path, where it changes");
  const auto pathOf = [](const LinkRow& row) { return pathText(row, row.pattern_db); };
  addThinned(out, link.rows, pathOf, [&](const LinkRow& row, const std::string& path) {
    out.add("  {:>8g} {:>9} {:>9} {:>10} {:>10} {:>16} {:>10} {:>9} {:>8} {:>9}  {}\n", row.time_s,
            rangeCell(row), cell(row.pattern_db), row.has_path ? cell(radToDeg(row.off_axis_rad), 0) : "-",
            cell(row.received_power_dbm), cell(row.interference_dbm), cell(row.noise_dbm), cell(row.sinr_db),
            cell(row.jammer_to_signal_db), receiver.hasThreshold() ? row.is_received ? "yes" : "no" : "-",
            path);
  });
  out.add("\n");
}

void addDetection(Text& out, const NamedLinks& links, const Detection& detection) {
  out.add("Radar '{}' and target '{}'\n", emitterName(links, detection.radar), targetName(links, detection));
  const bool has_clutter = detection.rows.front().radial_speed_mps.has_value();
  const auto ofClutter = [&](const std::string& speed, const std::string& ratio) {
    return has_clutter ? fmt::format(" {:>9} {:>10}", speed, ratio) : std::string();
  };
  out.add("  {:>8} {:>9} {:>9} {:>9} {:>8}{} {:>8} {:>6} {:>6} {:>10}  {}\n", "time s", "range km", "beam dB",
          "RCS dBsm", "SNR dB", ofClutter("speed m/s", "S/(C+N) dB"), "J/S dB", "Pd", "looks", "cumulative",
          "path, where it changes");
  const auto pathOf = [](const DetectionRow& row) { return pathText(row, row.look_pattern_db); };
  const DetectionRow* next = detection.rows.data();  // the first whose looks are not printed yet
  addThinned(out, detection.rows, pathOf, [&](const DetectionRow& row, const std::string& path) {
    int looks = 0;
    for (; next <= &row; ++next) looks += next->looks;
    out.add("  {:>8g} {:>9} {:>9} {:>9} {:>8}{} {:>8} {:>6} {:>6} {:>10}  {}\n", row.time_s, rangeCell(row),
            cell(row.look_pattern_db), cell(ratioToDb(row.rcs_m2)), cell(row.snr_db),
            ofClutter(cell(row.radial_speed_mps.value_or(0)), cell(row.sclnr_db)),
            cell(row.jammer_to_signal_db), cell(row.detection_probability, 3), looks,
            cell(row.cumulative_probability, 3), path);
  });
  out.add("\n");
}

std::string csvNumber(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

std::string offAxisText(const PathRow& row) {
  return row.has_path ? csvNumber(radToDeg(row.off_axis_rad)) : "";
}

std::string csvPath(const char* kind, const std::string& emitter, const std::string& to, const PathRow& row) {
  return fmt::format("{},{:.10g},{},{},{},{},{},{},{}", kind, row.time_s, csvCell(emitter), csvCell(to),
                     int(row.active), row.has_path ? fmt::format("{:.1f}", row.range_m) : "",
                     csvNumber(row.power_density_dbwm2), csvNumber(row.pattern_db), int(row.is_blocked));
}

}  // namespace

emfield::LinkOptions linkOptions(const scenario::Scenario& scenario, const LinkSelection& selection) {
  const auto indices = [&](const auto& items, const std::vector<std::string>& names, const char* option,
                           const char* kind) {
    return scenario::namedIndices(items, names, selection.prefix + option, kind, scenario.file);
  };
  emfield::LinkOptions options;
  options.times_s = selection.times.empty() ? scenario::timesOf(scenario.clock)
                                            : scenario::parseTimes(selection.times, scenario.clock);
  options.emitters = indices(scenario.emitters, selection.emitters, "emitter", "emitter");
  if (!selection.receivers.empty() || selection.targets.empty())
    options.receivers =
        indices(scenario.placed_receivers, selection.receivers, "receiver", "receiver with a platform");
  if (!selection.targets.empty() || selection.receivers.empty())
    options.targets = indices(scenario.targets, selection.targets, "target", "target");
  if (!selection.model.empty()) options.model = propagation::modelNamed(selection.model)->model;
  return options;
}

emfield::LinkReport computeLinks(const std::shared_ptr<const scenario::Scenario>& scenario,
                                 const emfield::LinkOptions& options, const ProgressSink& progress) {
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  emfield::LinkReport report = emfield::computeLinks(scenario, terrain.get(), options, progress);
  report.warnings.insert(report.warnings.begin(), warningsOf(*scenario).begin(), warningsOf(*scenario).end());
  if (terrain) {
    for (std::string& warning : terrain->warnings()) report.warnings.push_back(std::move(warning));
  }
  const std::string missed = scenario::missedActivityText(*scenario, options.times_s);
  const bool is_told =
      std::any_of(report.warnings.begin(), report.warnings.end(), [&](const std::string& told) {
        return told.find(missed) != std::string::npos;  // of the steps, with the same times
      });
  if (!missed.empty() && !is_told) report.warnings.push_back(missed);
  int last_radar = -1;  // detections of one radar follow each other
  for (const Detection& detection : report.detections) {
    const scenario::Emitter& radar = scenario->emitters[static_cast<std::size_t>(detection.radar)];
    std::string text = scenario::mergedLooksText(radar.name, radar.scan, options.times_s);
    if (!text.empty() && detection.radar != last_radar) report.warnings.push_back(std::move(text));
    last_radar = detection.radar;
  }
  if (report.links.empty() && report.detections.empty()) {
    throw Error(ErrorCode::bad_input, {scenario->file},
                "there is no link: it takes a receiver with a platform that is tuned to an emitter, or a "
                "target and a radar, on another "
                "platform than the emitter");
  }
  return report;
}

Json toJson(const NamedLinks& links) {
  Json of_receivers = Json::array(), of_targets = Json::array();
  for (const Link& link : links.report.links) {
    of_receivers.push_back({{"emitter", emitterName(links, link.emitter)},
                            {"receiver", receiverOf(links, link).name},
                            {"first_received_s", number(link.firstReceived_s())},
                            {"last_received_s", number(link.lastReceived_s())},
                            {"received_share", link.receivedShare()},
                            {"rows", rowsJson(link.rows)}});
  }
  for (const Detection& detection : links.report.detections) {
    of_targets.push_back({{"radar", emitterName(links, detection.radar)},
                          {"target", targetName(links, detection)},
                          {"first_detection_s", number(detection.firstDetection_s())},
                          {"cumulative_first_s", number(firstByLooks_s(detection))},
                          {"cumulative_probability", detection.rows.back().cumulative_probability},
                          {"rows", rowsJson(detection.rows)}});
  }
  return {{"scenario", links.file},
          {"clutter", emfield::clutterText(*links.scenario)},
          {"links", of_receivers},
          {"detections", of_targets},
          {"warnings", links.report.warnings}};
}

std::string linksText(const NamedLinks& links) {
  Text out;
  addLinkSummary(out, links);
  addDetectionSummary(out, links);
  for (const Link& link : links.report.links) addLink(out, links, link);
  for (const Detection& detection : links.report.detections) addDetection(out, links, detection);
  out.add("\nground cover along the paths: {}\n", emfield::clutterText(*links.scenario));
  return out.take();
}

void writeCsv(const NamedLinks& links, const std::string& file) {
  writeWhole(file, [&](std::ostream& out) {
    out << "kind,time_s,emitter,to,active,range_m,power_density_dbwm2,pattern_db,blocked,jammer_to_signal_db,"
           "received_power_dbm,interference_dbm,noise_dbm,sinr_db,received,"
           "rcs_dbsm,snr_db,sclnr_db,radial_speed_mps,detection_probability,looks,cumulative_probability,"
           "verdict,off_axis_deg,look_pattern_db\n";
    for (const Link& link : links.report.links) {
      for (const LinkRow& row : link.rows) {
        out << csvPath("receiver", emitterName(links, link.emitter), receiverOf(links, link).name, row)
            << fmt::format(",{},{},{},{},{},{},,,,,,,,{},{},\n", csvNumber(row.jammer_to_signal_db),
                           csvNumber(row.received_power_dbm), csvNumber(row.interference_dbm),
                           csvNumber(row.noise_dbm), csvNumber(row.sinr_db), int(row.is_received),
                           csvCell(row.verdict), offAxisText(row));
      }
    }
    for (const Detection& detection : links.report.detections) {
      for (const DetectionRow& row : detection.rows) {
        out << csvPath("target", emitterName(links, detection.radar), targetName(links, detection), row)
            << fmt::format(",{},,,,,,{},{},{},{},{},{},{},{},{},{}\n", csvNumber(row.jammer_to_signal_db),
                           csvNumber(ratioToDb(row.rcs_m2)), csvNumber(row.snr_db), csvNumber(row.sclnr_db),
                           csvNumber(row.radial_speed_mps.value_or(std::nan(""))),
                           csvNumber(row.detection_probability), row.looks,
                           csvNumber(row.cumulative_probability), csvCell(row.verdict), offAxisText(row),
                           csvNumber(row.look_pattern_db));
      }
    }
  });
}

}  // namespace emscape::report
