/// P.452 against the validation set of ITU-R Study Group 3.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "emfield/check/datasets.h"
#include "emfield/check/reference_table.h"
#include "emscape/base/units.h"
#include "propagation/clear_air/single_path.h"
#include "propagation/p452/p452.h"

namespace emscape::emfield {

using namespace propagation;
namespace {

namespace fs = std::filesystem;

struct P452Posts {
  std::vector<double> range_m;
  std::vector<float> height_msl_m;
  std::vector<double> clutter_m;
  std::vector<PathZone> zones;
};

P452Posts readP452Posts(const fs::path& file) {
  const char* const kZone = "zone: 1=Coastal Land/2=Inland/3=Sea";
  const ReferenceTable table(file, {"d (km)", "h(m)", kZone});
  const PathZone zones[] = {PathZone::coastal_land, PathZone::inland, PathZone::sea};
  const char* const clutter =
      table.hasColumn("Ground cover height (m)") ? "Ground cover height (m)" : "Ground Cover Height (m)";
  P452Posts posts;
  for (int i = 0; i < table.rows(); ++i) {
    posts.range_m.push_back(1000 * table.number(i, "d (km)"));
    posts.height_msl_m.push_back(static_cast<float>(table.number(i, "h(m)")));
    posts.clutter_m.push_back(table.number(i, clutter));
    posts.zones.push_back(zones[std::clamp(table.integer(i, kZone), 1, 3) - 1]);
  }
  return posts;
}

/// Latitude (deg) half way along a path: P.2001-4 Attachment H.
double middleLatitude_deg(const ReferenceTable& cases, int i) {
  const auto angle_rad = [&](const char* column) { return degToRad(cases.number(i, column)); };
  const double from = angle_rad("phit_n (deg)"), to = angle_rad("phir_n (deg)");
  const double east = angle_rad("phir_e (deg)") - angle_rad("phit_e (deg)");
  const double bearing_rad =
      std::atan2(std::sin(east) * std::cos(to),
                 std::cos(from) * std::sin(to) - std::sin(from) * std::cos(to) * std::cos(east));
  const double half_rad = cases.number(i, "dtot") * 1000 / 2 / kClearAirEarthRadius_m;
  return radToDeg(std::asin(std::sin(from) * std::cos(half_rad) +
                            std::cos(from) * std::sin(half_rad) * std::cos(bearing_rad)));
}

/// Differences, by unit.
struct P452Figures {
  FigureCheck loss{"Lb", 1e-3, "dB"};
  FigureCheck losses{"losses of mechanisms", 1e-3, "dB"};
  FigureCheck angles{"angles", 1e-3, "mrad"};
  FigureCheck distances{"distances", 1e-5, "km"};
  FigureCheck heights{"heights", 1e-3, "m"};
  FigureCheck parameters{"parameters", 2e-6, "relative"};  // they have seven digits
};

void compare(const P452Model<double>& model, const ClearAirColumn<double>& column,
             const P452Path<double>& path, const ReferenceTable& cases, int i, P452Figures& figures) {
  const auto check = [&](FigureCheck& figure, const char* name, double computed) {
    figure.compare(computed, cases.number(i, name), cases.location(i).line);
  };
  const ClearAirPath<double>& at = path.geometry;
  const ClearAirLoss<double>& loss = path.loss;
  check(figures.loss, "Lb", loss.loss_db);

  check(figures.losses, "Lbfsg", loss.sight.median_db);
  check(figures.losses, "Lb0p", loss.sight.loss_db);
  check(figures.losses, "Lb0b", loss.sight.ducting_db);
  check(figures.losses, "Ldsph", loss.diffraction.median.spherical_db);
  check(figures.losses, "Ld50", loss.diffraction.median.loss_db);
  check(figures.losses, "Ldp", loss.diffraction.loss_db);
  check(figures.losses, "Lbs", loss.troposcatter_db);
  check(figures.losses, "Lba", loss.ducting_db);

  check(figures.angles, "theta_t", at.horizon_angle_mrad[0]);
  check(figures.angles, "theta_r", at.horizon_angle_mrad[1]);
  check(figures.angles, "theta", at.angle_mrad);

  check(figures.distances, "dlt", at.horizon_distance_m[0] / 1000);
  check(figures.distances, "dlr", at.horizon_distance_m[1] / 1000);
  check(figures.distances, "dtm", column.zones.longest_land_m / 1000);
  check(figures.distances, "dlm", column.zones.longest_inland_m / 1000);

  const double base_m = column.base_msl_m;
  check(figures.heights, "hm", at.roughness_m);
  check(figures.heights, "hte", at.ducting_height_m[0]);
  check(figures.heights, "hre", at.ducting_height_m[1]);
  check(figures.heights, "hstd", base_m + column.tx_m - at.diffraction_heights.tx_m);
  check(figures.heights, "hsrd", base_m + at.rx_m - at.diffraction_heights.rx_m);

  const auto relative = [&](const char* name, double computed) {
    figures.parameters.compareRelative(computed, cases.number(i, name), cases.location(i).line);
  };
  relative("ae", model.clear_air.median.earth.earth_radius_m / 1000);
  relative("b0", column.ducting_time_percent);
  relative("omega", column.zones.sea_fraction);
}

}  // namespace

DatasetCheck checkP452(const fs::path& folder) {
  std::vector<fs::path> results;
  for (const auto& entry : fs::directory_iterator(folder / "results")) results.push_back(entry.path());
  std::sort(results.begin(), results.end());
  P452Figures figures;
  int count = 0;
  for (const fs::path& file : results) {
    std::string name = file.filename().string();  // test_result_PATH.csv
    name.replace(name.find("result"), 6, "profile");
    const P452Posts posts = readP452Posts(folder / "profiles" / name);
    const ReferenceTable cases(file, {"f (GHz)", "p (%)", "Lb"});
    for (int i = 0; i < cases.rows(); ++i, ++count) {
      P452Parameters parameters;
      parameters.clear_air.frequency_hz = cases.number(i, "f (GHz)") * 1e9;
      parameters.clear_air.time_percent = cases.number(i, "p (%)");
      parameters.clear_air.latitude_deg = middleLatitude_deg(cases, i);
      parameters.clear_air.lapse_rate = cases.number(i, "DN");
      parameters.clear_air.polarization = cases.integer(i, "pol (1-h/2-v)") == 1
                                              ? LinearPolarization::horizontal
                                              : LinearPolarization::vertical;
      parameters.sea_level_refractivity = cases.number(i, "N0");
      parameters.dry_pressure_hpa = cases.number(i, "press (hPa)");
      parameters.temperature_k = cases.number(i, "temp (deg C)") + 273.15;
      parameters.gains_dbi = cases.number(i, "Gt (dBi)") + cases.number(i, "Gr (dBi)");
      const auto model = p452Model<double>(parameters);

      const TerrainProfile profile{posts.range_m.data(), posts.height_msl_m.data(),
                                   static_cast<int>(posts.range_m.size())};
      PathZones zones =
          sumZones(profile, [&](int post) { return posts.zones[static_cast<std::size_t>(post)]; });
      zones.coast_distance_m[0] = 1000 * cases.number(i, "dct (km)");
      zones.coast_distance_m[1] = 1000 * cases.number(i, "dcr (km)");
      const ClearAirProfile path(model.clear_air, profile, zones, cases.number(i, "hts"), [&](int post) {
        return isNearTerminal(profile, post, kP452ClutterDistance_m)
                   ? 0
                   : posts.clutter_m[static_cast<std::size_t>(post)];
      });
      compare(model, path.column(), p452Path(model, path.column(), cases.number(i, "hrs")), cases, i,
              figures);
    }
  }
  return {
      count,
      {figures.loss, figures.losses, figures.angles, figures.distances, figures.heights, figures.parameters}};
}

}  // namespace emscape::emfield
