#include "emfield/clutter/clutter_beam.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

#include "emscape/base/units.h"

namespace emscape::emfield {
namespace {

double twoWayPower(const scenario::Antenna& antenna, double azimuth_rad, double elevation_rad) {
  const double level = std::cos(elevation_rad);
  const double amplitude = antenna.amplitudeTowards(
      {level * std::cos(azimuth_rad), level * std::sin(azimuth_rad), std::sin(elevation_rad)}, 0, 0);
  return std::pow(amplitude, 4);
}

/// @param sums       of a cut's two-way power from -90 degrees on, up to evenly spaced elevations
/// @param width_rad  of the beam
PowerBelow powerBelow(const std::vector<double>& sums, double width_rad) {
  constexpr double kReach = 4, kLeast = 1e-9;  // widths; part
  const double intervals = static_cast<double>(sums.size() - 1);
  PowerBelow below;
  below.reach_rad = static_cast<float>(std::min(kReach * width_rad, kPi / 2));
  for (int n = 0; n < PowerBelow::kNodes; ++n) {
    const double angle_rad = static_cast<double>(below.reach_rad) * (2.0 * n / (PowerBelow::kNodes - 1) - 1);
    const double at = std::clamp((angle_rad / kPi + 0.5) * intervals, 0.0, intervals - 1e-6);
    const auto edge = static_cast<std::size_t>(at);
    const double sum = sums[edge] + (at - static_cast<double>(edge)) * (sums[edge + 1] - sums[edge]);
    const double part = std::clamp(sum / sums.back(), kLeast, 1 - kLeast);
    below.log2_odds[n] = static_cast<float>(std::log2(part / (1 - part)));
  }
  return below;
}

/// @param highest_rad  elevation of the pattern's maximum
PowerBeside powerBeside(const scenario::Antenna& antenna, double highest_rad) {
  constexpr double kReach = 1.5;  // widths
  constexpr int kSamples = 16;    // of a row
  const double row_rad = 2 * kPi / clutterAzimuths(antenna);
  PowerBeside power;
  power.beside = static_cast<int>(std::min(std::ceil(kReach * degToRad(antenna.beamwidth_az_deg) / row_rad),
                                           static_cast<double>(PowerBeside::kMaxBeside)));
  double parts[2 * PowerBeside::kMaxBeside + 1] = {}, sum = 0;
  const int count = 2 * power.beside + 1;
  for (int n = 0; n < count; ++n) {
    for (int i = 0; i < kSamples; ++i)
      parts[n] +=
          twoWayPower(antenna, (n - power.beside + (i + 0.5) / kSamples - 0.5) * row_rad, highest_rad);
    sum += parts[n];
  }
  if (!(sum > 0)) return {};
  for (int n = 0; n < count; ++n) power.parts[n] = static_cast<float>(parts[n] / sum);
  return power;
}

}  // namespace

ClutterBeam clutterBeam(const scenario::Antenna& antenna) {
  constexpr double kPerBeamwidth = 64, kLeastSamples = 3600, kMostSamples = 36000;
  const double beamwidth_deg = std::min(antenna.beamwidth_az_deg, antenna.beamwidth_el_deg);
  const int samples =
      static_cast<int>(std::clamp(180 * kPerBeamwidth / beamwidth_deg, kLeastSamples, kMostSamples));
  const auto power = [&](double azimuth_rad, double elevation_rad) {
    return twoWayPower(antenna, azimuth_rad, elevation_rad);
  };
  ClutterBeam beam;
  double highest = 0, highest_rad = 0;
  std::vector<double> sums{0};  // up to the upper edge of each sample
  for (int n = 0; n < samples; ++n) {
    const double elevation_rad = kPi * ((n + 0.5) / samples - 0.5), here = power(0, elevation_rad);
    sums.push_back(sums.back() + here * std::cos(elevation_rad) * kPi / samples);
    if (here > highest) {
      highest = here;
      highest_rad = elevation_rad;
    }
  }
  beam.elevation_rad = sums.back();
  double highest_of_azimuth = highest;
  for (int n = 0; n < samples; ++n) {
    const double here = power(2 * kPi * n / samples, highest_rad);
    beam.azimuth_rad += here * 2 * kPi / samples;
    highest_of_azimuth = std::max(highest_of_azimuth, here);
  }
  if (!(highest > 0)) return {};
  beam.azimuth_rad /= highest_of_azimuth;
  beam.elevation_rad /= highest;
  beam.beside = powerBeside(antenna, highest_rad);
  beam.below = powerBelow(sums, beam.elevation_rad);
  return beam;
}

std::shared_ptr<const ClutterBeam> clutterBeamOf(const scenario::AntennaPtr& antenna) {
  struct Known {
    std::weak_ptr<const scenario::Antenna> antenna;
    std::shared_ptr<const ClutterBeam> beam;
  };
  static std::mutex mutex;
  static std::vector<Known> known;
  const std::lock_guard lock(mutex);
  known.erase(std::remove_if(known.begin(), known.end(), [](const Known& k) { return k.antenna.expired(); }),
              known.end());
  for (const Known& k : known) {
    if (k.antenna.lock() == antenna) return k.beam;
  }
  known.push_back({antenna, std::make_shared<const ClutterBeam>(clutterBeam(*antenna))});
  return known.back().beam;
}

int clutterAzimuths(const scenario::Antenna& antenna) {
  return static_cast<int>(std::clamp(std::ceil(4 * 360 / antenna.beamwidth_az_deg), 90.0, 1440.0));
}

}  // namespace emscape::emfield
