#include "scenario/scan_sampling.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

}  // namespace emscape::scenario
