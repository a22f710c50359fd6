/// Geoid undulation at published points.
#include "emfield/check/datasets.h"
#include "emfield/check/reference_table.h"
#include "emscape/base/geodesy/geoid.h"

namespace emscape::emfield {

DatasetCheck checkGeoid(const std::filesystem::path& folder) {
  const ReferenceTable cases(folder / "check_points.csv", {"lat_deg", "lon_deg_east", "N_m"});
  FigureCheck undulation{"N_m", 0.02, "m"};
  for (int i = 0; i < cases.rows(); ++i) {
    undulation.compare(geoidUndulation_m(cases.number(i, "lat_deg"), cases.number(i, "lon_deg_east")),
                       cases.number(i, "N_m"), cases.location(i).line);
  }
  return {cases.rows(), {undulation}};
}

}  // namespace emscape::emfield
