#include "interop/importing/scenario_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/text/utc.h"
#include "document/node_span.h"
#include "document/text_edit.h"
#include "scenario/file/save_scenario.h"

namespace emscape::interop {
namespace {

namespace fs = std::filesystem;

DocumentNodePtr terrainFiles(const std::vector<std::string>& files, const fs::path& folder) {
  std::vector<DocumentNodePtr> names;
  for (const std::string& file : files) {
    const fs::path absolute = fs::absolute(file).lexically_normal();
    names.push_back(
        textNode(absolute.lexically_relative(fs::absolute(folder).lexically_normal()).generic_string()));
  }
  return listNode(names);
}

std::string commentOf(const std::string& header) {
  std::string text;
  std::istringstream lines(header);
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  return text;
}

/// Adds items to a list of the document.
std::string withItems(const std::string& text, const std::string& file, const std::string& key,
                      const std::vector<DocumentNodePtr>& items) {
  if (items.empty()) return text;
  document::ProblemList problems;
  const DocumentNodePtr root = document::readDocument(file, text, problems);
  const DocumentNodePtr list = document::valueAt(root, {key});
  const document::Span span = document::spanOf(text, *list);
  std::string added;
  if (document::isFlow(text, *list)) {
    for (const DocumentNodePtr& item : items) added += ", " + document::flowText(*item, false);
    return text.substr(0, span.end - 1) + added + text.substr(span.end - 1);
  }
  // The hyphens of the list stand where its value begins.
  const int indent = std::max(list->position.column - 1, 0);
  const std::size_t line_end = std::min(text.find('\n', span.end), text.size());
  std::string before = text.substr(0, line_end);
  return before + "\n" + blockText(items, indent) + text.substr(std::min(line_end + 1, text.size()));
}

/// Replaces the place or track of platforms of the document; a moving one keeps what it says of the times
/// outside of its track.
std::string withMoved(const std::string& text, const std::string& file,
                      const std::map<std::size_t, DocumentNodePtr>& moved) {
  document::ProblemList problems;
  const DocumentNodePtr root = document::readDocument(file, text, problems);
  std::vector<document::Splice> splices;
  for (const auto& [index, platform] : moved) {
    const DocumentNodePtr before = document::valueAt(root, {std::string("platforms"), index});
    const MapBuilder now(platform);
    const bool moves = now.find("track") != nullptr;
    const bool is_flow = document::isFlow(text, *before);
    const DocumentNodePtr attitude = now.find("attitude");
    bool has_attitude = false;
    for (const document::MapEntry& entry : before->entries) has_attitude |= entry.key == "attitude";
    for (const document::MapEntry& entry : before->entries) {
      if (entry.key == "attitude") {
        splices.push_back(document::spliceFor(text, root, {std::string("platforms"), index, entry.key},
                                              moves ? nullptr : attitude));
      }
      if (entry.key != "position" && entry.key != "track") continue;
      MapBuilder place(now.find(moves ? "track" : "position"));
      if (moves) place.set("outside", MapBuilder(entry.value).find("outside"));
      std::string written = (moves ? "track: " : "position: ") + document::flowText(*place.node(), false);
      if (attitude && !has_attitude) {
        const int indent = std::max(entry.position.column - 1, 0);
        written += (is_flow ? ", " : "\n" + std::string(static_cast<std::size_t>(indent), ' ')) +
                   "attitude: " + document::flowText(*attitude, false);
      }
      splices.push_back({entry.position.offset, document::valueSpanOf(text, entry).end, written});
    }
  }
  std::sort(splices.begin(), splices.end(), [](const auto& a, const auto& b) { return a.begin > b.begin; });
  std::string changed = text;
  for (const document::Splice& splice : splices)
    changed.replace(splice.begin, splice.end - splice.begin, splice.text);
  return changed;
}

}  // namespace

std::string scenarioText(const ScenarioParts& parts, const fs::path& folder) {
  std::string text = commentOf(parts.header) + "schema_version: 1\n";
  const auto line = [&text](const std::string& key, const DocumentNodePtr& value) {
    text += key + ": " + document::flowText(*value, false) + "\n";
  };
  line("name", textNode(parts.name));
  if (!parts.epoch_utc.empty()) text += "epoch: " + parts.epoch_utc + "\n";
  line("duration_s", decimalNode(parts.duration_s, 3));
  line("step_s", decimalNode(parts.step_s, 3));
  text += "region:\n";
  for (const document::MapEntry& entry : parts.region->entries)
    text += "  " + entry.key + ": " + document::flowText(*entry.value, false) + "\n";
  if (!parts.terrain.empty())
    text += "terrain: {files: " + document::flowText(*terrainFiles(parts.terrain, folder), false) + "}\n";
  text += "\nplatforms:\n" + blockText(parts.platforms, 2);
  text += "\nemitters:\n" + blockText(parts.emitters, 2);
  text += "\noutput:\n  quantities: [power_density_dbwm2]\n";
  return text;
}

std::string scenarioTextOnBase(const scenario::Scenario& base, const ScenarioParts& parts,
                               const fs::path& folder) {
  scenario::Scenario changed = base;
  std::vector<scenario::Edit> edits;
  if (!parts.name.empty()) edits.push_back({"name", document::flowText(*textNode(parts.name), false)});
  if (!parts.epoch_utc.empty()) edits.push_back({"epoch", parts.epoch_utc});
  edits.push_back({"duration_s", decimalText(parts.duration_s, 3)});
  if (parts.region) edits.push_back({"region", document::flowText(*parts.region, false)});
  if (!parts.terrain.empty()) {
    // Edits name files from the base's folder.
    const fs::path base_folder = fs::absolute(base.file).parent_path();
    edits.push_back(
        {"terrain", "{files: " + document::flowText(*terrainFiles(parts.terrain, base_folder), false) + "}"});
  }
  changed.set(edits);
  std::string text = scenario::scenarioTextIn(changed, folder);
  try {
    text = withMoved(text, base.file, parts.moved);
    text = withItems(text, base.file, "emitters", parts.emitters);
    text = withItems(text, base.file, "platforms", parts.platforms);
  } catch (const Error& error) {
    throw Error(error.code(), {base.file, 0, 0},
                "platforms and emitters cannot be moved or added: " + error.message());
  }
  return commentOf(parts.header) + text;
}

std::string farEpochText(std::optional<std::int64_t> epoch_ms, const scenario::Scenario& base) {
  constexpr double kYear_ms = 365.25 * 86400e3;
  const auto base_ms = parseUtc_ms(base.clock.epoch_utc);
  if (!epoch_ms || !base_ms) return "";
  const double years = static_cast<double>(*epoch_ms - *base_ms) / kYear_ms;
  if (std::abs(years) < 1) return "";
  return fmt::format(
      "the recording begins {}, {:.1f} years {} the base's epoch, {}. Is it in GPS time, which counts from "
      "1980 (10.0 "
      "years; for a table --columns time=NAME:gps), or has a receiver's week number begun again (19.6 "
      "years)?",
      utcText(*epoch_ms), std::abs(years), years < 0 ? "before" : "after", base.clock.epoch_utc);
}

}  // namespace emscape::interop
