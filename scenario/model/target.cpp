#include "emscape/scenario/model/target.h"

#include "emscape/base/units.h"
#include "scenario/antenna/csv_grid.h"

namespace emscape::scenario {
namespace {

class MeasuredRcs : public RcsTable {
 public:
  explicit MeasuredRcs(MeasuredGrid grid) : grid_(std::move(grid)) {}
  double rcs_dbsm(double azimuth_deg, double elevation_deg) const override {
    return grid_.valueAt(grid_.azimuth.locate(azimuth_deg), grid_.elevation.locate(elevation_deg));
  }

 private:
  MeasuredGrid grid_;
};

}  // namespace

double Target::rcsTowards_m2(double azimuth_deg, double elevation_deg) const {
  return table ? dbToRatio(table->rcs_dbsm(azimuth_deg, elevation_deg)) : rcs_m2;
}

RcsTablePtr readRcsTable(const std::string& file) {
  return std::make_shared<MeasuredRcs>(readMeasuredGrid(file, {"rcs_dbsm", -200, 100, "dBsm"}, true));
}

}  // namespace emscape::scenario
