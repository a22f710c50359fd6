#include "report/runs/import_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/count_text.h"

namespace emscape::report {
namespace {

/// The kinds that occur most often, and the number of the others.
std::string countsText(const std::map<std::string, long long>& counts) {
  constexpr std::size_t kShown = 8;
  std::vector<std::pair<std::string, long long>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  long long others = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (i < kShown) {
      text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", sorted[i].first, sorted[i].second);
    } else {
      others += sorted[i].second;
    }
  }
  if (others > 0) text += fmt::format(", {} others", others);
  return text;
}

}  // namespace

Json importJson(const interop::ImportResult& result) {
  Json types = Json::array(), emitters = Json::array(), ignored = Json::object(), left_out = Json::object();
  for (const interop::ImportedType& type : result.types) {
    types.push_back({{"type", type.type},
                     {"text", type.text},
                     {"domain", interop::toString(type.domain)},
                     {"objects", type.objects},
                     {"emitters", type.emitters}});
  }
  for (const interop::ImportedEmitters& use : result.emitters) {
    emitters.push_back({{"name", use.name},
                        {"count", use.count},
                        {"matched", use.fault.empty()},
                        {"source", use.source},
                        {"reason", use.fault}});
  }
  for (const auto& [kind, count] : result.tally.ignored) ignored[kind] = count;
  for (const auto& [reason, count] : result.left_out) left_out[reason] = count;
  return {{"scenario", result.scenario},
          {"tracks", result.tracks},
          {"track_files", result.track_files},
          {"format", result.format},
          {"epoch", result.epoch_utc.empty() ? Json(nullptr) : Json(result.epoch_utc)},
          {"begin_s", result.recorded.begin_s},
          {"end_s", result.recorded.end_s},
          {"duration_s", result.duration_s},
          {"types", types},
          {"emitters", emitters},
          {"moved", result.moved},
          {"left_out", left_out},
          {"records", result.tally.records},
          {"bad", result.tally.bad},
          {"first_bad", result.tally.first_bad},
          {"torn", result.tally.torn},
          {"ignored", ignored},
          {"notes", [&] {
             std::vector<std::string> notes = result.tally.notes;
             notes.insert(notes.end(), result.notes.begin(), result.notes.end());
             return notes;
           }()}};
}

std::string importText(const interop::ImportResult& result) {
  std::string text = fmt::format("{:<40} {:>8} {:>9}\n", "objects", "number", "emitters");
  for (const interop::ImportedType& type : result.types)
    text += fmt::format("{:<40} {:>8} {:>9}\n", type.text, type.objects, type.emitters);
  for (const auto& [reason, count] : result.left_out)
    text += fmt::format("{:<40} {:>8}\n", "left out: " + reason, count);
  text += fmt::format("\n{:<40} {:>8}\n", "emitters", "number");
  for (const interop::ImportedEmitters& use : result.emitters) {
    if (use.fault.empty()) text += fmt::format("{:<40} {:>8}\n", use.name, use.count);
  }
  for (const interop::ImportedEmitters& use : result.emitters) {
    if (!use.fault.empty())
      text += fmt::format("{:<40} {:>8}  {}\n", "left out: " + use.name, use.count, use.fault);
  }
  text += fmt::format("\n{}, {:.3f} to {:.3f} s, {}", result.format, result.recorded.begin_s,
                      result.recorded.end_s, countText(result.tally.records, "record", "records"));
  if (!result.epoch_utc.empty()) text += ", t = 0 is " + result.epoch_utc;
  text += "\n";
  if (result.tally.bad > 0)
    text += fmt::format("{} could not be read, the first: {}\n",
                        countText(result.tally.bad, "record", "records"), result.tally.first_bad);
  if (!result.tally.torn.empty()) text += "the recording ends too early: " + result.tally.torn + "\n";
  if (!result.tally.ignored.empty()) text += "not used: " + countsText(result.tally.ignored) + "\n";
  for (const auto* notes : {&result.tally.notes, &result.notes}) {
    for (const std::string& note : *notes) text += "note: " + note + "\n";
  }
  text += fmt::format("{}: {:.6g} s", result.scenario, result.duration_s);
  if (result.track_files > 0)
    text += fmt::format(", {} in {}", countText(result.track_files, "track", "tracks"), result.tracks);
  return text + "\n";
}

}  // namespace emscape::report
