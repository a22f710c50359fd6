#include "emfield/solver/field_plan.h"

#include <algorithm>

#include "emfield/excess/model_check.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "scenario/file/quantity_needs.h"

namespace emscape::emfield {

using scenario::Emitter;

FieldPlan makePlan(std::shared_ptr<const scenario::Scenario> scenario, const FieldOptions& options) {
  FieldPlan plan;
  plan.scenario = std::move(scenario);
  plan.warnings = checkModels(*plan.scenario);
  plan.channels = channelsOf(*plan.scenario, options.quantities);
  const std::vector<Channel> of_output = plan.channels;
  if (options.also_per_emitter) {
    const std::vector<Channel> each =
        channelsOf(*plan.scenario, options.quantities, scenario::CombineMode::per_emitter);
    plan.channels.insert(plan.channels.end(), each.begin(), each.end());
  }
  for (const Channel& channel : of_output) {
    if (options.also_unjammed && scenario::needsJammer(channel.quantity)) {
      plan.channels.push_back({channel.quantity, channel.name + " without jamming", channel.emitters});
    }
  }
  for (const Channel& channel : plan.channels) {
    plan.channel_plans.push_back(channelPlan(channel, *plan.scenario));
    const std::string unmet = scenario::unmetInterval(channel.quantity, plan.scenario->output.interval.kind);
    if (!unmet.empty()) throw Error(ErrorCode::bad_input, {plan.scenario->file}, unmet);
  }
  const std::vector<Emitter>& emitters = plan.scenario->emitters;
  for (const Emitter& emitter : emitters) {
    const double wavelength = wavelength_m(emitter.frequency_hz);
    const double dimension_m = emitter.antenna->apertureDimension_m(wavelength);
    plan.far_field_m.push_back(2 * dimension_m * dimension_m / wavelength);
  }
  plan.needs.resize(emitters.size());
  for (std::size_t c = 0; c < plan.channels.size(); ++c) {
    const std::vector<RadarTask>& radars = plan.channel_plans[c].radars;
    const bool has_mechanisms = plan.channel_plans[c].reduction == Reduction::dominant_mechanism;
    for (const int e : plan.channels[c].emitters) {
      plan.needs[e].any = true;
      if (has_mechanisms) plan.needs[e].mechanisms = true;
    }
    for (std::size_t n = 0; n < radars.size(); ++n) {
      if (radars[n].clutter.surface > 0) plan.needs[plan.channels[c].emitters[n]].clutter_map = true;
    }
  }
  return plan;
}

bool haveSameNames(const FieldPlan& a, const FieldPlan& b) {
  return std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(), b.channels.end(),
                    [](const Channel& x, const Channel& y) { return x.name == y.name; });
}

bool haveSameSums(const FieldPlan& a, const FieldPlan& b) {
  const auto sameChannel = [](const Channel& x, const Channel& y) {
    return x.quantity == y.quantity && x.emitters == y.emitters && x.jammers == y.jammers;
  };
  const auto sameSums = [](const ChannelPlan& x, const ChannelPlan& y) {
    return x.reduction == y.reduction && x.reducesPower() == y.reducesPower();
  };
  return std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(), b.channels.end(),
                    sameChannel) &&
         std::equal(a.channel_plans.begin(), a.channel_plans.end(), b.channel_plans.begin(),
                    b.channel_plans.end(), sameSums);
}

}  // namespace emscape::emfield
