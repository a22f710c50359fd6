#include "playback/editing/probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emfield/link/path_report.h"
#include "emscape/base/error.h"
#include "emscape/scenario/model/snapshot.h"
#include "volume/difference.h"
#include "volume/labels.h"

namespace emscape::playback {
namespace {

using volume::DenseVolume;
using volume::Grid;

/// Position in voxels: (0, 0, 0) is the centre of the first one.
Vec3d inVoxels(const Grid& grid, const Vec3d& position_m) {
  const Vec3d offset = position_m - grid.first_center_m;
  return {offset.x / grid.spacing_m.x, offset.y / grid.spacing_m.y, offset.z / grid.spacing_m.z};
}

/// A difference may be below its floor, which is 0: none.
bool holdsField(const DenseVolume& volume, int i, int j, int k) {
  const float value = volume.values[static_cast<std::size_t>(volume.grid.index(i, j, k))];
  return !volume.isMasked(i, j, k) && std::isfinite(value) &&
         (value > volume.info.floor || volume::isDifference(volume.info));
}

/// Trilinear; none unless all eight voxels around have a field.
std::optional<float> interpolated(const DenseVolume& volume, const Vec3d& at) {
  const Dims& dims = volume.grid.dims;
  const auto lower = [](double position, int count) {
    return std::clamp(static_cast<int>(std::floor(position)), 0, std::max(count - 2, 0));
  };
  const int i = lower(at.x, dims.x), j = lower(at.y, dims.y), k = lower(at.z, dims.z);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int ci = std::min(i + (corner & 1), dims.x - 1), cj = std::min(j + (corner >> 1 & 1), dims.y - 1),
              ck = std::min(k + (corner >> 2 & 1), dims.z - 1);
    if (!holdsField(volume, ci, cj, ck)) return std::nullopt;
    const auto weight = [](double position, int low, bool is_upper) {
      const double part = std::clamp(position - low, 0.0, 1.0);
      return is_upper ? part : 1 - part;
    };
    sum += weight(at.x, i, (corner & 1) != 0) * weight(at.y, j, (corner & 2) != 0) *
           weight(at.z, k, (corner & 4) != 0) *
           double{volume.values[static_cast<std::size_t>(volume.grid.index(ci, cj, ck))]};
  }
  return static_cast<float>(sum);
}

std::string textOf(const VolumeSample& sample, const DenseVolume& volume) {
  const volume::VolumeInfo& info = volume.info;
  const std::string unit = info.unit.empty() ? "" : " " + info.unit;
  switch (sample.kind) {
    case VolumeSample::Kind::outside:
      return "outside the volume's box";
    case VolumeSample::Kind::masked:
      return volume.grid.georeferenced ? "masked: below the ground, or over missing terrain" : "masked";
    case VolumeSample::Kind::at_floor:
      if (info.categorical) return "none";
      if (!unit.empty()) return fmt::format("no field above the floor of {:g}{}", info.floor, unit);
      return fmt::format("{}{:g}", info.floor == 0 ? "" : "at most ", info.floor);  // a probability, a number
    case VolumeSample::Kind::value:
      break;
  }
  if (volume::isDifference(info) && sample.value == 0) return "no difference";
  if (!info.categorical) return fmt::format("{:.4g}{}", sample.value, unit);
  const auto index = static_cast<std::size_t>(std::lround(sample.value));
  const std::vector<std::string> labels = volume::labelsOf(info);
  return index < labels.size() ? labels[index] : std::to_string(index);
}

std::vector<EmitterProbe> probeEmitters(const emfield::PathEnd& point, double time_s,
                                        const std::shared_ptr<const scenario::Scenario>& scenario,
                                        const scenario::Terrain* terrain) {
  std::vector<EmitterProbe> emitters;
  for (const scenario::Emitter& emitter : scenario->emitters) emitters.push_back({emitter.name, {}, ""});
  const auto refuse = [](EmitterProbe& emitter, const Error& error) { emitter.refusal = error.message(); };
  scenario::Snapshot snapshot;
  try {
    snapshot = scenario::instantAt(scenario, terrain, time_s);
  } catch (const Error& error) {
    for (EmitterProbe& emitter : emitters) refuse(emitter, error);
    return emitters;
  }
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    try {
      emitters[e].budget = emfield::pathBudget(snapshot, static_cast<int>(e), point,
                                               scenario->emitters[e].propagation.model, terrain);
      emfield::tellSteepGround(*emitters[e].budget);
    } catch (const Error& error) {
      refuse(emitters[e], error);
    }
  }
  return emitters;
}

}  // namespace

VolumeSample sampleVolume(const DenseVolume& volume, const Vec3d& position_m) {
  using Kind = VolumeSample::Kind;
  const Dims& dims = volume.grid.dims;
  const Vec3d at = inVoxels(volume.grid, position_m);
  constexpr double kRounding = 1e-6;  // voxels; a ray's end is in the box
  const auto isInside = [](double position, int count) {
    return position >= -0.5 - kRounding && position <= count - 0.5 + kRounding;
  };
  if (!isInside(at.x, dims.x) || !isInside(at.y, dims.y) || !isInside(at.z, dims.z)) return {};
  const auto nearest = [](double position, int count) {
    return std::clamp(static_cast<int>(std::lround(position)), 0, count - 1);
  };
  VolumeSample sample;
  sample.voxel = {nearest(at.x, dims.x), nearest(at.y, dims.y), nearest(at.z, dims.z)};
  const auto [i, j, k] = sample.voxel;
  sample.value = volume.values[static_cast<std::size_t>(volume.grid.index(i, j, k))];
  if (volume.isMasked(i, j, k) || std::isnan(sample.value)) {
    sample.kind = Kind::masked;
  } else if (!holdsField(volume, i, j, k)) {
    sample.kind = Kind::at_floor;
  } else {
    sample.kind = Kind::value;
    if (!volume.info.categorical) sample.value = interpolated(volume, at).value_or(sample.value);
  }
  return sample;
}

ProbeReading probe(const Vec3d& position_m, const DenseVolume& volume,
                   const std::shared_ptr<const scenario::Scenario>& scenario,
                   const scenario::Terrain* terrain) {
  ProbeReading reading;
  reading.position_m = position_m;
  reading.sample = sampleVolume(volume, position_m);
  reading.text = textOf(reading.sample, volume);
  if (!volume.grid.georeferenced) return reading;
  const GeoFrame frame(volume.grid.frame);
  const GeodeticPosition position = frame.toGeodetic(position_m);
  const double height_msl_m = frame.heightMsl_m(position_m);
  reading.position = position;
  reading.height_msl_m = height_msl_m;
  if (terrain != nullptr) {
    const double ground_msl_m = terrain->heightMsl_m(position.latitude_deg, position.longitude_deg);
    if (!std::isnan(ground_msl_m)) reading.height_agl_m = height_msl_m - ground_msl_m;
  }
  if (scenario) {
    reading.emitters = probeEmitters({position, height_msl_m}, volume.info.time_s, scenario, terrain);
  }
  return reading;
}

}  // namespace emscape::playback
