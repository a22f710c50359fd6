#include "emscape/emfield/link/path_excess.h"

#include <cmath>
#include <vector>

#include "emfield/columns/station.h"
#include "emfield/excess/emitter_excess.h"
#include "emfield/excess/model_check.h"
#include "emfield/ground/ground_posts.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

using propagation::AirLoss;
using propagation::PathInputs;

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

PathExcess pathExcess(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                      const scenario::BeamPose& beam, const PathProfile& profile,
                      const scenario::Terrain* terrain) {
  PathExcess excess;
  excess.warnings = checkModel(scenario, emitter);
  const propagation::ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  propagation::Atmosphere atmosphere = scenario.atmosphere;
  atmosphere.k_factor = profile.k_factor;
  const Station station = makeStation(profile.begin.position, profile.begin.height_msl_m, atmosphere);
  double end_msl_m = profile.end.height_msl_m;
  if (model.on_effective_earth) {
    end_msl_m = station.refraction.effectiveHeight_m(end_msl_m, station.height_msl_m, profile.range_m);
  }
  const PathInputs inputs = pathInputs(scenario, emitter, beam, station, terrain,
                                       {profile.range_m, profile.end.height_msl_m, profile.end.height_msl_m});
  propagation::TerrainProfile posts{profile.ranges_m.data(), profile.ground_msl_m.data(), profile.count()};
  std::vector<float> cover_m;
  const GroundPosts ground = groundPosts(terrain, profile.ranges_m);
  if (!ground.is_smooth && ground.terrain.hasCover()) {
    cover_m.resize(profile.ranges_m.size());
    const FastInverse along{profile.range_m, std::sin(profile.azimuth_rad), std::cos(profile.azimuth_rad)};
    readCover(station, ground, along, posts.range_m, posts.height_msl_m, posts.count, cover_m.data());
    posts.cover_m = cover_m.data();
  }
  propagation::PathColumn path(posts, profile.range_m, end_msl_m, profile.azimuth_rad);
  inModel(emitter, [&] { static_cast<propagation::Explanation&>(excess) = model.explain(inputs, path); });
  if (propagation::hasAirLoss(inputs.emitter)) {
    std::vector<float> tables;
    addAir(propagation::airLoss(inputs, propagation::hasGases(inputs.emitter), tables), profile, excess);
  }
  for (std::string& warning : pathWarnings(emitter, inputs, path.warnings()))
    excess.warnings.push_back(std::move(warning));
  return excess;
}

}  // namespace emscape::emfield
