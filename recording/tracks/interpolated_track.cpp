#include "recording/tracks/interpolated_track.h"

#include <algorithm>
#include <cmath>

namespace emscape::interop {
namespace {

constexpr int kMaxDegree = 12;
constexpr int kMaxParts = 64;
constexpr double kStraight_m = 1;

/// Lagrange's polynomial through samples [begin, begin + count).
Vec3d polynomialAt(const EcefSample* samples, std::size_t count, double t_s) {
  Vec3d sum{0, 0, 0};
  for (std::size_t i = 0; i < count; ++i) {
    double weight = 1;
    for (std::size_t k = 0; k < count; ++k) {
      if (k != i) weight *= (t_s - samples[k].t_s) / (samples[i].t_s - samples[k].t_s);
    }
    sum = sum + samples[i].position_m * weight;
  }
  return sum;
}

}  // namespace

void addInterpolated(TrackRecorder& recorder, std::size_t object, const std::vector<EcefSample>& samples,
                     int degree, const std::string& location) {
  const std::size_t window =
      std::min(samples.size(), static_cast<std::size_t>(std::clamp(degree, 1, kMaxDegree)) + 1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    recorder.add(object, poseOfEcef(samples[i].t_s, samples[i].position_m), location);
    if (i + 1 == samples.size() || window < 3) continue;
    const std::size_t before = (window - 1) / 2;
    const std::size_t begin = std::min(i > before ? i - before : 0, samples.size() - window);
    const EcefSample &a = samples[i], &b = samples[i + 1];
    const auto at = [&](double part) {
      return polynomialAt(samples.data() + begin, window, a.t_s + part * (b.t_s - a.t_s));
    };
    const double bow_m = length(at(0.5) - (a.position_m + b.position_m) / 2.0);
    if (!(bow_m > kStraight_m)) continue;
    // The bow of a curve falls with the square of the number of parts.
    const int parts =
        static_cast<int>(std::min(std::ceil(std::sqrt(bow_m / kStraight_m)) + 1, 1.0 * kMaxParts));
    for (int n = 1; n < parts; ++n) {
      const double part = static_cast<double>(n) / parts;
      recorder.add(object, poseOfEcef(a.t_s + part * (b.t_s - a.t_s), at(part)), location);
    }
  }
}

}  // namespace emscape::interop
