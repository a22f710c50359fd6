#include "emfield/field_plan.h"

#include <algorithm>
#include <numeric>

#include "emfield/model_check.h"
#include "emscape/base/units.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::ScanKind;

/// How an emitter changes over time: 0 never, 1 at single moments, 2 all the time.
int changesOverTime(const scenario::Scenario& scenario, const Emitter& emitter) {
  const bool moves = scenario.platforms[static_cast<std::size_t>(emitter.platform)].track.size() > 1;
  switch (emitter.scan.kind) {
    case ScanKind::rotate:
    case ScanKind::sector:
    case ScanKind::raster:
      return 2;
    case ScanKind::dwell_list:
      return moves ? 2 : 1;
    case ScanKind::fixed:
      break;
  }
  if (moves) return 2;
  return emitter.active_s.empty() ? 0 : 1;
}

}  // namespace

FieldPlan makePlan(std::shared_ptr<const scenario::Scenario> scenario,
                   const std::vector<std::string>& quantities, const FieldPlan* previous) {
  FieldPlan plan;
  plan.scenario = std::move(scenario);
  plan.warnings = checkModels(*plan.scenario);
  plan.channels = channelsOf(*plan.scenario, quantities);
  std::vector<std::shared_ptr<const DetectionCurve>> curves;
  const auto collect = [&curves](const ChannelRecipe& recipe) {
    curves.insert(curves.end(), recipe.curves.begin(), recipe.curves.end());
  };
  if (previous != nullptr) std::for_each(previous->recipes.begin(), previous->recipes.end(), collect);
  for (const Channel& channel : plan.channels) {
    plan.recipes.push_back(recipeOf(channel, *plan.scenario, curves));
    collect(plan.recipes.back());
  }
  const std::vector<Emitter>& emitters = plan.scenario->emitters;
  for (const Emitter& emitter : emitters) {
    const double wavelength = wavelength_m(emitter.frequency_hz);
    const double dimension_m = emitter.antenna->apertureDimension_m(wavelength);
    plan.far_field_m.push_back(2 * dimension_m * dimension_m / wavelength);
  }
  plan.order.resize(emitters.size());
  std::iota(plan.order.begin(), plan.order.end(), 0);
  std::stable_sort(plan.order.begin(), plan.order.end(), [&](int a, int b) {
    return changesOverTime(*plan.scenario, emitters[a]) < changesOverTime(*plan.scenario, emitters[b]);
  });
  return plan;
}

bool haveSameChannels(const FieldPlan& a, const FieldPlan& b) {
  const auto sameChannel = [](const Channel& x, const Channel& y) {
    return x.quantity == y.quantity && x.name == y.name && x.emitters == y.emitters && x.jammers == y.jammers;
  };
  const auto sameSums = [](const ChannelRecipe& x, const ChannelRecipe& y) {
    return x.reduction == y.reduction && x.radars.empty() == y.radars.empty();
  };
  return std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(), b.channels.end(),
                    sameChannel) &&
         std::equal(a.recipes.begin(), a.recipes.end(), b.recipes.begin(), b.recipes.end(), sameSums);
}

}  // namespace emscape::emfield
