#include "emscape/emfield/path_excess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <variant>

#include "emfield/excess/excess_model.h"
#include "emfield/model_check.h"
#include "emfield/models/horizon.h"
#include "emfield/models/p528.h"
#include "emfield/station.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::PropagationModel;
using scenario::Scenario;

/// The path as a column of one voxel, with the memory that models want.
class OneVoxel {
 public:
  explicit OneVoxel(const PathProfile& profile)
      : memory_(ExcessScratch::bytes(profile.count() + 1, 1) / sizeof(double) + 1),
        scratch_(ExcessScratch::in(memory_.data(), profile.count() + 1, 1)) {
    scratch_.height_msl_m[0] = static_cast<float>(profile.end.height_msl_m);
    column_.range_m = profile.range_m;
    column_.ground_msl_m = profile.ground_msl_m.back();
    column_.profile = {profile.ranges_m.data(), profile.ground_msl_m.data(), profile.count()};
    column_.height_msl_m = scratch_.height_msl_m;
    column_.count = 1;
  }

  template <class Model>
  double excess_db(const Model& model) {
    remarks_ |= model(column_, scratch_, scratch_.excess_db);
    return static_cast<double>(scratch_.excess_db[0]);
  }
  const ExcessColumn& column() const { return column_; }
  /// Of all models so far.
  unsigned remarks() const { return remarks_; }

 private:
  std::vector<double> memory_;
  ExcessScratch scratch_;
  ExcessColumn column_;
  unsigned remarks_ = 0;
};

void addHorizon(const PathProfile& profile, PathExcess& excess) {
  // As the field has it: slopes in single precision.
  const HorizonGeometry<float> geometry{static_cast<float>(profile.begin.height_msl_m),
                                        static_cast<float>(profile.effective_earth_radius_m)};
  std::vector<RangeTerms<float>> ranges;
  for (const double range_m : profile.ranges_m) ranges.push_back(geometry.termsAt(range_m));
  std::vector<float> slopes(profile.ranges_m.size());
  grazingSlopes(geometry, profile.ground_msl_m.data(), ranges.data(), profile.count(), slopes.data());
  const int before = profile.count() - 2;
  const bool is_lit = before == 0 || static_cast<float>(profile.end.height_msl_m) >=
                                         geometry.heightOn(slopes[before], ranges.back());
  excess.why = is_lit ? "nothing stands above the ray: free space"
                      : "something stands above the ray: no field at all behind it (no diffraction)";
  if (!is_lit) {
    excess.add("shadow", "shadow of terrain and earth", std::numeric_limits<double>::infinity());
  }
}

void addModel(const NoExcess&, OneVoxel&, PathExcess&) {}
/// addP528 stands for it.
void addModel(const P528Excess&, OneVoxel&, PathExcess&) {}

void addModel(const DiffractionExcess& model, OneVoxel& voxel, PathExcess& excess) {
  const double loss_db = voxel.excess_db(model);
  const double terrain_db = static_cast<double>(
      deltaBullington(model.model, voxel.column().profile, model.tx_msl_m, voxel.column().height_msl_m[0])
          .terrain_db);
  excess.add("terrain_edge", "terrain as one edge (Bullington)", terrain_db);
  excess.add("smooth_earth", "what that lacks of the earth's bulge", loss_db - terrain_db);
  excess.why = "delta-Bullington over the terrain profile";
}

void addModel(const EdgeExcess& model, OneVoxel& voxel, PathExcess& excess) {
  excess.add("edges", model.three_edges ? "three edges (Deygout)" : "the largest edge",
             voxel.excess_db(model));
  excess.why = "terrain as knife edges alone, without the earth's bulge";
}

void addModel(const TwoRayExcess& model, OneVoxel& voxel, PathExcess& excess) {
  excess.add("two_ray", "interference with the reflected ray, horizon", voxel.excess_db(model));
  excess.why = fmt::format("over a smooth surface {:.1f} m above mean sea level; terrain has no part in it",
                           model.surface_msl_m);
}

void addModel(const ItmExcess& model, OneVoxel& voxel, PathExcess& excess) {
  const ExcessColumn& column = voxel.column();
  const double loss_db = voxel.excess_db(model);
  const double diffraction_db = voxel.excess_db(model.diffraction);
  const auto heightWeight = [](float height_msl_m, float ground_msl_m) {
    return itmHeightWeight(static_cast<double>(height_msl_m) - static_cast<double>(ground_msl_m));
  };
  const double weight =
      static_cast<double>(itmRangeWeight(column.range_m) *
                          heightWeight(model.diffraction.tx_msl_m, column.profile.height_msl_m[0]) *
                          heightWeight(column.height_msl_m[0], column.ground_msl_m));
  excess.add("itm", fmt::format("ITM by its weight, {:.2f}", weight),
             loss_db - (1 - weight) * diffraction_db);
  excess.add("diffraction", fmt::format("diffraction by the rest, {:.2f}", 1 - weight),
             (1 - weight) * diffraction_db);
  excess.why = weight == 1   ? "both ends and the distance are within ITM's limits"
               : weight == 0 ? "an end or the distance is outside ITM's limits: diffraction stands instead"
                             : "near ITM's limits it goes over to diffraction by weights";
}

Station stationOf(const PathProfile& profile) {
  return makeStation(profile.begin.position, profile.begin.height_msl_m, profile.k_factor);
}

/// The field takes it from a table of these curves.
void addP528(const Scenario& scenario, const Emitter& emitter, const PathProfile& profile,
             const scenario::Terrain* terrain, PathExcess& excess) {
  const double surface_msl_m = smoothSurface_msl_m(scenario, emitter, stationOf(profile), terrain);
  const auto allowed = [&](double height_msl_m) {
    return std::clamp(height_msl_m - surface_msl_m, kP528Height.least, kP528Height.most);
  };
  const P528Curve curve(std::make_shared<const P528Atmosphere>(emitter.frequency_hz), emitter.frequency_hz,
                        allowed(profile.begin.height_msl_m), allowed(profile.end.height_msl_m),
                        emitter.polarization != scenario::Polarization::horizontal);
  const P528Loss loss = curve.at(profile.range_m, emitter.p528.time_percent);
  const char* const modes[] = {"line of sight", "diffraction", "scatter by the troposphere"};
  excess.add("p528", modes[static_cast<int>(loss.mode) - 1],
             loss.loss_db - loss.free_space_db - loss.absorption_db);
  excess.add("p528_gases", "oxygen and water vapour, as P.528 has them", loss.absorption_db);
  excess.why = fmt::format(
      "over a smooth earth {:.1f} m above mean sea level, not exceeded {:g} % of the time; "
      "terrain has no part in it",
      surface_msl_m, emitter.p528.time_percent);
}

void addAir(AirLoss air, const PathProfile& profile, PathExcess& excess) {
  const auto loss_db = [&] {
    return static_cast<double>(
        air.lossDb(static_cast<float>(profile.range_m), static_cast<float>(profile.end.height_msl_m)));
  };
  const double all_db = loss_db();
  air.level_rain = 0;
  const double gases_db = loss_db();
  if (air.gases != nullptr) excess.add("gases", "oxygen and water vapour", gases_db);
  if (all_db > gases_db) excess.add("rain", "rain", all_db - gases_db);
}

}  // namespace

PathExcess pathExcess(const Scenario& scenario, const Emitter& emitter, const scenario::EmitterState& state,
                      const PathProfile& profile, const scenario::Terrain* terrain,
                      const FanResolution& resolution) {
  const PathExtent extent{profile.range_m, profile.end.height_msl_m, profile.end.height_msl_m};
  PathExcess excess;
  excess.warnings = checkModel(scenario, emitter);
  OneVoxel voxel(profile);
  if (emitter.propagation == PropagationModel::p528) {
    addP528(scenario, emitter, profile, terrain, excess);
    std::vector<float> tables;
    if (hasAirLoss(scenario, emitter)) {
      addAir(airLoss(scenario, emitter, profile.begin.position.latitude_deg, profile.begin.height_msl_m,
                     stationOf(profile).earth_radius_m, extent, tables),
             profile, excess);
    }
  } else {
    if (emitter.propagation == PropagationModel::free_space)
      excess.why = "spreading alone: neither terrain nor earth count";
    if (emitter.propagation == PropagationModel::horizon) addHorizon(profile, excess);
    const EmitterExcess of_model =
        makeExcess(scenario, emitter, stationOf(profile), terrain, extent, resolution);
    std::visit([&](const auto& model) { addModel(model, voxel, excess); }, of_model.model);
    addAir(of_model.air, profile, excess);
  }
  for (std::string& warning : pathWarnings(scenario, emitter, state, extent, terrain, voxel.remarks()))
    excess.warnings.push_back(std::move(warning));
  return excess;
}

}  // namespace emscape::emfield
