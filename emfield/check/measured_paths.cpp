#include "emfield/check/measured_paths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "emfield/check/reference_table.h"
#include "emfield/columns/station.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/emfield/solver/steep_ground.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

constexpr double kNoLoss = std::numeric_limits<double>::quiet_NaN();

std::optional<double> wholeNumberText(const std::string& text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Values of the roles, from columns or constants.
class RoleValues {
 public:
  RoleValues(const ReferenceTable& table, const std::map<std::string, std::string>& columns) : table_(table) {
    for (const MeasuredRole& role : measuredRoles()) {
      const auto given = columns.find(role.name);
      const std::string& column = given != columns.end() ? given->second : role.name;
      if (table.hasColumn(column)) {
        sources_[role.name] = {column, std::nullopt};
      } else if (given != columns.end()) {
        const std::optional<double> constant = wholeNumberText(column);
        if (!constant) throw missing(role.name, column);
        sources_[role.name] = {"", constant};
      }
    }
    for (const auto& [role, column] : columns) {
      const auto& roles = measuredRoles();
      if (std::none_of(roles.begin(), roles.end(),
                       [&name = role](const MeasuredRole& r) { return name == r.name; }))
        throw Error(ErrorCode::usage,
                    fmt::format("--columns: no value is called '{}'; values are {}", role, namesOfRoles()));
    }
    for (const char* role : {"transmitter_latitude_deg", "transmitter_longitude_deg", "receiver_latitude_deg",
                             "receiver_longitude_deg", "loss_db"})
      if (!has(role)) throw missing(role, role);
    if (!has("frequency_hz") && !has("frequency_mhz")) throw missing("frequency_mhz", "frequency_mhz");
    for (const char* end : {"transmitter", "receiver"}) {
      const std::string agl = std::string(end) + "_height_agl_m";
      if (!has(agl) && !has(std::string(end) + "_height_msl_m")) throw missing(agl, agl);
    }
  }

  bool has(const std::string& role) const { return sources_.count(role) > 0; }
  double at(int row, const std::string& role) const {
    const Source& source = sources_.at(role);
    return source.constant ? *source.constant : table_.number(row, source.column);
  }
  /// @throws Error (bad_input) outside the limits
  double within(int row, const std::string& role, double min, double max) const {
    const double value = at(row, role);
    if (value >= min && value <= max) return value;
    throw Error(ErrorCode::bad_input, table_.location(row),
                fmt::format("{}: {} is not within {} to {}", role, value, min, max));
  }

 private:
  struct Source {
    std::string column;
    std::optional<double> constant;
  };
  static std::string namesOfRoles() {
    std::vector<std::string> names;
    for (const MeasuredRole& role : measuredRoles()) names.emplace_back(role.name);
    return fmt::format("{}", fmt::join(names, ", "));
  }
  Error missing(const std::string& role, const std::string& column) const {
    return {
        ErrorCode::bad_input,
        {table_.location(0).file, 1, 0},
        fmt::format("column '{}' is missing; --columns {}=COLUMN (or =NUMBER) names another; the table has "
                    "{}",
                    column, role, fmt::join(table_.columns(), ", "))};
  }

  const ReferenceTable& table_;
  std::map<std::string, Source> sources_;
};

/// A row of the table before the terrain is known.
struct MeasuredRow {
  int row = 0;
  double latitude_deg[2] = {}, longitude_deg[2] = {};
  std::optional<double> agl_m[2], msl_m[2];
  double frequency_hz = 0, measured_db = 0;
  int rows = 1;
};

MeasuredRow readRow(const RoleValues& values, int row) {
  MeasuredRow read;
  read.row = row;
  for (int end = 0; end < 2; ++end) {
    const std::string name = end == 0 ? "transmitter" : "receiver";
    read.latitude_deg[end] = values.within(row, name + "_latitude_deg", -90, 90);
    read.longitude_deg[end] = values.within(row, name + "_longitude_deg", -360, 360);
    if (values.has(name + "_height_agl_m"))
      read.agl_m[end] = values.within(row, name + "_height_agl_m", 0, 1e5);
    else
      read.msl_m[end] = values.within(row, name + "_height_msl_m", -500, 1e5);
  }
  read.frequency_hz = values.has("frequency_hz") ? values.within(row, "frequency_hz", 1e5, 1e12)
                                                 : 1e6 * values.within(row, "frequency_mhz", 0.1, 1e6);
  read.measured_db = values.within(row, "loss_db", 0, 500);
  return read;
}

bool holdsBetween(double value, const PathCondition& condition) {
  const double limit = *wholeNumberText(condition.value);
  const std::string& c = condition.comparison;
  return c == "="    ? value == limit
         : c == "<"  ? value < limit
         : c == "<=" ? value <= limit
         : c == ">"  ? value > limit
                     : value >= limit;
}

bool isOfPath(const PathCondition& condition) {
  return condition.name == "distance_m" || condition.name == "elevation_deg";
}

bool holdsInTable(const ReferenceTable& table, int row, const PathCondition& condition) {
  const std::string& cell = table.text(row, condition.name);
  if (condition.comparison == "=" && cell == condition.value) return true;
  return wholeNumberText(condition.value) && holdsBetween(table.number(row, condition.name), condition);
}

void checkConditions(const ReferenceTable& table, const std::vector<PathCondition>& conditions) {
  for (const PathCondition& condition : conditions) {
    if (!isOfPath(condition) && !table.hasColumn(condition.name))
      throw Error(ErrorCode::usage,
                  fmt::format("--where: the table has no column '{}'; it has distance_m, elevation_deg, {}",
                              condition.name, fmt::join(table.columns(), ", ")));
  }
}

/// Rows of one path: the same ends and frequency.
std::vector<MeasuredRow> groupsOf(const std::vector<MeasuredRow>& rows, double group_deg) {
  if (!(group_deg > 0)) return rows;
  using Key = std::array<double, 9>;
  std::map<Key, std::size_t> places;
  std::vector<MeasuredRow> groups;
  for (const MeasuredRow& row : rows) {
    const auto cell = [&](double angle_deg) { return std::round(angle_deg / group_deg); };
    const Key key{cell(row.latitude_deg[0]),  cell(row.longitude_deg[0]), cell(row.latitude_deg[1]),
                  cell(row.longitude_deg[1]), row.agl_m[0].value_or(-1),  row.agl_m[1].value_or(-1),
                  row.msl_m[0].value_or(-1),  row.msl_m[1].value_or(-1),  row.frequency_hz};
    const auto [place, is_new] = places.emplace(key, groups.size());
    if (is_new) {
      groups.push_back(row);
      continue;
    }
    MeasuredRow& sum = groups[place->second];
    ++sum.rows;
    sum.measured_db += (row.measured_db - sum.measured_db) / sum.rows;
    for (int end = 0; end < 2; ++end) {
      sum.latitude_deg[end] += (row.latitude_deg[end] - sum.latitude_deg[end]) / sum.rows;
      sum.longitude_deg[end] += (row.longitude_deg[end] - sum.longitude_deg[end]) / sum.rows;
    }
  }
  return groups;
}

/// The terrain below all paths.
scenario::TerrainPtr terrainOf(const scenario::Scenario& scenario, const std::vector<MeasuredRow>& rows) {
  scenario::Scenario around = scenario;
  around.platforms.clear();
  around.region.origin.latitude_deg = rows.front().latitude_deg[0];
  around.region.origin.longitude_deg = rows.front().longitude_deg[0];
  around.region.size_m = {1, 1, 1};
  for (const MeasuredRow& row : rows) {
    scenario::Platform platform;
    platform.name = "measured path";
    for (int end = 0; end < 2; ++end) {
      platform.track.emplace_back();
      platform.track.back().position.latitude_deg = row.latitude_deg[end];
      platform.track.back().position.longitude_deg = row.longitude_deg[end];
    }
    around.platforms.push_back(std::move(platform));
  }
  return scenario::loadTerrain(around);
}

/// @param agl_m  receives the height above the ground
PathEnd endOf(const MeasuredRow& row, int end, const scenario::Terrain* terrain,
              const SourceLocation& location, double& agl_m) {
  const double latitude_deg = row.latitude_deg[end], longitude_deg = row.longitude_deg[end];
  const double ground_m = terrain == nullptr ? 0 : terrain->heightMsl_m(latitude_deg, longitude_deg);
  if (std::isnan(ground_m)) {
    throw Error(ErrorCode::bad_input, location,
                fmt::format("there is no terrain at latitude {:.5f}, longitude {:.5f} deg; {}", latitude_deg,
                            longitude_deg, scenario::kMissingTerrainRemedy));
  }
  const double height_msl_m = row.agl_m[end] ? ground_m + *row.agl_m[end] : *row.msl_m[end];
  agl_m = height_msl_m - ground_m;
  if (agl_m < 0) {
    throw Error(ErrorCode::bad_input, location,
                fmt::format("{} m above mean sea level is {:.1f} m below the ground", height_msl_m, -agl_m));
  }
  return {{latitude_deg, longitude_deg, height_msl_m + geoidUndulation_m(latitude_deg, longitude_deg)},
          height_msl_m};
}

PathTerrain terrainStateOf(const PathProfile& profile, double wavelength) {
  constexpr double kFree_radii = 0.6;
  const std::vector<PathObstacle> obstacles = pathObstacles(profile, wavelength);
  const auto decisive =
      std::find_if(obstacles.begin(), obstacles.end(), [](const PathObstacle& o) { return o.decides; });
  if (decisive == obstacles.end()) return PathTerrain::clear;
  const double radii = decisive->clearanceInFresnelRadii();
  return radii < 0 ? PathTerrain::blocked : radii < kFree_radii ? PathTerrain::grazing : PathTerrain::clear;
}

/// What a path adds to the results of all.
struct Computed {
  std::vector<std::string> warnings, refusals;  ///< refusals by model
  std::vector<propagation::SteepGround> steep;
};

/// The warnings of all paths, each with the number of paths that have it with any numbers.
std::vector<std::string> warningsOfPaths(const std::vector<Computed>& found) {
  const auto withoutNumbers = [](std::string text) {
    const auto isOfNumber = [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; };
    text.erase(std::remove_if(text.begin(), text.end(), isOfNumber), text.end());
    return text;
  };
  std::map<std::string, std::set<std::size_t>> paths;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const std::string& warning : found[i].warnings) paths[withoutNumbers(warning)].insert(i);
  }
  std::set<std::string> warnings;
  for (const Computed& computed : found) {
    for (const std::string& warning : computed.warnings) {
      warnings.insert(fmt::format("{} (on {} of {} paths)", warning, paths[withoutNumbers(warning)].size(),
                                  found.size()));
    }
  }
  return {warnings.begin(), warnings.end()};
}

/// Sets distance, terrain and losses of a path whose ends are set.
Computed compute(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                 const std::vector<propagation::PropagationModel>& models, const scenario::Terrain* terrain,
                 MeasuredPath& path) {
  Computed found;
  const double wavelength = wavelength_m(path.frequency_hz);
  const auto profileOf = [&](bool at_crossings) {
    return readPathProfile(path.transmitter, path.receiver, scenario.atmosphere, terrain, at_crossings);
  };
  const PathProfile regular = profileOf(false), at_crossings = profileOf(true);
  const double free_space_db = 2 * ratioToDb(4 * kPi * path.distance_m / wavelength);
  path.terrain = terrainStateOf(at_crossings, wavelength);
  for (const propagation::PropagationModel model : models) {
    scenario::Emitter by_model = emitter;
    by_model.frequency_hz = path.frequency_hz;
    by_model.propagation.model = model;
    by_model.propagation.parabolic_equation.source = propagation::PeRadiator::isotropic;
    std::string refusal;
    double loss_db = kNoLoss;
    try {
      const PathProfile& profile = propagation::readsCrossings(by_model.propagation) ? at_crossings : regular;
      const PathExcess excess = pathExcess(scenario, by_model, {}, profile, terrain);
      loss_db = free_space_db + excess.loss_db;
      found.warnings.insert(found.warnings.end(), excess.warnings.begin(), excess.warnings.end());
      if (excess.steep) found.steep.push_back(*excess.steep);
    } catch (const Error& error) {
      refusal = error.message();
    }
    path.computed_db.push_back(loss_db);
    found.refusals.push_back(refusal);
  }
  return found;
}

}  // namespace

const std::vector<MeasuredRole>& measuredRoles() {
  static const std::vector<MeasuredRole> roles = {
      {"transmitter_latitude_deg", "WGS84"},
      {"transmitter_longitude_deg", "WGS84"},
      {"transmitter_height_agl_m", "above the ground; or transmitter_height_msl_m"},
      {"transmitter_height_msl_m", "above mean sea level (EGM96)"},
      {"receiver_latitude_deg", "WGS84"},
      {"receiver_longitude_deg", "WGS84"},
      {"receiver_height_agl_m", "above the ground; or receiver_height_msl_m"},
      {"receiver_height_msl_m", "above mean sea level (EGM96)"},
      {"frequency_mhz", "carrier; or frequency_hz"},
      {"frequency_hz", "carrier"},
      {"loss_db", "basic transmission loss: sent EIRP minus received power between isotropic antennas"}};
  return roles;
}

PathCondition PathCondition::parse(const std::string& text) {
  const std::size_t at = text.find_first_of("<>=");
  if (at != std::string::npos && at > 0 && at + 1 < text.size()) {
    const bool is_double = text[at] != '=' && text[at + 1] == '=';
    PathCondition condition{text.substr(0, at), text.substr(at, is_double ? 2 : 1),
                            text.substr(at + (is_double ? 2 : 1))};
    const bool needs_number = condition.comparison != "=" || isOfPath(condition);
    if (!condition.value.empty() && (!needs_number || wholeNumberText(condition.value))) return condition;
  }
  throw Error(ErrorCode::usage,
              fmt::format("--where '{}' is no condition; expected NAME=VALUE, NAME<NUMBER, NAME<=NUMBER, "
                          "NAME>NUMBER or NAME>=NUMBER, such as distance_m>=1000",
                          text));
}

void ErrorStatistics::add(double error_db) {
  if (!std::isfinite(error_db)) {
    ++without;
    return;
  }
  ++paths;
  mean_db += error_db;
  rms_db += error_db * error_db;
}

void ErrorStatistics::finish() {
  if (paths == 0) return;
  mean_db /= paths;
  const double mean_square = rms_db / paths;
  rms_db = std::sqrt(mean_square);
  sd_db = std::sqrt(std::max(mean_square - mean_db * mean_db, 0.0));
}

MeasuredCheck checkMeasuredPaths(const std::string& file, const scenario::Scenario& scenario,
                                 const scenario::Emitter& emitter, const MeasuredOptions& options) {
  const ReferenceTable table(file, {});
  const RoleValues values(table, options.columns);
  checkConditions(table, options.conditions);
  MeasuredCheck check;
  check.rows = table.rows();
  std::vector<MeasuredRow> rows;
  for (int row = 0; row < table.rows(); ++row) {
    const bool holds =
        std::all_of(options.conditions.begin(), options.conditions.end(),
                    [&](const PathCondition& c) { return isOfPath(c) || holdsInTable(table, row, c); });
    if (holds) rows.push_back(readRow(values, row));
  }
  rows = groupsOf(rows, options.group_deg);
  const auto requirePaths = [&](bool any) {
    if (!any) throw Error(ErrorCode::bad_input, {file, 0, 0}, "no row meets the conditions of --where");
  };
  requirePaths(!rows.empty());
  const scenario::TerrainPtr terrain = terrainOf(scenario, rows);
  for (const MeasuredRow& row : rows) {
    const SourceLocation location = table.location(row.row);
    MeasuredPath path;
    path.line = location.line;
    path.rows = row.rows;
    path.frequency_hz = row.frequency_hz;
    path.measured_db = row.measured_db;
    path.transmitter = endOf(row, 0, terrain.get(), location, path.transmitter_agl_m);
    path.receiver = endOf(row, 1, terrain.get(), location, path.receiver_agl_m);
    const Station station =
        makeStation(path.transmitter.position, path.transmitter.height_msl_m, scenario.atmosphere);
    const Vec3d line = lineTo(station, path.receiver.position);
    path.distance_m = length(line);
    path.elevation_deg = radToDeg(std::atan2(line.z, std::hypot(line.x, line.y)));
    const bool holds =
        std::all_of(options.conditions.begin(), options.conditions.end(), [&](const PathCondition& c) {
          return !isOfPath(c) ||
                 holdsBetween(c.name == "distance_m" ? path.distance_m : path.elevation_deg, c);
        });
    if (!holds) continue;
    check.selected += path.rows;
    check.paths.push_back(std::move(path));
  }
  requirePaths(!check.paths.empty());

  std::vector<Computed> found(check.paths.size());
  parallelFor(static_cast<int>(check.paths.size()), 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      checkpoint();
      try {
        found[i] = compute(scenario, emitter, options.models, terrain.get(), check.paths[i]);
      } catch (const Error& error) {
        throw Error(error.code(), {file, check.paths[i].line, 0}, error.message(), error.hint());
      }
    }
  });
  std::set<std::string> warnings;
  if (terrain) {
    const std::vector<std::string> of_terrain = terrain->warnings();
    warnings.insert(of_terrain.begin(), of_terrain.end());
  }
  for (std::size_t m = 0; m < options.models.size(); ++m) {
    ModelErrors& errors = check.models.emplace_back();
    errors.model = options.models[m];
    for (std::size_t i = 0; i < check.paths.size(); ++i) {
      const MeasuredPath& path = check.paths[i];
      const double error_db = path.computed_db[m] - path.measured_db;
      errors.all.add(error_db);
      errors.by_terrain[static_cast<std::size_t>(path.terrain)].add(error_db);
      if (errors.refusal.empty()) errors.refusal = found[i].refusals[m];
    }
    errors.all.finish();
    for (ErrorStatistics& statistics : errors.by_terrain) statistics.finish();
  }
  check.warnings.assign(warnings.begin(), warnings.end());
  for (std::string& warning : warningsOfPaths(found)) check.warnings.push_back(std::move(warning));
  SteepGrounds steep;
  for (Computed& computed : found) {
    for (propagation::SteepGround& march : computed.steep) steep[emitter.name].push_back(std::move(march));
  }
  for (std::string& warning : steepGroundWarnings(steep)) check.warnings.push_back(std::move(warning));
  return check;
}

}  // namespace emscape::emfield
