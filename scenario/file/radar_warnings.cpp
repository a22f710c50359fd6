#include "scenario/file/radar_warnings.h"

#include <fmt/format.h>

#include <cmath>

#include "emscape/base/units.h"
#include "scenario/file/warning_of_items.h"

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

}  // namespace

void addRadarWarnings(const Scenario& scenario, const Section& root, ParseContext& context) {
  warnOfNarrowReceivers(scenario, root, context);
  warnOfRanges(scenario, root, context);
}

}  // namespace emscape::scenario
