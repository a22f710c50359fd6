#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include "base/files/file_reading.h"
#include "base/text/unended_line.h"
#include "scenario/file/parse_sections.h"
#include "scenario/limits.h"
#include "scenario/terrain/file_names.h"

namespace emscape::scenario {
namespace {

constexpr double kMaxVoxelAspect = 1000;  ///< of x over y

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
    const std::string table = readWholeText(cover.table);
    digest += table;
    if (const std::string unended = unendedLineWarning(cover.table, table, "a row"); !unended.empty())
      context.problems.addWarning(section.locationOf("table"), unended);
  } catch (const Error& error) {
    context.problems.addError(error.location().file.empty() ? section.locationOf("table") : error.location(),
                              error.message());
  }
  return cover;
}

}  // namespace

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

propagation::Ground parseGround(const Section& section, ParseContext& context) {
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
  if (section.text("terminal_clutter_ends") == "receiver")
    context.problems.addWarning(section.locationOf("terminal_clutter_ends"),
                                "'receiver' is not used any more: an antenna up to "
                                "'terminal_clutter_below_m' is within the clutter, whether it transmits or "
                                "receives");
  ground.terminal_clutter_combine =
      section.choice<propagation::ClutterCombination>("terminal_clutter_combine");
  ground.location = section.location();
  return ground;
}

}  // namespace emscape::scenario
