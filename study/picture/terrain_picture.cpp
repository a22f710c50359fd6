#include "study/picture/terrain_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "emscape/base/units.h"
#include "emscape/study/maps/area.h"
#include "study/picture/map_picture.h"

namespace emscape::study {
namespace {

using scenario::GeoBox;
using scenario::TerrainFileInfo;

constexpr double kMetresPerDegree = 111132;
constexpr std::size_t kMaxNamedFiles = 14;  ///< with a colour each; more are coloured by kind

bool contains(const GeoBox& box, double latitude_deg, double longitude_deg) {
  const double middle_deg = 0.5 * (box.west_deg + box.east_deg);
  return latitude_deg >= box.south_deg && latitude_deg <= box.north_deg &&
         std::abs(wrapLongitude_deg(longitude_deg - middle_deg)) <= 0.5 * (box.east_deg - box.west_deg);
}

/// Name, spacing and datum; of many files the kind only.
std::string labelOf(const TerrainFileInfo& file, bool is_named) {
  const std::string datum = file.vertical_datum.substr(0, file.vertical_datum.find(':'));
  const std::string kind =
      fmt::format("{:.0f} m, {}{}", postSpacing_m(file), datum,
                  datum.find('(') != std::string::npos && datum.back() != ')' ? ")" : "");
  return (is_named ? std::filesystem::path(file.file).filename().string() : file.format) + ": " + kind;
}

/// The kind of all files that are needed, if they are of one.
std::string commonKindOf(const std::vector<TerrainFileInfo>& files) {
  std::string kind;
  for (const TerrainFileInfo& file : files) {
    if (!file.is_needed) continue;
    const std::string own = labelOf(file, false);
    if (!kind.empty() && own != kind) return "";
    kind = own;
  }
  return kind;
}

/// The heights; unknown where there is none.
Map heightsMap(const std::vector<float>& ground_msl_m) {
  Map map;
  map.name = "terrain";
  map.kind = MapKind::level;
  map.title = "height above mean sea level";
  map.unit = "m";
  map.values = ground_msl_m;
  for (const float height_m : ground_msl_m)
    map.answers.push_back(std::isnan(height_m) ? PixelAnswer::unknown : PixelAnswer::exact);
  return map;
}

/// Categories: the files or their kinds, then voids, if there are any; no value: ground without a file.
Map sourcesMap(const std::vector<TerrainFileInfo>& files, const scenario::Terrain& terrain,
               const MapGrid& grid) {
  Map map;
  map.name = "terrain";
  map.kind = MapKind::category;
  map.title = "source of the ground";
  std::vector<const TerrainFileInfo*> finest_first;
  for (const TerrainFileInfo& file : files) {
    if (file.is_needed) finest_first.push_back(&file);
  }
  std::stable_sort(finest_first.begin(), finest_first.end(),
                   [](const auto* a, const auto* b) { return postSpacing_m(*a) < postSpacing_m(*b); });
  std::vector<int> categories;
  std::map<std::string, int> of_label;
  for (const TerrainFileInfo* file : finest_first) {
    const std::string label = labelOf(*file, finest_first.size() <= kMaxNamedFiles);
    const auto [known, is_new] = of_label.emplace(label, static_cast<int>(map.labels.size()));
    if (is_new) {
      map.labels.push_back(label);
      map.colors.push_back(static_cast<int>(map.labels.size()));
    }
    categories.push_back(known->second);
  }
  const int void_category = static_cast<int>(map.labels.size());
  for (const emfield::Surface::Position& at : grid.positions) {
    int category = -1;
    for (std::size_t k = 0; k < finest_first.size() && category < 0; ++k) {
      if (contains(finest_first[k]->box, at.latitude_deg, at.longitude_deg)) category = categories[k];
    }
    const bool is_known =
        !std::isnan(at.latitude_deg) && !std::isnan(terrain.heightMsl_m(at.latitude_deg, at.longitude_deg));
    map.values.push_back(category < 0 ? NAN : static_cast<float>(is_known ? category : void_category));
  }
  if (std::find(map.values.begin(), map.values.end(), static_cast<float>(void_category)) !=
      map.values.end()) {
    map.labels.emplace_back("void in the files");
    map.colors.push_back(0);
  }
  return map;
}

/// Categories: the classes of the land cover, of those with the same name the first.
Map coverMap(const scenario::LandCover& cover, const MapGrid& grid) {
  Map map;
  map.name = "land_cover";
  map.kind = MapKind::category;
  map.title = "land cover";
  std::vector<int> categories;
  for (const scenario::CoverClass& of : cover.classes()) {
    const auto known = std::find(map.labels.begin(), map.labels.end(), of.name);
    categories.push_back(static_cast<int>(known - map.labels.begin()));
    if (known != map.labels.end()) continue;
    map.labels.push_back(of.name);
    map.label_colors.push_back(of.color);
  }
  for (const emfield::Surface::Position& at : grid.positions) {
    const int found = std::isnan(at.latitude_deg) ? -1 : cover.classAt(at.latitude_deg, at.longitude_deg);
    map.values.push_back(found < 0 ? NAN : static_cast<float>(categories[static_cast<std::size_t>(found)]));
  }
  return map;
}

}  // namespace

double postSpacing_m(const TerrainFileInfo& file) {
  const double middle_deg = 0.5 * (file.box.south_deg + file.box.north_deg);
  return kMetresPerDegree *
         std::max(file.post_spacing_lat_deg, file.post_spacing_lon_deg * std::cos(degToRad(middle_deg)));
}

render::Image8 drawTerrain(const std::vector<TerrainFileInfo>& files, const scenario::Terrain& terrain,
                           TerrainContent content, const GeoBox& box, const std::string& title, int width) {
  constexpr double kPixels = 600;  // of the longer side of the area
  constexpr double kMaxExtent_deg = 60;
  if (box.north_deg - box.south_deg > kMaxExtent_deg || box.east_deg - box.west_deg > 3 * kMaxExtent_deg)
    throw Error(ErrorCode::usage,
                fmt::format("a picture shows at most {} degrees of latitude and {} of longitude; the "
                            "files cover {:.4g} and {:.4g}: name fewer",
                            kMaxExtent_deg, 3 * kMaxExtent_deg, box.north_deg - box.south_deg,
                            box.east_deg - box.west_deg));
  MapArea area;
  area.box = box;
  const double nearest_deg = box.south_deg > 0   ? box.south_deg
                             : box.north_deg < 0 ? box.north_deg
                                                 : 0;  // to the equator
  const double extent_m =
      kMetresPerDegree * std::max(box.north_deg - box.south_deg,
                                  (box.east_deg - box.west_deg) * std::cos(degToRad(nearest_deg)));
  const MapGrid grid = makeMapGrid(area, std::max(std::ceil(extent_m / kPixels), 1.0), "local");
  MapPictureOptions options;
  options.width = width;
  options.title = title;
  options.subtitle =
      std::isnan(terrain.lowest_m())
          ? std::string("no height is known")
          : fmt::format("{:.0f} to {:.0f} m above mean sea level; {} void posts; {:.3g} % without a file",
                        terrain.lowest_m(), terrain.highest_m(), terrain.voidPosts(),
                        100 * terrain.uncoveredFraction());
  options.ground_msl_m = groundOf(grid, terrain);
  if (content == TerrainContent::land_cover && terrain.landCover() != nullptr)
    return drawMap(grid, coverMap(*terrain.landCover(), grid), options);
  // With several kinds of files the colours tell the source, else the height.
  const std::string kind = commonKindOf(files);
  if (kind.empty()) return drawMap(grid, sourcesMap(files, terrain, grid), options);
  options.subtitle = kind + "; " + options.subtitle;
  return drawMap(grid, heightsMap(options.ground_msl_m), options);
}

}  // namespace emscape::study
