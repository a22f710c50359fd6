#include "scenario/scan/swept_antenna.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "base/large_array.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "scenario/antenna/pattern.h"
#include "scenario/antenna/refined_grid.h"
#include "scenario/antenna/tables.h"
#include "scenario/scan/many_arcs.h"
#include "scenario/scan/power_row.h"

namespace emscape::scenario {
namespace {

constexpr std::size_t kFewDwells = 128;

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
std::vector<PowerRow> rowsOf(const PatternView& pattern, const Tilts& tilts, const RowAzimuths& azimuths,
                             double elevation_rad) {
  std::vector<PowerRow> rows;
  rows.reserve(tilts.tilts_deg.size());
  for (const double tilt_deg : tilts.tilts_deg) {
    checkpoint();
    rows.emplace_back(pattern, azimuths, elevation_rad, degToRad(tilt_deg));
  }
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
      checkpoint();
      if (pattern == SweptPattern::mean) {
        weights_[tilt] = rowWeightsOf(arcs[tilt], azimuths);
      } else {
        spans_[tilt] = rowSpansOf(arcs[tilt], azimuths);
      }
    }
  }
  /// The power of the interval at one elevation, from azimuth 0 on.
  std::vector<double> powerOf(const PatternView& view, const Tilts& tilts, const RowAzimuths& azimuths,
                              double elevation_rad) const {
    std::vector<double> power(static_cast<std::size_t>(azimuths.count()));
    for (std::size_t tilt = 0; tilt < tilts.tilts_deg.size(); ++tilt) {
      checkpoint();
      const PowerRow row(view, azimuths, elevation_rad, degToRad(tilts.tilts_deg[tilt]));
      if (pattern_ == SweptPattern::mean) {
        addMean(row.power(), weights_[tilt], power);
      } else {
        raiseToLargest(row.power(), spans_[tilt], power);
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
  if (dwells.size() > kFewDwells) {  // of many bursts: each position once
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

/// A grid's nodes along one axis.
struct Axis {
  std::vector<double> angles_deg;
  std::optional<RefinedAxis> refined;  ///< none: evenly spaced

  int count() const { return static_cast<int>(angles_deg.size()); }
};

Axis evenAxis(double span_deg, int intervals) {
  Axis axis;
  for (int i = 0; i <= intervals; ++i) axis.angles_deg.push_back(span_deg * (i - intervals / 2) / intervals);
  return axis;
}

Axis refinedAxis(int half_span_deg, double coarse_step_deg, const RefinedAxis::Zones& zones) {
  Axis axis;
  axis.refined.emplace(half_span_deg, coarse_step_deg, zones);
  for (int i = 0; i < axis.refined->count(); ++i) axis.angles_deg.push_back(axis.refined->angle_deg(i));
  return axis;
}

/// Zones around the directions from which the beam begins to move, or at which it stays.
struct Middles {
  std::vector<double> azimuths_deg, elevations_deg;

  explicit Middles(const ScanSweep& sweep) {
    for (const SweptArc& arc : sweep.arcs) {
      azimuths_deg.push_back(arc.first_deg);
      azimuths_deg.push_back(arc.first_deg + arc.width_deg);
      elevations_deg.push_back(arc.elevation_deg);
    }
    for (const SweptDwell& dwell : sweep.dwells) {
      azimuths_deg.push_back(dwell.azimuth_deg);
      elevations_deg.push_back(dwell.elevation_deg);
    }
  }
};

/// Steps per beamwidth below which a table is refined.
constexpr double kCoarse = 8;

struct SweptAxes {
  Axis azimuths, elevations;
};

/// The axes of a grid. Where the largest number of even steps is coarse for the beam, they are refined around
/// its directions, as far and as finely as a number of entries permits.
SweptAxes sweptAxes(const Antenna& antenna, const ScanSweep& sweep) {
  constexpr double kLeastStep_deg = 360.0 / kMaxSweptAzimuths, kMaxEntries = 9e6;
  struct Fineness {
    double reach, steps;  // both in beamwidths
  };
  const double width_deg = antenna.beamwidth_az_deg, height_deg = antenna.beamwidth_el_deg;
  if (std::min(width_deg, height_deg) >= kCoarse * kLeastStep_deg) {
    return {evenAxis(360, intervalsFor(360, width_deg, 16, kMaxSweptAzimuths)),
            evenAxis(180, intervalsFor(180, height_deg, 16, kMaxSweptAzimuths / 2))};
  }
  const Middles middles(sweep);
  const auto axisOf = [&](int half_span_deg, double beam_deg, const std::vector<double>& middles_deg,
                          const Fineness& fineness) {
    const double step_deg = beam_deg / fineness.steps;
    return refinedAxis(half_span_deg, std::max(step_deg, kLeastStep_deg),
                       {middles_deg, fineness.reach * beam_deg, step_deg});
  };
  SweptAxes axes;
  for (const Fineness& fineness : {Fineness{12, 20}, {6, 16}, {3, 16}, {3, 8}, {2, 6}}) {
    axes = {axisOf(180, width_deg, middles.azimuths_deg, fineness),
            axisOf(90, height_deg, middles.elevations_deg, fineness)};
    if (double(axes.azimuths.count()) * axes.elevations.count() <= kMaxEntries) return axes;
  }
  const double affordable_deg = 180 / std::sqrt(kMaxEntries / 2);
  const auto evenly = [&](int half_span_deg, double beam_deg) {
    const double step_deg = std::max(affordable_deg, beam_deg / 16);
    return refinedAxis(half_span_deg, step_deg, {{}, 0, step_deg});
  };
  return {evenly(180, width_deg), evenly(90, height_deg)};
}

/// The azimuths of rows for the columns of a grid.
RowAzimuths rowAzimuths(const Axis& columns, double beamwidth_deg) {
  if (!columns.refined) return RowAzimuths(columns.count() - 1);
  const double step_deg = std::min(1.0, beamwidth_deg / 40);  // linear in power, not in amplitude
  return RowAzimuths(RefinedAxis(180, std::max(step_deg, 360.0 / kMaxSweptAzimuths),
                                 {{0}, std::min(180.0, 12 * beamwidth_deg), step_deg}));
}

/// Whole turns, each with one tilt: the same at every azimuth.
AntennaPtr roundAntenna(const Antenna& antenna, const ScanSweep& sweep, SweptPattern pattern) {
  constexpr int kMaxElevations = 7200, kMaxAzimuths = 3600;
  const Sampled sampled(antenna, pattern);
  const double least_step_deg = 180.0 / kMaxElevations;
  const bool is_narrow =
      std::min(antenna.beamwidth_az_deg, antenna.beamwidth_el_deg) < kCoarse * least_step_deg;
  const double step_deg = antenna.beamwidth_el_deg / 32;
  const Axis elevations =
      is_narrow ? refinedAxis(90, std::max(step_deg, least_step_deg),
                              {Middles(sweep).elevations_deg, 12 * antenna.beamwidth_el_deg, step_deg})
                : evenAxis(180, intervalsFor(180, antenna.beamwidth_el_deg, 32, kMaxElevations));
  const RowAzimuths azimuths =
      is_narrow ? rowAzimuths(elevations, antenna.beamwidth_az_deg)
                : RowAzimuths(intervalsFor(360, antenna.beamwidth_az_deg, 8, kMaxAzimuths));
  const Tilts tilts(sweep);
  std::vector<double> amplitudes(static_cast<std::size_t>(elevations.count()));
  std::atomic<int> done{0};
  parallelFor(elevations.count(), 16, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      std::vector<PowerRow> rows =
          rowsOf(sampled.view, tilts, azimuths, degToRad(elevations.angles_deg[static_cast<std::size_t>(e)]));
      amplitudes[static_cast<std::size_t>(e)] = std::sqrt(powerOf(rows, tilts, sweep, 0, pattern));
    }
    reportDone(static_cast<double>(done += end - begin) / elevations.count());
  });
  const std::vector<float> positions = is_narrow ? elevations.refined->positions() : std::vector<float>();
  const int last = elevations.count() - 1;
  const auto shape = [amplitudes, positions, last](double angle_rad) {
    double at = std::clamp((angle_rad / kPi + 0.5) * last, 0.0, double(last));
    if (!positions.empty()) {
      const auto unit = std::lround((angle_rad / kPi + 0.5) * double(positions.size() - 1));
      at = double(positions[static_cast<std::size_t>(std::clamp<long>(unit, 0, long(positions.size()) - 1))]);
    }
    const int below = std::min(static_cast<int>(at), last - 1);
    return amplitudes[static_cast<std::size_t>(below)] +
           (at - below) * (amplitudes[static_cast<std::size_t>(below) + 1] -
                           amplitudes[static_cast<std::size_t>(below)]);
  };
  const auto one = [](double) { return 1.0; };
  const double table_step_deg = is_narrow ? 1.0 / RefinedAxis::kUnitsPerDegree : 180.0 / last;
  return describedAntenna(std::make_shared<SeparableAntenna>(
                              tabulate(one, kPi, kPi), tabulate(shape, kPi / 2, degToRad(table_step_deg)),
                              static_cast<double>(sampled.floor_amplitude)),
                          antenna.gain_dbi, 360, antenna.beamwidth_el_deg, "interval");
}

AntennaPtr gridAntenna(const Antenna& antenna, const ScanSweep& sweep, SweptPattern pattern) {
  const Sampled sampled(antenna, pattern);
  const auto [columns, elevations] = sweptAxes(antenna, sweep);
  const RowAzimuths azimuths = rowAzimuths(columns, antenna.beamwidth_az_deg);
  const Tilts tilts(sweep);
  const std::vector<Steering> dwells = steeringsOf(sweep);
  const int count = columns.count();
  std::vector<float> amplitudes;
  resizeInParts(amplitudes, static_cast<std::size_t>(count) * static_cast<std::size_t>(elevations.count()));
  std::optional<ManyArcs> many;
  if (areManyArcs(sweep.arcs.size(), tilts.tilts_deg.size(), pattern) && !columns.refined)
    many.emplace(sweep, tilts, count - 1, pattern);
  std::atomic<int> done{0};
  parallelFor(elevations.count(), 8, [&, &columns = columns, &elevations = elevations](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      const double elevation_rad = degToRad(elevations.angles_deg[static_cast<std::size_t>(e)]);
      float* const row = amplitudes.data() + static_cast<std::size_t>(e) * static_cast<std::size_t>(count);
      if (many) {
        const std::vector<double> power = many->powerOf(sampled.view, tilts, azimuths, elevation_rad);
        const int azimuths_of_turn = count - 1;
        for (int a = 0; a < count; ++a) {
          const int from_north = (a + azimuths_of_turn / 2) % azimuths_of_turn;
          row[a] = static_cast<float>(std::sqrt(power[static_cast<std::size_t>(from_north)]));
        }
        continue;
      }
      std::vector<PowerRow> rows = rowsOf(sampled.view, tilts, azimuths, elevation_rad);
      for (int a = 0; a < count; ++a) {
        checkpoint();
        const double azimuth_deg = columns.angles_deg[static_cast<std::size_t>(a)],
                     azimuth_rad = degToRad(azimuth_deg);
        const Vec3d direction{std::cos(elevation_rad) * std::cos(azimuth_rad),
                              std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
        const double power = dwells.empty()
                                 ? powerOf(rows, tilts, sweep, azimuth_deg, pattern)
                                 : powerOf(sampled.view, dwells, vecCast<float>(direction), pattern);
        row[a] = static_cast<float>(std::sqrt(power));
      }
    }
    reportDone(static_cast<double>(done += end - begin) / elevations.count());
  });
  std::shared_ptr<Antenna> swept;
  if (columns.refined) {
    swept = std::make_shared<RefinedGridAntenna>(*columns.refined, *elevations.refined, std::move(amplitudes),
                                                 sampled.floor_amplitude);
  } else {
    swept = std::make_shared<GridAntenna>(std::move(amplitudes), count, elevations.count(),
                                          sampled.floor_amplitude);
  }
  return describedAntenna(swept, antenna.gain_dbi, antenna.beamwidth_az_deg, antenna.beamwidth_el_deg,
                          "interval");
}

/// True if an interval's pattern is the same at every azimuth. A mean over more than a turn but not over
/// whole turns depends on the azimuth.
bool isSameAllRound(const ScanSweep& sweep, SweptPattern pattern) {
  return sweep.dwells.empty() && std::all_of(sweep.arcs.begin(), sweep.arcs.end(), [&](const SweptArc& arc) {
           return pattern == SweptPattern::largest ? arc.isRound() : arc.isWholeTurns();
         });
}

}  // namespace

AntennaPtr sweptAntenna(const Antenna& antenna, const ScanSweep& sweep, SweptPattern pattern) {
  return isSameAllRound(sweep, pattern) ? roundAntenna(antenna, sweep, pattern)
                                        : gridAntenna(antenna, sweep, pattern);
}

SweptSize sweptSizeOf(const Antenna& antenna, const ScanSweep& sweep) {
  const SweptAxes axes = sweptAxes(antenna, sweep);
  return {double(axes.azimuths.count()), double(axes.elevations.count()),
          double(rowAzimuths(axes.azimuths, antenna.beamwidth_az_deg).count())};
}

double lowOnAxis_db(const Antenna& antenna, const ScanSweep& sweep) {
  if (isSameAllRound(sweep, SweptPattern::mean)) return 0;
  const SweptAxes axes = sweptAxes(antenna, sweep);
  const auto low_db = [](const Axis& axis, double beam_deg) {
    const double step_deg = axis.refined ? axis.refined->fineStep_deg() : beam_deg / kCoarse;
    return 12 * std::pow(step_deg / 2 / beam_deg, 2);
  };
  return std::max(low_db(axes.azimuths, antenna.beamwidth_az_deg),
                  low_db(axes.elevations, antenna.beamwidth_el_deg));
}

}  // namespace emscape::scenario
