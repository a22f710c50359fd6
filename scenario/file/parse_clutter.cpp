#include <fmt/format.h>

#include "scenario/file/parse_sections.h"

namespace emscape::scenario {
namespace {

Mti parseMti(const Section& section, ParseContext& context) {
  constexpr int kMaxCancellerPulses = 10;
  Mti mti;
  mti.kind = section.choice<MtiKind>("kind");
  mti.pulses = section.integer("pulses");
  mti.surface_spread_mps = section.number("surface_spread_m_s");
  mti.rain_spread_mps = section.number("rain_spread_m_s");
  mti.improvement_limit_db = section.optionalNumber("improvement_limit_db");
  if (mti.kind == MtiKind::canceller && mti.pulses > kMaxCancellerPulses) {
    context.problems.addError(
        section.locationOf("pulses"),
        fmt::format("'pulses' of a canceller is {}, at most {}", mti.pulses, kMaxCancellerPulses));
  }
  return mti;
}

}  // namespace

std::optional<Clutter> parseClutter(const Section& section, const Emitter& radar, ParseContext& context) {
  Clutter clutter;
  clutter.land_by_cover = section.has("land");
  if (clutter.land_by_cover)
    clutter.land_gamma_db = landGammaDb(section.choice<LandKind>("land"), radar.frequency_hz);
  if (section.has("land_gamma_db")) {
    if (section.has("land")) {
      context.problems.addError(section.locationOf("land_gamma_db"),
                                "'land_gamma_db' is given in place of 'land': give one of the two");
    }
    clutter.land_gamma_db = section.number("land_gamma_db");
  }
  if (section.has("sea_state")) clutter.sea_state = section.integer("sea_state");
  clutter.rain = section.optionalBoolean("rain").value_or(false);
  if (section.sound() && !clutter.hasSurface() && !clutter.rain) {
    context.problems.addError(
        section.location(),
        "'clutter' names no source: give 'land', 'land_gamma_db', 'sea_state' or 'rain: true'");
  }
  if (section.has("mti")) clutter.mti = parseMti(section.section("mti"), context);
  clutter.target_radial_speed_mps = section.optionalNumber("target_radial_speed_m_s");
  if (clutter.target_radial_speed_mps && !clutter.mti) {
    context.problems.addWarning(section.locationOf("target_radial_speed_m_s"),
                                "'target_radial_speed_m_s' has no effect without 'mti'");
  }
  constexpr double kLowestSea_hz = 0.5e9, kHighestSea_hz = 35e9, kHighestRain_hz = 10e9;
  if (clutter.sea_state && (radar.frequency_hz < kLowestSea_hz || radar.frequency_hz > kHighestSea_hz)) {
    context.problems.addWarning(
        section.locationOf("sea_state"),
        fmt::format("the sea's reflectivity is modelled for 0.5 to 35 GHz; '{}' is at {:g} GHz", radar.name,
                    radar.frequency_hz / 1e9));
  }
  if (clutter.rain && radar.frequency_hz > kHighestRain_hz) {
    context.problems.addWarning(section.locationOf("rain"),
                                fmt::format("the echo of rain is that of drops much smaller than the "
                                            "wavelength, up to 10 GHz; '{}' is at {:g} GHz",
                                            radar.name, radar.frequency_hz / 1e9));
  }
  if (!section.sound() || !radar.waveform) return std::nullopt;
  clutter.range_cell_m = section.optionalNumber("range_cell_m").value_or(radar.waveform->minRange_m());
  return clutter;
}

}  // namespace emscape::scenario
