#include "emfield/excess/elevation_cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emfield/radar/receiver.h"
#include "emscape/base/error.h"

namespace emscape::emfield {
namespace {

using propagation::PeRadiator;

bool isMarched(const scenario::Emitter& emitter, PeRadiator source) {
  return emitter.propagation.model == propagation::PropagationModel::parabolic_equation &&
         emitter.propagation.parabolic_equation.source == source;
}

/// Elevation (deg) of the beam that is farthest from the horizon by its scan.
double steepestBeam_deg(const scenario::ScanSpec& scan) {
  const auto steeper = [](double a, double b) { return std::abs(b) > std::abs(a) ? b : a; };
  if (scan.kind == scenario::ScanKind::raster) {
    const double half_deg = (scan.bars - 1) * scan.elevation_step_deg / 2;
    return steeper(scan.elevation_deg - half_deg, scan.elevation_deg + half_deg);
  }
  if (scan.kind != scenario::ScanKind::dwell_list) return scan.elevation_deg;
  double steepest_deg = 0;
  for (const scenario::Dwell& dwell : scan.dwells)
    steepest_deg = steeper(steepest_deg, scan.elevation_deg + dwell.elevation_deg);
  return steepest_deg;
}

/// Description of the beam's motion in elevation; empty if it does not move.
std::string motionInElevation(const scenario::Scenario& scenario, const scenario::Emitter& emitter) {
  const scenario::ScanSpec& scan = emitter.scan;
  switch (scan.kind) {
    case scenario::ScanKind::raster:
      if (scan.bars > 1 && scan.elevation_step_deg != 0)
        return fmt::format("its raster has {} bars, {:g} degrees apart", scan.bars, scan.elevation_step_deg);
      break;
    case scenario::ScanKind::dwell_list: {
      const auto [lowest, highest] = std::minmax_element(
          scan.dwells.begin(), scan.dwells.end(), [](const scenario::Dwell& a, const scenario::Dwell& b) {
            return a.elevation_deg < b.elevation_deg;
          });
      if (lowest != scan.dwells.end() && lowest->elevation_deg < highest->elevation_deg)
        return fmt::format("its dwells are at {:g} to {:g} degrees", lowest->elevation_deg,
                           highest->elevation_deg);
      break;
    }
    case scenario::ScanKind::track:
      return "it turns onto its targets (scan: track)";
    case scenario::ScanKind::victim:
      return "it turns onto its victim (scan: victim)";
    case scenario::ScanKind::fixed:
    case scenario::ScanKind::rotate:
    case scenario::ScanKind::sector:
      break;
  }
  if (emitter.kind != scenario::EmitterKind::radar) return "";
  const RadarLook look = lookOf(emitter, scenario.output.radar_look);
  const bool turns = look.kind == LookKind::turned && look.sin_lowest < look.sin_highest;
  return turns || look.kind == LookKind::steered
             ? "the radar's beam follows targets (output: {radar_look: target}; scan: it does not)"
             : "";
}

}  // namespace

double ElevationCut::operator()(double elevation_rad) const {
  Vec3d level{zenith.z, 0, -zenith.x};  // normal to the antenna's right and to the zenith
  const double size = length(level);
  level = size > 0 ? level * (1 / size) : Vec3d{1, 0, 0};
  return antenna->signedAmplitudeTowards(level * std::cos(elevation_rad) + zenith * std::sin(elevation_rad),
                                         0, steer_v);
}

std::optional<ElevationCut> elevationCut(const scenario::Emitter& emitter, const scenario::BeamPose& beam) {
  if (!isMarched(emitter, PeRadiator::pattern) ||
      emitter.antenna->view().kind == scenario::PatternKind::isotropic)
    return std::nullopt;
  return ElevationCut{emitter.antenna, {beam.forward.z, beam.right.z, beam.up.z}, beam.steer_v};
}

void checkElevationCut(const scenario::Scenario& scenario, const scenario::Emitter& emitter) {
  if (!isMarched(emitter, PeRadiator::pattern)) return;
  const std::string motion = motionInElevation(scenario, emitter);
  if (motion.empty()) return;
  throw Error(
      ErrorCode::bad_input, emitter.propagation.location,
      fmt::format("emitter '{}': 'parabolic_equation': 'source' is pattern, which marches the beam at one "
                  "elevation, but {}; expected isotropic, or a beam that stays in elevation",
                  emitter.name, motion));
}

std::vector<std::string> tiltWarnings(const scenario::Scenario& scenario, const scenario::Emitter& emitter) {
  if (!isMarched(emitter, PeRadiator::isotropic) ||
      emitter.antenna->view().kind == scenario::PatternKind::isotropic)
    return {};
  const double tilt_deg = steepestBeam_deg(emitter.scan), width_deg = emitter.antenna->beamwidth_el_deg;
  if (!(std::abs(tilt_deg) > width_deg / 2)) return {};
  return {fmt::format(
      "emitter '{}': 'parabolic_equation': the beam of {:g} degrees points {:g} degrees {} the horizon, but "
      "the "
      "field is marched from an isotropic source and weighed by the pattern towards the direct ray: rays "
      "from the ground, which the beam hardly reaches, count as much, and lobes are too deep; {}",
      emitter.name, width_deg, std::abs(tilt_deg), tilt_deg > 0 ? "above" : "below",
      motionInElevation(scenario, emitter).empty()
          ? "'parabolic_equation: {source: pattern}' marches the beam"
          : "'source: pattern' takes only beams that stay in elevation; 'two_ray' weighs each ray by "
            "itself")};
}

}  // namespace emscape::emfield
