#include "scenario/file/radar_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"
#include "scenario/file/warning_of_items.h"
#include "scenario/model/blanked_jammers.h"

namespace emscape::scenario {
namespace {

/// Warns about receivers of radars of a few hertz, as 1.0 for 1.0e6 Hz.
void warnOfNarrowReceivers(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& radar = scenario.emitters[i];
    const double bandwidth_hz = radar.receiver.bandwidth_hz;
    if (radar.kind != EmitterKind::radar || bandwidth_hz >= kNarrow_hz) continue;
    warning.add(
        sections[i].section("receiver").locationOf("bandwidth_hz"), radar.name,
        fmt::format("the receiver of radar '{}' is {:g} Hz wide, narrower than that of any radar: its "
                    "noise is too low; 'bandwidth_hz' is in hertz",
                    radar.name, bandwidth_hz));
  }
  warning.addTo(context.problems);
}

/// Warns about ranges of radars that their waveform rules out.
void warnOfRanges(const Scenario& scenario, const Section& root, ParseContext& context) {
  constexpr double kRounding = 1.001;
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems of_instrumented, of_cell;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& radar = scenario.emitters[i];
    if (!radar.waveform) continue;
    const Waveform& waveform = *radar.waveform;
    const double unambiguous_m = waveform.unambiguousRange_m();
    if (waveform.instrumented_range_m.value_or(0) > kRounding * unambiguous_m) {
      of_instrumented.add(
          sections[i].section("waveform").locationOf("instrumented_range_m"), radar.name,
          fmt::format(
              "radar '{}' looks {:.4g} km far, but its PRF of {:g} Hz has an unambiguous range of {:.4g} km: "
              "{}; a PRF up to {:.0f} Hz is unambiguous to {:.4g} km",
              radar.name, *waveform.instrumented_range_m / 1000, waveform.prf_hz, unambiguous_m / 1000,
              waveform.limits_detection ? "nothing is detected beyond that"
                                        : "echoes from beyond that appear nearer",
              std::floor(kSpeedOfLight / (2 * *waveform.instrumented_range_m)),
              *waveform.instrumented_range_m / 1000));
    }
    if (!radar.clutter || !radar.clutter->hasSurface()) continue;
    const Section clutter = sections[i].section("clutter");
    const double cell_m = radar.clutter->range_cell_m,
                 resolved_m = kSpeedOfLight / 2 / radar.receiver.bandwidth_hz;
    constexpr double kLong_m = 5000, kOfResolved = 10;
    if (cell_m <= kLong_m && cell_m <= unambiguous_m) continue;
    const bool is_given = clutter.has("range_cell_m");
    if (cell_m <= unambiguous_m && cell_m <= kOfResolved * resolved_m) continue;
    of_cell.add(
        is_given ? clutter.locationOf("range_cell_m")
                 : sections[i].section("waveform").locationOf("pulse_width_s"),
        radar.name,
        fmt::format(
            "the range cell of radar '{}' is {:.4g} km long{}, its receiver of {:g} Hz resolves {:.4g} m: "
            "the clutter of all of it hides a target; 'range_cell_m' of a compressed pulse is c / (2 "
            "bandwidth)",
            radar.name, cell_m / 1000, is_given ? "" : " (c pulse width / 2)", radar.receiver.bandwidth_hz,
            resolved_m));
  }
  of_instrumented.addTo(context.problems);
  of_cell.addTo(context.problems);
}

/// Whether a jammer radiates into a radar: those of its own platform are left out.
bool jams(const Emitter& jammer, const Emitter& radar) {
  return jammer.kind == EmitterKind::jammer && jammer.enabled && radar.enabled &&
         jammer.platform != radar.platform && isInBandOf(radar, jammer);
}

/// Warns about blankers at which more jammers of pulses radiate than the model tells apart.
void warnOfManyPulses(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& radar = scenario.emitters[i];
    if (!radar.receiver.side_lobe_blanking) continue;
    const auto count =
        std::count_if(scenario.emitters.begin(), scenario.emitters.end(),
                      [&radar](const Emitter& emitter) { return jams(emitter, radar) && emitter.waveform; });
    if (count <= kMaxBlankedJammers) continue;
    warning.add(
        sections[i].section("receiver").locationOf("side_lobe_blanking"), radar.name,
        fmt::format("side-lobe blanking of radar '{}': of {} jammers of pulses the {} strongest count as "
                    "such, the others as noise without a pause, of their mean power",
                    radar.name, count, kMaxBlankedJammers));
  }
  warning.addTo(context.problems);
}

/// Warns about a blanker that continuous jammers in the side lobes shut for good.
void warnOfBlankers(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& radar = scenario.emitters[i];
    if (!radar.receiver.side_lobe_blanking) continue;
    const auto jammer =
        std::find_if(scenario.emitters.begin(), scenario.emitters.end(),
                     [&radar](const Emitter& emitter) { return jams(emitter, radar) && !emitter.waveform; });
    if (jammer == scenario.emitters.end()) continue;
    warning.add(
        sections[i].section("receiver").locationOf("side_lobe_blanking"), radar.name,
        fmt::format(
            "side-lobe blanking of radar '{}' is against pulses; '{}' has no 'waveform' and "
            "jams without a pause: in the side lobes it shuts the receiver to weak echoes all the time, "
            "unless it is below the noise",
            radar.name, jammer->name));
  }
  warning.addTo(context.problems);
}

/// Warns about samples of clutter that are not fewer than the pulses.
void warnOfSamples(const Scenario& scenario, const Section& root, ParseContext& context) {
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& radar = scenario.emitters[i];
    if (!radar.clutter || radar.clutter->independent_samples.value_or(0) <= radar.receiver.pulses) continue;
    warning.add(sections[i].section("clutter").locationOf("independent_samples"), radar.name,
                fmt::format("'independent_samples' of '{}' is {}, more than the {} pulses integrated: all of "
                            "them count as independent",
                            radar.name, *radar.clutter->independent_samples, radar.receiver.pulses));
  }
  warning.addTo(context.problems);
}

/// Bandwidth (Hz) of an emitter's pulses: that of the range cell of its clutter, at least 1 / pulse width.
double pulseBandwidth_hz(const Emitter& emitter) {
  const double of_pulse_hz = 1 / emitter.waveform->pulse_width_s;
  return emitter.clutter ? std::max(of_pulse_hz, kSpeedOfLight / 2 / emitter.clutter->range_cell_m)
                         : of_pulse_hz;
}

/// A receiver that is narrower than an emitter's pulses and receives them; null: none.
const ReceiverProfile* narrowerReceiver(const Scenario& scenario, const Emitter& emitter, double pulses_hz) {
  const auto hears = [&](const ReceiverProfile& receiver) {
    return receiver.bandwidth_hz > 0 && receiver.bandwidth_hz < pulses_hz &&
           (receiver.center_frequency_hz == 0 ||
            std::abs(receiver.center_frequency_hz - emitter.frequency_hz) <=
                (receiver.bandwidth_hz + emitter.bandwidth_hz) / 2);
  };
  const auto placed = std::find_if(scenario.placed_receivers.begin(), scenario.placed_receivers.end(), hears);
  if (placed != scenario.placed_receivers.end()) return &*placed;
  const auto profile = std::find_if(scenario.receivers.begin(), scenario.receivers.end(), hears);
  return profile == scenario.receivers.end() ? nullptr : &*profile;
}

/// Warns about signals whose bandwidth is not that of their pulses.
void warnOfPulseBandwidths(const Scenario& scenario, const Section& root, ParseContext& context) {
  constexpr double kNarrower = 0.5;
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems of_none, of_narrow;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& emitter = scenario.emitters[i];
    if (!emitter.waveform) continue;
    const double pulses_hz = pulseBandwidth_hz(emitter), width_s = emitter.waveform->pulse_width_s;
    const ReceiverProfile* const receiver = narrowerReceiver(scenario, emitter, pulses_hz);
    if (emitter.bandwidth_hz == 0 && emitter.kind == EmitterKind::radar && receiver != nullptr) {
      of_none.add(
          sections[i].section("waveform").locationOf("pulse_width_s"), emitter.name,
          fmt::format("the pulses of '{}' are {:.4g} Hz wide, but its signal has no 'bandwidth_hz': "
                      "all its power falls into receiver '{}', {:.4g} Hz wide; 'bandwidth_hz: {:.4g}' "
                      "of the emitter leaves out what is outside",
                      emitter.name, pulses_hz, receiver->name, receiver->bandwidth_hz, pulses_hz));
    } else if (emitter.bandwidth_hz >= kNarrow_hz && emitter.bandwidth_hz * width_s < kNarrower) {
      of_narrow.add(
          sections[i].locationOf("bandwidth_hz"), emitter.name,
          fmt::format("the signal of '{}' is {:.4g} Hz wide, narrower than pulses of {:g} s can be: "
                      "receivers get too much of it; 1 / pulse width is {:.4g} Hz",
                      emitter.name, emitter.bandwidth_hz, width_s, 1 / width_s));
    }
  }
  of_none.addTo(context.problems);
  of_narrow.addTo(context.problems);
}

/// Warns about clutter of rain without rain.
void warnOfNoRain(const Scenario& scenario, const Section& root, ParseContext& context) {
  if (scenario.atmosphere.rain_mm_h > 0) return;
  const std::vector<Section> sections = root.sections("emitters");
  WarningOfItems warning;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Emitter& radar = scenario.emitters[i];
    if (!radar.clutter || !radar.clutter->rain) continue;
    warning.add(sections[i].section("clutter").locationOf("rain"), radar.name,
                fmt::format("the clutter of '{}' has echoes of rain, but it does not rain: 'atmosphere: "
                            "{{rain_mm_h: 4}}' is moderate rain",
                            radar.name));
  }
  warning.addTo(context.problems);
}

}  // namespace

bool isInBandOf(const Emitter& radar, const Emitter& jammer) {
  return radar.kind == EmitterKind::radar && std::abs(radar.frequency_hz - jammer.frequency_hz) <=
                                                 (radar.receiver.bandwidth_hz + jammer.bandwidth_hz) / 2;
}

void addRadarWarnings(const Scenario& scenario, const Section& root, ParseContext& context) {
  warnOfNarrowReceivers(scenario, root, context);
  warnOfRanges(scenario, root, context);
  warnOfBlankers(scenario, root, context);
  warnOfManyPulses(scenario, root, context);
  warnOfSamples(scenario, root, context);
  warnOfPulseBandwidths(scenario, root, context);
  warnOfNoRain(scenario, root, context);
}

}  // namespace emscape::scenario
