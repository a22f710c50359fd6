/// Diffraction.
#include <string>
#include <vector>

#include "emfield/check/datasets.h"
#include "emfield/check/reference_table.h"
#include "propagation/diffraction/diffraction.h"

namespace emscape::emfield {

using namespace propagation;
namespace {

struct Terrain {
  std::vector<double> range_m;
  std::vector<float> height_msl_m;

  TerrainProfile profile() const { return {range_m.data(), height_msl_m.data(), int(range_m.size())}; }
};

Terrain readTerrain(const std::filesystem::path& file) {
  const ReferenceTable posts(file, {"distance_km", "height_amsl_m"});
  Terrain terrain;
  for (int i = 0; i < posts.rows(); ++i) {
    terrain.range_m.push_back(1000 * posts.number(i, "distance_km"));
    terrain.height_msl_m.push_back(float(posts.number(i, "height_amsl_m")));
  }
  return terrain;
}

}  // namespace

DatasetCheck checkDeltaBullington(const std::filesystem::path& folder) {
  const ReferenceTable cases(folder / "cases.csv", {"path", "htg_m", "hrg_m", "f_mhz", "htsp_m", "hrsp_m",
                                                    "L_bulla_dB", "L_bulls_dB", "L_dsph_dB", "L_d_dB"});
  FigureCheck loss{"L_d_dB", 0.1, "dB"}, terrain_loss{"L_bulla_dB", 0.1, "dB"},
      smooth{"L_bulls_dB", 0.1, "dB"}, spherical{"L_dsph_dB", 0.1, "dB"}, transmitter{"htsp_m", 1e-3, "m"},
      receiver{"hrsp_m", 1e-3, "m"};
  for (int i = 0; i < cases.rows(); ++i) {
    const Terrain terrain =
        readTerrain(folder / ("path" + std::to_string(cases.integer(i, "path")) + ".csv"));
    DiffractionParameters parameters;
    // the reference uses c = 3e8 m/s: the same wavelength at another frequency
    parameters.frequency_hz = cases.number(i, "f_mhz") * 1e6 * (kSpeedOfLight / 3e8);
    parameters.effective_earth_radius_m = 8.5e6;
    const auto model = diffractionModel<double>(parameters);
    const DeltaBullington<double> result =
        deltaBullington(model, terrain.profile(), terrain.height_msl_m.front() + cases.number(i, "htg_m"),
                        terrain.height_msl_m.back() + cases.number(i, "hrg_m"));
    const int line = cases.location(i).line;
    loss.compare(result.loss_db, cases.number(i, "L_d_dB"), line);
    terrain_loss.compare(result.terrain_db, cases.number(i, "L_bulla_dB"), line);
    if (result.spherical_db > 0) smooth.compare(result.smooth_db, cases.number(i, "L_bulls_dB"), line);
    spherical.compare(result.spherical_db, cases.number(i, "L_dsph_dB"), line);
    transmitter.compare(result.effective.tx_m, cases.number(i, "htsp_m"), line);
    receiver.compare(result.effective.rx_m, cases.number(i, "hrsp_m"), line);
  }
  return {cases.rows(), {loss, terrain_loss, smooth, spherical, transmitter, receiver}};
}

DatasetCheck checkKnifeEdge(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"nu", "J_exact_fresnel_dB", "J_P526_approx_dB"});
  FigureCheck exact{"J_exact_fresnel_dB", 1e-4, "dB"}, approximate{"J_P526_approx_dB", 1e-4, "dB"};
  for (int i = 0; i < cases.rows(); ++i) {
    const double nu = cases.number(i, "nu");
    const int line = cases.location(i).line;
    exact.compare(knifeEdgeExactDb(nu), cases.number(i, "J_exact_fresnel_dB"), line);
    approximate.compare(knifeEdgeDb(nu), cases.number(i, "J_P526_approx_dB"), line);
  }
  return {cases.rows(), {exact, approximate}};
}

}  // namespace emscape::emfield
