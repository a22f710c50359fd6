#include "scenario/scan/swept_antenna.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "scenario/antenna/pattern.h"
#include "scenario/antenna/tables.h"
#include "scenario/scan/many_arcs.h"

namespace emscape::scenario {
namespace {

/// More are computed by many_arcs.h.
constexpr std::size_t kFewArcs = 128;

/// Number of intervals of a table: a span with a number of steps per beamwidth; even, up to a limit.
int intervalsFor(double span_deg, double beamwidth_deg, double steps_per_beamwidth, int most) {
  const double steps = std::min(std::ceil(span_deg / beamwidth_deg * steps_per_beamwidth), double(most));
  return 2 * static_cast<int>(std::ceil(steps / 2));
}

/// The pattern without its lower limit, in which the table would round the edge: for the largest values the
/// limit is the same as that of the pattern. A mean includes it in its power.
struct Sampled {
  PatternView view;
  float floor_amplitude = 0;

  Sampled(const Antenna& antenna, SweptPattern pattern) : view(antenna.view()) {
    if (pattern == SweptPattern::largest) std::swap(view.side_lobe_amplitude, floor_amplitude);
  }
};

/// Power of a pattern at one elevation by azimuth relative to the beam, over the full circle.
class PowerRow {
 public:
  /// @param elevation_rad  of the row
  /// @param tilt_rad       of the beam, upwards
  PowerRow(const PatternView& pattern, int azimuths, double elevation_rad, double tilt_rad)
      : count_(azimuths), power_(static_cast<std::size_t>(azimuths)) {
    const double level = std::cos(elevation_rad), up = std::sin(elevation_rad);
    const double cos_tilt = std::cos(tilt_rad), sin_tilt = std::sin(tilt_rad);
    for (int i = 0; i < azimuths; ++i) {
      const double azimuth_rad = 2 * kPi * i / azimuths;
      const double ahead = level * std::cos(azimuth_rad), right = level * std::sin(azimuth_rad);
      const Vec3d direction{ahead * cos_tilt + up * sin_tilt, right, up * cos_tilt - ahead * sin_tilt};
      const float amplitude = patternAmplitude(pattern, vecCast<float>(direction), 0, 0);
      power_[static_cast<std::size_t>(i)] = static_cast<double>(amplitude) * static_cast<double>(amplitude);
    }
    sums_.reserve(power_.size() + 1);
    sums_.push_back(0);
    for (int i = 0; i < azimuths; ++i) sums_.push_back(sums_.back() + (at(i) + at(i + 1)) / 2);
  }

  const std::vector<double>& power() const { return power_; }
  double largest() const { return *std::max_element(power_.begin(), power_.end()); }
  /// Between two azimuths (deg), less than a turn apart.
  double largest(double begin_deg, double end_deg) {
    const double first_turn = std::floor(begin_deg / 360) * 360;
    const double begin = (begin_deg - first_turn) * count_ / 360, end = (end_deg - first_turn) * count_ / 360;
    const double at_ends = std::max(between(begin), between(end));
    const int first = static_cast<int>(std::ceil(begin)), last = static_cast<int>(std::floor(end));
    return last < first ? at_ends : std::max(at_ends, largestOf(first, last));
  }
  /// The mean between two azimuths (deg).
  double mean(double begin_deg, double end_deg) const {
    const double first_turn = std::floor(begin_deg / 360) * 360;
    const double begin = (begin_deg - first_turn) * count_ / 360, end = (end_deg - first_turn) * count_ / 360;
    if (!(end > begin)) return between(begin);
    return (integralTo(end) - integralTo(begin)) / (end - begin);
  }

 private:
  double at(int i) const { return power_[index(i)]; }
  double between(double x) const {
    const double below = std::floor(x);
    const int i = static_cast<int>(below);
    return at(i) + (x - below) * (at(i + 1) - at(i));
  }
  /// Integral of the interpolated power from azimuth 0.
  double integralTo(double x) const {
    const double turns = std::floor(x / count_);
    const double in_turn = x - turns * count_;
    const int i = std::min(static_cast<int>(in_turn), count_ - 1);
    const double part = in_turn - i;
    return turns * sums_.back() + sums_[static_cast<std::size_t>(i)] +
           part * (at(i) + part / 2 * (at(i + 1) - at(i)));
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

  int count_;
  std::vector<double> power_, sums_;       ///< sums_[i]: the integral from azimuth 0 to entry i
  std::vector<std::vector<double>> runs_;  ///< runs_[n][i]: the largest of the 2^n entries from i on
};

/// The different tilts of a sweep's arcs.
struct Tilts {
  std::vector<double> tilts_deg;
  std::vector<std::size_t> of_arc;  ///< index of each arc's tilt

  explicit Tilts(const ScanSweep& sweep) {
    for (const SweptArc& arc : sweep.arcs) {
      const auto found = std::find(tilts_deg.begin(), tilts_deg.end(), arc.elevation_deg);
      of_arc.push_back(static_cast<std::size_t>(found - tilts_deg.begin()));
      if (found == tilts_deg.end()) tilts_deg.push_back(arc.elevation_deg);
    }
  }
};

/// The rows of one elevation, one for each tilt.
std::vector<PowerRow> rowsOf(const PatternView& pattern, const Tilts& tilts, int azimuths,
                             double elevation_rad) {
  std::vector<PowerRow> rows;
  rows.reserve(tilts.tilts_deg.size());
  for (const double tilt_deg : tilts.tilts_deg)
    rows.emplace_back(pattern, azimuths, elevation_rad, degToRad(tilt_deg));
  return rows;
}

/// The power of an interval at one azimuth of a row.
double powerOf(std::vector<PowerRow>& rows, const Tilts& tilts, const ScanSweep& sweep, double azimuth_deg,
               SweptPattern pattern) {
  double power = 0;
  for (std::size_t n = 0; n < sweep.arcs.size(); ++n) {
    const SweptArc& arc = sweep.arcs[n];
    PowerRow& row = rows[tilts.of_arc[n]];
    // The beam is at first..first + width; these are the angles of the azimuth relative to it.
    const double begin_deg = azimuth_deg - arc.first_deg - arc.width_deg,
                 end_deg = azimuth_deg - arc.first_deg;
    if (pattern == SweptPattern::mean) {
      power += arc.share * row.mean(begin_deg, end_deg);
    } else {
      power = std::max(power, arc.isRound() ? row.largest() : row.largest(begin_deg, end_deg));
    }
  }
  return power;
}

/// The arcs of a sweep that has many, by tilt.
class ManyArcs {
 public:
  ManyArcs(const ScanSweep& sweep, const Tilts& tilts, int azimuths, SweptPattern pattern)
      : pattern_(pattern), weights_(tilts.tilts_deg.size()), spans_(tilts.tilts_deg.size()) {
    std::vector<std::vector<SweptArc>> arcs(tilts.tilts_deg.size());
    for (std::size_t n = 0; n < sweep.arcs.size(); ++n) arcs[tilts.of_arc[n]].push_back(sweep.arcs[n]);
    for (std::size_t tilt = 0; tilt < arcs.size(); ++tilt) {
      if (pattern == SweptPattern::mean) {
        weights_[tilt] = rowWeightsOf(arcs[tilt], azimuths);
      } else {
        spans_[tilt] = rowSpansOf(arcs[tilt], azimuths);
      }
    }
  }
  /// The power of the interval at one elevation, from azimuth 0 on.
  std::vector<double> powerOf(const std::vector<PowerRow>& rows) const {
    std::vector<double> power(rows.front().power().size());
    for (std::size_t tilt = 0; tilt < rows.size(); ++tilt) {
      if (pattern_ == SweptPattern::mean) {
        addMean(rows[tilt].power(), weights_[tilt], power);
      } else {
        raiseToLargest(rows[tilt].power(), spans_[tilt], power);
      }
    }
    return power;
  }

 private:
  SweptPattern pattern_;
  std::vector<std::vector<double>> weights_;
  std::vector<std::vector<RowSpan>> spans_;
};

/// A dwell as direction cosines of its steering.
struct Steering {
  float u = 0, v = 0;
  double share = 0;
};

std::vector<Steering> steeringsOf(const ScanSweep& sweep) {
  std::vector<SweptDwell> dwells = sweep.dwells;
  if (dwells.size() > kFewArcs) {  // of many bursts: each position once
    const auto angles = [](const SweptDwell& dwell) {
      return std::tie(dwell.azimuth_deg, dwell.elevation_deg);
    };
    std::stable_sort(dwells.begin(), dwells.end(),
                     [&](const SweptDwell& a, const SweptDwell& b) { return angles(a) < angles(b); });
    std::vector<SweptDwell> joined;
    for (const SweptDwell& dwell : dwells) {
      if (joined.empty() || angles(joined.back()) != angles(dwell)) {
        joined.push_back(dwell);
      } else {
        joined.back().share += dwell.share;
      }
    }
    dwells = std::move(joined);
  }
  std::vector<Steering> steerings;
  for (const SweptDwell& dwell : dwells) {
    const double azimuth_rad = degToRad(dwell.azimuth_deg), elevation_rad = degToRad(dwell.elevation_deg);
    steerings.push_back({static_cast<float>(std::sin(azimuth_rad) * std::cos(elevation_rad)),
                         static_cast<float>(std::sin(elevation_rad)), dwell.share});
  }
  return steerings;
}

/// The power of an interval of dwells in a direction of the array's frame.
double powerOf(const PatternView& view, const std::vector<Steering>& dwells, const Vec3f& direction,
               SweptPattern pattern) {
  double power = 0;
  for (const Steering& dwell : dwells) {
    const float amplitude = patternAmplitude(view, direction, dwell.u, dwell.v);
    const double of_dwell = static_cast<double>(amplitude) * static_cast<double>(amplitude);
    power = pattern == SweptPattern::mean ? power + dwell.share * of_dwell : std::max(power, of_dwell);
  }
  return power;
}

double angleOf(int index, int intervals, double span_deg) {
  return span_deg * (index - intervals / 2) / intervals;
}

/// Whole turns, each with one tilt: the same at every azimuth.
AntennaPtr roundAntenna(const Antenna& antenna, const ScanSweep& sweep, SweptPattern pattern) {
  const Sampled sampled(antenna, pattern);
  const int azimuths = intervalsFor(360, antenna.beamwidth_az_deg, 8, 3600);
  const int elevations = intervalsFor(180, antenna.beamwidth_el_deg, 32, 7200);
  const Tilts tilts(sweep);
  std::vector<double> amplitudes(static_cast<std::size_t>(elevations) + 1);
  std::atomic<int> done{0};
  parallelFor(elevations + 1, 16, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      checkpoint();
      std::vector<PowerRow> rows =
          rowsOf(sampled.view, tilts, azimuths, degToRad(angleOf(e, elevations, 180)));
      amplitudes[static_cast<std::size_t>(e)] = std::sqrt(powerOf(rows, tilts, sweep, 0, pattern));
    }
    reportDone(static_cast<double>(done += end - begin) / (elevations + 1));
  });
  const auto shape = [amplitudes, elevations](double angle_rad) {
    const double at = std::clamp((angle_rad / kPi + 0.5) * elevations, 0.0, double(elevations));
    const int below = std::min(static_cast<int>(at), elevations - 1);
    return amplitudes[static_cast<std::size_t>(below)] +
           (at - below) * (amplitudes[static_cast<std::size_t>(below) + 1] -
                           amplitudes[static_cast<std::size_t>(below)]);
  };
  const auto one = [](double) { return 1.0; };
  return describedAntenna(
      std::make_shared<SeparableAntenna>(tabulate(one, kPi, kPi), tabulate(shape, kPi / 2, kPi / elevations),
                                         static_cast<double>(sampled.floor_amplitude)),
      antenna.gain_dbi, 360, antenna.beamwidth_el_deg, "interval");
}

AntennaPtr gridAntenna(const Antenna& antenna, const ScanSweep& sweep, SweptPattern pattern) {
  const Sampled sampled(antenna, pattern);
  const int azimuths = intervalsFor(360, antenna.beamwidth_az_deg, 16, kMaxSweptAzimuths);
  const int elevations = intervalsFor(180, antenna.beamwidth_el_deg, 16, kMaxSweptAzimuths / 2);
  const Tilts tilts(sweep);
  const std::vector<Steering> dwells = steeringsOf(sweep);
  std::vector<float> amplitudes((static_cast<std::size_t>(azimuths) + 1) *
                                (static_cast<std::size_t>(elevations) + 1));
  std::optional<ManyArcs> many;
  if (sweep.arcs.size() > kFewArcs) many.emplace(sweep, tilts, azimuths, pattern);
  std::atomic<int> done{0};
  parallelFor(elevations + 1, 8, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      checkpoint();
      const double elevation_rad = degToRad(angleOf(e, elevations, 180));
      std::vector<PowerRow> rows = rowsOf(sampled.view, tilts, azimuths, elevation_rad);
      float* const row = amplitudes.data() + static_cast<std::size_t>(e) * (azimuths + 1);
      if (many) {
        const std::vector<double> power = many->powerOf(rows);
        for (int a = 0; a <= azimuths; ++a)
          row[a] =
              static_cast<float>(std::sqrt(power[static_cast<std::size_t>((a + azimuths / 2) % azimuths)]));
        continue;
      }
      for (int a = 0; a <= azimuths; ++a) {
        const double azimuth_deg = angleOf(a, azimuths, 360), azimuth_rad = degToRad(azimuth_deg);
        const Vec3d direction{std::cos(elevation_rad) * std::cos(azimuth_rad),
                              std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
        const double power = dwells.empty()
                                 ? powerOf(rows, tilts, sweep, azimuth_deg, pattern)
                                 : powerOf(sampled.view, dwells, vecCast<float>(direction), pattern);
        row[a] = static_cast<float>(std::sqrt(power));
      }
    }
    reportDone(static_cast<double>(done += end - begin) / (elevations + 1));
  });
  return describedAntenna(std::make_shared<GridAntenna>(std::move(amplitudes), azimuths + 1, elevations + 1,
                                                        sampled.floor_amplitude),
                          antenna.gain_dbi, antenna.beamwidth_az_deg, antenna.beamwidth_el_deg, "interval");
}

}  // namespace

AntennaPtr sweptAntenna(const Antenna& antenna, const ScanSweep& sweep, SweptPattern pattern) {
  // A mean over more than a turn but not over whole turns depends on the azimuth.
  const bool is_same_all_round =
      sweep.dwells.empty() && std::all_of(sweep.arcs.begin(), sweep.arcs.end(), [&](const SweptArc& arc) {
        return pattern == SweptPattern::largest ? arc.isRound() : arc.isWholeTurns();
      });
  return is_same_all_round ? roundAntenna(antenna, sweep, pattern) : gridAntenna(antenna, sweep, pattern);
}

}  // namespace emscape::scenario
