#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "emfield/columns/station.h"
#include "emfield/excess/clutter_text.h"
#include "emfield/excess/emitter_excess.h"
#include "emfield/excess/model_check.h"
#include "emfield/ground/ground_posts.h"
#include "emscape/emfield/link/path_budget.h"
#include "propagation/clear_air/row.h"
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

/// The clutter on a path as the model reads it.
PathCover coverOf(const propagation::ModelSettings& settings, const propagation::TerrainProfile& posts) {
  const bool is_raised = propagation::isRaisedByClutter(settings),
             is_p1812 = settings.model == propagation::PropagationModel::p1812;
  const propagation::ClearAirGround ground = is_p1812
                                                 ? propagation::clearAirGround(settings.p1812, kClutterFree_m)
                                                 : propagation::clearAirGround(settings.p452, kClutterFree_m);
  PathCover cover;
  bool is_bare = true;
  for (int i = 0; i < posts.count; ++i) {
    const bool is_between = isClutterAt(posts.range_m[i], posts.range_m[posts.count - 1]);
    const float height_m = !is_raised   ? ground.clutterAt(posts, i)
                           : is_between ? posts.clutter_m(i, 0.0f)
                                        : 0.0f;
    cover.height_m.push_back(height_m);
    is_bare = is_bare && !(height_m > 0);
  }
  if (is_bare) return {};
  cover.ranges_m.assign(posts.range_m, posts.range_m + posts.count);
  cover.ground_msl_m.assign(posts.height_msl_m, posts.height_msl_m + posts.count);
  return cover;
}

}  // namespace

PathExcess pathExcess(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                      const scenario::BeamPose& beam, const PathProfile& given,
                      const scenario::Terrain* terrain) {
  PathExcess excess;
  excess.warnings = checkModel(scenario, emitter);
  const propagation::ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  propagation::Atmosphere atmosphere = scenario.atmosphere;
  atmosphere.k_factor = given.k_factor;
  std::optional<PathProfile> even;
  if (model.radial != nullptr && terrain != nullptr) even = withEvenPosts(given, atmosphere, *terrain);
  const PathProfile& profile = even ? *even : given;
  const Station station = makeStation(profile.begin.position, profile.begin.height_msl_m, atmosphere);
  double end_msl_m = profile.end.height_msl_m;
  if (model.on_effective_earth) {
    end_msl_m = station.refraction.effectiveHeight_m(end_msl_m, station.height_msl_m, profile.range_m);
  }
  const PathInputs inputs = pathInputs(scenario, emitter, beam, station, terrain,
                                       {profile.range_m, profile.end.height_msl_m, profile.end.height_msl_m});
  std::vector<double> ranges_m = profile.ranges_m;
  std::vector<float> heights_msl_m = profile.ground_msl_m, cover_m;
  const std::vector<double> regular_m = postRanges(profile.range_m, postSpacing_m(terrain));
  GroundPosts ground = groundPosts(terrain, regular_m);
  const FastInverse along{profile.range_m, std::sin(profile.azimuth_rad), std::cos(profile.azimuth_rad)};
  int count = profile.count();
  const bool has_clutter = hasClutter(emitter.propagation, terrain);
  if (has_clutter && profile.cover_m.empty()) {
    ground.has_clutter = true;
    ranges_m.resize(ranges_m.size() + kMostClutterPosts);
    heights_msl_m.resize(ranges_m.size());
    count = addClutterPosts(station, ground, along, count, ranges_m.data(), heights_msl_m.data());
  }
  propagation::TerrainProfile posts{ranges_m.data(), heights_msl_m.data(), count};
  if (!ground.is_smooth && ground.terrain.hasCover()) {
    cover_m.resize(static_cast<std::size_t>(count));
    readCover(station, ground, along, posts.range_m, posts.height_msl_m, posts.count, cover_m.data());
    posts.cover_m = cover_m.data();
  }
  if (has_clutter) excess.cover = coverOf(emitter.propagation, posts);
  const bool is_raised = propagation::isRaisedByClutter(emitter.propagation);
  propagation::PathColumn path(posts, profile.range_m, end_msl_m, profile.azimuth_rad);
  inModel(emitter, [&] {
    const auto bare = [&](std::vector<float>& bare_m) {
      for (float& height_m : bare_m) height_m = height_m > 0 ? 0 : height_m;
    };
    const bool has_heights =
        std::any_of(cover_m.begin(), cover_m.end(), [](float height_m) { return height_m > 0; });
    if (!has_heights || !usesClutterMap(emitter.propagation)) {
      static_cast<propagation::Explanation&>(excess) = model.explain(inputs, path);
      return;
    }
    // The parts of the path over bare ground, and what the clutter adds to their sum.
    std::vector<float> bare_m = cover_m, raised_msl_m(heights_msl_m.size());
    bare(bare_m);
    propagation::TerrainProfile without = posts;
    without.cover_m = bare_m.data();
    const propagation::TerrainProfile with = is_raised ? raiseByClutter(posts, raised_msl_m.data()) : posts;
    propagation::PathColumn over_ground(without, profile.range_m, end_msl_m, profile.azimuth_rad);
    propagation::PathColumn over_clutter(with, profile.range_m, end_msl_m, profile.azimuth_rad);
    static_cast<propagation::Explanation&>(excess) = model.explain(inputs, over_ground);
    const propagation::Explanation all = model.explain(inputs, over_clutter);
    path.addWarnings(over_clutter.warnings());
    excess.steep = all.steep;
    excess.clutter_db = all.loss_db - excess.loss_db;
    excess.add("clutter", "trees and buildings along the path", excess.clutter_db);
    excess.why = all.why;
    if (emitter.propagation.model != propagation::PropagationModel::itm) return;
    const propagation::ModelInfo& edges = propagation::modelInfo(propagation::PropagationModel::diffraction);
    const double by_edges_db =
        edges.explain(inputs, over_clutter).loss_db - edges.explain(inputs, over_ground).loss_db;
    constexpr double kFar_db = 10;
    if (std::abs(excess.clutter_db - by_edges_db) > kFar_db) {
      excess.warnings.push_back(fmt::format(
          "emitter '{}': trees and buildings on the path cost {:.1f} dB by 'itm' and {:.1f} dB by "
          "'diffraction': near an end, ITM takes them for nothing while a line of sight between its posts is "
          "left, and for a horizon as soon as none is; 'propagation: diffraction' has no such step",
          emitter.name, excess.clutter_db + 0.0, by_edges_db));
    }
  });
  for (std::string& warning : scatterWarnings(emitter, inputs, path.column(), profile.end.height_msl_m,
                                              excess.loss_db - std::max(excess.clutter_db, 0.0)))
    excess.warnings.push_back(std::move(warning));
  const propagation::TerminalClutter terminal = terminalClutter(scenario, emitter, station, terrain);
  const auto end_agl_m = static_cast<float>(profile.end.height_msl_m) - profile.ground_msl_m.back();
  if (const int ends = terminal.ends(static_cast<float>(profile.range_m), end_agl_m); ends > 0) {
    double loss_db = static_cast<double>(terminal.lossDb(static_cast<float>(profile.range_m), end_agl_m));
    const double terrain_db = excess.loss_db;
    const char* const around = ends > 1 ? "both ends" : "one end";
    if (terminal.is_larger) loss_db = std::max(loss_db - terrain_db, 0.0);
    excess.add("terminal_clutter",
               fmt::format("clutter around {} (P.2108-1, {:g} % of locations{}{})", around,
                           scenario.ground.terminal_clutter_percent, ends > 1 ? " of each" : "",
                           terminal.is_larger ? ", what it has more than the terrain" : ""),
               loss_db);
    excess.clutter_db += loss_db;
    constexpr double kGrazing_db = 6;
    if (!terminal.is_larger && !model.on_smooth_surface && terrain_db > kGrazing_db &&
        std::isfinite(terrain_db)) {
      excess.warnings.push_back(fmt::format(
          "emitter '{}': {} costs {:.1f} dB, and {:.1f} dB of P.2108-1 are added to it for clutter around "
          "{}: "
          "on measured paths that terrain blocks, such sums were 9 to 20 dB too high in the mean; 'ground: "
          "{{terminal_clutter_combine: larger}}' takes the larger of both",
          emitter.name, terrain == nullptr ? "the smooth earth" : "terrain", terrain_db, loss_db, around));
    }
  }
  if (propagation::hasAirLoss(inputs.emitter)) {
    std::vector<float> tables;
    addAir(propagation::airLoss(inputs, propagation::hasGases(inputs.emitter), tables), profile, excess);
  }
  if (model.on_smooth_surface && terrain != nullptr && !scenario.ground.surface_msl_m)
    excess.why += "; the surface is the ground below the emitter, and another with the ends exchanged";
  if (model.on_smooth_surface && profile.end.height_msl_m < inputs.surface_msl_m) {
    excess.warnings.push_back(fmt::format(
        "emitter '{}': the point is {:.0f} m below the smooth surface of '{}' ({:.0f} m above "
        "mean sea level), where the model has no field of its own; 'ground: {{surface_msl_m: "
        "...}}' sets the surface",
        emitter.name, inputs.surface_msl_m - profile.end.height_msl_m, model.name, inputs.surface_msl_m));
  }
  for (std::string& warning : pathWarnings(emitter, inputs, path.warnings()))
    excess.warnings.push_back(std::move(warning));
  const auto groundAt_m = [&](float ground_msl_m) {
    return model.on_smooth_surface ? inputs.surface_msl_m : static_cast<double>(ground_msl_m);
  };
  for (std::string& warning :
       lowEndWarnings(emitter, profile.begin.height_msl_m - groundAt_m(profile.ground_msl_m.front()),
                      profile.end.height_msl_m - groundAt_m(profile.ground_msl_m.back())))
    excess.warnings.push_back(std::move(warning));
  return excess;
}

}  // namespace emscape::emfield
