#include "emfield/solver/interval_looks.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "emscape/base/units.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::IntervalKind;
using scenario::ScanKind;
using scenario::ScanSweep;
using scenario::SweptArc;

/// The bars of a scan, from the lowest upwards; scans other than rasters have one.
class Bars {
 public:
  explicit Bars(const scenario::ScanSpec& scan)
      : count_(scan.kind == ScanKind::raster ? scan.bars : 1),
        step_deg_(scan.elevation_step_deg),
        lowest_deg_(scan.elevation_deg - (count_ - 1) / 2.0 * scan.elevation_step_deg) {}

  int count() const { return count_; }
  int of(const SweptArc& arc) const {
    if (count_ == 1) return 0;
    const double bar = std::round((arc.elevation_deg - lowest_deg_) / step_deg_);
    return static_cast<int>(std::clamp(bar, 0.0, count_ - 1.0));
  }
  /// @param bar  with a fraction: between two bars
  double elevation_rad(double bar) const { return degToRad(lowest_deg_ + bar * step_deg_); }
  /// Sine of the elevation half way to the bar below; of the lowest bar: below all elevations.
  float sineBelow(int bar) const {
    return bar == 0 ? -2 : static_cast<float>(std::sin(elevation_rad(bar - 0.5)));
  }
  float sineAbove(int bar) const { return bar == count_ - 1 ? 2 : sineBelow(bar + 1); }

 private:
  int count_;
  double step_deg_, lowest_deg_;
};

/// Numbers of looks of a sweep: those everywhere, which are the result, and arcs with more.
/// @param whole_deg  a turn, or the width of the scan
double countLooks(const ScanSweep& sweep, double whole_deg, const Bars& bars, std::vector<CountedArc>& more) {
  const auto add = [&](CountedArc arc, int bar) {
    arc.sin_lowest = bars.sineBelow(bar);
    arc.sin_highest = bars.sineAbove(bar);
    const bool continues = !more.empty() && more.back().sin_highest == arc.sin_lowest &&
                           more.back().cos_middle == arc.cos_middle &&
                           more.back().sin_middle == arc.sin_middle && more.back().cos_half == arc.cos_half &&
                           more.back().passes == arc.passes;
    if (continues) {
      more.back().sin_highest = arc.sin_highest;
    } else {
      more.push_back(arc);
    }
  };
  std::vector<double> whole(static_cast<std::size_t>(bars.count()));
  for (const SweptArc& arc : sweep.arcs) {
    const int bar = bars.of(arc);
    const double times = std::floor(arc.width_deg / whole_deg + 1e-9);
    whole[static_cast<std::size_t>(bar)] += arc.times * times;
    const double rest_deg = arc.width_deg - times * whole_deg;
    if (rest_deg <= 1e-6 * whole_deg) continue;
    const double middle_rad = degToRad(arc.first_deg + rest_deg / 2);
    CountedArc counted;
    counted.cos_middle = static_cast<float>(std::cos(middle_rad));
    counted.sin_middle = static_cast<float>(std::sin(middle_rad));
    counted.cos_half = static_cast<float>(std::cos(degToRad(rest_deg / 2)));
    counted.passes = static_cast<float>(arc.times);
    add(counted, bar);
  }
  const double everywhere = *std::min_element(whole.begin(), whole.end());
  for (int bar = 0; bar < bars.count(); ++bar) {
    CountedArc counted;
    counted.passes = static_cast<float>(whole[static_cast<std::size_t>(bar)] - everywhere);
    if (counted.passes > 0) add(counted, bar);
  }
  return everywhere;
}

/// Azimuths that a beam passes on each of a run of bars.
struct PassedBars {
  double first_deg = 0, width_deg = 0;
  int lowest = 0, highest = 0;
};

/// The directions that a beam passes: for each azimuth the longest runs of bars.
std::vector<PassedBars> passedBars(std::vector<SweptArc> arcs, const Bars& bars) {
  constexpr double kSame_deg = 1e-6;
  joinArcs(arcs);
  std::vector<double> edges_deg;
  for (const SweptArc& arc : arcs)
    edges_deg.insert(edges_deg.end(), {arc.first_deg, arc.first_deg + arc.width_deg});
  std::sort(edges_deg.begin(), edges_deg.end());
  const auto areSame = [](double a, double b) { return b - a < kSame_deg; };
  edges_deg.erase(std::unique(edges_deg.begin(), edges_deg.end(), areSame), edges_deg.end());
  std::vector<PassedBars> passed;
  const auto add = [&](double begin_deg, double end_deg, int lowest, int highest) {
    const auto beside = std::find_if(passed.begin(), passed.end(), [&](const PassedBars& known) {
      return known.lowest == lowest && known.highest == highest &&
             std::abs(known.first_deg + known.width_deg - begin_deg) < kSame_deg;
    });
    if (beside != passed.end()) {
      beside->width_deg = end_deg - beside->first_deg;
    } else {
      passed.push_back({begin_deg, end_deg - begin_deg, lowest, highest});
    }
  };
  for (std::size_t i = 0; i + 1 < edges_deg.size(); ++i) {
    const double middle_deg = (edges_deg[i] + edges_deg[i + 1]) / 2;
    std::vector<int> at_azimuth;  // its bars, upwards as the arcs
    for (const SweptArc& arc : arcs) {
      if (middle_deg > arc.first_deg && middle_deg < arc.first_deg + arc.width_deg)
        at_azimuth.push_back(bars.of(arc));
    }
    for (std::size_t n = 0; n < at_azimuth.size();) {
      const int lowest = at_azimuth[n++];
      int highest = lowest;
      while (n < at_azimuth.size() && at_azimuth[n] == highest + 1) highest = at_azimuth[n++];
      add(edges_deg[i], edges_deg[i + 1], lowest, highest);
    }
  }
  return passed;
}

LookArc lookArc(const PassedBars& part, const Bars& bars) {
  const double middle_rad = degToRad(part.first_deg + part.width_deg / 2);
  const double half_rad = degToRad(std::min(part.width_deg, kTurn_deg) / 2);
  const double lowest_rad = bars.elevation_rad(part.lowest), highest_rad = bars.elevation_rad(part.highest);
  LookArc arc;
  arc.cos_middle = static_cast<float>(std::cos(middle_rad));
  arc.sin_middle = static_cast<float>(std::sin(middle_rad));
  arc.cos_azimuth = static_cast<float>(std::cos(half_rad));
  arc.sin_azimuth = static_cast<float>(std::sin(half_rad));
  arc.sin_lowest = static_cast<float>(std::sin(lowest_rad));
  arc.cos_lowest = static_cast<float>(std::cos(lowest_rad));
  arc.sin_highest = static_cast<float>(std::sin(highest_rad));
  arc.cos_highest = static_cast<float>(std::cos(highest_rad));
  return arc;
}

/// Sets the directions of the looks of a sweep.
void setDirections(const ScanSweep& sweep, const Bars& bars, IntervalLooks& looks) {
  constexpr double kMiddle_deg = 1e-6;
  const std::vector<PassedBars> passed = passedBars(sweep.arcs, bars);
  const auto isOnAllBars = [&](const PassedBars& part) {
    return part.lowest == 0 && part.highest == bars.count() - 1;
  };
  if (std::any_of(passed.begin(), passed.end(),
                  [&](const PassedBars& part) { return part.width_deg >= kTurn_deg && isOnAllBars(part); }))
    return;
  const bool is_ahead = passed.size() == 1 && isOnAllBars(passed.front()) &&
                        std::abs(passed.front().first_deg + passed.front().width_deg / 2) < kMiddle_deg;
  if (!is_ahead) {
    for (const PassedBars& part : passed) looks.arcs.directions.push_back(lookArc(part, bars));
    return;
  }
  looks.half_width_deg = 0;
  for (const SweptArc& arc : sweep.arcs) {
    looks.half_width_deg = std::max({looks.half_width_deg, -arc.first_deg, arc.first_deg + arc.width_deg});
  }
}

/// The last passes in a frame whose forward is at an azimuth, before an interval's end, without passes of
/// which all azimuths are passed again in one later pass in the same direction.
/// @param is_still  the beam does not move: it looks continuously in all possible directions
std::vector<PassedArc> lastPasses(std::vector<scenario::TimedPass> passes, double frame_deg, bool is_still,
                                  double end_s) {
  constexpr double kRounding_rad = 1e-6;
  std::sort(passes.begin(), passes.end(), [](const auto& a, const auto& b) { return a.end_s > b.end_s; });
  std::vector<PassedArc> last;
  for (const scenario::TimedPass& pass : passes) {
    const double width_deg = pass.end_deg - pass.begin_deg;
    PassedArc arc;
    arc.middle_rad = static_cast<float>(
        degToRad(std::remainder((pass.begin_deg + pass.end_deg) / 2 - frame_deg, kTurn_deg)));
    arc.half_width_rad = static_cast<float>(is_still ? kPi : degToRad(std::abs(width_deg) / 2));
    arc.age_s = static_cast<float>(end_s - (is_still ? pass.end_s : (pass.begin_s + pass.end_s) / 2));
    if (width_deg != 0)
      arc.age_s_rad = static_cast<float>(-(pass.end_s - pass.begin_s) / degToRad(width_deg));
    const bool is_repeated = std::any_of(last.begin(), last.end(), [&](const PassedArc& later) {
      const double apart_rad =
          std::remainder(static_cast<double>(later.middle_rad - arc.middle_rad), 2 * kPi);
      const double margin_rad = static_cast<double>(later.half_width_rad - arc.half_width_rad);
      return std::abs(apart_rad) <= margin_rad + kRounding_rad &&
             std::signbit(later.age_s_rad) == std::signbit(arc.age_s_rad);
    });
    if (!is_repeated) last.push_back(arc);
  }
  return last;
}

/// The directions of a sweep's dwells: those of a turning antenna are arcs without width.
std::vector<LookArc> dwellDirections(const ScanSweep& sweep) {
  std::vector<std::pair<double, double>> angles_deg;
  for (const SweptArc& arc : sweep.arcs) angles_deg.push_back({arc.first_deg, arc.elevation_deg});
  for (const scenario::SweptDwell& dwell : sweep.dwells)
    angles_deg.push_back({dwell.azimuth_deg, dwell.elevation_deg});
  std::sort(angles_deg.begin(), angles_deg.end());
  angles_deg.erase(std::unique(angles_deg.begin(), angles_deg.end()), angles_deg.end());
  std::vector<LookArc> directions;
  for (const auto& [azimuth_deg, elevation_deg] : angles_deg) {
    LookArc arc;
    arc.cos_middle = static_cast<float>(std::cos(degToRad(azimuth_deg)));
    arc.sin_middle = static_cast<float>(std::sin(degToRad(azimuth_deg)));
    arc.cos_azimuth = 1;
    arc.sin_lowest = arc.sin_highest = static_cast<float>(std::sin(degToRad(elevation_deg)));
    arc.cos_lowest = arc.cos_highest = static_cast<float>(std::cos(degToRad(elevation_deg)));
    directions.push_back(arc);
  }
  return directions;
}

bool isAllAround(const CountedArc& arc) {
  return arc.cos_half < -1;
}

/// Number of passes towards a bar at all azimuths.
float looksAllAround(const IntervalLooks& looks, const Bars& bars, int bar) {
  float passes = looks.everywhere;
  for (const CountedArc& arc : looks.arcs.counts) {
    if (isAllAround(arc) && arc.sin_lowest <= bars.sineBelow(bar) && arc.sin_highest >= bars.sineAbove(bar))
      passes += arc.passes;
  }
  return passes;
}

/// Number of cycles of the dwells in the active time of an interval; each cycle is one look in every
/// direction.
float dwellLooks(const scenario::ScanSpec& scan, double active_s) {
  return static_cast<float>(std::max(1.0, std::floor(active_s / scenario::scanCycle_s(scan) + 1e-9)));
}

}  // namespace

bool stays(const ScanSweep& sweep) {
  return sweep.dwells.empty() && std::all_of(sweep.arcs.begin(), sweep.arcs.end(), [&](const SweptArc& arc) {
           return arc.width_deg == 0 && arc.first_deg == sweep.arcs.front().first_deg &&
                  arc.elevation_deg == sweep.arcs.front().elevation_deg;
         });
}

void joinArcs(std::vector<SweptArc>& arcs) {
  if (arcs.size() < 2) return;
  constexpr double kPerDegree = 1e9, kRounding_deg = 1 / kPerDegree;
  const auto rounded = [](double angle_deg) { return std::round(angle_deg * kPerDegree) / kPerDegree; };
  std::sort(arcs.begin(), arcs.end(), [](const SweptArc& a, const SweptArc& b) {
    return std::tie(a.elevation_deg, a.first_deg) < std::tie(b.elevation_deg, b.first_deg);
  });
  std::vector<SweptArc> joined;
  for (const SweptArc& arc : arcs) {
    const double end_deg = arc.first_deg + arc.width_deg;
    const bool joins = !joined.empty() && joined.back().elevation_deg == arc.elevation_deg &&
                       arc.first_deg <= joined.back().first_deg + joined.back().width_deg + kRounding_deg;
    if (!joins) joined.push_back({rounded(arc.first_deg), 0, arc.elevation_deg, 1, 1});
    SweptArc& last = joined.back();
    last.width_deg = std::max(last.width_deg, rounded(end_deg - last.first_deg));
  }
  arcs = std::move(joined);
}

IntervalLooks intervalLooks(const scenario::Scenario& scenario, const Emitter& emitter, double t_s,
                            const ScanSweep& sweep, double forward_deg) {
  const scenario::IntervalSpec& interval = scenario.output.interval;
  const scenario::ScanSpec& scan = emitter.scan;
  const double duration_s = scenario::intervalDuration_s(interval, scan, scenario.clock);
  IntervalLooks looks;
  looks.forward_deg = forward_deg;
  if (scan.kind == ScanKind::dwell_list) {
    looks.everywhere = dwellLooks(scan, scenario::activeTime_s(emitter, t_s, duration_s));
    looks.arcs.directions = dwellDirections(sweep);
    return looks;
  }
  const bool is_still = stays(sweep);
  if (interval.kind == IntervalKind::cumulative && scan.kind != ScanKind::raster) {
    looks.arcs.passes =
        lastPasses(scenario::lastPassesOf(emitter, t_s, duration_s), forward_deg, is_still, t_s + duration_s);
  }
  if (is_still) return looks;
  const Bars bars(scan);
  const bool sweeps = scan.kind == ScanKind::sector || scan.kind == ScanKind::raster;
  looks.everywhere =
      static_cast<float>(countLooks(sweep, sweeps ? scan.width_deg : kTurn_deg, bars, looks.arcs.counts));
  setDirections(sweep, bars, looks);
  return looks;
}

IntervalLooks looksInPart(const scenario::Scenario& scenario, const Emitter& part, double t_s,
                          const ScanSweep& sweep, const IntervalLooks& whole, float share) {
  const double duration_s = scenario::intervalDuration_s(scenario.output.interval, part.scan, scenario.clock);
  const auto inFrame = [&whole](ScanSweep of) {
    for (SweptArc& arc : of.arcs) arc.first_deg -= whole.forward_deg;
    return of;
  };
  const IntervalLooks own = intervalLooks(
      scenario, part, t_s, inFrame(scenario::sweepOf(part, t_s, duration_s)), whole.forward_deg);
  IntervalLooks looks = whole;
  looks.arcs.passes = own.arcs.passes;
  looks.everywhere = looks.least = 0;
  looks.arcs.counts.clear();
  // A direction at the edge of what the scan passes is within its arcs, however it is rounded.
  constexpr double kGap_rad = 1e-5;
  for (CountedArc arc : own.arcs.counts) {
    if (isAllAround(arc)) continue;
    arc.cos_half = static_cast<float>(
        std::cos(std::min(std::acos(static_cast<double>(arc.cos_half)) + 2 * kGap_rad, kPi)));
    looks.arcs.counts.push_back(arc);
  }
  const Bars bars(part.scan);
  std::vector<SweptArc> passed = inFrame(sweep).arcs;
  joinArcs(passed);
  for (int bar = 0; bar < bars.count(); ++bar) {
    const float elsewhere = share * std::max(looksAllAround(whole, bars, bar), whole.least);
    CountedArc arc;
    arc.sin_lowest = bars.sineBelow(bar);
    arc.sin_highest = bars.sineAbove(bar);
    arc.passes = elsewhere;
    looks.arcs.counts.push_back(arc);
    arc.passes = looksAllAround(own, bars, bar) - elsewhere;
    for (const SweptArc& of : passed) {
      if (bars.of(of) != bar) continue;
      const double middle_rad = degToRad(of.first_deg + of.width_deg / 2);
      arc.cos_middle = static_cast<float>(std::cos(middle_rad));
      arc.sin_middle = static_cast<float>(std::sin(middle_rad));
      arc.cos_half = of.width_deg < kTurn_deg
                         ? static_cast<float>(std::cos(degToRad(of.width_deg / 2) + kGap_rad))
                         : -2.0f;
      looks.arcs.counts.push_back(arc);
    }
  }
  return looks;
}

}  // namespace emscape::emfield
