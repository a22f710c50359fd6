#include "emfield/solver/field_inputs.h"

#include <algorithm>
#include <tuple>
#include <vector>

#include "propagation/parabolic_equation/air/refractivity_field.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

using scenario::PatternView;

// Each structured binding names every member, so that a new one cannot be forgotten.

auto membersOf(const GeodeticPosition& position) {
  const auto& [latitude_deg, longitude_deg, height_ellipsoid_m] = position;
  return std::tie(latitude_deg, longitude_deg, height_ellipsoid_m);
}
auto membersOf(const propagation::Ground& ground) {
  const auto& [kind, relative_permittivity, conductivity_s_m, roughness_m, surface_msl_m, sea_by_height,
               terminal_clutter, percent, below_m, combine, place] = ground;
  return std::tie(kind, relative_permittivity, conductivity_s_m, roughness_m, surface_msl_m, sea_by_height,
                  terminal_clutter, percent, below_m, combine);
}
auto membersOf(const propagation::Atmosphere& atmosphere) {
  const auto& [k_factor, pressure_hpa, temperature_k, vapour_g_m3, rain_mm_h, rain_height_m, gases,
               refraction, sea_level_refractivity, climate, refractivity] = atmosphere;
  return std::tie(k_factor, pressure_hpa, temperature_k, vapour_g_m3, rain_mm_h, rain_height_m, gases,
                  refraction, sea_level_refractivity, climate);
}

auto membersOf(const LookArc& arc) {
  const auto& [cos_middle, sin_middle, cos_azimuth, sin_azimuth, sin_lowest, cos_lowest, sin_highest,
               cos_highest] = arc;
  return std::tie(cos_middle, sin_middle, cos_azimuth, sin_azimuth, sin_lowest, cos_lowest, sin_highest,
                  cos_highest);
}
auto membersOf(const CountedArc& arc) {
  const auto& [cos_middle, sin_middle, cos_half, sin_lowest, sin_highest, passes] = arc;
  return std::tie(cos_middle, sin_middle, cos_half, sin_lowest, sin_highest, passes);
}
auto membersOf(const PassedArc& arc) {
  const auto& [middle_rad, half_width_rad, age_s, age_s_rad] = arc;
  return std::tie(middle_rad, half_width_rad, age_s, age_s_rad);
}
auto membersOf(const RadarLook& look) {
  const auto& [kind, cos_azimuth, sin_azimuth, sin_lowest, cos_lowest, sin_highest, cos_highest, steer_u,
               steer_v] = look;
  return std::tie(kind, cos_azimuth, sin_azimuth, sin_lowest, cos_lowest, sin_highest, cos_highest, steer_u,
                  steer_v);
}
auto membersOf(const propagation::ReflectedRay& ray) {
  const auto& [re, im, weight, depression_sine, is_envelope] = ray;
  return std::tie(re, im, weight, depression_sine, is_envelope);
}
auto membersOf(const DetectionCurveView& curve) {
  // Plans keep a curve as long as its detector stays the same: the address of the knots identifies it.
  const auto& [knots, count, first_snr_db, steps_per_db] = curve;
  return std::tie(knots, count, first_snr_db, steps_per_db);
}

auto membersOf(const ClutterTask& clutter) {
  const auto& [surface, rain, rain_octaves_per_m, rain_top_m, sea_level_m, curvature_per_m, below] = clutter;
  return std::make_tuple(surface, rain, rain_octaves_per_m, rain_top_m, sea_level_m, curvature_per_m,
                         below.reach_rad,
                         std::vector<float>(below.log2_odds, below.log2_odds + PowerBelow::kNodes));
}
auto membersOf(const HeardRanges& heard) {
  const auto& [farthest_m, repeat_m, pulse_m] = heard;
  return std::tie(farthest_m, repeat_m, pulse_m);
}
auto membersOf(const ClutterMapInputs& map) {
  const auto& [land_gamma_db, land_by_cover, sea_state, range_cell_m, unambiguous_range_m, antenna] = map;
  return std::tie(land_gamma_db, land_by_cover, sea_state, range_cell_m, unambiguous_range_m);
}

template <class T>
bool same(const T& a, const T& b) {
  return membersOf(a) == membersOf(b);
}

template <class Arc>
bool sameArcs(const std::vector<Arc>& a, const std::vector<Arc>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same<Arc>);
}

bool sameJammer(const JammerAtRadar& a, const JammerAtRadar& b) {
  return a.boresight_to_noise == b.boresight_to_noise && a.duty == b.duty && sameRays(a, b);
}

bool sameTask(const RadarTask& a, const RadarTask& b) {
  // The jammers and the arcs are in RadarShare; sameLook() compares the look.
  const auto& [measure, reduction, look, look_arcs, look_arc_count, is_cumulative, looks, last_passes,
               echo_root, factor, lowest, ceiling, unjammed, curve, clutter, heard, blanker, jammers,
               jammer_count] = a;
  return measure == b.measure && reduction == b.reduction && is_cumulative == b.is_cumulative &&
         looks.everywhere == b.looks.everywhere && looks.least == b.looks.least && echo_root == b.echo_root &&
         factor == b.factor && lowest == b.lowest && ceiling == b.ceiling && unjammed == b.unjammed &&
         same(curve, b.curve) && same(clutter, b.clutter) && same(heard, b.heard) &&
         blanker.auxiliary == b.blanker.auxiliary &&
         blanker.curve.probabilities == b.blanker.curve.probabilities;
}

bool sameShare(const RadarShare& a, const RadarShare& b) {
  const auto& [channel, task, forward, right, up, jammers, arcs] = a;
  return channel == b.channel && sameTask(task, b.task) && sameLook(a, b) &&
         sameArcs(arcs.counts, b.arcs.counts) && sameArcs(arcs.passes, b.arcs.passes) &&
         std::equal(jammers.begin(), jammers.end(), b.jammers.begin(), b.jammers.end(), sameJammer);
}

bool sameArc(const BeamArc& a, const BeamArc& b) {
  // The azimuths follow from the arc, the reach from the pattern.
  const auto& [aim, first_rad, step_rad, begin, count, reach, share] = a;
  const auto& [cos_azimuth, sin_azimuth, cos_elevation, sin_elevation, steer_u, steer_v] = aim;
  return first_rad == b.first_rad && step_rad == b.step_rad && begin == b.begin && count == b.count &&
         reach == b.reach && share == b.share && cos_azimuth == b.aim.cos_azimuth &&
         sin_azimuth == b.aim.sin_azimuth && cos_elevation == b.aim.cos_elevation &&
         sin_elevation == b.aim.sin_elevation && steer_u == b.aim.steer_u && steer_v == b.aim.steer_v;
}

bool sameShare(const OccupancyShare& a, const OccupancyShare& b) {
  const auto& [channel, threshold_wm2, eirp_over_4pi_w, forward, right, up, positions] = a;
  return channel == b.channel && threshold_wm2 == b.threshold_wm2 && eirp_over_4pi_w == b.eirp_over_4pi_w &&
         forward == b.forward && right == b.right && up == b.up &&
         std::equal(positions.arcs.begin(), positions.arcs.end(), b.positions.arcs.begin(),
                    b.positions.arcs.end(), sameArc);
}

bool sameBeam(const EmitterBeam& a, const EmitterBeam& b) {
  const auto& [geometry, pattern, forward, right, up, steer_u, steer_v, eirp_over_4pi_w] = a;
  return forward == b.forward && right == b.right && up == b.up && steer_u == b.steer_u &&
         steer_v == b.steer_v && eirp_over_4pi_w == b.eirp_over_4pi_w;
}

bool sameTable(const float* a, const float* b, long long count) {
  if (a == nullptr || b == nullptr) return a == b;
  return std::equal(a, a + count, b);
}

bool samePattern(const PatternView& a, const PatternView& b) {
  const auto& [kind, gaussian_azimuth, gaussian_elevation, side_lobe_amplitude, lobe_tangent, azimuth_table,
               elevation_table, azimuth_count, elevation_count, grid_table, columns, rows, element_exponent] =
      a;
  return kind == b.kind && gaussian_azimuth == b.gaussian_azimuth &&
         gaussian_elevation == b.gaussian_elevation && side_lobe_amplitude == b.side_lobe_amplitude &&
         lobe_tangent == b.lobe_tangent && azimuth_count == b.azimuth_count &&
         elevation_count == b.elevation_count && columns == b.columns && rows == b.rows &&
         element_exponent == b.element_exponent && sameTable(azimuth_table, b.azimuth_table, azimuth_count) &&
         sameTable(elevation_table, b.elevation_table, elevation_count) &&
         sameTable(grid_table, b.grid_table, static_cast<long long>(columns) * rows);
}

bool sameShare(const ChannelWeight& a, const ChannelWeight& b) {
  const auto& [channel, weight] = a;
  return channel == b.channel && weight == b.weight;
}

template <class Share>
std::vector<const Share*> sharesIn(const std::vector<Share>& shares, int channel) {
  std::vector<const Share*> found;
  for (const Share& share : shares) {
    if (share.channel == channel) found.push_back(&share);
  }
  return found;
}

/// True if an emitter's contributions to a channel are the same.
template <class Share>
bool haveSame(const std::vector<Share>& a, const std::vector<Share>& b, int channel) {
  const std::vector<const Share*> of_a = sharesIn(a, channel), of_b = sharesIn(b, channel);
  return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                    [](const Share* x, const Share* y) { return sameShare(*x, *y); });
}

}  // namespace

bool samePattern(const scenario::AntennaPtr& a, const scenario::AntennaPtr& b) {
  return a == b || samePattern(a->view(), b->view());
}

/// @param a, b  null: no map
bool haveSameBeam(const scenario::AntennaPtr& a, const scenario::AntennaPtr& b) {
  return a == b || (a && b && samePattern(a, b) && a->beamwidth_az_deg == b->beamwidth_az_deg &&
                    a->beamwidth_el_deg == b->beamwidth_el_deg);
}

bool areSame(const std::optional<ElevationCut>& a, const std::optional<ElevationCut>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  const auto& [antenna, zenith, steer_v] = *a;
  return samePattern(antenna, b->antenna) && zenith == b->zenith && steer_v == b->steer_v;
}

bool sameLook(const RadarShare& a, const RadarShare& b) {
  return same(a.task.look, b.task.look) && sameArcs(a.arcs.directions, b.arcs.directions) &&
         a.forward == b.forward && a.right == b.right && a.up == b.up;
}

bool sameRays(const JammerAtRadar& a, const JammerAtRadar& b) {
  const auto& [direction, boresight_to_noise, duty, has_reflected_ray, reflected, reflected_direction,
               direct_amplitude, reflected_amplitude] = a;
  return direction == b.direction && has_reflected_ray == b.has_reflected_ray &&
         same(reflected, b.reflected) && reflected_direction == b.reflected_direction &&
         direct_amplitude == b.direct_amplitude && reflected_amplitude == b.reflected_amplitude;
}

GeometryInputs geometryInputs(const FieldPlan& plan, int emitter_index, const scenario::EmitterState& state) {
  // Only the listed inputs enter the geometry. Members that are not named below enter the combine stage
  // (power_w, losses_db, antenna, receiver, bandwidth_hz, the filter of clutter), the channels (kind,
  // waveform), the snapshot (platform, scan, enabled, active_s) or messages (name, locations).
  const auto& [name, platform, kind, frequency_hz, bandwidth_hz, power_w, losses_db, polarization, antenna,
               scan, propagation, receiver, waveform, clutter, enabled, active_s, place, frequency_place] =
      plan.scenario->emitters[static_cast<std::size_t>(emitter_index)];
  GeometryInputs inputs;
  inputs.position = state.position;
  inputs.height_msl_m = state.height_msl_m;
  inputs.far_field_m = plan.far_field_m[static_cast<std::size_t>(emitter_index)];
  inputs.propagation = {frequency_hz, polarization, propagation, plan.scenario->ground,
                        plan.scenario->atmosphere};
  inputs.elevation_cut =
      elevationCut(plan.scenario->emitters[static_cast<std::size_t>(emitter_index)], state.beam);
  const GeometryNeeds& needs = plan.needs[static_cast<std::size_t>(emitter_index)];
  inputs.mechanisms = needs.mechanisms;
  if (needs.clutter_map) {
    inputs.clutter = clutterMapInputs(plan.scenario->emitters[static_cast<std::size_t>(emitter_index)]);
  }
  return inputs;
}

bool haveSameSettings(const GeometryInputs& computed, const GeometryInputs& needed) {
  const auto& [position, height_msl_m, far_field_m, propagation, elevation_cut, clutter, mechanisms] =
      computed;
  const auto& [frequency_hz, polarization, settings, ground, atmosphere] = propagation;
  return far_field_m == needed.far_field_m && frequency_hz == needed.propagation.frequency_hz &&
         polarization == needed.propagation.polarization && areSame(settings, needed.propagation.settings) &&
         same(ground, needed.propagation.ground) && same(atmosphere, needed.propagation.atmosphere) &&
         propagation::areSame(atmosphere.refractivity, needed.propagation.atmosphere.refractivity) &&
         areSame(elevation_cut, needed.elevation_cut) && (mechanisms || !needed.mechanisms) &&
         (!needed.clutter || (clutter && same(*clutter, *needed.clutter) &&
                              haveSameBeam(clutter->antenna, needed.clutter->antenna)));
}

bool areSame(const GeometryInputs& computed, const GeometryInputs& needed) {
  return same(computed.position, needed.position) && computed.height_msl_m == needed.height_msl_m &&
         haveSameSettings(computed, needed);
}

bool areSame(const ProductScale& a, const ProductScale& b) {
  const auto& [form, scale, offset, floor] = a;
  return form == b.form && scale == b.scale && offset == b.offset && floor == b.floor;
}

bool markChangedChannels(const CombinePass::Member* before, const CombinePass::Member* now,
                         std::vector<bool>& channels) {
  const auto markAll = [&channels](const CombinePass::Member& inputs) {
    for (const ChannelWeight& share : inputs.emitter.shares) channels[share.channel] = true;
    for (const RadarShare& share : inputs.radars) channels[share.channel] = true;
    for (const OccupancyShare& share : inputs.occupancies) channels[share.channel] = true;
    return !inputs.emitter.shares.empty() || !inputs.radars.empty() || !inputs.occupancies.empty();
  };
  if (before == nullptr || now == nullptr) {
    const CombinePass::Member* const either = before != nullptr ? before : now;
    return either != nullptr && markAll(*either);
  }
  const EmitterBeam& old_beam = before->emitter.beam;
  const EmitterBeam& beam = now->emitter.beam;
  if (!samePattern(before->antenna, now->antenna) || !samePattern(before->beam_antenna, now->beam_antenna) ||
      old_beam.eirp_over_4pi_w != beam.eirp_over_4pi_w) {
    return markAll(*now);
  }
  bool is_any = false;
  const auto mark = [&](int channel) { is_any = channels[channel] = true; };
  const bool has_beam = sameBeam(old_beam, beam);
  for (const ChannelWeight& share : now->emitter.shares) {
    if (!has_beam || !haveSame(before->emitter.shares, now->emitter.shares, share.channel))
      mark(share.channel);
  }
  // If a radar looks at targets, its share does not contain the beam's direction in the scan.
  for (const RadarShare& share : now->radars) {
    if (!haveSame(before->radars, now->radars, share.channel)) mark(share.channel);
  }
  for (const OccupancyShare& share : now->occupancies) {
    if (!haveSame(before->occupancies, now->occupancies, share.channel)) mark(share.channel);
  }
  return is_any;
}

}  // namespace emscape::emfield
