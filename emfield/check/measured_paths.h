/// Measured losses of paths against the propagation models.
///
/// A table has one measured path per row. Every path is computed by the functions of `emscape profile`: the
/// same terrain posts, model settings, ground and atmosphere.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "emscape/base/enum_names.h"
#include "emscape/emfield/link/path_profile.h"
#include "emscape/propagation/settings.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::emfield {

/// State of the terrain on a path: the largest obstacle above the ray, within 0.6 radii of the first Fresnel
/// zone, or neither.
enum class PathTerrain { clear, grazing, blocked };
constexpr auto namesOf(PathTerrain) {
  return std::array{"clear", "grazing", "blocked"};
}

/// A condition on the rows: a column of the table, or distance_m or elevation_deg of the straight line at the
/// transmitter.
struct PathCondition {
  std::string name;
  std::string comparison;  ///< =, <, <=, >, >=
  std::string value;       ///< a number; with "=" also a text

  /// Parses "NAME<NUMBER", "NAME=TEXT" and so on. @throws Error (usage)
  static PathCondition parse(const std::string& text);
};

struct MeasuredOptions {
  /// Column names or numbers by role; roles that are missing have the column of their own name.
  std::map<std::string, std::string> columns;
  std::vector<PathCondition> conditions;  ///< all must hold
  /// Rows whose ends agree to this many degrees and in their heights and frequency are one path with the mean
  /// of their losses; 0: every row is a path.
  double group_deg = 0;
  std::vector<propagation::PropagationModel> models;
};

/// Roles of columns; of a pair of heights one is needed.
struct MeasuredRole {
  const char* name;
  const char* description;
};
const std::vector<MeasuredRole>& measuredRoles();

/// One measured path.
struct MeasuredPath {
  int line = 0;  ///< of its first row
  int rows = 1;  ///< that were averaged
  PathEnd transmitter, receiver;
  double transmitter_agl_m = 0, receiver_agl_m = 0;
  double frequency_hz = 0;
  double measured_db = 0;  ///< basic transmission loss
  double distance_m = 0;   ///< slant
  double elevation_deg = 0;
  PathTerrain terrain = PathTerrain::clear;
  std::vector<double> computed_db;  ///< by MeasuredCheck::models; NaN: refused; infinite: no field
};

/// Statistics of computed minus measured losses (dB).
struct ErrorStatistics {
  int paths = 0;       ///< with a computed loss
  int without = 0;     ///< refused, or without a field
  double mean_db = 0;  ///< negative: the model promises too strong a signal
  double sd_db = 0;    ///< of all paths: rms^2 = mean^2 + sd^2
  double rms_db = 0;

  void add(double error_db);
  void finish();
};

/// A model's statistics: of all paths and by their terrain.
struct ModelErrors {
  propagation::PropagationModel model = propagation::PropagationModel::free_space;
  ErrorStatistics all;
  std::array<ErrorStatistics, 3> by_terrain;  ///< by PathTerrain
  std::string refusal;                        ///< the first; empty: none
};

struct MeasuredCheck {
  int rows = 0;      ///< of the table
  int selected = 0;  ///< rows that meet the conditions
  std::vector<MeasuredPath> paths;
  std::vector<ModelErrors> models;
  std::vector<std::string> warnings;  ///< of terrain and models, each once
};

/// Compares a table with the models.
/// @param file      comma-, semicolon- or tab-separated text with a line of column names
/// @param scenario  its terrain, ground, atmosphere and clutter
/// @param emitter   its model settings and polarisation
/// @throws Error (bad_input) with file and line for a malformed table, or a path over missing terrain
MeasuredCheck checkMeasuredPaths(const std::string& file, const scenario::Scenario& scenario,
                                 const scenario::Emitter& emitter, const MeasuredOptions& options);

}  // namespace emscape::emfield
