/// The models that have an excess loss, as the field solver sees them.
///
/// A model is a plain struct with
///     static constexpr bool kNeedsTerrain;  // whether a column's profile is read for it
///     static constexpr bool kInParts;       // whether it is made of begin() and fill()
///     EMSCAPE_HD unsigned operator()(const ExcessColumn&, const ExcessScratch&, float* excess_db) const;
/// which fills the excess (dB) of a column's voxels and returns remarks (bits). It runs on host and device.
/// On a device that has more threads than columns fit into its memory, begin() does what comes once for a
/// column and fill(), which also takes a ColumnPart, some of the heights of many. begin() returns 0, or
/// kMissingTerrain with NaN for every voxel; then there is nothing to fill.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "emfield/excess/air_loss.h"
#include "emfield/excess/diffraction_excess.h"
#include "emfield/excess/edge_excess.h"
#include "emfield/excess/itm_excess.h"
#include "emfield/excess/p528_excess.h"
#include "emfield/excess/smooth_excess.h"
#include "emfield/grid_columns.h"
#include "emfield/station.h"
#include "emscape/scenario/scenario.h"

namespace emscape::emfield {

using ExcessModel =
    std::variant<NoExcess, DiffractionExcess, EdgeExcess, TwoRayExcess, ItmExcess, P528Excess>;

/// What the paths from one emitter lose over free space.
struct EmitterExcess {
  ExcessModel model;
  AirLoss air;

  /// What model and air point to, in host memory; empty where they need none.
  std::shared_ptr<const std::vector<float>> model_tables, air_tables;
  /// The same, pointing to copies of the tables elsewhere.
  EmitterExcess withTablesAt(const float* model_tables_copy, const float* air_tables_copy) const;

  /// Whether profiles are read.
  bool needsTerrain() const;
};

/// Whether an emitter's voxels have an excess: false for free_space and horizon in clear air, which need no
/// memory for it.
bool hasExcess(const scenario::Scenario& scenario, const scenario::Emitter& emitter);

/// Whether makeExcess() looks at where an emitter's paths end.
bool needsPathExtent(const scenario::Scenario& scenario, const scenario::Emitter& emitter);

/// Where a grid's paths from a station end.
PathExtent pathExtent(const Station& station, const GridColumns& columns);

/// The excess of an emitter that has one.
/// @param terrain     null: none
/// @param resolution  of profiles
/// @throws Error (bad_input) for a model without terrain where the ground below the emitter is missing
EmitterExcess makeExcess(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                         const Station& station, const scenario::Terrain* terrain, const PathExtent& extent,
                         const FanResolution& resolution);

/// The ground of a scenario as a wave sees it.
GroundConstants groundConstants(const scenario::Ground& ground, double frequency_hz);

/// ITM's link of an emitter but for the heights, and its quantiles.
ItmLink<float> itmLink(const scenario::Scenario& scenario, const scenario::Emitter& emitter);
ItmQuantiles<float> itmQuantiles(const scenario::ItmSettings& settings);

/// Height (m above mean sea level) of the smooth surface of two_ray and p528.
/// @throws Error (bad_input) where it is to be the ground below the emitter and that is missing
double smoothSurface_msl_m(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                           const Station& station, const scenario::Terrain* terrain);

/// What a model's remarks on an emitter's paths mean, one line each; those on missing terrain left out.
std::vector<std::string> remarkMessages(const scenario::Emitter& emitter, unsigned remarks);

}  // namespace emscape::emfield
