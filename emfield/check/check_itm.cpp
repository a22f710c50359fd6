/// ITM against NTIA's implementation: computed cases, and the cases published with it.
#include <fmt/core.h>

#include "emfield/check/datasets.h"
#include "emfield/check/reference_table.h"
#include "propagation/itm/itm.h"

namespace emscape::emfield {

using namespace propagation;
namespace {

ItmLink<double> linkOf(const ReferenceTable& cases, int i) {
  ItmLink<double> link;
  link.height_agl_m[0] = cases.number(i, "h_tx_m");
  link.height_agl_m[1] = cases.number(i, "h_rx_m");
  link.frequency_hz = cases.number(i, "f_mhz") * 1e6;
  link.vertical_polarization = cases.integer(i, "pol") == 1;
  link.relative_permittivity = cases.number(i, "epsilon");
  link.conductivity_s_m = cases.number(i, "sigma");
  link.sea_level_refractivity = cases.number(i, "N_0");
  link.climate = static_cast<ItmClimate>(cases.integer(i, "climate"));
  link.variability_mode = cases.integer(i, "mdvar");
  return link;
}

ItmQuantiles<double> quantilesOf(const ReferenceTable& cases, int i) {
  return {cases.number(i, "time_pct"), cases.number(i, "location_pct"), cases.number(i, "situation_pct")};
}

/// The cases of a folder, computed one by one.
class PointToPoint {
 public:
  explicit PointToPoint(const std::filesystem::path& folder)
      : cases(folder / "cases.csv", {"h_tx_m", "h_rx_m", "climate", "N_0", "f_mhz", "pol", "epsilon", "sigma",
                                     "mdvar", "time_pct", "location_pct", "situation_pct", "A_db"}),
        profiles_(readReferenceProfiles(folder / "profiles.csv")) {
    if (static_cast<int>(profiles_.size()) != cases.rows()) {
      throw Error(ErrorCode::bad_input, {(folder / "profiles.csv").string(), 0, 0},
                  fmt::format("{} profiles where cases.csv has {} cases", profiles_.size(), cases.rows()));
    }
  }

  ItmResult<double> result(int i) const {
    const ReferenceProfile& profile = profiles_[static_cast<std::size_t>(i)];
    const ItmProfile<double> terrain{profile.heights_msl_m.data(),
                                     static_cast<int>(profile.heights_msl_m.size()) - 1, profile.step_m};
    return itmPointToPoint(terrain, linkOf(cases, i), quantilesOf(cases, i));
  }

  const ReferenceTable cases;

 private:
  const std::vector<ReferenceProfile> profiles_;
};

}  // namespace

DatasetCheck checkItmPointToPoint(const std::filesystem::path& folder) {
  const PointToPoint computed(folder);
  const ReferenceTable& cases = computed.cases;
  FigureCheck loss{"A_db", 0.01, "dB"};
  FigureCheck between{"intermediates", 1e-3, "relative"};
  FigureCheck status{"return_code", 0, ""};
  FigureCheck warnings{"warnings", 0, ""};
  FigureCheck mode{"mode", 0, ""};
  for (int i = 0; i < cases.rows(); ++i) {
    const ItmResult<double> result = computed.result(i);
    const int line = cases.location(i).line;
    loss.compare(result.loss_db, cases.number(i, "A_db"), line);
    status.compare(static_cast<int>(result.status), cases.integer(i, "return_code"), line);
    warnings.compare(result.warnings, cases.integer(i, "warnings"), line);
    mode.compare(static_cast<int>(result.mode), cases.integer(i, "mode"), line);
    const ItmTerminal<double>& tx = result.path.terminal[0];
    const ItmTerminal<double>& rx = result.path.terminal[1];
    const std::pair<const char*, double> intermediates[] = {
        {"A_ref_db", result.reference_db},          {"A_fs_db", result.free_space_db},
        {"N_s", result.path.surface_refractivity},  {"delta_h_m", result.path.irregularity_m},
        {"theta_hzn_tx_rad", tx.horizon_angle_rad}, {"theta_hzn_rx_rad", rx.horizon_angle_rad},
        {"d_hzn_tx_m", tx.horizon_distance_m},      {"d_hzn_rx_m", rx.horizon_distance_m},
        {"h_e_tx_m", tx.effective_height_m},        {"h_e_rx_m", rx.effective_height_m}};
    for (const auto& [column, value] : intermediates) {
      between.compareRelative(value, cases.number(i, column), line);
    }
  }
  return {cases.rows(), {loss, between, status, warnings, mode}};
}

DatasetCheck checkItmPublished(const std::filesystem::path& folder) {
  const PointToPoint computed(folder);
  FigureCheck loss{"A_db", 0.006, "dB"};
  for (int i = 0; i < computed.cases.rows(); ++i) {
    loss.compare(computed.result(i).loss_db, computed.cases.number(i, "A_db"),
                 computed.cases.location(i).line);
  }
  return {computed.cases.rows(), {loss}};
}

DatasetCheck checkItmArea(const std::filesystem::path& folder) {
  const ReferenceTable cases(folder / "cases.csv",
                             {"d_km", "delta_h_m", "tx_siting_criteria", "rx_siting_criteria", "A_db"});
  FigureCheck loss{"A_db", 0.051, "dB"};
  for (int i = 0; i < cases.rows(); ++i) {
    const ItmArea<double> area{cases.number(i, "d_km") * 1000,
                               cases.number(i, "delta_h_m"),
                               {static_cast<ItmSiting>(cases.integer(i, "tx_siting_criteria")),
                                static_cast<ItmSiting>(cases.integer(i, "rx_siting_criteria"))}};
    loss.compare(itmAreaMode(area, linkOf(cases, i), quantilesOf(cases, i)).loss_db, cases.number(i, "A_db"),
                 cases.location(i).line);
  }
  return {cases.rows(), {loss}};
}

}  // namespace emscape::emfield
