#include "emscape/scenario/terrain/terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "base/geodesy/geoid_grid.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/log.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "scenario/terrain/place.h"
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
/// @param location  of the elevation files, for errors
void toMeanSeaLevel(TerrainSheet& sheet, VerticalDatum datum, const SourceLocation& location) {
  std::optional<GeoidGrid> egm2008;
  if (datum == VerticalDatum::egm2008) {
    try {
      egm2008 = egm2008Grid({sheet.lattice.y(0), sheet.lattice.y(sheet.rows - 1), sheet.lattice.x(0),
                             sheet.lattice.x(sheet.columns - 1)});
    } catch (const Error& error) {
      throw Error(error.code(), location, error.message());
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

std::string fillText(const FillValues::Found& fill) {
  return fmt::format(
      "{} post{} of {:g} m {} more than {:g} m below all posts around: a fill value that the file "
      "does not declare; void",
      fill.posts, fill.posts == 1 ? "" : "s", fill.height_m, fill.posts == 1 ? "is" : "are",
      FillValues::kStep_m);
}

/// Notes on elevation files; a note on many files is logged once.
class FileNotes {
 public:
  void add(const TerrainFile& file, const std::string& note) {
    const auto known =
        std::find_if(notes_.begin(), notes_.end(), [&](const Note& other) { return other.text == note; });
    if (known != notes_.end()) {
      ++known->files;
    } else {
      notes_.push_back({note, file.name(), 1});
    }
  }
  void log(LogLevel level) const {
    for (const Note& note : notes_) {
      const std::string others = note.files > 1 ? fmt::format(" and {} more", note.files - 1) : "";
      const std::string text = fmt::format("elevation file {}{}: {}", note.first_file, others, note.text);
      level == LogLevel::warning ? logWarning(text) : logInfo(text);
    }
  }

 private:
  struct Note {
    std::string text, first_file;
    int files;
  };
  std::vector<Note> notes_;
};

/// Sheets of longitudes and latitudes, the finest first, with closed seams.
std::vector<TerrainSheet> sheetsWithin(const TerrainSpec& spec, const GeoBox& box) {
  FileNotes notes, warnings;
  std::vector<RasterTile> tiles;
  for (std::size_t k = 0; k < spec.files.size(); ++k) {
    const SourceLocation location = k < spec.locations.size() ? spec.locations[k] : SourceLocation{};
    const auto file = std::make_shared<const TerrainFile>(spec.files[k], location);
    for (const std::string& note : file->notes()) notes.add(*file, note);
    for (const std::string& warning : file->warnings()) warnings.add(*file, warning);
    for (RasterTile& tile : tilesWithin(file, box)) tiles.push_back(std::move(tile));
  }
  notes.log(LogLevel::info);
  std::vector<TerrainSheet> sheets;
  for (TerrainSheet& sheet : readSheets(tiles)) {
    for (const TerrainSheet::Fill& fill : sheet.fills) warnings.add(*fill.file, fillText(fill.value));
    if (sheet.file->isGeographic()) {
      sheets.push_back(std::move(sheet));
    } else {
      for (TerrainSheet& brought : toGeographicSheets(std::move(sheet), box))
        sheets.push_back(std::move(brought));
    }
  }
  warnings.log(LogLevel::warning);
  std::stable_sort(sheets.begin(), sheets.end(),
                   [](const TerrainSheet& a, const TerrainSheet& b) { return a.spacing_m < b.spacing_m; });
  if (spec.vertical_datum != VerticalDatum::egm96) {
    const SourceLocation location = spec.locations.empty() ? SourceLocation{} : spec.locations.front();
    for (TerrainSheet& sheet : sheets) toMeanSeaLevel(sheet, spec.vertical_datum, location);
  }
  closeSeams(sheets);
  return sheets;
}

class TerrainMosaic : public Terrain {
 public:
  TerrainMosaic(const TerrainSpec& spec, const GeoBox& box) : box_(checked(box)) {
    std::vector<TerrainSheet> sheets = sheetsWithin(spec, box);
    for (const TerrainSheet& sheet : sheets) rasters_.push_back(sheet.raster());
    survey(sheets);
    // The heights do not move in memory: the rasters' pointers stay valid.
    for (TerrainSheet& sheet : sheets) heights_m_.push_back(std::move(sheet.heights_m));
  }

  double heightMsl_m(double latitude_deg, double longitude_deg) const override {
    return view().heightAt(degToRad(latitude_deg), degToRad(longitude_deg));
  }
  TerrainView view() const override { return {rasters_.data(), static_cast<int>(rasters_.size())}; }
  double postSpacing_m() const override { return post_spacing_m_; }
  long long voidPosts() const override { return void_posts_; }
  double uncoveredFraction() const override { return uncovered_fraction_; }
  GeoBox box() const override { return box_; }
  GeoBox coverage() const override { return coverage_; }
  double lowest_m() const override { return lowest_m_; }
  double highest_m() const override { return highest_m_; }

 private:
  void survey(const std::vector<TerrainSheet>& sheets);
  void surveyPosts(const TerrainSheet& sheet);
  bool covered(const std::vector<TerrainSheet>& sheets, double latitude_deg, double longitude_deg) const;

  GeoBox box_;
  std::vector<std::vector<float>> heights_m_;
  std::vector<TerrainRaster> rasters_;
  double post_spacing_m_ = std::numeric_limits<double>::quiet_NaN();
  long long void_posts_ = 0;
  double uncovered_fraction_ = 1.0;
  GeoBox coverage_;
  double lowest_m_ = std::numeric_limits<double>::quiet_NaN();
  double highest_m_ = std::numeric_limits<double>::quiet_NaN();
};

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
  long long uncovered = 0;
  for (int j = 0; j < kCoverageProbes; ++j) {
    const double latitude_deg =
        box_.south_deg + (box_.north_deg - box_.south_deg) * j / (kCoverageProbes - 1);
    for (int i = 0; i < kCoverageProbes; ++i) {
      const double longitude_deg =
          box_.west_deg + (box_.east_deg - box_.west_deg) * i / (kCoverageProbes - 1);
      if (!covered(sheets, latitude_deg, longitude_deg)) ++uncovered;
    }
  }
  uncovered_fraction_ = static_cast<double>(uncovered) / (kCoverageProbes * kCoverageProbes);
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
      }
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

/// Reads all heights of a file, or of a very large one a part: kStrips strips of rows from the first to the
/// last.
void surveyHeights(const TerrainFile& file, TerrainFileInfo& info) {
  constexpr long long kMaxPosts = 1LL << 28;
  constexpr int kStrips = 64;
  const long long rows = file.rows(), columns = file.columns();
  const bool is_partial = rows * columns > kMaxPosts;
  const int strips = is_partial ? kStrips : 1;
  const long long rows_of_strip = is_partial ? std::max(1LL, kMaxPosts / columns / kStrips) : rows;
  for (int strip = 0; strip < strips; ++strip) {
    const long long first_row = strip == 0 ? 0 : (rows - rows_of_strip) * strip / (strips - 1);
    FillValues fills(columns);
    // Heights that may be fill values count once they are known not to be.
    std::map<float, long long> low_m;
    file.read({0, first_row, columns, rows_of_strip}, [&](long long, const float* heights_m) {
      fills.add(heights_m);
      int voids = 0;
      float lowest_m = HUGE_VALF, highest_m = -HUGE_VALF;
      for (long long column = 0; column < columns; ++column) {
        const float height_m = heights_m[column];  // NaN is neither smaller nor larger
        if (height_m < FillValues::kBelow_m) ++low_m[height_m];
        lowest_m = height_m < lowest_m && height_m >= FillValues::kBelow_m ? height_m : lowest_m;
        highest_m = height_m > highest_m && height_m >= FillValues::kBelow_m ? height_m : highest_m;
        voids += std::isnan(height_m) ? 1 : 0;
      }
      info.void_posts += voids;
      if (lowest_m > highest_m) return;
      info.lowest_m = std::fmin(info.lowest_m, lowest_m);
      info.highest_m = std::fmax(info.highest_m, highest_m);
    });
    for (const FillValues::Found& fill : fills.found()) {
      info.notes.push_back(fillText(fill));
      info.void_posts += fill.posts;
      low_m.erase(fill.height_m);
    }
    if (!low_m.empty()) {
      info.lowest_m = std::fmin(info.lowest_m, low_m.begin()->first);
      info.highest_m = std::fmax(info.highest_m, low_m.rbegin()->first);
    }
  }
  if (is_partial) {
    info.notes.push_back("is large: its range and voids are those of " +
                         std::to_string(strips * rows_of_strip) + " of its " + std::to_string(rows) +
                         " rows");
  }
}

}  // namespace

std::shared_ptr<const Terrain> Terrain::load(const TerrainSpec& spec, const GeoBox& box) {
  return std::make_shared<const TerrainMosaic>(spec, box);
}

TerrainFileInfo Terrain::describe(const std::string& name, bool read_heights) {
  const TerrainFile file(name, SourceLocation{});
  TerrainFileInfo info;
  info.file = name;
  info.format = file.format();
  info.crs = file.crs();
  info.box = geographicBoxOf(file);
  info.columns = file.columns();
  info.rows = file.rows();
  info.pixel_is_area = file.isArea();
  info.notes = file.notes();
  info.notes.insert(info.notes.end(), file.warnings().begin(), file.warnings().end());
  const double column = 0.5 * (file.columns() - 1), row = 0.5 * (file.rows() - 1);
  const PostLattice& lattice = file.lattice();
  std::vector<double> x{lattice.x(column - 0.5), lattice.x(column + 0.5), lattice.x(column),
                        lattice.x(column)};
  std::vector<double> y{lattice.y(row), lattice.y(row), lattice.y(row - 0.5), lattice.y(row + 0.5)};
  file.toGeographic(x, y);
  if (!std::isfinite(x[2]) || !std::isfinite(y[2]))
    throw Error(ErrorCode::bad_input, "elevation file " + name + ": its posts are not on the earth");
  info.post_spacing_lon_deg = std::abs(wrapLongitude_deg(x[1] - x[0]));
  info.post_spacing_lat_deg = std::abs(y[3] - y[2]);
  info.lowest_m = info.highest_m = std::numeric_limits<double>::quiet_NaN();
  if (read_heights) surveyHeights(file, info);
  return info;
}

}  // namespace emscape::scenario
