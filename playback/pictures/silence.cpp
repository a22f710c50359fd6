#include "playback/pictures/silence.h"

#include <fmt/format.h>

#include <algorithm>

#include "emscape/scenario/model/quantities.h"
#include "playback/frames/presence.h"
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
  const auto isPresent = [&](const Emitter& emitter) { return isPresentAt(scenario, emitter, time_s); };
  const auto transmits = [&](const Emitter& emitter) {
    if (!isPresent(emitter)) return false;
    if (is_instant) return scenario::isActiveAt(emitter, time_s);
    return emitter.enabled && (interval.turns || scenario::activeTime_s(emitter, time_s, duration_s) > 0);
  };
  if (colon != std::string::npos) {
    const std::string channel = quantity.substr(colon + 1);
    for (const Emitter& emitter : scenario.emitters) {
      if (emitter.name != channel || transmits(emitter)) continue;
      return fmt::format(isPresent(emitter) ? "'{}' does not transmit" : "'{}' is not present", channel);
    }
  }
  // Says of which kind nothing transmits, and whether that is since none is there.
  const auto silenceOf = [&](const char* kind, auto is_meant) -> std::string {
    bool is_present = false, is_known = false;
    for (const Emitter& emitter : scenario.emitters) {
      if (!is_meant(emitter)) continue;
      if (transmits(emitter)) return "";
      is_known = true;
      is_present = is_present || isPresent(emitter);
    }
    return fmt::format(is_present || !is_known ? "no {} transmits" : "no {} is present", kind);
  };
  const auto isOf = [](EmitterKind kind) {
    return [kind](const Emitter& emitter) { return emitter.kind == kind; };
  };
  const auto& platforms = scenario.platforms;
  const bool is_empty =
      !platforms.empty() &&
      std::none_of(platforms.begin(), platforms.end(), [&](auto& each) { return each.isPresentAt(time_s); });
  if (is_empty) return "no platform is present";
  if (scenario::needsRadar(row->quantity)) {
    const std::string silence = silenceOf("radar", isOf(EmitterKind::radar));
    return !silence.empty() || !row->needs_jammer ? silence : silenceOf("jammer", isOf(EmitterKind::jammer));
  }
  return silenceOf("emitter", [](const Emitter&) { return true; });
}

}  // namespace emscape::playback
