#include <algorithm>

#include "emscape/base/error.h"
#include "emscape/emfield/solver/field_solver.h"

namespace emscape::emfield {
namespace {

using scenario::CombineMode;
using scenario::EmitterKind;
using scenario::Quantity;

/// Quantities with one value for all emitters, for any combination.
bool countsEmitters(Quantity quantity) {
  return quantity == Quantity::emitter_count || quantity == Quantity::dominant_emitter;
}

/// True if a quantity's channel has all emitters for any combination, including per_band.
bool takesAllEmitters(Quantity quantity) {
  return quantity == Quantity::sinr_db;
}

}  // namespace

std::vector<Channel> channelsOf(const scenario::Scenario& scenario,
                                const std::vector<std::string>& quantities) {
  return channelsOf(scenario, quantities, scenario.output.combine);
}

std::vector<Channel> channelsOf(const scenario::Scenario& scenario,
                                const std::vector<std::string>& quantities, CombineMode combine) {
  std::vector<Channel> channels;
  for (const std::string& name : quantities.empty() ? scenario.output.quantities : quantities) {
    const Quantity quantity = scenario::quantityFromName(name);
    std::vector<int> emitters;
    for (std::size_t e = 0; e < scenario.emitters.size(); ++e) {
      const bool enters = !needsRadar(quantity) || scenario.emitters[e].kind == EmitterKind::radar;
      if (enters) emitters.push_back(static_cast<int>(e));
    }
    if (needsRadar(quantity) && emitters.empty()) {
      throw Error(ErrorCode::bad_input, {scenario.file},
                  "quantity '" + name + "' needs an emitter of kind 'radar'");
    }
    if (takesAllEmitters(quantity)) {
      channels.push_back({quantity, name, emitters});
    } else if (combine == CombineMode::per_emitter && !countsEmitters(quantity)) {
      for (int e : emitters) channels.push_back({quantity, name + ":" + scenario.emitters[e].name, {e}});
    } else if (combine == CombineMode::per_band) {
      if (scenario.bands.empty()) {
        throw Error(ErrorCode::bad_input, {scenario.file},
                    "combine 'per_band' needs at least one entry under 'bands'");
      }
      for (const scenario::Band& band : scenario.bands) {
        Channel channel{quantity, name + ":" + band.name, {}};
        std::copy_if(emitters.begin(), emitters.end(), std::back_inserter(channel.emitters), [&](int e) {
          const double frequency_hz = scenario.emitters[e].frequency_hz;
          return frequency_hz >= band.begin_hz && frequency_hz < band.end_hz;
        });
        if (!needsRadar(quantity) || !channel.emitters.empty()) channels.push_back(channel);
      }
    } else {
      channels.push_back({quantity, name, emitters});
    }
  }
  for (Channel& channel : channels) {
    for (std::size_t e = 0; needsJammer(channel.quantity) && e < scenario.emitters.size(); ++e) {
      if (scenario.emitters[e].kind == EmitterKind::jammer) channel.jammers.push_back(static_cast<int>(e));
    }
  }
  return channels;
}

}  // namespace emscape::emfield
