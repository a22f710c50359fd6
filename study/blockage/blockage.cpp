#include "study/blockage/blockage.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/files/whole_file.h"
#include "emfield/columns/station.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/study/maps/area.h"
#include "study/picture/map_picture.h"

namespace emscape::study {
namespace {

constexpr double kPixelsOfRadius = 400;

/// Elevation of the beam's axis at the time.
double elevationOf(const scenario::EmitterState& state) {
  return radToDeg(std::asin(std::clamp(state.beam.forward.z, -1.0, 1.0)));
}

/// Fills one azimuth: the ground is read at half the spacing of its posts.
void fillAzimuth(const emfield::Station& station, const scenario::Terrain& terrain, int azimuth,
                 Blockage& blockage) {
  const double radius_rad = degToRad(blockage.beamwidth_deg) / 2;
  const double angle_rad = degToRad(blockage.azimuth_deg(azimuth));
  const double cosine = std::cos(degToRad(blockage.elevation_deg));
  const double step_m = blockage.request.step_m;
  const int parts = std::max(1, static_cast<int>(std::ceil(step_m / (terrain.postSpacing_m() / 2))));
  double most = 0;
  for (int n = 0; n < blockage.ranges; ++n) {
    double partial = 0, highest_m = -HUGE_VAL;
    for (int part = 0; part < parts; ++part) {
      const double slant_m = (n + (part + 0.5) / parts) * step_m;
      const double axis_m = blockage.axis_msl_m(slant_m);
      const double ground_m = blockage.effective_earth_radius_m *
                              std::asin(slant_m * cosine / (blockage.effective_earth_radius_m + axis_m));
      const FastDirect at = fastDirect(station.geodesy, std::sin(angle_rad), std::cos(angle_rad), ground_m);
      const double height_m = terrain.heightMsl_m(radToDeg(at.latitude_rad), radToDeg(at.longitude_rad));
      const double share = partOfBeamBelow(height_m - axis_m, slant_m * radius_rad);
      partial = std::isnan(share) ? share : std::isnan(partial) ? partial : std::max(partial, share);
      highest_m = std::isnan(height_m)    ? height_m
                  : std::isnan(highest_m) ? highest_m
                                          : std::max(highest_m, height_m);
    }
    most = std::isnan(most) || std::isnan(partial) ? NAN : std::max(most, partial);
    const std::size_t gate = static_cast<std::size_t>(azimuth) * blockage.ranges + n;
    blockage.edge_msl_m[gate] = static_cast<float>(highest_m);
    blockage.partial[gate] = static_cast<float>(partial);
    blockage.cumulative[gate] = static_cast<float>(most);
  }
}

/// Drops the gates behind the last one whose blockage is known in any direction.
void endWithKnownGround(Blockage& blockage) {
  const int before = blockage.ranges;
  int known = 0;
  for (int azimuth = 0; azimuth < blockage.request.azimuths; ++azimuth)
    for (int n = known; n < before; ++n)
      if (!std::isnan(blockage.cumulative[static_cast<std::size_t>(azimuth) * before + n])) known = n + 1;
  if (known == 0 || known == before) return;
  blockage.ranges = known;
  for (std::vector<float>* values : {&blockage.edge_msl_m, &blockage.partial, &blockage.cumulative}) {
    for (int azimuth = 0; azimuth < blockage.request.azimuths; ++azimuth)
      std::copy_n(values->begin() + static_cast<std::ptrdiff_t>(azimuth) * before, known,
                  values->begin() + static_cast<std::ptrdiff_t>(azimuth) * known);
    values->resize(static_cast<std::size_t>(blockage.request.azimuths) * known);
  }
}

}  // namespace

double partOfBeamBelow(double edge_m, double radius_m) {
  if (std::isnan(edge_m)) return edge_m;
  const double y = std::clamp(edge_m / radius_m, -1.0, 1.0);
  return (y * std::sqrt(1 - y * y) + std::asin(y) + kPi / 2) / kPi;
}

double Blockage::axis_msl_m(double slant_m) const {
  const double from = effective_earth_radius_m + station_msl_m, angle = degToRad(elevation_deg);
  return std::hypot(slant_m * std::cos(angle), from + slant_m * std::sin(angle)) - effective_earth_radius_m;
}

double Blockage::ground_m(double slant_m) const {
  const double from = effective_earth_radius_m + station_msl_m, angle = degToRad(elevation_deg);
  return effective_earth_radius_m * std::atan2(slant_m * std::cos(angle), from + slant_m * std::sin(angle));
}

int Blockage::gateAt(double ground_m) const {
  const double angle = ground_m / effective_earth_radius_m;
  const double cosine = std::cos(angle + degToRad(elevation_deg));
  if (!(cosine > 0)) return -1;
  const double slant_m = (effective_earth_radius_m + station_msl_m) * std::sin(angle) / cosine;
  const double gate = slant_m / request.step_m;
  return gate < ranges ? static_cast<int>(gate) : -1;
}

Blockage computeBlockage(const std::shared_ptr<const scenario::Scenario>& scenario,
                         const BlockageRequest& request) {
  const scenario::Emitter& emitter = scenario->emitters[static_cast<std::size_t>(request.emitter)];
  if (!scenario->terrain)
    throw Error(ErrorCode::bad_input, {scenario->file, 0, 0},
                "terrain blocks beams, but the scenario names no elevation files (terrain.files)");
  // The emitter's position needs the terrain below it: the region's.
  const scenario::TerrainPtr of_region = scenario::loadTerrain(*scenario);
  const scenario::Snapshot snapshot = scenario::instantAt(scenario, of_region.get(), request.time_s);
  const scenario::EmitterState& state = snapshot.emitters[static_cast<std::size_t>(request.emitter)];
  Blockage blockage;
  blockage.request = request;
  blockage.scenario = scenario->name;
  blockage.title = titleOf(*scenario);
  blockage.emitter = emitter.name;
  blockage.position = state.position;
  const emfield::Station station =
      emfield::makeStation(state.position, state.height_msl_m, scenario->atmosphere);
  blockage.station_msl_m = state.height_msl_m;
  blockage.effective_earth_radius_m = station.effective_earth_radius_m;
  blockage.elevation_deg = request.elevation_deg.value_or(elevationOf(state));
  blockage.beamwidth_deg =
      request.beamwidth_deg.value_or(emitter.antenna ? emitter.antenna->beamwidth_el_deg : 0);
  if (!(blockage.beamwidth_deg > 0 && blockage.beamwidth_deg <= 180))
    throw Error(ErrorCode::usage,
                fmt::format("the antenna of '{}' has no beam: give --beamwidth, its width in elevation (deg)",
                            emitter.name));
  const double range_m = request.range_m.value_or(BlockageRequest::kUsualRange_m);
  blockage.ranges = static_cast<int>(std::ceil(range_m / request.step_m - 1e-9));
  if (blockage.ranges > BlockageRequest::kMaxRanges)
    throw Error(ErrorCode::usage, fmt::format("{} gates of {:g} m are more than {}: make --step larger",
                                              blockage.ranges, request.step_m, BlockageRequest::kMaxRanges));
  const scenario::TerrainPtr terrain = loadTerrain(
      *scenario, circularArea({state.position.latitude_deg, state.position.longitude_deg, range_m}));
  if (std::isnan(terrain->lowest_m()))
    throw Error(ErrorCode::bad_input, {scenario->file, 0, 0},
                "no ground is known around the emitter; " + terrain->placeText());
  blockage.warnings = warningsOf(*scenario);
  for (const std::string& warning : terrain->warnings()) blockage.warnings.push_back(warning);
  const std::size_t gates = static_cast<std::size_t>(request.azimuths) * blockage.ranges;
  for (std::vector<float>* values : {&blockage.edge_msl_m, &blockage.partial, &blockage.cumulative})
    values->resize(gates);
  const WorkPart part("beam blockage", 0, 1);
  std::atomic<int> done{0};
  parallelFor(request.azimuths, 1, [&](int begin, int end) {
    for (int azimuth = begin; azimuth < end; ++azimuth) fillAzimuth(station, *terrain, azimuth, blockage);
    reportDone(static_cast<double>(done += end - begin) / request.azimuths);
  });
  if (!request.range_m) endWithKnownGround(blockage);
  return blockage;
}

BlockageMap mapOf(const Blockage& blockage) {
  const MapArea area =
      circularArea({blockage.position.latitude_deg, blockage.position.longitude_deg, blockage.range_m()});
  BlockageMap made{makeMapGrid(area, std::ceil(blockage.range_m() / kPixelsOfRadius), "local"), {}};
  const MapGrid& grid = made.grid;
  Map& map = made.map;
  map.name = "beam_blockage";
  map.kind = MapKind::fraction;
  map.title = "beam cut by terrain";
  map.subject = map.description =
      fmt::format("part of the beam of {:.3g} deg at {:.3g} deg elevation that terrain cuts up to there",
                  blockage.beamwidth_deg, blockage.elevation_deg);
  map.values.assign(grid.pixels(), NAN);
  map.answers.assign(grid.pixels(), PixelAnswer::none);
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    // The projection is equidistant from the emitter.
    const double x_m = grid.left_m + (static_cast<double>(p % grid.width) + 0.5) * grid.cell_m;
    const double y_m = grid.top_m - (static_cast<double>(p / grid.width) + 0.5) * grid.cell_m;
    const int gate = std::isnan(grid.positions[p].latitude_deg) ? -1 : blockage.gateAt(std::hypot(x_m, y_m));
    if (gate < 0) continue;
    const double turns = std::atan2(x_m, y_m) / (2 * kPi) * blockage.request.azimuths;
    const int azimuth =
        (static_cast<int>(std::lround(turns)) + blockage.request.azimuths) % blockage.request.azimuths;
    map.values[p] = blockage.cumulative[static_cast<std::size_t>(azimuth) * blockage.ranges + gate];
    map.answers[p] = std::isnan(map.values[p]) ? PixelAnswer::unknown : PixelAnswer::exact;
  }
  return made;
}

render::Image8 drawBlockage(const Blockage& blockage, int width) {
  const BlockageMap made = mapOf(blockage);
  MapPictureOptions options;
  options.width = width;
  options.title = fmt::format("{}: beam blockage of '{}'", blockage.title, blockage.emitter);
  options.subtitle = made.map.description;
  options.markers = {{blockage.position.latitude_deg, blockage.position.longitude_deg, blockage.emitter,
                      render::MarkerKind::radar, render::Affiliation::none, ""}};
  return drawMap(made.grid, made.map, options);
}

void writeBlockageCsv(const Blockage& blockage, const std::string& file, Replaces replaces) {
  const auto text = [](float value, int decimals) {
    return std::isnan(value) ? std::string() : fmt::format("{:.{}f}", value, decimals);
  };
  const auto write = [&](std::ostream& out) {
    out << "azimuth_deg,range_m,beam_msl_m,ground_msl_m,partial_blockage,cumulative_blockage\n";
    for (int azimuth = 0; azimuth < blockage.request.azimuths; ++azimuth) {
      for (int n = 0; n < blockage.ranges; ++n) {
        const std::size_t gate = static_cast<std::size_t>(azimuth) * blockage.ranges + n;
        out << fmt::format("{:g},{:g},{:.1f},{},{},{}\n", blockage.azimuth_deg(azimuth), blockage.gate_m(n),
                           blockage.axis_msl_m(blockage.gate_m(n)), text(blockage.edge_msl_m[gate], 1),
                           text(blockage.partial[gate], 4), text(blockage.cumulative[gate], 4));
      }
    }
  };
  writeWhole(file, write, replaces);
}

}  // namespace emscape::study
