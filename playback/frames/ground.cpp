#include "playback/frames/ground.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/parallel.h"
#include "scenario/map/map_image.h"
#include "scenario/terrain/sea.h"

namespace emscape::playback {
namespace {

using render::GroundKind;
using render::HeightField;

constexpr int kMaxPosts = 1500;
/// Posts along a side of the smooth earth: for its curvature, and for the shape of coasts.
constexpr int kSmoothPosts = 65, kCoastPosts = 900;

int postsAlong(double size_m, double spacing_m) {
  return std::clamp(static_cast<int>(std::ceil(size_m / spacing_m)) + 1, 2, kMaxPosts);
}

Vec3d postPosition(const HeightField& field, int i, int j) {
  return {field.first_x_m + i * field.spacing_x_m, field.first_y_m + j * field.spacing_y_m, 0};
}

/// Heights above sea level of all posts; fills the field's heights.
std::vector<float> fillHeights(HeightField& field, const LoadedScenario& scene, const GeoFrame& frame) {
  const std::size_t posts = static_cast<std::size_t>(field.columns) * field.rows;
  std::vector<float> msl_m(posts);
  field.heights_m.resize(posts);
  parallelFor(field.rows, 8, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int i = 0; i < field.columns; ++i) {
        const Vec3d at = postPosition(field, i, j);
        const GroundHeight height = groundHeight(scene, frame, at.x, at.y);
        const std::size_t post = static_cast<std::size_t>(j) * field.columns + i;
        field.heights_m[post] = static_cast<float>(height.z_m);
        msl_m[post] = static_cast<float>(height.msl_m);
      }
    }
  });
  return msl_m;
}

/// Water by the coasts, for each post.
std::vector<std::uint8_t> waterByCoast(const HeightField& field, const scenario::Coast& coast,
                                       const GeoFrame& frame) {
  return scenario::waterOnGrid(
      coast, field.columns, field.rows,
      [&](const std::vector<GeodeticPosition>& shore) {
        std::vector<scenario::GridPlace> places;
        places.reserve(shore.size());
        for (const GeodeticPosition& position : shore) {
          const Vec3d at = frame.toLocal(position);
          places.push_back(
              {(at.x - field.first_x_m) / field.spacing_x_m, (at.y - field.first_y_m) / field.spacing_y_m});
        }
        return places;
      },
      [&](int column, int row) { return frame.toGeodetic(postPosition(field, column, row)); });
}

std::vector<GroundKind> kindsOf(const std::vector<std::uint8_t>& water) {
  std::vector<GroundKind> kinds(water.size(), GroundKind::land);
  for (std::size_t post = 0; post < water.size(); ++post)
    if (water[post] != 0) kinds[post] = GroundKind::water;
  return kinds;
}

/// Water by the coasts where the terrain is low.
std::vector<std::uint8_t> lowWater(std::vector<std::uint8_t> by_coast, const std::vector<float>& msl_m) {
  constexpr float kMaxShore_m = 2;
  for (std::size_t post = 0; post < by_coast.size(); ++post) {
    if (!(msl_m[post] < kMaxShore_m)) by_coast[post] = 0;
  }
  return by_coast;
}

}  // namespace

GroundHeight groundHeight(const LoadedScenario& scene, const GeoFrame& frame, double x_m, double y_m) {
  // In a tangent frame the position on the earth also depends on z: repeated with the computed z.
  GroundHeight height;
  const int rounds = frame.origin().kind == FrameKind::enu ? 2 : 1;
  for (int round = 0; round < rounds; ++round) {
    GeodeticPosition position = frame.toGeodetic({x_m, y_m, height.z_m});
    height.msl_m = scene.terrain ? scene.terrain->heightMsl_m(position.latitude_deg, position.longitude_deg)
                                 : scene.scenario->ground.surface_msl_m.value_or(0);
    if (std::isnan(height.msl_m) || frame.origin().kind == FrameKind::altitude) {
      height.z_m = height.msl_m;
      return height;
    }
    position.height_ellipsoid_m =
        height.msl_m + geoidUndulation_m(position.latitude_deg, position.longitude_deg);
    height.z_m = frame.toLocal(position).z;
  }
  return height;
}

scenario::GeoBox boxOf(const volume::Grid& grid) {
  const GeoFrame frame(grid.frame);
  const Vec3d lower = grid.lower_m(), upper = grid.upper_m();
  const double middle_deg = grid.frame.longitude_deg;
  scenario::GeoBox box{90, -90, middle_deg, middle_deg};
  constexpr int kParts = 16;
  for (int i = 0; i <= kParts; ++i) {
    for (int j = 0; j <= kParts; ++j) {
      const GeodeticPosition at = frame.toGeodetic(
          {lower.x + (upper.x - lower.x) * i / kParts, lower.y + (upper.y - lower.y) * j / kParts, 0});
      const double longitude_deg = middle_deg + wrapLongitude_deg(at.longitude_deg - middle_deg);
      box.south_deg = std::min(box.south_deg, at.latitude_deg);
      box.north_deg = std::max(box.north_deg, at.latitude_deg);
      box.west_deg = std::min(box.west_deg, longitude_deg);
      box.east_deg = std::max(box.east_deg, longitude_deg);
    }
  }
  return box;
}

Ground groundOf(const LoadedScenario& scene, const volume::Grid& grid, const scenario::Coast* coast,
                bool fine) {
  const Vec3d lower_m = grid.lower_m();
  const Vec3d size_m = grid.upper_m() - lower_m;
  const double longest_m = std::max(size_m.x, size_m.y);
  double spacing_m = scene.terrain ? scene.terrain->postSpacing_m()
                                   : longest_m / ((coast != nullptr ? kCoastPosts : kSmoothPosts) - 1);
  if (fine) spacing_m = std::min(spacing_m, longest_m / (kMaxPosts - 1));
  Ground ground{std::make_shared<HeightField>()};
  HeightField* const field = ground.field.get();
  field->columns = postsAlong(size_m.x, spacing_m);
  field->rows = postsAlong(size_m.y, spacing_m);
  field->first_x_m = lower_m.x;
  field->first_y_m = lower_m.y;
  field->spacing_x_m = size_m.x / (field->columns - 1);
  field->spacing_y_m = size_m.y / (field->rows - 1);
  const GeoFrame frame(grid.frame);
  const std::vector<float> msl_m = fillHeights(*field, scene, frame);
  std::vector<std::uint8_t> by_coast;
  if (coast != nullptr) by_coast = waterByCoast(*field, *coast, frame);
  if (scene.terrain) {
    std::vector<std::uint8_t> sea = scenario::seaByHeights(field->columns, field->rows, msl_m, by_coast);
    ground.is_sea_by_heights = std::find(sea.begin(), sea.end(), 1) != sea.end();
    if (!ground.is_sea_by_heights && !by_coast.empty()) sea = lowWater(std::move(by_coast), msl_m);
    field->kinds = kindsOf(sea);
  } else if (coast != nullptr) {
    field->kinds = kindsOf(by_coast);
  } else {
    const propagation::GroundKind kind = scene.scenario->ground.kind;
    const bool is_water =
        kind == propagation::GroundKind::sea || kind == propagation::GroundKind::fresh_water;
    field->kinds.assign(msl_m.size(), is_water ? GroundKind::water : GroundKind::land);
  }
  return ground;
}

bool drawsSmoothEarth(const LoadedScenario& scene, const volume::Grid& grid) {
  if (scene.terrain || !scene.scenario || !grid.georeferenced) return false;
  constexpr double kMaxBelow = 0.25;  // of the volume's height
  const Vec3d lower = grid.lower_m(), upper = grid.upper_m(), middle = (lower + upper) * 0.5;
  const double z_m = groundHeight(scene, GeoFrame(grid.frame), middle.x, middle.y).z_m;
  return z_m > lower.z - kMaxBelow * (upper.z - lower.z) && z_m < upper.z;
}

std::vector<render::Category> groundClassesOf(const scenario::LandCover& cover,
                                              const std::vector<GeodeticPosition>& positions) {
  struct Found {
    const scenario::CoverClass* of;  // classes of one name are one
    long long count;
  };
  std::vector<long long> counts(cover.classes().size());
  for (const GeodeticPosition& at : positions) {
    const int found = cover.classAt(at.latitude_deg, at.longitude_deg);
    if (found >= 0) ++counts[static_cast<std::size_t>(found)];
  }
  std::vector<Found> all;
  for (std::size_t c = 0; c < counts.size(); ++c) {
    if (counts[c] == 0) continue;
    const scenario::CoverClass& of = cover.classes()[c];
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const Found& each) { return each.of->name == of.name; });
    if (known == all.end())
      all.push_back({&of, counts[c]});
    else
      known->count += counts[c];
  }
  std::stable_sort(all.begin(), all.end(), [](const Found& a, const Found& b) { return a.count > b.count; });
  std::vector<render::Category> classes;
  for (const Found& found : all) {
    const auto part = [&](int shift) { return static_cast<float>(found.of->color >> shift & 255U) / 255; };
    classes.push_back({0, found.of->name, render::Rgb{part(0), part(8), part(16)}});
  }
  return classes;
}

std::vector<render::Category> drape(render::HeightField& ground, const std::string& name,
                                    const scenario::Terrain* terrain, const volume::Grid& grid) {
  const GeoFrame frame(grid.frame);
  std::vector<GeodeticPosition> positions;
  positions.reserve(ground.heights_m.size());
  for (int j = 0; j < ground.rows; ++j) {
    for (int i = 0; i < ground.columns; ++i) {
      const Vec3d at = postPosition(ground, i, j);
      const float z = ground.heights_m[positions.size()];
      positions.push_back(frame.toGeodetic({at.x, at.y, std::isnan(z) ? 0.0 : double{z}}));
    }
  }
  ground.colors = scenario::drapeColors(name, terrain, positions);
  if (name != scenario::kLandCoverDrape) return {};
  return groundClassesOf(*terrain->landCover(), positions);
}

}  // namespace emscape::playback
