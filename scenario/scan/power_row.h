/// Power of a pattern at one elevation by azimuth, for largest values and means over azimuths that a beam
/// passes.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "emscape/base/units.h"
#include "scenario/antenna/pattern.h"
#include "scenario/antenna/refined_grid.h"

namespace emscape::scenario {

/// The azimuths of a row's entries, counted in units of which a turn has a whole number.
class RowAzimuths {
 public:
  /// Evenly spaced: a unit each.
  explicit RowAzimuths(int count) : units_(count) {
    for (int i = 0; i <= count; ++i) starts_.push_back(i);
    index();
  }
  /// Those of an axis of azimuths.
  explicit RowAzimuths(const RefinedAxis& axis) : units_(360 * RefinedAxis::kUnitsPerDegree) {
    for (int i = 0; i < axis.count(); ++i) {
      starts_.push_back(static_cast<int>(std::lround(axis.angle_deg(i) * RefinedAxis::kUnitsPerDegree)));
      if (starts_.back() < 0) starts_.back() += units_;
    }
    std::sort(starts_.begin(), starts_.end());
    starts_.erase(std::unique(starts_.begin(), starts_.end()), starts_.end());
    starts_.push_back(units_);
    index();
  }

  int count() const { return static_cast<int>(starts_.size()) - 1; }
  int units() const { return units_; }
  double azimuth_rad(int i) const { return 2 * kPi * starts_[static_cast<std::size_t>(i)] / units_; }
  int width(int i) const {
    return starts_[static_cast<std::size_t>(i) + 1] - starts_[static_cast<std::size_t>(i)];
  }
  /// Position of a number of units, 0 or more, counted in entries: those of whole turns, the entry before it,
  /// and the part of the way to the next one.
  struct Position {
    int turns = 0, entry = 0;
    double part = 0;

    double entries(int of_turn) const { return double(turns) * of_turn + entry + part; }
  };
  Position at(double units) const {
    Position position;
    position.turns = static_cast<int>(std::floor(units / units_));
    const double in_turn = units - double(position.turns) * units_;
    const int unit = std::min(static_cast<int>(in_turn), units_ - 1);
    position.entry = entry_of_unit_[static_cast<std::size_t>(unit)];
    position.part =
        (in_turn - starts_[static_cast<std::size_t>(position.entry)]) / double(width(position.entry));
    return position;
  }

 private:
  void index() {
    entry_of_unit_.reserve(static_cast<std::size_t>(units_));
    for (int i = 0; i < count(); ++i) entry_of_unit_.insert(entry_of_unit_.end(), width(i), i);
  }

  int units_;
  std::vector<int> starts_;         ///< of the entries, and units_
  std::vector<int> entry_of_unit_;  ///< the last entry that is not behind a unit
};

/// Power by azimuth relative to the beam, over the full circle.
class PowerRow {
 public:
  /// @param azimuths       outlive the row
  /// @param elevation_rad  of the row
  /// @param tilt_rad       of the beam, upwards
  PowerRow(const PatternView& pattern, const RowAzimuths& azimuths, double elevation_rad, double tilt_rad)
      : azimuths_(&azimuths), count_(azimuths.count()), power_(static_cast<std::size_t>(azimuths.count())) {
    const double level = std::cos(elevation_rad), up = std::sin(elevation_rad);
    const double cos_tilt = std::cos(tilt_rad), sin_tilt = std::sin(tilt_rad);
    for (int i = 0; i < count_; ++i) {
      const double azimuth_rad = azimuths.azimuth_rad(i);
      const double ahead = level * std::cos(azimuth_rad), right = level * std::sin(azimuth_rad);
      const Vec3d direction{ahead * cos_tilt + up * sin_tilt, right, up * cos_tilt - ahead * sin_tilt};
      const float amplitude = patternAmplitude(pattern, vecCast<float>(direction), 0, 0);
      power_[static_cast<std::size_t>(i)] = static_cast<double>(amplitude) * static_cast<double>(amplitude);
    }
    sums_.reserve(power_.size() + 1);
    sums_.push_back(0);
    for (int i = 0; i < count_; ++i)
      sums_.push_back(sums_.back() + (at(i) + at(i + 1)) / 2 * azimuths.width(i));
  }

  double largest() const { return *std::max_element(power_.begin(), power_.end()); }
  /// Between two azimuths (deg), less than a turn apart.
  double largest(double begin_deg, double end_deg) {
    const auto [begin, end] = unitsOf(begin_deg, end_deg);
    const RowAzimuths::Position from = azimuths_->at(begin), to = azimuths_->at(end);
    const double at_ends = std::max(between(from), between(to));
    const int first = static_cast<int>(std::ceil(from.entries(count_))),
              last = static_cast<int>(std::floor(to.entries(count_)));
    return last < first ? at_ends : std::max(at_ends, largestOf(first, last));
  }
  /// The mean between two azimuths (deg).
  double mean(double begin_deg, double end_deg) const {
    const auto [begin, end] = unitsOf(begin_deg, end_deg);
    if (!(end > begin)) return between(azimuths_->at(begin));
    return (integralTo(azimuths_->at(end)) - integralTo(azimuths_->at(begin))) / (end - begin);
  }

 private:
  std::pair<double, double> unitsOf(double begin_deg, double end_deg) const {
    const double first_turn = std::floor(begin_deg / 360) * 360;
    const int units = azimuths_->units();
    return {(begin_deg - first_turn) * units / 360, (end_deg - first_turn) * units / 360};
  }
  double at(int i) const { return power_[index(i)]; }
  double between(const RowAzimuths::Position& x) const {
    return at(x.entry) + x.part * (at(x.entry + 1) - at(x.entry));
  }
  /// Integral of the interpolated power from azimuth 0.
  double integralTo(const RowAzimuths::Position& x) const {
    return x.turns * sums_.back() + sums_[static_cast<std::size_t>(x.entry)] +
           azimuths_->width(x.entry) * x.part * (at(x.entry) + x.part / 2 * (at(x.entry + 1) - at(x.entry)));
  }

  /// Largest of the entries first..last, from two overlapping runs whose length is a power of two.
  double largestOf(int first, int last) {
    std::size_t level = 0;
    while ((2 << level) <= last - first + 1) ++level;
    if (runs_.empty()) runs_.push_back(power_);
    while (runs_.size() <= level) {
      const std::vector<double>& half = runs_.back();
      const int length = 1 << (runs_.size() - 1);
      std::vector<double> whole(half.size());
      for (int i = 0; i < count_; ++i) whole[index(i)] = std::max(half[index(i)], half[index(i + length)]);
      runs_.push_back(std::move(whole));
    }
    return std::max(runs_[level][index(first)], runs_[level][index(last + 1 - (1 << level))]);
  }
  /// @param i  0..2 count_: of two turns
  std::size_t index(int i) const {
    return static_cast<std::size_t>(i < count_ ? i : i < 2 * count_ ? i - count_ : i - 2 * count_);
  }

  const RowAzimuths* azimuths_;
  int count_;
  std::vector<double> power_, sums_;       ///< sums_[i]: the integral from azimuth 0 to entry i
  std::vector<std::vector<double>> runs_;  ///< runs_[n][i]: the largest of the 2^n entries from i on
};

}  // namespace emscape::scenario
