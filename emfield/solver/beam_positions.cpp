#include "emfield/solver/beam_positions.h"

#include <algorithm>
#include <cmath>

#include "emfield/solver/interval_beam.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::emfield {
namespace {

constexpr double kStepsPerBeamwidth = 20;
constexpr int kMinSteps = 1024, kMaxSteps = 16384;

Aim aimOf(double azimuth_deg, double elevation_deg) {
  const double azimuth_rad = degToRad(azimuth_deg), elevation_rad = degToRad(elevation_deg);
  Aim aim;
  aim.cos_azimuth = static_cast<float>(std::cos(azimuth_rad));
  aim.sin_azimuth = static_cast<float>(std::sin(azimuth_rad));
  aim.cos_elevation = static_cast<float>(std::cos(elevation_rad));
  aim.sin_elevation = static_cast<float>(std::sin(elevation_rad));
  return aim;
}

float amplitudeOf(const scenario::PatternView& pattern, const Aim& aim, const Vec3f& direction) {
  return scenario::patternAmplitude(pattern, turnedBy(aim, direction), aim.steer_u, aim.steer_v);
}

/// Entries of a table over an angle, fine enough for lobes of a beamwidth.
int entriesFor(double angle_deg, double beamwidth_deg) {
  return static_cast<int>(std::ceil(angle_deg / std::clamp(beamwidth_deg / 8, 0.1, 0.5)));
}

PatternReach reachOf(const scenario::Antenna& antenna, double elevation_deg) {
  const scenario::PatternView pattern = antenna.view();
  const Aim aim = aimOf(0, elevation_deg);
  const int azimuths = entriesFor(kTurn_deg / 2, antenna.beamwidth_az_deg);
  const int elevations = entriesFor(kTurn_deg / 2, antenna.beamwidth_el_deg);
  std::vector<float> largest(static_cast<std::size_t>(azimuths) +
                             1);  // at any elevation, by azimuth off the beam
  parallelFor(azimuths + 1, 8, [&](int begin, int end) {
    for (int a = begin; a < end; ++a) {
      const double azimuth_rad = kPi * a / azimuths;
      for (int e = 0; e <= elevations; ++e) {
        const double elevation_rad = kPi * (static_cast<double>(e) / elevations - 0.5);
        for (const double side : {1.0, -1.0}) {
          const Vec3d ray{std::cos(azimuth_rad) * std::cos(elevation_rad),
                          side * std::sin(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad)};
          largest[a] = std::max(largest[a], std::abs(amplitudeOf(pattern, aim, vecCast<float>(ray))));
        }
      }
    }
  });
  PatternReach reach;
  for (int n = 0; n < PatternReach::kLevels; ++n) {
    const double level = dbToRatio(-(n / static_cast<double>(PatternReach::kLevelsPerDb)) - 1);
    int last = azimuths;
    while (last >= 0 && static_cast<double>(largest[last] * largest[last]) <= level) --last;
    reach.azimuth_rad[n] = static_cast<float>(kPi * std::min(last + 2, azimuths) / azimuths);
  }
  return reach;
}

/// Adds an arc's positions and, if it has more than one, how far the pattern reaches from them.
/// @param first_deg  of the arc in the frame
void addArc(double first_deg, double width_deg, double elevation_deg, double share,
            const scenario::AntennaPtr& antenna, PatternReaches& reaches, BeamPositions& positions) {
  const int count = beamPositions(width_deg, antenna->beamwidth_az_deg);
  const double step_deg = width_deg / count;
  BeamArc arc;
  arc.aim = aimOf(first_deg + step_deg / 2, elevation_deg);
  arc.first_rad = static_cast<float>(degToRad(first_deg + step_deg / 2));
  arc.step_rad = static_cast<float>(degToRad(step_deg));
  arc.begin = static_cast<int>(positions.cos_azimuth.size());
  arc.count = count;
  arc.share = static_cast<float>(share / count);
  if (count > 1) {
    arc.reach = static_cast<int>(positions.reaches.size());
    positions.reaches.push_back(reaches.of(antenna, elevation_deg));
  }
  for (int n = 0; n < count; ++n) {
    const Aim aim = aimOf(first_deg + step_deg * (n + 0.5), 0);
    positions.cos_azimuth.push_back(aim.cos_azimuth);
    positions.sin_azimuth.push_back(aim.sin_azimuth);
  }
  positions.arcs.push_back(arc);
}

/// Adds a position of a steered beam, ahead in the frame.
void addSteered(double steer_u, double steer_v, double share, BeamPositions& positions) {
  BeamArc arc;
  arc.aim.steer_u = static_cast<float>(steer_u);
  arc.aim.steer_v = static_cast<float>(steer_v);
  arc.begin = static_cast<int>(positions.cos_azimuth.size());
  arc.share = static_cast<float>(share);
  positions.cos_azimuth.push_back(1);
  positions.sin_azimuth.push_back(0);
  positions.arcs.push_back(arc);
}

}  // namespace

int beamPositions(double width_deg, double beamwidth_deg) {
  if (width_deg <= 0) return 1;
  const double wanted = std::ceil(kStepsPerBeamwidth * width_deg / beamwidth_deg);
  return static_cast<int>(std::clamp(wanted, double(kMinSteps), double(kMaxSteps)));
}

const PatternReach& PatternReaches::of(const scenario::AntennaPtr& antenna, double elevation_deg) {
  const auto known = known_.find({antenna, elevation_deg});
  if (known != known_.end()) return known->second;
  for (auto it = known_.begin(); it != known_.end();) {  // of antennas without other owners
    it = it->first.first.use_count() == 1 ? known_.erase(it) : std::next(it);
  }
  return known_.emplace(std::pair(antenna, elevation_deg), reachOf(*antenna, elevation_deg)).first->second;
}

void setPositions(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                  const scenario::EmitterState& state, double t_s, PatternReaches& reaches,
                  OccupancyShare& share) {
  const double duration_s =
      scenario::intervalDuration_s(scenario.output.interval, emitter.scan, scenario.clock);
  const scenario::ScanSweep sweep = scenario::sweepOf(emitter, t_s, duration_s);
  const bool is_still = stays(sweep) || emitter.antenna->view().kind == scenario::PatternKind::isotropic;
  const scenario::BeamPose frame = is_still ? state.beam : sweepFrame(emitter, state);
  share.forward = vecCast<float>(frame.forward);
  share.right = vecCast<float>(frame.right);
  share.up = vecCast<float>(frame.up);
  share.positions = {};
  if (is_still) {
    double active = 0;
    for (const scenario::SweptArc& arc : sweep.arcs) active += arc.share;
    for (const scenario::SweptDwell& dwell : sweep.dwells) active += dwell.share;
    return addSteered(state.beam.steer_u, state.beam.steer_v, active, share.positions);
  }
  // The frame of a sector or raster is turned to its middle.
  const bool sweeps =
      emitter.scan.kind == scenario::ScanKind::sector || emitter.scan.kind == scenario::ScanKind::raster;
  const double frame_deg = sweeps ? emitter.scan.azimuth_deg : 0;
  for (const scenario::SweptArc& arc : sweep.arcs) {
    const auto add = [&](double first_deg, double width_deg, double part) {
      addArc(first_deg, width_deg, arc.elevation_deg, part, emitter.antenna, reaches, share.positions);
    };
    const double turns = std::floor(arc.width_deg / kTurn_deg + 1e-9);
    const double rest_deg = std::max(arc.width_deg - turns * kTurn_deg, 0.0);
    const double of_turns = turns > 0 ? arc.share * turns * kTurn_deg / arc.width_deg : 0;
    if (turns > 0) add(0, kTurn_deg, of_turns);  // the same wherever they begin
    if (turns == 0 || rest_deg > 1e-6 * arc.width_deg) {
      add(arc.first_deg - frame_deg, rest_deg, arc.share - of_turns);
    }
  }
  for (const scenario::SweptDwell& dwell : sweep.dwells) {
    const double azimuth_rad = degToRad(dwell.azimuth_deg), elevation_rad = degToRad(dwell.elevation_deg);
    addSteered(std::sin(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad), dwell.share,
               share.positions);
  }
}

}  // namespace emscape::emfield
