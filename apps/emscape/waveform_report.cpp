#include "apps/emscape/waveform_report.h"

#include "base/quantity_text.h"

namespace emscape::app {

using scenario::Waveform;

Json waveformJson(const scenario::Emitter& emitter) {
  if (!emitter.waveform) return nullptr;
  const Waveform& waveform = *emitter.waveform;
  return {{"prf_hz", waveform.prf_hz},
          {"pulse_width_s", waveform.pulse_width_s},
          {"duty_cycle", waveform.dutyCycle()},
          {"mean_power_w", emitter.power_w * waveform.dutyCycle()},
          {"min_range_m", waveform.minRange_m()},
          {"instrumented_range_m", number(waveform.instrumented_range_m)},
          {"unambiguous_range_m", waveform.unambiguousRange_m()},
          {"first_blind_speed_mps", waveform.firstBlindSpeed_mps(emitter.frequency_hz)},
          {"hits_per_scan",
           number(scenario::hitsPerScan(emitter.scan, emitter.antenna->beamwidth_az_deg, waveform.prf_hz))},
          {"pulses", emitter.receiver.pulses}};
}

void printWaveform(const scenario::Emitter& emitter) {
  if (!emitter.waveform) return;
  const Waveform& waveform = *emitter.waveform;
  const auto line = [](const char* name, const std::string& text) { print("  {:<22} {}\n", name, text); };
  const double repeat_km = waveform.unambiguousRange_m() / 1000, min_km = waveform.minRange_m() / 1000;
  print("\nWaveform\n");
  line("pulses", fmt::format("{} at {}", fmt::format("{:.4g} us", 1e6 * waveform.pulse_width_s),
                             quantityText(waveform.prf_hz, "Hz")));
  line("power",
       fmt::format("{} peak, {} mean (duty cycle {:.4g} %)", quantityText(emitter.power_w, "W"),
                   quantityText(emitter.power_w * waveform.dutyCycle(), "W"), 100 * waveform.dutyCycle()));
  line("unambiguous range", fmt::format("{:.3f} km", repeat_km));
  if (waveform.instrumented_range_m)
    line("instrumented range", fmt::format("{:.3f} km", *waveform.instrumented_range_m / 1000));
  line("blind ranges", fmt::format("up to {:.3f} km, and within {:.3f} km of each multiple of {:.3f} km",
                                   min_km, min_km, repeat_km));
  line("first blind speed",
       fmt::format("{:.1f} m/s, radial", waveform.firstBlindSpeed_mps(emitter.frequency_hz)));
  const auto hits = scenario::hitsPerScan(emitter.scan, emitter.antenna->beamwidth_az_deg, waveform.prf_hz);
  if (hits) line("hits per scan", fmt::format("{:.4g}; {} are integrated", *hits, emitter.receiver.pulses));
}

}  // namespace emscape::app
