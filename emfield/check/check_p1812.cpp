/// P.1812 against the validation set of ITU-R Study Group 3: every intermediate value that it contains.
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/files/file_reading.h"
#include "document/csv.h"
#include "emfield/check/datasets.h"
#include "propagation/clear_air/single_path.h"
#include "propagation/p1812/p1812.h"

namespace emscape::emfield {

using namespace propagation;
namespace {

namespace fs = std::filesystem;

double parseNumber(std::string_view text, const SourceLocation& place) {
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && stop == text.data() + text.size()) return value;
  throw Error(ErrorCode::bad_input, place, fmt::format("'{}' is not a number", text));
}

struct P1812Posts {
  std::vector<double> range_m;
  std::vector<float> height_msl_m;
  std::vector<double> clutter_m;
  std::vector<PathZone> zones;

  TerrainProfile profile() const {
    return {range_m.data(), height_msl_m.data(), static_cast<int>(range_m.size())};
  }
};

/// A profile in the format of Study Group 3's measurement data (Fryderyk).
P1812Posts readP1812Posts(const fs::path& file) {
  const std::string text = readWholeText(file);
  document::CsvReader reader(text);
  P1812Posts posts;
  bool is_profile = false;
  for (document::CsvRow row; reader.next(row);) {
    const std::string_view first = row.cells[0].text;
    if (first == "{End of Profile}") break;
    if (is_profile && first != "Number of Points:") {
      const auto number = [&](std::size_t i) {
        const SourceLocation place{file.string(), row.line, 0};
        if (i < row.cells.size()) return parseNumber(row.cells[i].text, place);
        throw Error(ErrorCode::bad_input, place, "a post has five cells");
      };
      posts.range_m.push_back(1000 * number(0));
      posts.height_msl_m.push_back(static_cast<float>(number(1)));
      posts.clutter_m.push_back(number(3));
      const double zone = number(4);
      posts.zones.push_back(zone == 1   ? PathZone::sea
                            : zone == 3 ? PathZone::coastal_land
                                        : PathZone::inland);
    }
    is_profile = is_profile || first == "{Begin of Profile}";
  }
  if (posts.range_m.size() >= 3) return posts;
  throw Error(ErrorCode::bad_input, {file.string(), 0, 0}, "has no terrain profile");
}

/// Values of a log by name and, if given, equation: "hst (m) Eq (85)".
class Log {
 public:
  explicit Log(const fs::path& file) : file_(file.string()) {
    const std::string text = readWholeText(file);
    document::CsvReader reader(text);
    for (document::CsvRow row; reader.next(row);) {
      if (row.cells.size() < 4 || row.cells[3].text.empty()) continue;
      std::string name(row.cells[0].text);
      if (!row.cells[1].text.empty()) name += " " + std::string(row.cells[1].text);
      values_[name] = {parseNumber(row.cells[3].text, {file_, row.line, 0}), row.line};
    }
  }
  struct Value {
    double number;
    int line;
  };
  const Value& at(const std::string& name) const {
    const auto found = values_.find(name);
    if (found != values_.end()) return found->second;
    throw Error(ErrorCode::bad_input, {file_, 0, 0}, fmt::format("has no '{}'", name));
  }
  double operator[](const std::string& name) const { return at(name).number; }

 private:
  std::string file_;
  std::map<std::string, Value> values_;
};

/// Differences, by unit.
struct P1812Figures {
  FigureCheck loss{"Lb", 1e-3, "dB"};
  FigureCheck losses{"losses of mechanisms", 1e-3, "dB"};
  FigureCheck angles{"angles", 1e-3, "mrad"};
  FigureCheck distances{"distances", 1e-6, "km"};
  FigureCheck heights{"heights", 1e-3, "m"};
  FigureCheck parameters{"parameters", 1e-6, "relative"};
  FigureCheck factors{"F_i, F_j, F_k, omega", 1e-6, ""};
};

void compare(const P1812Model<double>& model, const ClearAirColumn<double>& column,
             const P1812Path<double>& path, const Log& log, P1812Figures& figures) {
  const ClearAirPath<double>& at = path.geometry;
  const ClearAirLoss<double>& loss = path.median;
  const DeltaBullington<double>& ducting = loss.diffraction.ducting;
  const auto check = [&log](FigureCheck& figure, const char* name, double computed) {
    figure.compare(computed, log[name], log.at(name).line);
  };
  check(figures.loss, "Lb (dB) Eq (69)", path.loss_db);

  check(figures.losses, "Lbfs Eq (8)", loss.sight.free_space_db);
  check(figures.losses, "Lb0p Eq (10)", loss.sight.loss_db);
  check(figures.losses, "Lb0b Eq (11)", loss.sight.ducting_db);
  check(figures.losses, "Lbulla (dB) Eq (21)", ducting.terrain_db);
  if (ducting.spherical_db > 0) check(figures.losses, "Lbulls (dB) Eq (21)", ducting.smooth_db);
  check(figures.losses, "Ldsph (dB) Eq (27)", ducting.spherical_db);
  check(figures.losses, "Ld50 (dB) Eq (39)", loss.diffraction.median.loss_db);
  check(figures.losses, "Ldb (dB) Eq (39)", ducting.loss_db);
  check(figures.losses, "Ldp (dB) Eq (41)", loss.diffraction.loss_db);
  check(figures.losses, "Lbd50 (dB) Eq (42)", loss.sight.median_db + loss.diffraction.median.loss_db);
  // The reference's log also has L_bda under this name, where ducts make it smaller.
  check(
      figures.losses, "Lbd (dB) Eq (43)",
      loss.sight_or_ducting_db <= loss.diffraction_db ? loss.diffraction_or_ducting_db : loss.diffraction_db);
  check(figures.losses, "Lminb0p (dB) Eq (59)", loss.sight_and_sub_path_db);
  check(figures.losses, "Lba (dB) Eq (46)", loss.ducting_db);
  check(figures.losses, "Lminbap (dB) Eq (60)", loss.sight_or_ducting_db);
  check(figures.losses, "Lbda (dB) Eq (61)", loss.diffraction_or_ducting_db);
  check(figures.losses, "Lbam (dB) Eq (62)", loss.without_scatter_db);
  check(figures.losses, "Lbs (dB) Eq (44)", loss.troposcatter_db);
  check(figures.losses, "Lbc (dB) Eq (63)", loss.loss_db);

  check(figures.angles, "th_t (mrad) Eqs (76-78)", at.horizon_angle_mrad[0]);
  check(figures.angles, "th_r (mrad) Eqs (79-81)", at.horizon_angle_mrad[1]);
  check(figures.angles, "th (mrad) Eq (82)", at.angle_mrad);

  check(figures.distances, "dlt (km) Eq (78)", at.horizon_distance_m[0] / 1000);
  check(figures.distances, "dlr (km) Eq (81a)", at.horizon_distance_m[1] / 1000);
  check(figures.distances, "dtm (km) Sec 3.6", column.zones.longest_land_m / 1000);
  check(figures.distances, "dlm (km) Sec 3.6", column.zones.longest_inland_m / 1000);

  const double base_m = column.base_msl_m;
  check(figures.heights, "hst (m) Eq (85)", base_m + column.trend_m[0]);
  check(figures.heights, "hsr (m) Eq (86)", base_m + column.trend_m[1]);
  check(figures.heights, "hst (m) Eq (90a)", base_m + at.smooth_m[0]);
  check(figures.heights, "hsr (m) Eq (90b)", base_m + at.smooth_m[1]);
  check(figures.heights, "htc (m) Eq (37a)", at.diffraction_heights.tx_m);
  check(figures.heights, "hrc (m) Eq (37b)", at.diffraction_heights.rx_m);
  check(figures.heights, "hte (m) Eq (92a)", at.ducting_height_m[0]);
  check(figures.heights, "hre (m) Eq (92b)", at.ducting_height_m[1]);
  check(figures.heights, "hm (m) Eq (93)", at.roughness_m);

  const auto relative = [&](const char* name, double computed) {
    figures.parameters.compareRelative(computed, log[name], log.at(name).line);
  };
  relative("b0 (%) Eq (5)", column.ducting_time_percent);
  relative("ae (km) Eq (7a)", model.clear_air.median.earth.earth_radius_m / 1000);

  check(figures.factors, "w Table 5", column.zones.sea_fraction);
  check(figures.factors, "Fi Eq (40)", loss.diffraction.interpolation);
  check(figures.factors, "Fj Eq (57)", loss.sight_part);
  check(figures.factors, "Fk Eq (58)", loss.near_part);
}

}  // namespace

DatasetCheck checkP1812(const fs::path& folder) {
  std::vector<fs::path> results;
  for (const auto& entry : fs::directory_iterator(folder / "results")) results.push_back(entry.path());
  std::sort(results.begin(), results.end());
  P1812Figures figures;
  for (const fs::path& file : results) {
    const std::string name = file.stem().string();  // PROFILE_N_log
    const P1812Posts posts =
        readP1812Posts(folder / "profiles" / (name.substr(0, name.rfind('_', name.rfind('_') - 1)) + ".csv"));
    const Log log(file);

    ClearAirParameters parameters;
    parameters.frequency_hz = log["f (GHz)"] * 1e9;
    parameters.time_percent = log["p (%)"];
    parameters.latitude_deg = log["phi (deg) Eq (4)"];
    parameters.lapse_rate = log["DN"];
    parameters.polarization = log["pol"] == 1 ? LinearPolarization::horizontal : LinearPolarization::vertical;
    P1812Model<double> model;
    model.clear_air = clearAirModel<double>(parameters);
    model.sea_level_refractivity = log["N0"];
    model.location_deviate = normalDeviate(log["pL (%)"] / 100);
    model.location_deviation_db = log["sigmaL (dB)"];

    const TerrainProfile profile = posts.profile();
    PathZones zones = sumZones(profile, [&](int i) { return posts.zones[static_cast<std::size_t>(i)]; });
    zones.coast_distance_m[0] = posts.zones.front() == PathZone::sea ? 0 : 1000 * log["dct (km)"];
    zones.coast_distance_m[1] = posts.zones.back() == PathZone::sea ? 0 : 1000 * log["dcr (km)"];
    const ClearAirProfile path(model.clear_air, profile, zones, log["hts (m)"],
                               [&](int i) { return posts.clutter_m[static_cast<std::size_t>(i)]; });
    compare(model, path.column(), p1812Path(model, path.column(), log["hrs (m)"]), log, figures);
  }
  return {static_cast<int>(results.size()),
          {figures.loss, figures.losses, figures.angles, figures.distances, figures.heights,
           figures.parameters, figures.factors}};
}

}  // namespace emscape::emfield
