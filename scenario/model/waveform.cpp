#include "emscape/scenario/model/waveform.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"

namespace emscape::scenario {
namespace {

/// Angular rate (deg/s) of a beam in azimuth; 0: it does not sweep.
double sweepRate_deg_s(const ScanSpec& scan) {
  switch (scan.kind) {
    case ScanKind::rotate:
      return 6 * std::abs(scan.rate_rpm);
    case ScanKind::sector:
    case ScanKind::raster:
      return scan.rate_deg_s;
    default:
      return 0;
  }
}

}  // namespace

double Waveform::unambiguousRange_m() const {
  return kSpeedOfLight / (2 * prf_hz);
}

double Waveform::farthestDetection_m() const {
  return std::min(instrumented_range_m.value_or(unambiguousRange_m()), unambiguousRange_m());
}

double Waveform::minRange_m() const {
  return kSpeedOfLight * pulse_width_s / 2;
}

double Waveform::eclipsedPart(double range_m) const {
  const double delay_s = 2 * range_m / kSpeedOfLight;
  const double from_pulse_s = std::abs(std::remainder(delay_s, 1 / prf_hz));
  return std::max(0.0, 1 - from_pulse_s / pulse_width_s);
}

double Waveform::firstBlindSpeed_mps(double frequency_hz) const {
  return wavelength_m(frequency_hz) * prf_hz / 2;
}

std::optional<double> hitsPerScan(const ScanSpec& scan, double beamwidth_az_deg, double prf_hz) {
  if (scan.kind == ScanKind::dwell_list) {
    const auto shortest =
        std::min_element(scan.dwells.begin(), scan.dwells.end(),
                         [](const Dwell& a, const Dwell& b) { return a.duration_s < b.duration_s; });
    if (shortest == scan.dwells.end()) return std::nullopt;
    return prf_hz * shortest->duration_s;
  }
  const double rate_deg_s = sweepRate_deg_s(scan);
  if (!(rate_deg_s > 0)) return std::nullopt;
  return prf_hz * beamwidth_az_deg / rate_deg_s;
}

std::optional<double> scanPeriod_s(const ScanSpec& scan) {
  if (scan.kind == ScanKind::dwell_list) {
    double sum_s = 0;
    for (const Dwell& dwell : scan.dwells) sum_s += dwell.duration_s;
    return sum_s;
  }
  const double rate_deg_s = sweepRate_deg_s(scan);
  if (!(rate_deg_s > 0)) return std::nullopt;
  if (scan.kind == ScanKind::rotate) return 360 / rate_deg_s;
  return scan.bars * scan.width_deg / rate_deg_s;
}

int scannedPlanes(const ScanSpec& scan) {
  switch (scan.kind) {
    case ScanKind::rotate:
    case ScanKind::sector:
      return 1;
    case ScanKind::raster:
    case ScanKind::dwell_list:
      return 2;
    default:
      return 0;
  }
}

}  // namespace emscape::scenario
