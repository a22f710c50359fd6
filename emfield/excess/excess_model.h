/// The models that have an excess loss, as the field solver sees them.
///
/// A model is a plain struct with
///     static constexpr bool kNeedsTerrain;  // whether a column's profile is read for it
///     EMSCAPE_HD unsigned operator()(const ExcessColumn&, const ExcessScratch&, float* excess_db) const;
/// which fills the excess (dB) of a column's voxels and returns remarks (bits). It runs on host and device.
#pragma once

#include <variant>

#include "emfield/excess/diffraction_excess.h"
#include "emfield/station.h"
#include "scenario/scenario.h"

namespace emscape::emfield {

using ExcessModel = std::variant<DiffractionExcess>;

/// Whether an emitter's voxels have an excess: false for free_space and horizon in clear air, which need no
/// memory for it.
bool hasExcess(const scenario::Scenario& scenario, const scenario::Emitter& emitter);

/// The model of an emitter that has one.
ExcessModel makeExcessModel(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                            const Station& station);

/// Whether a model reads profiles.
bool needsTerrain(const ExcessModel& model);

}  // namespace emscape::emfield
