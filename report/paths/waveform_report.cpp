#include "report/paths/waveform_report.h"

#include "base/text/quantity_text.h"
#include "emfield/channels/radar_clutter.h"
#include "emscape/base/units.h"

namespace emscape::report {

using scenario::Waveform;

namespace {

/// True if the map of the land cover may give the land other reflectivities than the radar's own.
bool isByCover(const scenario::Scenario& scenario, const scenario::Clutter& clutter) {
  return clutter.land_by_cover && scenario.terrain && !scenario.terrain->land_cover.files.empty();
}

Json clutterJson(const scenario::Scenario& scenario, const scenario::Emitter& emitter) {
  if (!emitter.clutter) return nullptr;
  const scenario::Clutter& clutter = *emitter.clutter;
  return {{"land_gamma_db", number(clutter.land_gamma_db)},
          {"land_by_cover", isByCover(scenario, clutter)},
          {"sea_state", clutter.sea_state ? Json(*clutter.sea_state) : Json(nullptr)},
          {"rain", clutter.rain},
          {"range_cell_m", clutter.range_cell_m},
          {"surface_improvement_db", number(ratioToDb(emfield::surfaceImprovement(emitter)))},
          {"rain_improvement_db", number(ratioToDb(emfield::rainImprovement(emitter)))},
          {"filter_response_db", number(ratioToDb(emfield::filterResponse(emitter)))}};
}

/// "land (gamma -15.0 dB), sea (state 4), rain"
std::string sourcesOf(const scenario::Scenario& scenario, const scenario::Clutter& clutter) {
  std::string text;
  const auto add = [&text](const std::string& source) { text += (text.empty() ? "" : ", ") + source; };
  if (clutter.land_gamma_db) {
    add(fmt::format(isByCover(scenario, clutter)
                        ? "land by its cover (gamma {:.1f} dB where the cover names no kind of land)"
                        : "land (gamma {:.1f} dB)",
                    *clutter.land_gamma_db));
  }
  if (clutter.sea_state) add(fmt::format("sea (state {})", *clutter.sea_state));
  if (clutter.rain) add("rain");
  return text;
}

}  // namespace

Json waveformJson(const scenario::Scenario& scenario, const scenario::Emitter& emitter) {
  if (!emitter.waveform) return nullptr;
  const Waveform& waveform = *emitter.waveform;
  const auto ofRadar = [&](const Json& value) {
    return emitter.kind == scenario::EmitterKind::radar ? value : Json(nullptr);
  };
  return {{"prf_hz", waveform.prf_hz},
          {"pulse_width_s", waveform.pulse_width_s},
          {"duty_cycle", waveform.dutyCycle()},
          {"mean_power_w", emitter.power_w * waveform.dutyCycle()},
          {"min_range_m", ofRadar(waveform.minRange_m())},
          {"instrumented_range_m", number(waveform.instrumented_range_m)},
          {"unambiguous_range_m", ofRadar(waveform.unambiguousRange_m())},
          {"first_blind_speed_mps", ofRadar(waveform.firstBlindSpeed_mps(emitter.frequency_hz))},
          {"hits_per_scan", ofRadar(number(scenario::hitsPerScan(
                                emitter.scan, emitter.antenna->beamwidth_az_deg, waveform.prf_hz)))},
          {"pulses", ofRadar(emitter.receiver.pulses)},
          {"clutter", clutterJson(scenario, emitter)}};
}

void addWaveform(Text& out, const scenario::Scenario& scenario, const scenario::Emitter& emitter) {
  if (!emitter.waveform) return;
  const Waveform& waveform = *emitter.waveform;
  const auto line = [&](const char* name, const std::string& text) { out.add("  {:<22} {}\n", name, text); };
  const double repeat_km = waveform.unambiguousRange_m() / 1000, min_km = waveform.minRange_m() / 1000;
  out.add("\nWaveform\n");
  line("pulses", fmt::format("{} at {}", fmt::format("{:.4g} us", 1e6 * waveform.pulse_width_s),
                             quantityText(waveform.prf_hz, "Hz")));
  line("power",
       fmt::format("{} peak, {} mean (duty cycle {:.4g} %)", quantityText(emitter.power_w, "W"),
                   quantityText(emitter.power_w * waveform.dutyCycle(), "W"), 100 * waveform.dutyCycle()));
  if (emitter.kind != scenario::EmitterKind::radar) return;
  line("unambiguous range", fmt::format("{:.3f} km", repeat_km));
  if (waveform.instrumented_range_m)
    line("instrumented range", fmt::format("{:.3f} km", *waveform.instrumented_range_m / 1000));
  line("blind ranges", fmt::format("up to {:.3f} km, and within {:.3f} km of each multiple of {:.3f} km",
                                   min_km, min_km, repeat_km));
  line("first blind speed",
       fmt::format("{:.1f} m/s, radial", waveform.firstBlindSpeed_mps(emitter.frequency_hz)));
  const auto hits = scenario::hitsPerScan(emitter.scan, emitter.antenna->beamwidth_az_deg, waveform.prf_hz);
  if (hits) line("hits per scan", fmt::format("{:.4g}; {} are integrated", *hits, emitter.receiver.pulses));
  if (!emitter.clutter) return;
  const scenario::Clutter& clutter = *emitter.clutter;
  line("clutter", fmt::format("{}; range cell {:g} m", sourcesOf(scenario, clutter), clutter.range_cell_m));
  if (!clutter.mti) return;
  line("filter", fmt::format("{} of {} pulses", toString(clutter.mti->kind), clutter.mti->pulses));
  if (clutter.hasSurface())
    line("improvement, surface", fmt::format("{:.1f} dB", ratioToDb(emfield::surfaceImprovement(emitter))));
  if (clutter.rain)
    line("improvement, rain", fmt::format("{:.1f} dB", ratioToDb(emfield::rainImprovement(emitter))));
  line("response to the target",
       fmt::format("{:.1f} dB, {}", ratioToDb(emfield::filterResponse(emitter)),
                   clutter.target_radial_speed_mps
                       ? fmt::format("at {:g} m/s", *clutter.target_radial_speed_mps)
                       : std::string("mean of all radial speeds")));
}

}  // namespace emscape::report
