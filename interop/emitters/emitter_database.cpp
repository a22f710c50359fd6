#include "interop/emitters/emitter_database.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>

#include "base/files/file_reading.h"
#include "document/schema_check.h"
#include "document/section.h"
#include "document/text_file.h"

namespace emscape::interop {
namespace {

using document::Section;

constexpr std::size_t kMaxDatabaseBytes = std::size_t{4} << 20;

std::vector<int> wholeNumbers(const Section& section, const std::string& key) {
  std::vector<int> values;
  for (const double value : section.numbers(key)) values.push_back(static_cast<int>(value));
  return values;
}

EmitterMatch matchOf(const Section& section) {
  EmitterMatch match;
  if (section.has("dis_name")) match.dis_name = section.integer("dis_name");
  if (section.has("dis_radio")) match.dis_radio = section.integer("dis_radio");
  if (section.has("function")) match.function = section.integer("function");
  match.beam_function = wholeNumbers(section, "beam_function");
  match.index = wholeNumbers(section, "index");
  match.dis_entity_type = section.text("dis_entity_type");
  match.acmi_name = section.text("acmi_name");
  match.acmi_type = section.text("acmi_type");
  match.asi_beam = section.text("asi_beam");
  match.object_name = section.text("object_name");
  match.beam_name = section.text("beam_name");
  match.cot_type = section.text("cot_type");
  return match;
}

/// An object or beam that tells no name or type has none that could match.
bool holds(const std::string& pattern, const std::string& text) {
  return pattern.empty() || (!text.empty() && matchesPattern(pattern, text));
}

/// @param beam  null: none
bool matches(const EmitterMatch& match, const RecordedObject& object, const BeamKeys* beam) {
  const ObjectKeys& keys = object.keys;
  if (!match.dis_entity_type.empty()) {
    if (!keys.dis_entity_type) return false;
    if (!matchesPattern(match.dis_entity_type, fmt::format("{}", fmt::join(*keys.dis_entity_type, "."))))
      return false;
  }
  const bool has_own_name = beam != nullptr && !beam->acmi_name.empty();
  const bool has_own_type =
      beam != nullptr && !match.acmi_type.empty() && holds(match.acmi_type, beam->acmi_type);
  return holds(match.acmi_name, has_own_name ? beam->acmi_name : keys.acmi_name) &&
         (has_own_type || holds(match.acmi_type, keys.acmi_type)) && holds(match.object_name, object.name) &&
         keys.cot_type.compare(0, match.cot_type.size(), match.cot_type) == 0;
}

bool matches(const EmitterMatch& match, const RecordedBeam& beam) {
  const BeamKeys& keys = beam.keys;
  const auto isOneOf = [](const std::vector<int>& allowed, const std::optional<int>& value) {
    return allowed.empty() || (value && std::find(allowed.begin(), allowed.end(), *value) != allowed.end());
  };
  return (!match.dis_name || match.dis_name == keys.dis_name) &&
         (!match.dis_radio || match.dis_radio == keys.dis_radio) &&
         (!match.function || match.function == keys.dis_function) &&
         isOneOf(match.beam_function, keys.dis_beam_function) && isOneOf(match.index, keys.dis_index) &&
         holds(match.asi_beam, keys.asi_beam) && holds(match.beam_name, beam.name);
}

}  // namespace

bool matchesPattern(const std::string& patterns, const std::string& text) {
  for (std::size_t begin = 0; begin <= patterns.size();) {
    const std::size_t end = std::min(patterns.find('|', begin), patterns.size());
    if (fnmatch(patterns.substr(begin, end - begin).c_str(), text.c_str(), FNM_CASEFOLD | FNM_NOESCAPE) == 0)
      return true;
    begin = end + 1;
  }
  return false;
}

const EmitterRow* findRow(const EmitterDatabase& database, const RecordedObject& object,
                          const RecordedBeam* beam) {
  for (const EmitterRow& row : database.rows) {
    if (row.is_starter && beam == nullptr && !database.starter_serves_objects) continue;
    const bool fits = beam == nullptr ? !row.match.isOfBeams() : matches(row.match, *beam);
    if (fits && matches(row.match, object, beam == nullptr ? nullptr : &beam->keys)) return &row;
  }
  return nullptr;
}

void describeRecording(EmitterDatabase& database, const std::vector<RecordedObject>& objects,
                       const std::vector<RecordedBeam>& beams) {
  if (database.unmatched == Unmatched::use_default) return;
  const auto isOwn = [](const EmitterRow* row) { return row != nullptr && !row->is_starter; };
  const bool has_own =
      std::any_of(objects.begin(), objects.end(),
                  [&](const RecordedObject& object) { return isOwn(findRow(database, object, nullptr)); }) ||
      std::any_of(beams.begin(), beams.end(), [&](const RecordedBeam& beam) {
        return isOwn(findRow(database, objects[beam.object], &beam));
      });
  database.starter_serves_objects = !has_own;
}

EmitterDatabase parseEmitterDatabase(const std::string& file, const std::string& text) {
  document::ProblemList problems;
  EmitterDatabase database;
  const document::DocumentNodePtr root =
      document::readDocument(file, document::checkedUtf8(file, text), problems);
  if (!root) {
    document::requireNoProblem(problems);
    throw Error(ErrorCode::bad_input, {file, 1, 1}, "the emitter database is empty");
  }
  document::checkObject(file, *root, emitterDatabaseSpec(), problems);
  document::requireNoProblem(problems);
  const Section section(file, root.get(), emitterDatabaseSpec());
  for (const Section& item : section.sections("emitters")) {
    EmitterRow row;
    row.name = item.text("name");
    row.source = item.text("source");
    row.match = matchOf(item.section("match"));
    row.antenna_height_m = item.number("antenna_height_m");
    row.file = file;
    const Section match = item.section("match");
    if (match.node() == nullptr || match.node()->entries.empty())
      problems.addError(item.locationOf("match"), "'match' has no condition; every beam would match");
    for (const document::MapEntry& entry : item.node()->entries) {
      if (entry.key == "emitter") row.emitter = entry.value;
    }
    database.rows.push_back(std::move(row));
  }
  if (section.has("unmatched")) database.unmatched = section.choice<Unmatched>("unmatched");
  database.default_file = file;
  for (const document::MapEntry& entry : root->entries) {
    if (entry.key == "default") database.default_emitter = entry.value;
  }
  if (database.unmatched == Unmatched::use_default && !database.default_emitter) {
    problems.addError(section.locationOf("unmatched"),
                      "'unmatched' is default, but the database has no 'default'; write for example "
                      "default: {kind: transmitter}");
  }
  document::requireNoProblem(problems);
  return database;
}

EmitterDatabase loadEmitterDatabase(const std::string& file) {
  EmitterDatabase starter = parseEmitterDatabase("scenarios/data/emitters.yaml", kStarterEmitters);
  for (EmitterRow& row : starter.rows) row.is_starter = true;
  if (file.empty()) return starter;
  EmitterDatabase database = parseEmitterDatabase(file, readWholeText(file, kMaxDatabaseBytes));
  database.rows.insert(database.rows.end(), starter.rows.begin(), starter.rows.end());
  if (!database.unmatched) database.unmatched = starter.unmatched;
  return database;
}

}  // namespace emscape::interop
