#include "emscape/scenario/file/scenario_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/files/file_reading.h"
#include "base/text/utc.h"
#include "document/schema_check.h"
#include "document/text_edit.h"
#include "document/text_file.h"
#include "emscape/base/log.h"
#include "emscape/scenario/model/quantities.h"
#include "scenario/file/file_kind.h"
#include "scenario/file/parse_sections.h"
#include "scenario/file/quantity_needs.h"
#include "scenario/file/scenario_check.h"
#include "scenario/file/scenario_warnings.h"
#include "scenario/terrain/terrain_faults.h"

namespace emscape::scenario {

namespace {

constexpr double kMaxSteps = 1e7;

Clock parseClock(const Section& root, ParseContext& context) {
  Clock clock{root.text("epoch"), root.number("duration_s"), root.number("step_s")};
  // A time with an offset, or with a blank, as writers of YAML put it.
  const bool has_own_form = !clock.epoch_utc.empty() &&
                            (clock.epoch_utc.back() != 'Z' || clock.epoch_utc.find(' ') != std::string::npos);
  if (const auto epoch_ms = parseUtc_ms(clock.epoch_utc); epoch_ms && has_own_form)
    clock.epoch_utc = utcText(*epoch_ms);
  if (clock.duration_s >= clock.step_s * kMaxSteps) {
    context.problems.addError(root.locationOf("step_s"),
                              fmt::format("steps of {} s over {} s are more than the allowed {}",
                                          clock.step_s, clock.duration_s, kMaxSteps));
  }
  // A wrong epoch or duration has been reported already.
  if (parseUtc_ms(clock.epoch_utc) && std::isfinite(clock.duration_s)) {
    try {
      requireTime(clock, clock.duration_s);
    } catch (const Error& error) {
      context.problems.addError(root.locationOf("epoch"), "the scenario's end: " + error.message());
    }
  }
  return clock;
}

Band parseBand(const Section& section, ParseContext& context) {
  const Band band{section.text("name"), section.number("begin_hz"), section.number("end_hz")};
  if (band.begin_hz >= band.end_hz) {
    context.problems.addError(
        section.locationOf("end_hz"),
        fmt::format("'end_hz' is {}, not above 'begin_hz', {} Hz", band.end_hz, band.begin_hz));
  }
  return band;
}

IntervalSpec parseInterval(const Section& section, ParseContext& context) {
  IntervalSpec interval;
  interval.kind = section.choice<IntervalKind>("kind");
  interval.seconds = section.optionalNumber("seconds");
  interval.turns = section.optionalNumber("turns");
  if (interval.seconds && interval.turns) {
    context.problems.addError(section.locationOf("turns"),
                              "'seconds' and 'turns' both give the interval's duration: one of them");
  }
  return interval;
}

/// Checks that the scenario has everything that the output needs.
OutputSpec parseOutput(const Section& section, const Scenario& scenario, ParseContext& context) {
  OutputSpec output{section.texts("quantities"),
                    section.choice<CombineMode>("combine"),
                    section.choice<RadarAim>("radar_look"),
                    section.number("floor"),
                    section.number("count_threshold_dbwm2"),
                    {}};
  if (section.has("interval")) output.interval = parseInterval(section.section("interval"), context);
  if (section.has("receiver")) {
    output.receiver =
        indexNamedBy(section, "receiver", "receiver without a platform", scenario.receivers, context);
  }
  if (section.has("wanted_emitter"))
    output.wanted_emitter = indexNamedBy(section, "wanted_emitter", "emitter", scenario.emitters, context);
  const bool has_unknown_name =
      output.receiver < 0 || (section.has("wanted_emitter") && output.wanted_emitter < 0);
  output.detection_threshold = section.number("detection_threshold");
  output.exposure_group = section.choice<ExposureGroup>("exposure_group");
  const auto hasKind = [&](EmitterKind kind) {
    return std::any_of(scenario.emitters.begin(), scenario.emitters.end(),
                       [kind](const Emitter& emitter) { return emitter.kind == kind; });
  };
  const auto need = [&](bool met, const SourceLocation& location, const std::string& what,
                        const std::string& needed) {
    if (!met)
      context.problems.addError(location, fmt::format("{} needs {}; the scenario has none", what, needed));
  };
  for (std::size_t i = 0; i < output.quantities.size(); ++i) {
    const std::string& quantity = output.quantities[i];
    const SourceLocation location = section.locationOf("quantities", i);
    const auto row = std::find_if(quantityTable().begin(), quantityTable().end(),
                                  [&](const QuantityInfo& known) { return quantity == known.name; });
    if (row == quantityTable().end()) continue;  // already reported
    const std::string unmet_interval = unmetInterval(row->quantity, output.interval.kind);
    if (!unmet_interval.empty()) context.problems.addError(location, unmet_interval);
    if (row->kind == QuantityKind::of_receiver) {
      need(!scenario.receivers.empty(), location, quantity, "a receiver without a platform");
    }
    const bool is_reported = !unmet_interval.empty() || has_unknown_name ||
                             (row->kind == QuantityKind::of_receiver && scenario.receivers.empty());
    if (!is_reported) {
      const std::string unmet = unmetNeed(row->quantity, scenario, output);
      if (!unmet.empty()) context.problems.addError(location, unmet);
    }
    if (needsRadar(row->quantity)) {
      need(hasKind(EmitterKind::radar), location, quantity, "an emitter of kind radar");
    }
    if (row->needs_jammer) {
      need(hasKind(EmitterKind::jammer), location, quantity, "an emitter of kind jammer");
    }
  }
  if (output.combine == CombineMode::per_band) {
    need(!scenario.bands.empty(), section.locationOf("combine"), "combine per_band", "bands");
  }
  return output;
}

Scenario parseRoot(const Section& root, ParseContext& context) {
  Scenario scenario;
  scenario.name = root.text("name");
  scenario.file = context.file;
  scenario.clock = parseClock(root, context);
  context.epoch_utc = scenario.clock.epoch_utc;
  scenario.region = parseRegion(root.section("region"), context);
  context.origin = scenario.region.origin;
  if (root.has("terrain")) scenario.terrain = parseTerrain(root.section("terrain"), context);
  scenario.atmosphere = context.atmosphere = parseAtmosphere(root.section("atmosphere"), context);
  scenario.ground = parseGround(root.section("ground"), context);
  for (const Section& item : root.sections("platforms"))
    scenario.platforms.push_back(parsePlatform(item, context));
  for (const Section& item : root.sections("emitters")) {
    scenario.emitters.push_back(parseEmitter(item, scenario.platforms, context));
    if (item.has("blink")) blink(scenario.emitters.back(), item.section("blink"), scenario.clock, context);
  }
  for (const Section& item : root.sections("receivers")) {
    if (item.has("platform")) {
      scenario.placed_receivers.push_back(parsePlacedReceiver(item, scenario.platforms, context));
    } else {
      scenario.receivers.push_back(parseReceiverProfile(item));
    }
  }
  for (const Section& item : root.sections("targets"))
    scenario.targets.push_back(parseTarget(item, scenario.platforms, context));
  for (const Section& item : root.sections("bands")) scenario.bands.push_back(parseBand(item, context));
  scenario.output = parseOutput(root.section("output"), scenario, context);
  if (!context.problems.hasErrors()) {
    addScenarioWarnings(scenario, root, context);
    warnOfRefractivity(scenario, root, context);
  }
  scenario.hash = context.hash.hex();
  return scenario;
}

/// Maps the locations in a scenario from the edited text to its file.
void mapPlaces(Scenario& scenario, const document::EditedText& text) {
  const auto map = [&text](SourceLocation& location) { location = text.originOf(location); };
  map(scenario.ground.location);
  for (Platform& platform : scenario.platforms) map(platform.location);
  for (Emitter& emitter : scenario.emitters) {
    map(emitter.location);
    map(emitter.frequency_location);
    map(emitter.propagation.location);
  }
  if (!scenario.terrain) return;
  for (SourceLocation& location : scenario.terrain->locations) map(location);
  for (SourceLocation& location : scenario.terrain->surface_locations) map(location);
  for (SourceLocation& location : scenario.terrain->land_cover.locations) map(location);
}

/// Reads the scenario from its edited text. @param before  null, or the content of an earlier reading
ParseResult readSource(ScenarioSource source, const NamedFiles* before, ParseContext& context) {
  context.before = before;
  std::shared_ptr<Scenario> scenario;
  if (source.root) {
    context.hash.add(source.text.text());
    document::checkObject(context.file, *source.root, scenarioSpec(), context.problems);
    const Section root(context.file, source.root.get(), scenarioSpec());
    scenario = std::make_shared<Scenario>(parseRoot(root, context));
  }
  ParseResult result;
  result.problems = context.problems.inOrder();
  for (Problem& problem : result.problems) problem.location = source.text.originOf(problem.location);
  if (!scenario) return result;
  mapPlaces(*scenario, source.text);
  if (context.problems.hasErrors()) {
    scenario->platforms.clear();  // whose places may be wrong
    if (context.checks_terrain) addTerrainFaults(*scenario, result.problems);
    return result;
  }
  for (const Problem& problem : result.problems)
    source.warnings.push_back(toString(problem.location) + ": " + problem.message);
  source.files = std::move(context.files);
  source.read_for = context.read_for;
  scenario->source = std::make_shared<const ScenarioSource>(std::move(source));
  result.scenario = std::move(scenario);
  return result;
}

void applyEdits(ScenarioSource& source, const std::vector<Edit>& edits, ParseContext& context) {
  for (const Edit& edit : edits) {
    try {
      applyEdit(source, edit);
    } catch (const Error& error) {
      context.problems.addError(error.location(), error.message());
    }
  }
}

/// @throws Error (bad_input) that lists the errors of a result without a scenario
void requireScenario(const ParseResult& result) {
  if (result.scenario) return;
  throw Error(ErrorCode::bad_input, document::errorsText(result.problems));
}

/// @throws Error (bad_input) if there is no text
ParseContext contextOfEdits(const Scenario& scenario) {
  if (!scenario.source) {
    throw Error(ErrorCode::bad_input, "the scenario was not read from a file: there is no text to edit");
  }
  ParseContext context;
  context.file = scenario.file;
  context.read_for = scenario.source->read_for;
  return context;
}

/// @param readBytes  returns the text; its errors are problems of the result
ParseResult parsed(const std::string& file, const std::function<std::string()>& readBytes,
                   const std::vector<Edit>& edits, ReadFor read_for, bool checks_terrain = false) {
  ParseContext context;
  context.file = file;
  context.read_for = read_for;
  context.checks_terrain = checks_terrain;
  ScenarioSource source;
  try {
    source.text = {file, document::checkedUtf8(file, readBytes(), "a scenario")};
    source.root = document::readDocument(file, source.text.text(), context.problems);
    const std::string other =
        source.root ? otherDocumentText(documentKindOf(*source.root), DocumentKind::scenario) : "";
    if (!other.empty()) throw Error(ErrorCode::bad_input, {file, 0, 0}, other);
  } catch (const Error& error) {
    source.root = nullptr;
    context.problems.addError(error.location(), error.message());
  }
  if (source.root) applyEdits(source, edits, context);
  return readSource(std::move(source), nullptr, context);
}

}  // namespace

namespace {

std::string scenarioBytes(const std::string& file) {
  if (const std::string other = foreignFileText(file); !other.empty())
    throw Error(ErrorCode::bad_input, {file, 0, 0}, other);
  return readWholeText(file, kMaxScenarioBytes);
}

}  // namespace

ParseResult parseScenario(const std::string& file, const std::vector<Edit>& edits, ReadFor read_for) {
  return parsed(
      file, [&] { return scenarioBytes(file); }, edits, read_for);
}

ParseResult parseScenarioToCheck(const std::string& file, const std::vector<Edit>& edits) {
  return parsed(
      file, [&] { return scenarioBytes(file); }, edits, ReadFor::series, true);
}

bool addTerrainFaults(const Scenario& scenario, std::vector<Problem>& problems) {
  if (!scenario.terrain || scenario.region.dims.x == 0) return false;  // a wrong region has no box
  bool has_fault = false;
  for (const Error& error : faultsOfFiles(*scenario.terrain, terrainBox(scenario))) {
    const SourceLocation location =
        error.location().file.empty() ? SourceLocation{scenario.file, 0, 0} : error.location();
    const bool is_known = std::any_of(problems.begin(), problems.end(), [&](const Problem& other) {
      return other.severity == Severity::error && toString(other.location) == toString(location);
    });
    if (is_known) continue;
    problems.push_back({location, Severity::error, error.message()});
    has_fault = true;
  }
  return has_fault;
}

ParseResult parseScenarioText(const std::string& file, const std::string& text,
                              const std::vector<Edit>& edits, ReadFor read_for) {
  return parsed(
      file, [&] { return text; }, edits, read_for);
}

ParseResult editScenario(const Scenario& scenario, const std::vector<Edit>& edits) {
  ParseContext context = contextOfEdits(scenario);
  ScenarioSource source;
  source.text = scenario.source->text;
  source.root = scenario.source->root;
  source.edits = scenario.source->edits;
  applyEdits(source, edits, context);
  return readSource(std::move(source), &scenario.source->files, context);
}

std::shared_ptr<const Scenario> withEdits(const Scenario& scenario, const std::vector<Edit>& edits) {
  ParseContext context = contextOfEdits(scenario);
  ScenarioSource source;
  source.text = {scenario.file, scenario.source->text.original()};
  source.root = document::readDocument(scenario.file, source.text.text(), context.problems);
  applyEdits(source, edits, context);
  const ParseResult result = readSource(std::move(source), &scenario.source->files, context);
  requireScenario(result);
  return result.scenario;
}

void Scenario::set(const std::string& path, const std::string& value) {
  set({Edit{path, value}});
}

void Scenario::set(const std::vector<Edit>& edits) {
  const ParseResult result = editScenario(*this, edits);
  requireScenario(result);
  Scenario edited = *result.scenario;
  *this = std::move(edited);
}

std::vector<Edit> Scenario::edits() const {
  std::vector<Edit> all;
  if (!source) return all;
  for (const MadeEdit& made : source->edits) all.push_back(made.edit);
  return all;
}

std::vector<std::string> filesOf(const Scenario& scenario) {
  std::vector<std::string> files{scenario.file};
  if (scenario.source) {
    for (const auto& [file, digest] : scenario.source->files.digests) files.push_back(file);
  }
  if (scenario.terrain) {
    const std::vector<std::string> rasters = scenario.terrain->rasters();
    files.insert(files.end(), rasters.begin(), rasters.end());
    if (!scenario.terrain->land_cover.table.empty()) files.push_back(scenario.terrain->land_cover.table);
  }
  return files;
}

std::string scenarioJsonSchema() {
  return document::jsonSchema(
      scenarioSpec(), "Emscape scenario",
      "Made from the parser's table. The parser also reports what a schema cannot express: repeated names, "
      "platforms that do not exist, files that cannot be read.");
}

std::shared_ptr<const Scenario> loadScenario(const std::string& file, const std::vector<Edit>& edits,
                                             ReadFor read_for) {
  const ParseResult result = parseScenario(file, edits, read_for);
  for (const Problem& problem : result.problems) {
    if (problem.severity == Severity::warning)
      logWarning(toString(problem.location) + ": " + problem.message);
  }
  requireScenario(result);
  return result.scenario;
}

}  // namespace emscape::scenario
