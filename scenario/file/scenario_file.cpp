#include "emscape/scenario/file/scenario_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
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
#include "scenario/file/scenario_warnings.h"
#include "scenario/terrain/file_names.h"

namespace emscape::scenario {

namespace {

constexpr double kMaxVoxels = 2147483648.0;
constexpr double kMaxSteps = 1e7;
constexpr double kMaxVoxelAspect = 1000;  ///< of x over y

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

Region parseRegion(const Section& section, ParseContext& context) {
  const Section origin = section.section("origin");
  Region region;
  region.origin = {section.choice<FrameKind>("frame"), origin.number("latitude_deg"),
                   origin.number("longitude_deg"), origin.number("height_msl_m")};
  std::vector<double> size_m = section.numbers("size_m"), dims = section.numbers("dims");
  if (dims.size() == 3 && dims[0] * dims[1] * dims[2] > kMaxVoxels) {
    context.problems.addError(section.locationOf("dims"),
                              fmt::format("'dims' are {} voxels in all, outside the allowed range 8 to {}",
                                          dims[0] * dims[1] * dims[2], kMaxVoxels));
  }
  if (!section.sound()) return region;
  region.size_m = {size_m[0], size_m[1], size_m[2]};
  region.dims = {static_cast<int>(dims[0]), static_cast<int>(dims[1]), static_cast<int>(dims[2])};
  const double width_m = size_m[0] / dims[0], depth_m = size_m[1] / dims[1];
  if (std::max(width_m, depth_m) > kMaxVoxelAspect * std::min(width_m, depth_m)) {
    context.problems.addError(
        section.locationOf("size_m"),
        fmt::format(
            "'size_m' and 'dims' make voxels of {} m by {} m; one side may be at most {} times the other",
            width_m, depth_m, kMaxVoxelAspect));
  }
  return region;
}

/// What an item of terrain.files states of its files.
TerrainFileKeys parseTerrainKeys(const Section& section) {
  TerrainFileKeys keys;
  if (section.has("vertical_datum")) keys.vertical_datum = section.choice<VerticalDatum>("vertical_datum");
  if (section.has("height_unit")) keys.height_unit = section.choice<HeightUnit>("height_unit");
  if (section.has("encoding")) keys.encoding = section.choice<HeightEncoding>("encoding");
  if (section.has("band")) keys.band = section.integer("band");
  keys.crs = section.text("crs");
  keys.swap_bytes = section.optionalBoolean("swap_bytes").value_or(false);
  if (section.has("implausible")) keys.implausible = section.choice<ImplausibleHeights>("implausible");
  return keys;
}

/// Reports a file that cannot be opened; else returns its size.
std::optional<std::uintmax_t> openedSize(const std::string& file, const SourceLocation& location,
                                         ParseContext& context) {
  std::error_code failure;
  const std::uintmax_t size = std::filesystem::file_size(file, failure);
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  const bool is_other = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
                        !std::filesystem::is_directory(status);
  errno = 0;
  if (!failure && !is_other && std::ifstream(file)) return size;
  if (!failure) failure = std::error_code(errno, std::generic_category());
  context.problems.addError(location, fmt::format("elevation file {}: {}", file,
                                                  is_other ? "is not a regular file" : failure.message()));
  return std::nullopt;
}

/// Files of a list of the terrain's section, with what the list says of them.
struct TerrainFiles {
  std::vector<std::string> files;
  std::vector<SourceLocation> locations;
  std::vector<TerrainFileKeys> keys;
};

/// The files are opened, not read; files of an earlier reading are not opened again.
/// @param known   the terrain is that of the earlier reading
/// @param digest  receives names and sizes
TerrainFiles parseTerrainFiles(const Section& section, TerrainList list, bool known, std::string& digest,
                               ParseContext& context) {
  const std::string key = list == TerrainList::surface ? "surface_files" : "files";
  const bool with_keys = list != TerrainList::land_cover;
  TerrainFiles found;
  const std::vector<Section> items = with_keys ? section.sections(key) : std::vector<Section>{};
  const std::vector<std::string> names = with_keys ? std::vector<std::string>{} : section.texts(key);
  const std::size_t count = with_keys ? items.size() : names.size();
  // One entry per list: of the elevation files, the surface model, the land cover.
  std::vector<std::vector<std::string>>& stands_for = context.files.terrain_files[list];
  stands_for.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool has_keys = with_keys && items[i].node()->kind == document::NodeKind::map;
    const std::string name = !with_keys ? names[i] : has_keys ? items[i].text("file") : items[i].node()->text;
    if (name.empty()) continue;
    const SourceLocation location = section.locationOf(key, i);
    std::vector<std::string>& files = stands_for[i];
    try {
      files = known ? context.before->terrain_files.at(list).at(i) : elevationFilesOf(context.resolve(name));
    } catch (const Error& error) {
      context.problems.addError(location, error.message());
      continue;
    }
    for (const std::string& file : files) {
      found.files.push_back(file);
      found.locations.push_back(location);
      found.keys.push_back(has_keys ? parseTerrainKeys(items[i]) : TerrainFileKeys{});
      if (known) continue;
      const std::optional<std::uintmax_t> size = openedSize(file, location, context);
      const bool is_named = files.size() == 1 && file == context.resolve(name);
      if (size)
        digest +=
            fmt::format("{}:{}", is_named ? name : std::filesystem::path(file).filename().string(), *size);
    }
  }
  return found;
}

LandCoverSpec parseLandCover(const Section& section, bool known, std::string& digest, ParseContext& context) {
  LandCoverSpec cover;
  TerrainFiles files = parseTerrainFiles(section, TerrainList::land_cover, known, digest, context);
  cover.files = std::move(files.files);
  cover.locations = std::move(files.locations);
  if (!section.has("table")) {
    cover.classes = section.choice<CoverTable>("classes");
    return cover;
  }
  cover.table = context.resolve(section.text("table"));
  try {
    readCoverTable(cover.table);
    digest += readWholeText(cover.table);
  } catch (const Error& error) {
    context.problems.addError(error.location().file.empty() ? section.locationOf("table") : error.location(),
                              error.message());
  }
  return cover;
}

TerrainSpec parseTerrain(const Section& section, ParseContext& context) {
  TerrainSpec terrain;
  std::string digest;
  const NamedFiles* before = context.before;
  const bool known = before != nullptr && before->terrain_node &&
                     document::sameValue(*before->terrain_node, *section.node());
  if (section.has("vertical_datum")) terrain.vertical_datum = section.choice<VerticalDatum>("vertical_datum");
  if (section.has("missing")) terrain.missing = section.choice<MissingTerrain>("missing");
  TerrainFiles ground = parseTerrainFiles(section, TerrainList::ground, known, digest, context);
  terrain.files = std::move(ground.files);
  terrain.locations = std::move(ground.locations);
  terrain.keys = std::move(ground.keys);
  TerrainFiles surface = parseTerrainFiles(section, TerrainList::surface, known, digest, context);
  terrain.surface_files = std::move(surface.files);
  terrain.surface_locations = std::move(surface.locations);
  terrain.surface_keys = std::move(surface.keys);
  if (section.has("land_cover"))
    terrain.land_cover = parseLandCover(section.section("land_cover"), known, digest, context);
  context.files.terrain_node = std::make_shared<const document::DocumentNode>(*section.node());
  context.files.terrain_digest = known ? before->terrain_digest : digest;
  context.hash.add(context.files.terrain_digest);
  return terrain;
}

propagation::Atmosphere parseAtmosphere(const Section& section, ParseContext& context) {
  propagation::Atmosphere atmosphere;
  atmosphere.k_factor = section.number("k_factor");
  atmosphere.pressure_hpa = section.number("pressure_hpa");
  atmosphere.temperature_k = section.number("temperature_k");
  atmosphere.vapour_g_m3 = section.number("vapour_g_m3");
  atmosphere.rain_mm_h = section.number("rain_mm_h");
  atmosphere.rain_height_m = section.optionalNumber("rain_height_m");
  atmosphere.gases = section.choice<propagation::GasLosses>("gases");
  atmosphere.refraction = section.choice<propagation::RefractionProfile>("refraction");
  atmosphere.sea_level_refractivity = section.number("sea_level_refractivity");
  atmosphere.climate = section.choice<propagation::RadioClimate>("climate");
  atmosphere.refractivity = parseRefractivity(section, context);
  if (!section.has("k_factor")) atmosphere.k_factor = kFactorOf(section, atmosphere.k_factor);
  return atmosphere;
}

propagation::Ground parseGround(const Section& section) {
  propagation::Ground ground;
  ground.kind = section.choice<propagation::GroundKind>("kind");
  ground.relative_permittivity = section.optionalNumber("relative_permittivity");
  ground.conductivity_s_m = section.optionalNumber("conductivity_s_m");
  ground.roughness_m = section.number("roughness_m");
  ground.surface_msl_m = section.optionalNumber("surface_msl_m");
  ground.sea_by_height = section.optionalBoolean("sea_by_height").value_or(false);
  ground.terminal_clutter = section.choice<propagation::TerminalClutterModel>("terminal_clutter");
  ground.terminal_clutter_percent = section.number("terminal_clutter_percent");
  ground.terminal_clutter_below_m = section.number("terminal_clutter_below_m");
  ground.terminal_clutter_ends = section.choice<propagation::ClutterEnds>("terminal_clutter_ends");
  ground.terminal_clutter_combine =
      section.choice<propagation::ClutterCombination>("terminal_clutter_combine");
  ground.location = section.location();
  return ground;
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

/// Index of the item that a key of the output names; -1: there is none.
template <class Named>
int indexOfNamed(const Section& section, const char* key, const char* what, const std::vector<Named>& items,
                 ParseContext& context) {
  const std::string wanted = section.text(key);
  std::vector<std::string> names;
  for (const Named& item : items) {
    if (item.name == wanted) return static_cast<int>(names.size());
    names.push_back(item.name);
  }
  context.problems.addError(section.locationOf(key), fmt::format("there is no {} '{}'{}", what, wanted,
                                                                 document::didYouMean(wanted, names)));
  return -1;
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
        indexOfNamed(section, "receiver", "receiver without a platform", scenario.receivers, context);
  }
  if (section.has("wanted_emitter"))
    output.wanted_emitter = indexOfNamed(section, "wanted_emitter", "emitter", scenario.emitters, context);
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
  scenario.ground = parseGround(root.section("ground"));
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
  if (!scenario || context.problems.hasErrors()) return result;
  mapPlaces(*scenario, source.text);
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
  std::string all;
  for (const Problem& problem : result.problems) {
    if (problem.severity == Severity::warning) continue;
    all += (all.empty() ? "" : "\n") + toString(problem.location) + ": " + problem.message;
  }
  throw Error(ErrorCode::bad_input, all);
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
                   const std::vector<Edit>& edits, ReadFor read_for) {
  ParseContext context;
  context.file = file;
  context.read_for = read_for;
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

ParseResult parseScenario(const std::string& file, const std::vector<Edit>& edits, ReadFor read_for) {
  return parsed(
      file,
      [&] {
        if (const std::string other = foreignFileText(file); !other.empty())
          throw Error(ErrorCode::bad_input, {file, 0, 0}, other);
        return readWholeText(file, kMaxScenarioBytes);
      },
      edits, read_for);
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
    const auto add = [&](const std::vector<std::string>& names) {
      files.insert(files.end(), names.begin(), names.end());
    };
    add(scenario.terrain->files);
    add(scenario.terrain->surface_files);
    add(scenario.terrain->land_cover.files);
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
