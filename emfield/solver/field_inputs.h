/// The inputs of each stage of the field, from which an update finds what an edit or the time invalidates.
///
/// The inputs of stages 1 and 2 (columns and excess) are read in many places; they are collected here by
/// structured bindings of every member: a new member does not compile until it is added here. The inputs of
/// stage 3 (combine) are those of the engine: CombinePass::Member.
#pragma once

#include <optional>
#include <vector>

#include "emfield/excess/elevation_cut.h"
#include "emfield/solver/field_engine.h"
#include "propagation/inputs.h"

namespace emscape::emfield {

/// Inputs of an emitter's geometry (stages 1 and 2) and its warnings, without grid and terrain.
struct GeometryInputs {
  GeodeticPosition position;
  double height_msl_m = 0;
  double far_field_m = 0;
  propagation::EmitterInputs propagation;
  std::optional<ElevationCut> elevation_cut;
  std::optional<ClutterMapInputs> clutter;  ///< none: no channel includes clutter, and there is no map
  bool mechanisms = false;                  ///< GeometryNeeds::mechanisms
};

GeometryInputs geometryInputs(const FieldPlan& plan, int emitter, const scenario::EmitterState& state);

/// True if a geometry is valid for other inputs: everything except the position is equal, and it has the
/// clutter map and the mechanisms if they are needed. Source locations are ignored.
bool haveSameSettings(const GeometryInputs& computed, const GeometryInputs& needed);
/// True if the position is also equal, to the last bit.
bool areSame(const GeometryInputs& computed, const GeometryInputs& needed);

/// True if two antennas, not null, have the same pattern; their gains may differ.
bool samePattern(const scenario::AntennaPtr& a, const scenario::AntennaPtr& b);
/// True if two cuts, or none, are the same; the antennas' gains may differ.
bool areSame(const std::optional<ElevationCut>& a, const std::optional<ElevationCut>& b);

/// True if two radars with equal patterns have the same weights of voxels: the same look in the same frame.
/// Powers, jammers and channels may differ.
bool sameLook(const RadarShare& a, const RadarShare& b);

/// True if two jammers are received along the same rays. Their powers may differ.
bool sameRays(const JammerAtRadar& a, const JammerAtRadar& b);

/// Marks the channels in which an emitter's contribution has changed.
/// @param before    of the last update; null: it was not active
/// @param now       null: it is not active
/// @param channels  one per channel; those that differ are set
/// @return true if any channel was marked
bool markChangedChannels(const CombinePass::Member* before, const CombinePass::Member* now,
                         std::vector<bool>& channels);

/// True if two channels compute their products (stage 4) from their sums in the same way.
bool areSame(const ProductScale& a, const ProductScale& b);

}  // namespace emscape::emfield
