/// What each stage of the field is computed from, for an update to tell what an edit or the time invalidates.
///
/// The inputs of stages 1 and 2 (fan and excess) are read in many places; they are collected here, out of
/// structs that are taken apart member by member: a member that is added to one of them fails to compile
/// until it is sorted in. The inputs of stage 3 (combine) are what the engine is given.
#pragma once

#include <vector>

#include "emfield/solver/field_engine.h"
#include "propagation/inputs.h"

namespace emscape::emfield {

/// What the geometry of an emitter (stages 1 and 2) and its warnings are computed from, but for grid and
/// terrain.
struct GeometryInputs {
  GeodeticPosition position;
  double height_msl_m = 0;
  double far_field_m = 0;
  propagation::EmitterInputs propagation;
};

GeometryInputs geometryInputs(const FieldPlan& plan, int emitter, const scenario::EmitterState& state);

/// Whether all but the position is the same. Source locations do not count.
bool haveSameSettings(const GeometryInputs& a, const GeometryInputs& b);
/// Whether the position is the same, too, to the last bit.
bool areSame(const GeometryInputs& a, const GeometryInputs& b);

/// What an emitter's part in the channels (stage 3) is computed from, but for its geometry.
struct CombineInputs {
  CombinePass::Member member;
  scenario::AntennaPtr antenna;
};

/// Whether two antennas, not null, have the same pattern; their gains may differ.
bool samePattern(const scenario::AntennaPtr& a, const scenario::AntennaPtr& b);

/// Marks the channels in which an emitter's part is another one.
/// @param before    of the last update; null: it was not active
/// @param now       null: it is not active
/// @param channels  one per channel; those that differ are set
/// @return whether any channel was marked
bool markChangedChannels(const CombineInputs* before, const CombineInputs* now, std::vector<bool>& channels);

/// Whether two channels' products (stage 4) are made alike from their sums.
bool areSame(const ProductScale& a, const ProductScale& b);

}  // namespace emscape::emfield
