#include "emfield/excess/elevation_cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emfield/radar/receiver.h"
#include "emscape/base/error.h"

namespace emscape::emfield {
namespace {

bool radiatesCut(const scenario::Emitter& emitter) {
  return emitter.propagation.model == propagation::PropagationModel::parabolic_equation &&
         emitter.propagation.parabolic_equation.source == propagation::PeRadiator::pattern;
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
  if (!radiatesCut(emitter) || emitter.antenna->view().kind == scenario::PatternKind::isotropic)
    return std::nullopt;
  return ElevationCut{emitter.antenna, {beam.forward.z, beam.right.z, beam.up.z}, beam.steer_v};
}

void checkElevationCut(const scenario::Scenario& scenario, const scenario::Emitter& emitter) {
  if (!radiatesCut(emitter)) return;
  const std::string motion = motionInElevation(scenario, emitter);
  if (motion.empty()) return;
  throw Error(
      ErrorCode::bad_input, emitter.propagation.location,
      fmt::format("emitter '{}': 'parabolic_equation': 'source' is pattern, which marches the beam at one "
                  "elevation, but {}; expected isotropic, or a beam that stays in elevation",
                  emitter.name, motion));
}

}  // namespace emscape::emfield
