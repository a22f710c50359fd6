#include "scenario/scan/scan_sampling.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "emscape/scenario/model/quantities.h"

namespace emscape::scenario {
namespace {

/// Limit of the examined times: longer series have covered all azimuths by then, or repeat themselves.
constexpr double kMaxSampledTimes = 20000;

/// Fraction of 0..range (deg) that is within half a width of one of the azimuths.
/// @param closed  0 and range are the same azimuth
double litShare(std::vector<double> azimuths_deg, double width_deg, double range_deg, bool closed) {
  std::sort(azimuths_deg.begin(), azimuths_deg.end());
  const double half_deg = width_deg / 2;
  double lit_deg = 0, lit_to_deg = 0;
  const auto light = [&](double middle_deg) {
    const double begin_deg = std::max(middle_deg - half_deg, lit_to_deg);
    const double end_deg = std::min(middle_deg + half_deg, range_deg);
    lit_deg += std::max(end_deg - begin_deg, 0.0);
    lit_to_deg = std::max(lit_to_deg, end_deg);
  };
  if (closed) light(azimuths_deg.back() - range_deg);
  for (double azimuth_deg : azimuths_deg) light(azimuth_deg);
  if (closed) light(azimuths_deg.front() + range_deg);
  return std::min(lit_deg / range_deg, 1.0);
}

/// Whether the output shows the beams of radars, or of other emitters, in their scan direction at the time.
bool showsScans(const OutputSpec& output) {
  return output.interval.kind == IntervalKind::instant &&
         std::any_of(output.quantities.begin(), output.quantities.end(), [&](const std::string& name) {
           const Quantity quantity = quantityFromName(name);
           const bool is_of_target = quantity == Quantity::jammer_to_signal_db ||
                                     quantity == Quantity::burn_through_margin_db ||
                                     (needsRadar(quantity) && output.radar_look == RadarAim::target);
           return !is_of_target;
         });
}

/// A kind of interval that all quantities of an output have.
std::optional<IntervalKind> intervalOf(const OutputSpec& output) {
  for (const IntervalKind kind : {IntervalKind::cumulative, IntervalKind::max_hold, IntervalKind::mean}) {
    const bool has_all =
        std::all_of(output.quantities.begin(), output.quantities.end(),
                    [&](const std::string& name) { return hasInterval(info(quantityFromName(name)), kind); });
    if (has_all) return kind;
  }
  return std::nullopt;
}

/// Emitters whose beams are alike.
struct Beams {
  double width_deg = 0;
  ScanSampling sampling;
  std::vector<std::string> names;

  bool isLike(double other_width_deg, const ScanSampling& other) const {
    return width_deg == other_width_deg && sampling.step_deg == other.step_deg &&
           sampling.lit_share == other.lit_share;
  }
  std::string text(double step_s) const {
    const bool is_one = names.size() == 1;
    return fmt::format(
        "the {} of '{}', {:.3g} deg wide, {} {:.4g} deg in a step of {} s: of {} azimuths {} are ever "
        "lit",
        is_one ? "beam" : "beams", fmt::join(names, "', '"), width_deg, is_one ? "sweeps" : "sweep",
        sampling.step_deg, step_s, is_one ? "its" : "their",
        sampling.lit_share < 0.01 ? "below 1 %" : fmt::format("{:.0f} %", 100 * sampling.lit_share));
  }
};

}  // namespace

std::optional<ScanSampling> scanSampling(const ScanSpec& scan, double beamwidth_az_deg, const Clock& clock) {
  const bool rotates = scan.kind == ScanKind::rotate;
  if (!rotates && scan.kind != ScanKind::sector && scan.kind != ScanKind::raster) return std::nullopt;
  const double last = std::floor(clock.duration_s / clock.step_s + 1e-9);
  if (last < 1) return std::nullopt;
  ScanSampling sampling;
  sampling.step_deg = clock.step_s * (rotates ? 6 * std::abs(scan.rate_rpm) : scan.rate_deg_s);
  std::vector<double> azimuths_deg;
  const double left_deg = rotates ? 0 : scan.azimuth_deg - scan.width_deg / 2;
  for (double i = 0; i <= std::min(last, kMaxSampledTimes); ++i) {
    azimuths_deg.push_back(beamAt(scan, i * clock.step_s).azimuth_deg - left_deg);
  }
  sampling.lit_share =
      litShare(std::move(azimuths_deg), beamwidth_az_deg, rotates ? 360 : scan.width_deg, rotates);
  return sampling;
}

bool leavesGaps(const ScanSampling& sampling, double beamwidth_az_deg) {
  constexpr double kAll = 0.995;  // shares are printed in whole percent
  return sampling.step_deg > beamwidth_az_deg / 2 && sampling.lit_share < kAll;
}

std::optional<UnlitAzimuths> unlitAzimuths(const Scenario& scenario, const Clock& clock) {
  if (!showsScans(scenario.output)) return std::nullopt;
  const std::vector<Emitter>& emitters = scenario.emitters;
  std::vector<Beams> beams;
  UnlitAzimuths unlit;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    if (!emitters[e].enabled) continue;
    const double width_deg = emitters[e].antenna->beamwidth_az_deg;
    const auto sampling = scanSampling(emitters[e].scan, width_deg, clock);
    if (!sampling || !leavesGaps(*sampling, width_deg)) continue;
    if (beams.empty()) unlit.first_emitter = e;
    auto alike = std::find_if(beams.begin(), beams.end(),
                              [&](const Beams& other) { return other.isLike(width_deg, *sampling); });
    if (alike == beams.end()) alike = beams.insert(beams.end(), {width_deg, *sampling, {}});
    alike->names.push_back(emitters[e].name);
  }
  if (beams.empty()) return std::nullopt;
  for (const Beams& alike : beams)
    unlit.warning += (unlit.warning.empty() ? "" : "; ") + alike.text(clock.step_s);
  unlit.warning +=
      ". Smaller steps, or a rate whose steps fall between those of earlier turns, light the others";
  if (const auto kind = intervalOf(scenario.output))
    unlit.warning +=
        fmt::format("; the output's 'interval: {{kind: {}, turns: 1}}' shows what is lit between the steps",
                    toString(*kind));
  return unlit;
}

std::string mergedLooksText(const std::string& radar, const ScanSpec& scan,
                            const std::vector<double>& times_s) {
  const std::optional<double> period_s = scanPeriod_s(scan);
  double step_s = 0;
  for (std::size_t t = 1; t < times_s.size(); ++t) step_s = std::max(step_s, times_s[t] - times_s[t - 1]);
  constexpr double kRounding = 1e-6;
  if (!period_s || step_s <= *period_s * (1 + kRounding)) return "";
  return fmt::format(
      "emitter '{}': up to {:.0f} looks, one every {:g} s, fall between two of the times and count with the "
      "probability at the later one: steps of {:g} s or less take each look by itself",
      radar, std::ceil(step_s / *period_s - kRounding), *period_s, std::floor(*period_s * 1000) / 1000);
}

}  // namespace emscape::scenario
