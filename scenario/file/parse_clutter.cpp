#include <fmt/format.h>

#include "emscape/base/units.h"
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

/// A filter whose improvement is limited by nothing removes all clutter.
void warnOfPerfectFilter(const Section& section, const Clutter& clutter, const Emitter& radar,
                         ParseContext& context) {
  const Mti& mti = *clutter.mti;
  const bool of_surface = clutter.hasSurface() && mti.surface_spread_mps == 0;
  const bool of_rain = clutter.rain && mti.rain_spread_mps == 0;
  if (mti.improvement_limit_db || !(of_surface || of_rain)) return;
  std::string scanning;
  if (radar.waveform && radar.antenna) {
    const auto hits = hitsPerScan(radar.scan, radar.antenna->beamwidth_az_deg, radar.waveform->prf_hz);
    if (hits && *hits > 0)
      scanning = fmt::format(", {:.2g} m/s for this scan",
                             0.13 * wavelength_m(radar.frequency_hz) * radar.waveform->prf_hz / *hits);
  }
  context.problems.addWarning(
      section.location(),
      fmt::format(
          "radar '{}': the filter removes all clutter of {}, since neither its spread ({}) nor a limit "
          "of the radar ('improvement_limit_db') is given; typical spreads are 0.1 to 0.5 m/s of woods "
          "in wind, 1 m/s of the sea, 2 to 4 m/s of rain, to which the scan adds 0.13 lambda PRF / "
          "hits{}",
          radar.name,
          of_surface && of_rain ? "the surface and of rain"
          : of_rain             ? "rain"
                                : "the surface",
          of_surface && of_rain ? "'surface_spread_m_s' and 'rain_spread_m_s'"
          : of_rain             ? "'rain_spread_m_s'"
                                : "'surface_spread_m_s'",
          scanning));
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
  if (section.has("mti")) {
    clutter.mti = parseMti(section.section("mti"), context);
    warnOfPerfectFilter(section.section("mti"), clutter, radar, context);
  }
  if (section.has("independent_samples"))
    clutter.independent_samples = section.integer("independent_samples");
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
