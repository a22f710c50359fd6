#include "emfield/sector_terrain.h"

#include <algorithm>

#include "base/simd.h"

namespace emscape::emfield {
namespace {

constexpr int kBlock = SectorPosts::kBlock;
/// So that a parabola leaves the ground track by less than 1 mm.
constexpr double kMaxChord_m = 12000;

/// What the loops over a chord need.
struct ChordTask {
  SectorChord chord;
  const float *part, *range_m;  ///< of the posts
  int row_posts;
  const float* steepest;  ///< TerrainBounds
  int row_windows;
  float half_width_rad;
};

/// Heights in the middle of the sector. @return false if one is unknown
EMSCAPE_SIMD_CLONES bool readMiddle(const ChordTask& task, int first, int end, float* height_msl_m) {
  const Parabola<float> column = task.chord.column[0], row = task.chord.row[0];
  const float* const corner = task.chord.corner_msl_m;
  const float* const parts = task.part;
  const int row_posts = task.row_posts;
  float unknown = 0;
#pragma omp simd reduction(+ : unknown)
  for (int post = first; post < end; ++post) {
    const float height = bilinearHeight(corner, row_posts, column.at(parts[post]), row.at(parts[post]));
    height_msl_m[post] = height;
    unknown += height - height;
  }
  return unknown == 0;
}

/// Sets the slack of blocks. A block's box of positions holds those of all paths; nothing is steeper there.
EMSCAPE_SIMD_CLONES void boundBlocks(const ChordTask& task, int corner_column, int corner_row,
                                     int first_block, int end_block, int last_post, float* slack_m) {
  constexpr float kMargin = 0.02f;      // posts: for rounding, and for the curvature of a block
  constexpr float kRounding_m = 0.01f;  // of heights
  const SectorChord chord = task.chord;
  const float *const parts = task.part, *const ranges_m = task.range_m, *const steepest = task.steepest;
  const int row_windows = task.row_windows;
  const float half_width_rad = task.half_width_rad;
#pragma omp simd
  for (int b = first_block; b < end_block; ++b) {
    const int first = b * kBlock, end = first + kBlock - 1, last = end < last_post ? end : last_post;
    const auto extent = [&](const Parabola<float>* of, float& low, float& high) {
      const float begin = of[0].at(parts[first]), end_at = of[0].at(parts[last]);
      const float begin_width = std::fabs(of[1].at(parts[first])) + std::fabs(of[2].at(parts[first]));
      const float end_width = std::fabs(of[1].at(parts[last])) + std::fabs(of[2].at(parts[last]));
      const float low_begin = begin - begin_width, low_end = end_at - end_width;
      const float high_begin = begin + begin_width, high_end = end_at + end_width;
      low = (low_begin < low_end ? low_begin : low_end) - kMargin;
      high = (high_begin > high_end ? high_begin : high_end) + kMargin;
    };
    float west, east, south, north;
    extent(chord.column, west, east);
    extent(chord.row, south, north);
    constexpr float kPerStride = 1.0f / TerrainBounds::kStride;
    const float column = west + static_cast<float>(corner_column),
                row = south + static_cast<float>(corner_row);
    const int i = static_cast<int>((column > 0 ? column : 0) * kPerStride);
    const int j = static_cast<int>((row > 0 ? row : 0) * kPerStride);
    const float slope = steepest[j * row_windows + i];
    const float longer = east - west > north - south ? east - west : north - south;
    slack_m[b] = longer <= TerrainBounds::kMaxExtent ? slope * half_width_rad * ranges_m[last] + kRounding_m
                                                     : HUGE_VALF;
  }
}

}  // namespace

SectorPosts::SectorPosts(const Station& station, const GroundPosts& ground) {
  const int count = ground.range_count;
  for (int i = 0; i < count; ++i) range_m_.push_back(static_cast<float>(ground.ranges_m[i]));
  for (int first = 0; first < count; first += kBlock) {
    const int first_obstacle = std::max(first, 1), last = std::min(first + kBlock, count) - 1;
    first_m_.push_back(range_m_[std::min(first_obstacle, count - 1)]);
    last_m_.push_back(range_m_[std::max(last, std::min(first_obstacle, count - 1))]);
  }
  if (count < 2) return;
  const double step_m = ground.ranges_m[count - 1] - ground.ranges_m[count - 2];
  const double longest_m = std::min(kMaxChord_m, maxChord_m(std::fabs(station.geodesy.station.up.z)));
  blocks_per_chord_ = static_cast<int>(longest_m / (kBlock * step_m));
  const int per_chord = blocks_per_chord_ * kBlock;
  if (per_chord == 0) return;
  for (int i = 0; i < count; ++i) {
    const int first = i / per_chord * per_chord, last = std::min(first + per_chord, count) - 1;
    const double length_m = ground.ranges_m[last] - ground.ranges_m[first];
    part_.push_back(
        length_m > 0 ? static_cast<float>((ground.ranges_m[i] - ground.ranges_m[first]) / length_m) : 0);
  }
}

SectorTerrain::SectorTerrain(const Station& station, const GroundPosts& ground, const TerrainBounds& bounds,
                             const SectorPosts& posts)
    : station_(station),
      bounds_(bounds),
      ground_(ground),
      posts_(posts),
      raster_(ground.terrain.rasters),
      chords_(posts.blocks() / posts.blocksPerChord() + 1),
      height_msl_m_(static_cast<std::size_t>(posts.blocks()) * kBlock),
      slack_m_(posts.blocks()) {}

void SectorTerrain::read(const PathSectors::Azimuth& middle, double half_width_rad, int posts) {
  const int blocks = (posts + kBlock - 1) / kBlock;
  posts_read_ = posts;
  half_width_rad_ = half_width_rad;
  const double sine = std::sin(half_width_rad), cosine = std::cos(half_width_rad);
  azimuths_[0] = {middle.sine * cosine - middle.cosine * sine, middle.cosine * cosine + middle.sine * sine};
  azimuths_[1] = middle;
  azimuths_[2] = {middle.sine * cosine + middle.cosine * sine, middle.cosine * cosine - middle.sine * sine};
  blocks_ = 0;
  while (blocks_ < blocks) {
    const int first = blocks_, end = std::min(first + posts_.blocksPerChord(), blocks);
    readChord(first, end);
    if (blocks_ < end) return;
  }
}

/// Reads the blocks of a chord; beyond the edge of the raster no post is known.
void SectorTerrain::readChord(int first_block, int end_block) {
  const int first = first_block * kBlock;
  const int within = setLongestChord(first, std::min(end_block * kBlock, posts_read_));
  if (within < std::min(end_block * kBlock, posts_read_)) posts_read_ = within;
  if (within == first) return;
  end_block = (within + kBlock - 1) / kBlock;
  const int last = within - 1;
  const SectorChord& chord = chords_[first_block / posts_.blocksPerChord()];
  const ChordTask task{chord,
                       posts_.part(),
                       posts_.range_m(),
                       raster_->columns,
                       bounds_.steepest(),
                       bounds_.rowWindows(),
                       static_cast<float>(half_width_rad_)};
  const bool is_known = readMiddle(task, first, last + 1, height_msl_m_.data());
  const auto corner = chord.corner_msl_m - raster_->heights_msl_m;
  boundBlocks(task, static_cast<int>(corner % raster_->columns), static_cast<int>(corner / raster_->columns),
              first_block, end_block, last, slack_m_.data());
  // A void has infinite slopes beside it.
  for (; blocks_ < end_block; ++blocks_) {
    if (!(slack_m_[blocks_] < HUGE_VALF)) return;
  }
  if (!is_known) blocks_ = first_block;
}

/// Sets the chord from a post to the last one before `end` that is in the raster. @return the post beyond
/// that
int SectorTerrain::setLongestChord(int first, int end) {
  if (setChord(first, end - 1)) return end;
  int within = first, beyond = end - 1;  // the chord to the post before `within` is in the raster
  while (within < beyond) {
    const int middle = within + (beyond - within + 1) / 2;
    if (setChord(first, middle - 1)) {
      within = middle;
    } else {
      beyond = middle - 1;
    }
  }
  return within;
}

/// Sets the chord of posts first..last. @return false if it is not entirely in the raster
bool SectorTerrain::setChord(int first, int last) {
  const double begin_m = ground_.ranges_m[first], length_m = ground_.ranges_m[last] - begin_m;
  const int per_chord = posts_.blocksPerChord() * kBlock;
  constexpr double kMargin = 0.01;  // posts
  // The last post is at this part of the whole chord.
  const double part = last > first ? static_cast<double>(posts_.part()[last]) : 1;
  Parabola<double> columns[3], rows[3];
  double lowest_column = HUGE_VAL, lowest_row = HUGE_VAL;
  for (int edge = 0; edge < 3; ++edge) {
    const auto positionAt = [&](double range_m) {
      return fastDirect(station_.geodesy, azimuths_[edge].sine, azimuths_[edge].cosine, range_m);
    };
    const ChordInRaster in =
        chordInRaster(*raster_, chordThrough(positionAt(begin_m), positionAt(begin_m + length_m / 2),
                                             positionAt(begin_m + length_m)));
    if (!in.isWithin(*raster_, kMargin)) return false;
    columns[edge] = in.column;
    rows[edge] = in.row;
    lowest_column = std::min(lowest_column, in.lowest_column);
    lowest_row = std::min(lowest_row, in.lowest_row);
  }
  SectorChord& chord = chords_[first / per_chord];
  const int i = static_cast<int>(lowest_column), j = static_cast<int>(lowest_row);
  chord.corner_msl_m = raster_->heights_msl_m + static_cast<long long>(j) * raster_->columns + i;
  const auto fit = [part](const Parabola<double>* edges, int corner, Parabola<float>* of_sector) {
    double per_part = 1;
    for (int n = 0; n < 3; ++n, per_part /= part) {
      const double low = edges[0].c[n], middle = edges[1].c[n], high = edges[2].c[n];
      of_sector[0].c[n] = static_cast<float>((middle - (n == 0 ? corner : 0)) * per_part);
      of_sector[1].c[n] = static_cast<float>((high - low) / 2 * per_part);
      of_sector[2].c[n] = static_cast<float>(((high + low) / 2 - middle) * per_part);
    }
  };
  fit(columns, i, chord.column);
  fit(rows, j, chord.row);
  return true;
}

}  // namespace emscape::emfield
