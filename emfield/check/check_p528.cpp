/// P.528 against points of the recommendation's data tables.
#include <cmath>
#include <map>
#include <memory>
#include <tuple>

#include "emfield/check/datasets.h"
#include "emfield/check/reference_table.h"
#include "propagation/p528/p528.h"

namespace emscape::emfield {

using namespace propagation;

DatasetCheck checkP528(const std::filesystem::path& folder) {
  const ReferenceTable cases(folder / "cases.csv", {"f_mhz", "time_pct", "h1_m", "h2_m", "d_km", "loss_db"});
  std::map<double, std::shared_ptr<const P528Atmosphere>> atmospheres;
  std::map<std::tuple<double, double, double>, P528Curve> curves;
  FigureCheck rounded{"loss_db", 0.1, "dB"};  // in tenths, as in the tables
  FigureCheck exact{"loss_db, unrounded", 0.1, "dB"};
  for (int i = 0; i < cases.rows(); ++i) {
    const double frequency_hz = cases.number(i, "f_mhz") * 1e6;
    const double first_m = cases.number(i, "h1_m");
    const double second_m = cases.number(i, "h2_m");
    auto& atmosphere = atmospheres[frequency_hz];
    if (!atmosphere) atmosphere = std::make_shared<P528Atmosphere>(frequency_hz);
    const auto key = std::make_tuple(frequency_hz, first_m, second_m);
    auto curve = curves.find(key);
    if (curve == curves.end()) {
      curve = curves.emplace(key, P528Curve(atmosphere, frequency_hz, first_m, second_m)).first;
    }
    const double computed_db =
        curve->second.at(cases.number(i, "d_km") * 1000, cases.number(i, "time_pct")).loss_db;
    const double expected_db = cases.number(i, "loss_db");
    rounded.compare((std::round(computed_db * 10) - std::round(expected_db * 10)) / 10, 0,
                    cases.location(i).line);
    exact.compare(computed_db, expected_db, cases.location(i).line);
  }
  return {cases.rows(), {rounded, exact}};
}

}  // namespace emscape::emfield
