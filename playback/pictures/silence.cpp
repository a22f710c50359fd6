#include "playback/pictures/silence.h"

#include <fmt/format.h>

#include <algorithm>

#include "emscape/scenario/model/quantities.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::playback {

using scenario::Emitter;
using scenario::EmitterKind;

std::string silenceText(const scenario::Scenario& scenario, const std::string& quantity, double time_s) {
  const std::size_t colon = quantity.find(':');
  const std::string name = quantity.substr(0, colon);
  const auto& table = scenario::quantityTable();
  const auto row = std::find_if(table.begin(), table.end(),
                                [&](const scenario::QuantityInfo& each) { return name == each.name; });
  if (row == table.end()) return "";
  const scenario::IntervalSpec& interval = scenario.output.interval;
  const bool is_instant = interval.kind == scenario::IntervalKind::instant;
  // Turns of the scan last as long as each emitter's scan: there, only switched off emitters are silent.
  const double duration_s = interval.seconds.value_or(scenario.clock.step_s);
  const auto transmits = [&](const Emitter& emitter) {
    if (is_instant) return scenario::isActiveAt(emitter, time_s);
    return emitter.enabled && (interval.turns || scenario::activeTime_s(emitter, time_s, duration_s) > 0);
  };
  if (colon != std::string::npos) {
    const std::string channel = quantity.substr(colon + 1);
    for (const Emitter& emitter : scenario.emitters) {
      if (emitter.name == channel && !transmits(emitter))
        return fmt::format("'{}' does not transmit", channel);
    }
  }
  const auto isSilent = [&](auto is_meant) {
    return std::none_of(scenario.emitters.begin(), scenario.emitters.end(),
                        [&](const Emitter& emitter) { return is_meant(emitter) && transmits(emitter); });
  };
  const auto isOf = [](EmitterKind kind) {
    return [kind](const Emitter& emitter) { return emitter.kind == kind; };
  };
  if (scenario::needsRadar(row->quantity)) {
    if (isSilent(isOf(EmitterKind::radar))) return "no radar transmits";
    return row->needs_jammer && isSilent(isOf(EmitterKind::jammer)) ? "no jammer transmits" : "";
  }
  return isSilent([](const Emitter&) { return true; }) ? "no emitter transmits" : "";
}

}  // namespace emscape::playback
