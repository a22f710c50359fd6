/// Data that a solver derives from a scenario alone: the channels and the computation of each.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emfield/channels/products.h"
#include "emfield/geometry/emitter_geometry.h"
#include "emscape/emfield/solver/field_solver.h"

namespace emscape::emfield {

struct FieldPlan {
  std::shared_ptr<const scenario::Scenario> scenario;
  std::vector<Channel> channels;
  std::vector<ChannelPlan> channel_plans;  ///< one per channel
  std::vector<double> far_field_m;         ///< of each emitter: 2 D^2 / lambda
  std::vector<GeometryNeeds> needs;        ///< of each emitter, for all channels
  std::vector<std::string> warnings;       ///< of the models, on values of the scenario
};

/// @param options  which channels
/// @throws Error (bad_input) for a scenario that the field or its models cannot compute
FieldPlan makePlan(std::shared_ptr<const scenario::Scenario> scenario, const FieldOptions& options);

/// True if the channels of two plans have the same names.
bool haveSameNames(const FieldPlan& a, const FieldPlan& b);
/// True if two plans have the same channels apart from their names, with sums of the same kinds.
bool haveSameSums(const FieldPlan& a, const FieldPlan& b);

}  // namespace emscape::emfield
