#include "playback/editing/opacity_preset.h"

#include <fmt/format.h>

#include <algorithm>

#include "emscape/base/error.h"

namespace emscape::playback {
namespace {

using Point = render::TransferFunction::OpacityPoint;

constexpr double kShellHalfWidth = 0.02;  // of the interval
constexpr double kShellOpacity = 0.1;

/// Positions are fractions of the interval, 0..1.
void addShell(std::vector<Point>& points, double at, double opacity) {
  points.push_back({at - kShellHalfWidth, 0});
  points.push_back({at, opacity});
  points.push_back({at + kShellHalfWidth, 0});
}

std::vector<Point> unitPreset(const std::string& name, double at) {
  if (name == "ramp") return {{0, 0}, {1, 0.1}};
  if (name == "late ramp") return {{0, 0}, {0.2, 0}, {0.45, 0.004}, {0.7, 0.018}, {0.9, 0.07}, {1, 0.16}};
  if (name == "threshold") return {{0, 0}, {at, 0}, {at, 0.05}, {1, 0.05}};
  if (name == "opaque") return {{0, 1}, {1, 1}};
  std::vector<Point> points{{0, 0}};
  if (name == "shell") {
    addShell(points, at, kShellOpacity);
  } else if (name == "bands") {
    // Strong values are rare, so their bands may be denser.
    constexpr int kBands = 5;
    for (int band = 1; band <= kBands; ++band) {
      const double part = static_cast<double>(band) / (kBands + 1);
      addShell(points, part, kShellOpacity * part * part);
    }
  } else {
    std::string names;
    for (const OpacityPreset& preset : opacityPresets()) {
      names += (names.empty() ? "" : ", ") + std::string(preset.name);
    }
    throw Error(ErrorCode::bad_input, fmt::format("unknown opacity preset '{}': expected {}", name, names));
  }
  points.push_back({1, 0});
  return points;
}

}  // namespace

const std::vector<OpacityPreset>& opacityPresets() {
  static const std::vector<OpacityPreset> all{{"ramp", "rises evenly"},
                                              {"late ramp", "weak values stay clear, strong ones stand out"},
                                              {"threshold", "clear below a value, the same above it"},
                                              {"shell", "a thin layer at a value"},
                                              {"bands", "five thin layers"},
                                              {"opaque", "all values alike: for slices"}};
  return all;
}

std::vector<Point> opacityPreset(const std::string& name, double lowest, double highest, double at) {
  const double range = highest - lowest;
  const double part = std::clamp((at - lowest) / range, 2 * kShellHalfWidth, 1 - 2 * kShellHalfWidth);
  std::vector<Point> points = unitPreset(name, part);
  for (Point& point : points) point.at = point.at == 1 ? highest : lowest + range * point.at;
  return points;
}

}  // namespace emscape::playback
