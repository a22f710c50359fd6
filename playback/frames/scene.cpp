#include "emscape/playback/frames/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/quantity_text.h"
#include "emfield/channels/categories.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/parallel.h"
#include "volume/labels.h"

namespace emscape::playback {
namespace {

constexpr int kMaxPosts = 1500;

int postsAlong(double size_m, double spacing_m) {
  return std::clamp(static_cast<int>(std::ceil(size_m / spacing_m)) + 1, 2, kMaxPosts);
}

/// The ground (frame z, m) at a position of the frame; NaN over a hole.
double groundZ_m(const scenario::Terrain& terrain, const GeoFrame& frame, double x_m, double y_m) {
  // In a tangent frame the position on the earth also depends on z: repeated with the computed z.
  double z_m = 0;
  const int rounds = frame.origin().kind == FrameKind::enu ? 2 : 1;
  for (int round = 0; round < rounds; ++round) {
    GeodeticPosition position = frame.toGeodetic({x_m, y_m, z_m});
    const double height_msl_m = terrain.heightMsl_m(position.latitude_deg, position.longitude_deg);
    if (std::isnan(height_msl_m) || frame.origin().kind == FrameKind::altitude) return height_msl_m;
    position.height_ellipsoid_m =
        height_msl_m + geoidUndulation_m(position.latitude_deg, position.longitude_deg);
    z_m = frame.toLocal(position).z;
  }
  return z_m;
}

/// Height of a mast above the ground if that is given, else above mean sea level.
std::string heightText(const scenario::Platform& platform, double height_msl_m) {
  const std::optional<double>& above_ground_m = platform.track.front().position.height_agl_m;
  return above_ground_m && !platform.moves() ? fmt::format("{:.0f} m above ground", *above_ground_m)
                                             : fmt::format("{:.0f} m above sea", height_msl_m);
}

}  // namespace

render::MarkerKind markerKindOf(scenario::EmitterKind kind) {
  switch (kind) {
    case scenario::EmitterKind::radar:
      return render::MarkerKind::radar;
    case scenario::EmitterKind::jammer:
      return render::MarkerKind::jammer;
    case scenario::EmitterKind::transmitter:
      break;
  }
  return render::MarkerKind::transmitter;
}

render::Affiliation affiliationOf(const std::optional<scenario::Side>& side) {
  if (!side) return render::Affiliation::none;
  switch (*side) {
    case scenario::Side::friendly:
      return render::Affiliation::friendly;
    case scenario::Side::hostile:
      return render::Affiliation::hostile;
    case scenario::Side::neutral:
      return render::Affiliation::neutral;
    case scenario::Side::unknown:
      break;
  }
  return render::Affiliation::unknown;
}

std::shared_ptr<const render::HeightField> heightFieldOf(const scenario::Terrain& terrain,
                                                         const volume::Grid& grid) {
  const Vec3d lower_m = grid.lower_m();
  const Vec3d size_m = grid.upper_m() - lower_m;
  auto field = std::make_shared<render::HeightField>();
  field->columns = postsAlong(size_m.x, terrain.postSpacing_m());
  field->rows = postsAlong(size_m.y, terrain.postSpacing_m());
  field->first_x_m = lower_m.x;
  field->first_y_m = lower_m.y;
  field->spacing_x_m = size_m.x / (field->columns - 1);
  field->spacing_y_m = size_m.y / (field->rows - 1);
  field->heights_m.resize(static_cast<std::size_t>(field->columns) * field->rows);
  const GeoFrame frame(grid.frame);
  parallelFor(field->rows, 8, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int i = 0; i < field->columns; ++i) {
        field->heights_m[static_cast<std::size_t>(j) * field->columns + i] =
            static_cast<float>(groundZ_m(terrain, frame, field->first_x_m + i * field->spacing_x_m,
                                         field->first_y_m + j * field->spacing_y_m));
      }
    }
  });
  return field;
}

std::vector<render::Marker> markersOf(const scenario::Snapshot& snapshot, const scenario::Terrain* terrain,
                                      const volume::Grid& grid) {
  const GeoFrame frame(grid.frame);
  const std::vector<scenario::Platform>& platforms = snapshot.scenario->platforms;
  std::vector<render::Marker> markers;
  std::vector<bool> has_emitter(platforms.size());
  const auto add = [&](std::size_t p, const GeodeticPosition& position) -> render::Marker& {
    const scenario::Platform& platform = platforms[p];
    render::Marker& marker = markers.emplace_back();
    marker.position_m = frame.toLocal(position);
    marker.label = platform.name;
    marker.side = affiliationOf(platform.side);
    marker.sidc = platform.sidc;
    marker.moves = platform.moves();
    if (terrain) {
      const double ground_m = groundZ_m(*terrain, frame, marker.position_m.x, marker.position_m.y);
      if (!std::isnan(ground_m)) marker.ground_m = ground_m;
    }
    return marker;
  };
  for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
    const scenario::Emitter& emitter = snapshot.scenario->emitters[e];
    const scenario::EmitterState& state = snapshot.emitters[e];
    const auto platform = static_cast<std::size_t>(emitter.platform);
    has_emitter[platform] = true;
    render::Marker& marker = add(platform, state.position);
    marker.label = emitter.name;
    marker.kind = markerKindOf(emitter.kind);
    marker.detail =
        fmt::format("{} {}, {}", toString(emitter.kind), quantityText(emitter.frequency_hz, "Hz", 4),
                    heightText(platforms[platform], state.height_msl_m));
    marker.active = state.active;
    if (emitter.antenna->view().kind != scenario::PatternKind::isotropic) marker.beam = state.beam.forward;
  }
  for (std::size_t p = 0; p < platforms.size(); ++p) {
    if (has_emitter[p] || !platforms[p].side) continue;
    const scenario::PlatformState& state = snapshot.platforms[p];
    add(p, state.position).detail = heightText(platforms[p], state.height_msl_m);
  }
  return markers;
}

std::vector<render::Category> categoriesOf(const volume::VolumeInfo& info, const volume::ValueRange& range,
                                           const scenario::Scenario* scenario) {
  const std::string name = info.quantity.substr(0, info.quantity.find(':'));
  const std::vector<std::string> labels = volume::labelsOf(info);
  const auto hash = info.extra.find("scenario_hash");
  if (scenario != nullptr && hash != info.extra.end() && hash->second != scenario->hash) scenario = nullptr;
  std::vector<render::Category> categories;
  for (const scenario::QuantityInfo& quantity : scenario::quantityTable()) {
    if (scenario == nullptr || name != quantity.name) continue;
    const std::vector<std::string> names = emfield::categoryNames(*scenario, quantity.quantity);
    if (!labels.empty() && labels != names) continue;
    for (const int index : emfield::categoriesOf(*scenario, quantity.quantity))
      categories.push_back({index, names[static_cast<std::size_t>(index)]});
    return categories;
  }
  for (std::size_t index = 0; index < labels.size(); ++index) {
    const auto value = static_cast<float>(index);
    if (value >= range.min && value <= range.max)
      categories.push_back({static_cast<int>(index), labels[index]});
  }
  return categories;
}

}  // namespace emscape::playback
