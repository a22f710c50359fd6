#include "scenario/antenna/directivity.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "emscape/base/units.h"
#include "scenario/antenna/pattern.h"

namespace emscape::scenario {
namespace {

/// Sorted powers of one variable: the mean of max(factor * power, floor) then needs only a binary search.
class SortedPowers {
 public:
  explicit SortedPowers(std::vector<double> powers) : powers_(std::move(powers)), sums_{0} {
    std::sort(powers_.begin(), powers_.end(), std::greater<>());
    for (double power : powers_) sums_.push_back(sums_.back() + power);
  }
  double meanAbove(double factor, double floor) const {
    const auto below = std::partition_point(powers_.begin(), powers_.end(),
                                            [=](double power) { return factor * power > floor; });
    const auto above = static_cast<std::size_t>(below - powers_.begin());
    return (factor * sums_[above] + floor * double(powers_.size() - above)) / double(powers_.size());
  }

 private:
  std::vector<double> powers_, sums_;
};

/// Midpoints of `count` equal parts of -half_span..half_span.
double midpoint(int i, int count, double half_span) {
  return half_span * ((2.0 * i + 1) / count - 1);
}

template <class Function>
std::vector<double> sampled(int count, double half_span, const Function& function) {
  std::vector<double> values(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    values[static_cast<std::size_t>(i)] = function(midpoint(i, count, half_span));
  return values;
}

double tablePower(const float* table, int count, double x, double half_span) {
  const double amplitude = antenna_detail::atCell(
      table, antenna_detail::cellInTable(static_cast<float>(x), static_cast<float>(half_span), count));
  return amplitude * amplitude;
}

/// Powers by azimuth times powers by elevation, at least a floor.
double separableIntegral_sr(std::vector<double> azimuth, const std::vector<double>& elevation, double floor) {
  const SortedPowers round(std::move(azimuth));
  const auto rows = static_cast<int>(elevation.size());
  double integral = 0;
  for (int i = 0; i < rows; ++i) {
    integral +=
        std::cos(midpoint(i, rows, kPi / 2)) * round.meanAbove(elevation[static_cast<std::size_t>(i)], floor);
  }
  return integral * 2 * kPi * kPi / rows;
}

constexpr int kMinSamples = 1024, kMaxSamples = 1 << 14;

/// As many samples as a table has intervals, within bounds.
int samplesOf(int count) {
  return std::clamp(count - 1, kMinSamples, kMaxSamples);
}

/// A planar aperture in direction cosines, v = sin(elevation) and u = cos(elevation) sin(azimuth); unsteered
/// it is symmetrical in both. Elevations are processed in blocks with one cos(elevation) each, over which the
/// azimuth pattern is almost constant.
double planarIntegral_sr(const PatternView& pattern, double floor) {
  constexpr int kBlocks = 32;
  constexpr double kSpan = 2, kQuarter = kPi / 2, kBlock = kQuarter / kBlocks;
  // Tables have hundreds of entries per lobe; about ten samples per lobe are sufficient.
  const int columns = std::clamp(pattern.azimuth_count / 128, 256, 1 << 13);
  const int rows = std::clamp(pattern.elevation_count / (80 * kBlocks), 8, 1 << 8);
  double integral = 0;
  for (int block = 0; block < kBlocks; ++block) {
    const double level = std::cos((block + 0.5) * kBlock);
    std::vector<double> powers;
    for (int column = 0; column < columns; ++column) {
      const double azimuth = (column + 0.5) * kQuarter / columns;
      powers.push_back(
          tablePower(pattern.azimuth_table, pattern.azimuth_count, level * std::sin(azimuth), kSpan) *
          std::pow(level * std::cos(azimuth), 2 * double(pattern.element_exponent)));
    }
    const SortedPowers across(std::move(powers));
    for (int row = 0; row < rows; ++row) {
      const double elevation = (block + (row + 0.5) / rows) * kBlock;
      const double across_mean = across.meanAbove(
          tablePower(pattern.elevation_table, pattern.elevation_count, std::sin(elevation), kSpan), floor);
      integral += across_mean * std::cos(elevation);
    }
  }
  return 2 * integral * kPi * kBlock / rows +
         2 * kPi * floor;  // the forward half space, and the half space behind
}

/// Each row of samples is between two rows of the grid.
double gridIntegral_sr(const PatternView& pattern) {
  using antenna_detail::atCell;
  using antenna_detail::cellInTable;
  const int columns = std::clamp(pattern.columns - 1, 720, 3600);
  const int rows = std::clamp(pattern.rows - 1, 360, 1800);
  double integral = 0;
  for (int row = 0; row < rows; ++row) {
    const double elevation = midpoint(row, rows, kPi / 2);
    const auto cell = cellInTable(static_cast<float>(elevation), static_cast<float>(kPi / 2), pattern.rows);
    const float* const below = pattern.grid_table + static_cast<std::size_t>(cell.index) * pattern.columns;
    const float* const above = below + pattern.columns;
    double sum = 0;
    for (int column = 0; column < columns; ++column) {
      const auto azimuth = cellInTable(static_cast<float>(midpoint(column, columns, kPi)),
                                       static_cast<float>(kPi), pattern.columns);
      const double amplitude = lerp(atCell(below, azimuth), atCell(above, azimuth), cell.fraction);
      sum += amplitude * amplitude;
    }
    integral += sum * std::cos(elevation);
  }
  return integral * 2 * kPi * kPi / (double(rows) * columns);
}

/// Angles (rad) at which a table of positions passes whole numbers.
std::vector<double> nodesOf(const float* positions, int count, double half_span) {
  std::vector<double> nodes;
  for (int i = 0; i < count; ++i) {
    if (positions[i] == std::floor(positions[i])) nodes.push_back(half_span * (2.0 * i / (count - 1) - 1));
  }
  return nodes;
}

/// Between four nodes, the mean of their powers.
double refinedIntegral_sr(const PatternView& pattern) {
  const std::vector<double> azimuths = nodesOf(pattern.azimuth_table, pattern.azimuth_count, kPi);
  const std::vector<double> elevations = nodesOf(pattern.elevation_table, pattern.elevation_count, kPi / 2);
  const auto rowIntegral = [&](std::size_t row) {
    const float* const amplitudes = pattern.grid_table + row * static_cast<std::size_t>(pattern.columns);
    const auto power = [&](std::size_t i) { return double(amplitudes[i]) * double(amplitudes[i]); };
    double sum = 0;
    for (std::size_t i = 0; i + 1 < azimuths.size(); ++i)
      sum += (power(i) + power(i + 1)) / 2 * (azimuths[i + 1] - azimuths[i]);
    return sum;
  };
  double integral = 0;
  for (std::size_t row = 0; row + 1 < elevations.size(); ++row)
    integral += (rowIntegral(row) + rowIntegral(row + 1)) / 2 *
                (std::sin(elevations[row + 1]) - std::sin(elevations[row]));
  return integral;
}

}  // namespace

double patternIntegral_sr(const PatternView& pattern) {
  const double floor = double(pattern.side_lobe_amplitude) * double(pattern.side_lobe_amplitude);
  switch (pattern.kind) {
    case PatternKind::isotropic:
      break;
    case PatternKind::gaussian: {
      // Half power at sqrt(ln 2 / 2 / a): 32 samples to a beamwidth.
      const auto powers = [](double a, double half_span) {
        const int count = static_cast<int>(
            std::clamp(64 * half_span * std::sqrt(a), double(kMinSamples), double(kMaxSamples)));
        return sampled(count, half_span, [a](double angle) { return std::exp(-2 * a * angle * angle); });
      };
      return separableIntegral_sr(powers(double(pattern.gaussian_azimuth), kPi),
                                  powers(double(pattern.gaussian_elevation), kPi / 2), floor);
    }
    case PatternKind::separable: {
      const auto powers = [](const float* table, int count, double half_span) {
        return sampled(samplesOf(count), half_span,
                       [=](double angle) { return tablePower(table, count, angle, half_span); });
      };
      return separableIntegral_sr(powers(pattern.azimuth_table, pattern.azimuth_count, kPi),
                                  powers(pattern.elevation_table, pattern.elevation_count, kPi / 2), floor);
    }
    case PatternKind::phased_array:
      return planarIntegral_sr(pattern, floor);
    case PatternKind::grid:
      return gridIntegral_sr(pattern);
    case PatternKind::refined_grid:
      return refinedIntegral_sr(pattern);
  }
  return 4 * kPi;
}

}  // namespace emscape::scenario
