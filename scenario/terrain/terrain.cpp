#include "emscape/scenario/terrain/terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include "base/geodesy/geoid_grid.h"
#include "base/geodesy/position_mistakes.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/log.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "scenario/terrain/file_notes.h"
#include "scenario/terrain/georeference.h"
#include "scenario/terrain/place.h"
#include "scenario/terrain/terrain_faults.h"
#include "scenario/terrain/view.h"

namespace emscape::scenario {
namespace {

/// Points per side of the box at which coverage is tested; its edges are included.
constexpr int kCoverageProbes = 257;

const GeoBox& checked(const GeoBox& box) {
  const bool sane = box.south_deg >= -90.0 && box.south_deg <= box.north_deg && box.north_deg <= 90.0 &&
                    std::abs(box.west_deg) <= 360.0 && box.west_deg <= box.east_deg &&
                    box.east_deg - box.west_deg <= 360.0;
  if (!sane) {
    throw Error(ErrorCode::bad_input,
                "terrain box: latitudes " + std::to_string(box.south_deg) + " to " +
                    std::to_string(box.north_deg) + ", longitudes " + std::to_string(box.west_deg) + " to " +
                    std::to_string(box.east_deg) +
                    " degrees; latitudes must rise within -90..90, longitudes by 0..360");
  }
  return box;
}

/// Heights above a datum become heights above mean sea level (EGM96).
/// @param warnings  receives that a grid is missing, where the scenario does not ask for it
void toMeanSeaLevel(TerrainSheet& sheet, FileNotes& warnings) {
  const HeightMeaning& meaning = sheet.file->head().meaning;
  const VerticalDatum datum = meaning.datum;
  if (datum == VerticalDatum::egm96 || datum == VerticalDatum::navd88) return;
  std::optional<GeoidGrid> egm2008;
  if (datum == VerticalDatum::egm2008) {
    try {
      egm2008 = egm2008Grid({sheet.lattice.y(0), sheet.lattice.y(sheet.rows - 1), sheet.lattice.x(0),
                             sheet.lattice.x(sheet.columns - 1)});
    } catch (const Error& error) {
      if (meaning.origin == DatumOrigin::key)
        throw Error(error.code(), sheet.file->head().location, error.message());
      warnings.add(
          sheet.file->head().name,
          "its heights are above EGM2008 and are taken as above EGM96, since the grid that converts them is "
          "missing: " +
              error.message());
      return;
    }
  }
  parallelFor(sheet.rows, 16, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      for (int column = 0; column < sheet.columns; ++column) {
        if (sheet.kind(column, row) != PostKind::known) continue;
        const double latitude_deg = sheet.lattice.y(row), longitude_deg = sheet.lattice.x(column);
        double datum_msl_m = -geoidUndulation_m(latitude_deg, longitude_deg);
        if (egm2008) datum_msl_m += egm2008->undulation_m(latitude_deg, longitude_deg);
        sheet.heights_m[sheet.index(column, row)] += static_cast<float>(datum_msl_m);
      }
    }
  });
}

/// True if a tile of one degree reaches a box.
bool touches(const TileCorner& corner, const GeoBox& box) {
  constexpr double kReach_deg = 0.01;  // of a post outside, and of half a post
  if (corner.latitude_deg > box.north_deg + kReach_deg ||
      corner.latitude_deg + 1 < box.south_deg - kReach_deg)
    return false;
  for (const double turn_deg : {-360.0, 0.0, 360.0, 720.0}) {
    if (corner.longitude_deg + turn_deg <= box.east_deg + kReach_deg &&
        corner.longitude_deg + 1 + turn_deg >= box.west_deg - kReach_deg)
      return true;
  }
  return false;
}

/// The files of a terrain and what they hold within a box.
struct FilesWithin {
  std::vector<RasterTile> tiles;
  std::vector<GeoBox> boxes;  ///< of all files
  FileNotes notes, warnings;
};

void addFile(const ElevationSource& source, const SourceLocation& location, const TerrainFileKeys& keys,
             const GeoBox& box, FilesWithin& all) {
  // A tile of one degree is placed by its name: those outside the box need not be opened.
  const bool is_tile = lowerEnding(source.ownName()) == ".hgt";
  const std::optional<TileCorner> corner = is_tile ? cornerInName(source.ownName()) : std::nullopt;
  if (corner && !touches(*corner, box)) {
    std::error_code failed;
    if (std::filesystem::is_regular_file(source.file, failed)) {
      all.boxes.push_back({1.0 * corner->latitude_deg, corner->latitude_deg + 1.0,
                           1.0 * corner->longitude_deg, corner->longitude_deg + 1.0});
      return;
    }
  }
  const auto file = std::make_shared<const TerrainFile>(source, location, keys);
  all.boxes.push_back(geographicBoxOf(*file));
  std::vector<RasterTile> tiles = tilesWithin(file, box);
  if (tiles.empty()) return;
  for (const std::string& note : file->head().notes) all.notes.add(file->head().name, note);
  const Assumption assumed = assumptionOf(*file);
  if (!assumed.text.empty()) all.warnings.add(file->head().name, assumed.text, assumed.effect);
  for (const std::string& warning : file->head().meaning.warnings)
    all.warnings.add(file->head().name, warning);
  for (RasterTile& tile : tiles) all.tiles.push_back(std::move(tile));
}

FilesWithin filesWithin(const TerrainSpec& spec, const GeoBox& box) {
  FilesWithin all;
  for (std::size_t k = 0; k < spec.files.size(); ++k) {
    const SourceLocation location = k < spec.locations.size() ? spec.locations[k] : SourceLocation{};
    for (const ElevationSource& source : sourcesOf(spec, k))
      addFile(source, location, keysOf(spec, k), box, all);
  }
  return all;
}

std::string textOf(const GeoBox& box) {
  return fmt::format("latitudes {:.5g} to {:.5g}, longitudes {:.5g} to {:.5g} deg", box.south_deg,
                     box.north_deg, box.west_deg, box.east_deg);
}

bool contains(const GeoBox& box, double latitude_deg, double longitude_deg) {
  const double middle_deg = 0.5 * (box.west_deg + box.east_deg);
  return latitude_deg >= box.south_deg && latitude_deg <= box.north_deg &&
         std::abs(wrapLongitude_deg(longitude_deg - middle_deg)) <= 0.5 * (box.east_deg - box.west_deg);
}

/// Where the files are, where ground is needed, and which mistake keeps them apart.
std::string placeTextOf(const std::vector<GeoBox>& boxes, const GeoBox& needed,
                        const std::vector<NeededPlace>& places) {
  if (boxes.empty()) return "there are no elevation files";
  GeoBox all = boxes.front();
  for (const GeoBox& box : boxes) {
    all = {std::min(all.south_deg, box.south_deg), std::max(all.north_deg, box.north_deg),
           std::min(all.west_deg, box.west_deg), std::max(all.east_deg, box.east_deg)};
  }
  const std::string text =
      fmt::format("the elevation files cover {}; ground is needed at {}", textOf(all), textOf(needed));
  const auto isIn = [&](double latitude_deg, double longitude_deg) {
    return std::any_of(boxes.begin(), boxes.end(),
                       [&](const GeoBox& box) { return contains(box, latitude_deg, longitude_deg); });
  };
  std::vector<NeededPlace> all_places = places;
  all_places.push_back({"", 0.5 * (needed.south_deg + needed.north_deg),
                        wrapLongitude_deg(0.5 * (needed.west_deg + needed.east_deg))});
  for (const NeededPlace& place : all_places) {
    if (isIn(place.latitude_deg, place.longitude_deg)) continue;
    const auto mistake = mistakeIn(place.latitude_deg, place.longitude_deg, isIn);
    if (!mistake) continue;
    return text + fmt::format("; they would cover latitude {:.5g}, longitude {:.5g} deg: perhaps {}{}",
                              mistake->latitude_deg, mistake->longitude_deg, mistake->text,
                              place.name.empty() ? "" : " in " + place.name);
  }
  return text;
}

/// A program reads the files of a scenario more than once, for several boxes.
void logOnce(const std::vector<std::string>& notes) {
  static std::mutex mutex;
  static std::set<std::string> told;
  const std::lock_guard lock(mutex);
  for (const std::string& note : notes)
    if (told.insert(note).second) logInfo(note);
}

/// Sheets of longitudes and latitudes, the finest first, with closed seams.
std::vector<TerrainSheet> sheetsWithin(FilesWithin& files, const GeoBox& box) {
  logOnce(files.notes.texts());
  std::vector<TerrainSheet> sheets;
  for (TerrainSheet& sheet : readSheets(files.tiles)) {
    for (const TerrainSheet::Fill& fill : sheet.fills)
      files.warnings.add(fill.file->head().name, fillText(fill.value));
    for (const TerrainSheet::Remark& remark : sheet.remarks)
      files.warnings.add(remark.file->head().name, remark.text);
    for (const TerrainFilePtr& file : sheet.partly_searched)
      files.warnings.add(file->head().name, kPartlySearched);
    if (sheet.file->georeference().is_geographic) {
      sheets.push_back(std::move(sheet));
    } else {
      for (TerrainSheet& brought : toGeographicSheets(std::move(sheet), box))
        sheets.push_back(std::move(brought));
    }
  }
  std::stable_sort(sheets.begin(), sheets.end(),
                   [](const TerrainSheet& a, const TerrainSheet& b) { return a.spacing_m < b.spacing_m; });
  for (TerrainSheet& sheet : sheets) toMeanSeaLevel(sheet, files.warnings);
  closeSeams(sheets);
  return sheets;
}

class TerrainMosaic : public Terrain {
 public:
  TerrainMosaic(const TerrainSpec& spec, const GeoBox& box, const std::vector<NeededPlace>& places)
      : box_(checked(box)) {
    FilesWithin files = filesWithin(spec, box);
    std::vector<TerrainSheet> sheets = sheetsWithin(files, box);
    for (const TerrainSheet& sheet : sheets) rasters_.push_back(sheet.raster());
    survey(sheets);
    place_text_ = placeTextOf(files.boxes, box, places);
    warnings_ = files.warnings.texts();
    // The heights do not move in memory: the rasters' pointers stay valid.
    for (TerrainSheet& sheet : sheets) heights_m_.push_back(std::move(sheet.heights_m));
    if (spec.missing == MissingTerrain::sea) addSea();
    if (spec.land_cover.isGiven()) {
      land_cover_ = std::make_unique<const LandCover>(spec.land_cover, box);
      for (const std::string& warning : land_cover_->warnings()) warnings_.push_back(warning);
    }
    if (!spec.surface_files.empty()) addSurface(spec, box);
  }

  double heightMsl_m(double latitude_deg, double longitude_deg) const override {
    return view().heightAt(degToRad(latitude_deg), degToRad(longitude_deg));
  }
  TerrainView view() const override {
    TerrainView view{rasters_.data(), static_cast<int>(rasters_.size())};
    if (land_cover_) view.cover = land_cover_->view();
    if (surface_) {
      const TerrainView surface = surface_->view();
      view.surfaces = surface.rasters;
      view.surface_count = surface.count;
    }
    return view;
  }
  double postSpacing_m() const override { return post_spacing_m_; }
  long long voidPosts() const override { return void_posts_; }
  double uncoveredFraction() const override { return uncovered_fraction_; }
  GeoBox box() const override { return box_; }
  GeoBox coverage() const override { return coverage_; }
  double lowest_m() const override { return lowest_m_; }
  double highest_m() const override { return highest_m_; }
  std::vector<std::string> warnings() const override { return warnings_; }
  std::string placeText() const override { return place_text_; }
  const LandCover* landCover() const override { return land_cover_.get(); }

 private:
  void addSea();
  void addSurface(const TerrainSpec& spec, const GeoBox& box);
  void requireSurface(const TerrainSpec& spec, const GeoBox& box);
  void survey(const std::vector<TerrainSheet>& sheets);
  void surveyPosts(const TerrainSheet& sheet);
  void surveyVoid(const TerrainSheet& sheet, int column, int row);
  bool covered(const std::vector<TerrainSheet>& sheets, double latitude_deg, double longitude_deg) const;

  GeoBox box_;
  std::vector<std::vector<float>> heights_m_;
  std::vector<TerrainRaster> rasters_;
  double post_spacing_m_ = std::numeric_limits<double>::quiet_NaN();
  long long void_posts_ = 0;
  double uncovered_fraction_ = 1.0;
  double missing_fraction_ = 1.0;  ///< of the box: not covered, or among void posts
  double highest_beside_void_m_ = std::numeric_limits<double>::quiet_NaN();
  GeoBox coverage_;
  double lowest_m_ = std::numeric_limits<double>::quiet_NaN();
  double highest_m_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> warnings_;
  std::string place_text_;
  std::unique_ptr<const LandCover> land_cover_;
  TerrainPtr surface_;
};

/// Refuses a surface model that is far below or above the ground on average; two models of one ground differ
/// by some metres.
void TerrainMosaic::requireSurface(const TerrainSpec& spec, const GeoBox& box) {
  constexpr int kSide = 40;
  constexpr double kMaxBelow_m = 5, kTold_m = 1, kMaxAbove_m = 100;  // the highest clutter of classes
  double sum_m = 0;
  int count = 0;
  for (int n = 0; n < kSide * kSide; ++n) {
    const double latitude_deg = box.south_deg + (n / kSide + 0.5) / kSide * (box.north_deg - box.south_deg);
    const double longitude_deg = box.west_deg + (n % kSide + 0.5) / kSide * (box.east_deg - box.west_deg);
    const double difference_m =
        surface_->heightMsl_m(latitude_deg, longitude_deg) - heightMsl_m(latitude_deg, longitude_deg);
    if (std::isnan(difference_m)) continue;
    sum_m += difference_m;
    ++count;
  }
  if (count == 0) return;
  const double mean_m = sum_m / count;
  const std::string found =
      fmt::format("the surface model ('surface_files') is on average {:.1f} m {} the ground ('files')",
                  std::abs(mean_m), mean_m < 0 ? "below" : "above");
  if (mean_m < -kMaxBelow_m || mean_m > kMaxAbove_m) {
    throw Error(
        ErrorCode::bad_input,
        spec.surface_locations.empty() ? SourceLocation{} : spec.surface_locations.front(),
        found +
            ": the two are exchanged, or it has heights above the ground, or its unit ('height_unit') or "
            "datum ('vertical_datum') is another one");
  }
  if (mean_m < -kTold_m)
    warnings_.push_back("terrain: " + found + ": trees and buildings come out too low by that");
}

void TerrainMosaic::addSurface(const TerrainSpec& spec, const GeoBox& box) {
  surface_ = Terrain::load(surfaceOf(spec), box);
  for (const std::string& warning : surface_->warnings()) {
    if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end())
      warnings_.push_back(warning);
  }
  requireSurface(spec, box);
  if (surface_->uncoveredFraction() > 0)
    warnings_.push_back(fmt::format(
        "terrain: the surface model ('surface_files') leaves {:.3g} % of the area out: there the height of "
        "trees and buildings is that of the land cover, or of the models' settings",
        100 * surface_->uncoveredFraction()));
}

/// A raster of sea level below all others, over the whole box and beyond.
void TerrainMosaic::addSea() {
  constexpr int kPosts = 5;
  const GeoBox all{-90, 90, -180, 180};
  TerrainRaster sea;
  heights_m_.emplace_back(kPosts * kPosts, 0.0f);
  sea.heights_msl_m = heights_m_.back().data();
  sea.columns = sea.rows = kPosts;
  sea.south_rad = degToRad(all.south_deg);
  sea.west_rad = degToRad(all.west_deg);
  sea.posts_per_rad_lat = (kPosts - 1) / degToRad(all.north_deg - all.south_deg);
  sea.posts_per_rad_lon = (kPosts - 1) / degToRad(all.east_deg - all.west_deg);
  sea.last_column = sea.last_row = kPosts - 1;
  rasters_.push_back(sea);
  if (void_posts_ == 0 && uncovered_fraction_ == 0) return;
  lowest_m_ = std::fmin(lowest_m_, 0.0);
  highest_m_ = std::fmax(highest_m_, 0.0);
  constexpr double kShore_m = 100;  // ground beside voids that are the sea's is lower, but for cliffs
  std::string hint = uncovered_fraction_ == 1 ? "; " + place_text_ : "";
  if (highest_beside_void_m_ > kShore_m) {
    hint += fmt::format(
        "; beside void posts the ground is up to {:.0f} m high: such voids are not the sea's. Fill them in "
        "the "
        "file, as 'gdal_fillnodata.py IN OUT' does, or take 'missing: mask'",
        highest_beside_void_m_);
  }
  const std::string which =
      void_posts_ == 0 ? "no elevation file covers it"
                       : fmt::format("{:.3g} % that no elevation file covers, the others among {} void posts",
                                     100 * uncovered_fraction_, void_posts_);
  warnings_.push_back(
      fmt::format("terrain: {:.3g} % of the area is taken as sea (0 m), as 'missing: sea' says: {}{}",
                  100 * missing_fraction_, which, hint));
}

void TerrainMosaic::survey(const std::vector<TerrainSheet>& sheets) {
  for (std::size_t k = 0; k < sheets.size(); ++k) {
    const TerrainSheet& sheet = sheets[k];
    post_spacing_m_ = std::fmin(post_spacing_m_, sheet.finest_m);
    const GeoBox part{std::max(sheet.lattice.y(sheet.first_row), box_.south_deg),
                      std::min(sheet.lattice.y(sheet.last_row), box_.north_deg),
                      std::max(sheet.lattice.x(sheet.first_column), box_.west_deg),
                      std::min(sheet.lattice.x(sheet.last_column), box_.east_deg)};
    coverage_ = k == 0 ? part
                       : GeoBox{std::min(coverage_.south_deg, part.south_deg),
                                std::max(coverage_.north_deg, part.north_deg),
                                std::min(coverage_.west_deg, part.west_deg),
                                std::max(coverage_.east_deg, part.east_deg)};
    surveyPosts(sheet);
  }
  long long uncovered = 0, missing = 0;
  for (int j = 0; j < kCoverageProbes; ++j) {
    const double latitude_deg =
        box_.south_deg + (box_.north_deg - box_.south_deg) * j / (kCoverageProbes - 1);
    for (int i = 0; i < kCoverageProbes; ++i) {
      const double longitude_deg =
          box_.west_deg + (box_.east_deg - box_.west_deg) * i / (kCoverageProbes - 1);
      if (!covered(sheets, latitude_deg, longitude_deg)) ++uncovered;
      if (std::isnan(heightMsl_m(latitude_deg, longitude_deg))) ++missing;
    }
  }
  uncovered_fraction_ = static_cast<double>(uncovered) / (kCoverageProbes * kCoverageProbes);
  missing_fraction_ = static_cast<double>(missing) / (kCoverageProbes * kCoverageProbes);
}

void TerrainMosaic::surveyPosts(const TerrainSheet& sheet) {
  const double slack_x = TerrainRaster::kSlack * sheet.lattice.step_x;
  const double slack_y = TerrainRaster::kSlack * sheet.lattice.step_y;
  for (int row = 0; row < sheet.rows; ++row) {
    const double latitude_deg = sheet.lattice.y(row);
    if (latitude_deg < box_.south_deg - slack_y || latitude_deg > box_.north_deg + slack_y) continue;
    for (int column = 0; column < sheet.columns; ++column) {
      const double longitude_deg = sheet.lattice.x(column);
      if (longitude_deg < box_.west_deg - slack_x || longitude_deg > box_.east_deg + slack_x) continue;
      const PostKind kind = sheet.kind(column, row);
      if (kind == PostKind::known) {
        const double height_m = sheet.heights_m[sheet.index(column, row)];
        lowest_m_ = std::fmin(lowest_m_, height_m);
        highest_m_ = std::fmax(highest_m_, height_m);
      } else if (kind == PostKind::empty && std::isnan(heightMsl_m(latitude_deg, longitude_deg))) {
        ++void_posts_;
        surveyVoid(sheet, column, row);
      }
    }
  }
}

/// The ground at the posts beside a void one.
void TerrainMosaic::surveyVoid(const TerrainSheet& sheet, int column, int row) {
  for (int j = std::max(row - 1, 0); j <= std::min(row + 1, sheet.rows - 1); ++j) {
    for (int i = std::max(column - 1, 0); i <= std::min(column + 1, sheet.columns - 1); ++i) {
      if (sheet.kind(i, j) == PostKind::known)
        highest_beside_void_m_ =
            std::fmax(highest_beside_void_m_, double{sheet.heights_m[sheet.index(i, j)]});
    }
  }
}

/// True if a file has posts around the point, void or not.
bool TerrainMosaic::covered(const std::vector<TerrainSheet>& sheets, double latitude_deg,
                            double longitude_deg) const {
  if (!std::isnan(heightMsl_m(latitude_deg, longitude_deg))) return true;
  for (std::size_t k = 0; k < sheets.size(); ++k) {
    double column = 0, row = 0;
    if (rasters_[k].locate(degToRad(latitude_deg), degToRad(longitude_deg), column, row) &&
        sheets[k].isNextToVoid(column, row)) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::string> TerrainSpec::rasters() const {
  std::vector<std::string> all = files;
  all.insert(all.end(), surface_files.begin(), surface_files.end());
  all.insert(all.end(), land_cover.files.begin(), land_cover.files.end());
  return all;
}

std::shared_ptr<const Terrain> Terrain::load(const TerrainSpec& spec, const GeoBox& box,
                                             const std::vector<NeededPlace>& places) {
  return std::make_shared<const TerrainMosaic>(spec, box, places);
}

}  // namespace emscape::scenario
