#include "emfield/excess/sector_terrain.h"

#include <algorithm>

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

constexpr int kBlock = SectorPosts::kBlock, kGroup = SectorPosts::kGroup;
/// Limit for which a parabola deviates from the ground track by less than 1 mm.
constexpr double kMaxChord_m = 12000;

/// Positions in the middle of a sector, as stored by SectorTerrain.
struct MiddleTask {
  const float *column[3], *row[3];  ///< parabolas of each block
  const float* last_part;
  const int* corner;
  const float* part;  ///< in groups
  const float* raster_msl_m;
  int row_posts;
};

/// Heights in the middle of the sector, in groups.
EMSCAPE_SIMD_CLONES void readMiddle(const MiddleTask& task, int groups, float* height_msl_m) {
  const float* const raster = task.raster_msl_m;
  const int row_posts = task.row_posts;
  for (int g = 0; g < groups; ++g) {
    const int block = g * kGroup;
    const float *const c0 = task.column[0] + block, *const c1 = task.column[1] + block,
                       *const c2 = task.column[2] + block;
    const float *const r0 = task.row[0] + block, *const r1 = task.row[1] + block,
                       *const r2 = task.row[2] + block;
    const float* const last_part = task.last_part + block;
    const int* const corner = task.corner + block;
    for (int j = 0; j < kBlock; ++j) {
      const int first = (g * kBlock + j) * kGroup;
      const float* const parts = task.part + first;
      float* const heights = height_msl_m + first;
#pragma omp simd
      for (int n = 0; n < kGroup; ++n) {
        const float part = parts[n] < last_part[n] ? parts[n] : last_part[n];
        const float x = c0[n] + part * (c1[n] + part * c2[n]), y = r0[n] + part * (r1[n] + part * r2[n]);
        const int i = static_cast<int>(x), k = static_cast<int>(y);
        const int at = corner[n] + k * row_posts + i;
        const float to_east = x - static_cast<float>(i), to_north = y - static_cast<float>(k);
        const float south = lerp(raster[at], raster[at + 1], to_east);
        const float north = lerp(raster[at + row_posts], raster[at + row_posts + 1], to_east);
        heights[n] = lerp(south, north, to_north);
      }
    }
  }
}

/// Inputs of the bounds of a chord's blocks.
struct ChordTask {
  SectorChord chord;
  const float *first_part, *last_part, *last_m, *between_m;  ///< SectorPosts
  float known_part;                                          ///< of the last post that is known
  const float* steepest;                                     ///< TerrainBounds
  const float* highest_cover_m;                              ///< the same; null: no clutter
  int row_windows;
  float half_width_rad;
};

/// Extent of the positions of a block (posts).
struct Extent {
  float low, high;
};

/// Sets the slack and the highest clutter of blocks; NaN if a block is wider than the bounds cover. The box
/// of a block contains the positions of all paths; the slope in it does not exceed the bound.
EMSCAPE_SIMD_CLONES void boundBlocks(const ChordTask& task, int first_block, int end_block, float* slack_m,
                                     float* across_slack_m, float* cover_m) {
  constexpr float kMargin = 0.02f;      // posts: for rounding, and for the curvature of a block
  constexpr float kRounding_m = 0.01f;  // of heights
  const SectorChord chord = task.chord;
  const float *const first_part = task.first_part, *const last_part = task.last_part;
  const float *const last_m = task.last_m, *const between_m = task.between_m;
  const float* const steepest = task.steepest;
  const bool is_raised = task.highest_cover_m != nullptr;
  const float* const highest_cover_m = is_raised ? task.highest_cover_m : task.steepest;
  const int row_windows = task.row_windows;
  const float half_width_rad = task.half_width_rad, known_part = task.known_part;
#pragma omp simd
  for (int b = first_block; b < end_block; ++b) {
    const float begin_part = first_part[b];
    const float end_part = last_part[b] < known_part ? last_part[b] : known_part;
    const auto extent = [=](const Parabola<float>* of) {
      const float begin = of[0].at(begin_part), end_at = of[0].at(end_part);
      const float begin_width = std::fabs(of[1].at(begin_part)) + std::fabs(of[2].at(begin_part));
      const float end_width = std::fabs(of[1].at(end_part)) + std::fabs(of[2].at(end_part));
      const float low_begin = begin - begin_width, low_end = end_at - end_width;
      const float high_begin = begin + begin_width, high_end = end_at + end_width;
      const float low = (low_begin < low_end ? low_begin : low_end) - kMargin;
      const float high = (high_begin > high_end ? high_begin : high_end) + kMargin;
      return Extent{low, high};
    };
    const Extent columns = extent(chord.column), rows = extent(chord.row);
    constexpr float kPerStride = 1.0f / TerrainBounds::kStride;
    const float column = columns.low + static_cast<float>(chord.corner_column),
                row = rows.low + static_cast<float>(chord.corner_row);
    const int i = static_cast<int>((column > 0 ? column : 0) * kPerStride);
    const int j = static_cast<int>((row > 0 ? row : 0) * kPerStride);
    const float slope = steepest[j * row_windows + i], highest_m = highest_cover_m[j * row_windows + i];
    const float width = columns.high - columns.low, height = rows.high - rows.low;
    const float longer = width > height ? width : height;
    const float across_m = half_width_rad * last_m[b];
    const bool is_bounded = longer <= TerrainBounds::kMaxExtent;
    slack_m[b] = is_bounded ? slope * (across_m + between_m[b]) + kRounding_m : NAN;
    across_slack_m[b] = is_bounded ? slope * across_m + kRounding_m : NAN;
    cover_m[b] = is_raised ? highest_m : 0.0f;
  }
}

/// True if a chord is within a raster from its beginning to a part of it.
bool isWithin(const scenario::TerrainRaster& raster, const ChordInRaster& chord, double part) {
  constexpr double kMargin = 0.01;  // posts
  const auto within = [part](const Parabola<double>& parabola, double first, double last) {
    const double begin = parabola.c[0], end = parabola.at(part);
    const double margin = kMargin + std::fabs(parabola.c[2]) * part * part / 4;
    return std::min(begin, end) - margin >= first && std::max(begin, end) + margin <= last;
  };
  return within(chord.column, raster.first_column, raster.last_column) &&
         within(chord.row, raster.first_row, raster.last_row);
}

}  // namespace

SectorPosts::SectorPosts(const Station& station, const GroundPosts& ground) {
  constexpr float kFirst_m = 0.01f;  // of an obstacle
  const int count = ground.range_count;
  if (count < 2) return;
  for (int i = 0; i < count; ++i) {
    range_m_.push_back(static_cast<float>(ground.ranges_m[i]));
    const auto between = [&](int post) { return (ground.ranges_m[post] + ground.ranges_m[post + 1]) / 2; };
    nearest_m_.push_back(i < 2 ? kFirst_m : farthest_m_.back());
    farthest_m_.push_back(static_cast<float>(i + 1 < count ? between(std::max(i, 1)) : ground.ranges_m[i]));
  }
  for (int first = 0; first < count; first += kBlock) {
    const int end = std::min(first + kBlock, count);
    first_m_.push_back(nearest_m_[first]);
    last_m_.push_back(farthest_m_[end - 1]);
    float between_m = 0;
    for (int i = std::max(first, 1); i < end; ++i) {
      between_m = std::max({between_m, range_m_[i] - nearest_m_[i], farthest_m_[i] - range_m_[i]});
    }
    between_m_.push_back(between_m);
  }
  const double step_m = ground.ranges_m[count - 1] - ground.ranges_m[count - 2];
  const double longest_m = std::min(kMaxChord_m, maxChord_m(std::fabs(station.geodesy.station.up.z)));
  blocks_per_chord_ = static_cast<int>(longest_m / (kBlock * step_m));
  const int per_chord = blocks_per_chord_ * kBlock;
  if (per_chord == 0) return;
  for (int i = 0; i < count; ++i) {
    const int first = i / per_chord * per_chord, end = std::min(first + per_chord, count - 1);
    const double length_m = ground.ranges_m[end] - ground.ranges_m[first];
    const auto partAt = [&](double range_m) {
      return length_m > 0 ? static_cast<float>((range_m - ground.ranges_m[first]) / length_m) : 0;
    };
    part_.push_back(partAt(ground.ranges_m[i]));
    const int block = i / kBlock;
    if (i % kBlock == 0) first_part_.push_back(i > 0 ? partAt(static_cast<double>(first_m_[block])) : 0);
    if (i % kBlock == kBlock - 1 || i == count - 1) {
      last_part_.push_back(partAt(static_cast<double>(last_m_[block])));
    }
  }
}

std::vector<int> SectorPosts::postsInGroups() const {
  std::vector<int> posts(sizeInGroups());
  for (int post = 0; post < static_cast<int>(posts.size()); ++post) {
    posts[inGroups(post)] = std::clamp(post, std::min(1, count() - 1), count() - 1);
  }
  return posts;
}

SectorTerrain::SectorTerrain(const Station& station, const GroundPosts& ground, const TerrainBounds& bounds,
                             const SectorPosts& posts)
    : station_(station),
      bounds_(bounds),
      ground_(ground),
      posts_(posts),
      raster_(ground.terrain.rasters),
      chords_(posts.chords()),
      height_msl_m_(posts.sizeInGroups()) {
  for (const int post : posts.postsInGroups()) in_groups_part_.push_back(posts.part()[post]);
  const std::size_t blocks = static_cast<std::size_t>(posts.groups()) * kGroup;
  for (std::vector<float>& parabola : parabolas_) parabola.resize(blocks);
  last_part_.resize(blocks);
  corner_.resize(blocks);
  slack_m_.resize(blocks);
  across_slack_m_.resize(blocks);
  cover_m_.resize(blocks);
}

void SectorTerrain::readBlock(int block, float aside, float* height_msl_m) const {
  const SectorChord& of_block = chords_[block / posts_.blocksPerChord()];
  const Parabola<float> column = alongPath(of_block.column, aside), row = alongPath(of_block.row, aside);
  const float* const parts = posts_.part() + block * kBlock;
  const int count = std::min(kBlock, posts_read_ - block * kBlock);
  for (int i = 0; i < count; ++i) {
    height_msl_m[i] =
        bilinearHeight(of_block.corner_msl_m, rowPosts(), column.at(parts[i]), row.at(parts[i]));
  }
}

void SectorTerrain::read(const PathSectors::Azimuth& middle, double half_width_rad, int posts) {
  const double sine = std::sin(half_width_rad), cosine = std::cos(half_width_rad);
  azimuths_[0] = {middle.sine * cosine - middle.cosine * sine, middle.cosine * cosine + middle.sine * sine};
  azimuths_[1] = middle;
  azimuths_[2] = {middle.sine * cosine + middle.cosine * sine, middle.cosine * cosine - middle.sine * sine};
  const int per_chord = posts_.blocksPerChord() * kBlock;
  posts_read_ = 0;
  for (int index = 0; posts_read_ < posts; ++index) {
    const int first = posts_read_, end = std::min(first + per_chord, posts);
    posts_read_ = setChord(index, end);
    if (posts_read_ == first) break;
    const int last = posts_read_ - 1;
    spread(index, last);
    boundBlocks(
        {chords_[index], posts_.firstPart(), posts_.lastPart(), posts_.last_m(), posts_.between_m(),
         posts_.part()[last], bounds_.steepest(), ground_.is_raised ? bounds_.highestCover_m() : nullptr,
         bounds_.rowWindows(), static_cast<float>(half_width_rad)},
        first / kBlock, blocks(), slack_m_.data(), across_slack_m_.data(), cover_m_.data());
    if (posts_read_ < end) break;
  }
  if (posts_read_ == 0) return;
  const SectorChord& first_chord = chords_[0];
  base_msl_m_ = bilinearHeight(first_chord.corner_msl_m, raster_->columns, first_chord.column[0].c[0],
                               first_chord.row[0].c[0]);
  const int groups = (blocks() + kGroup - 1) / kGroup;
  readMiddle({{parabolas_[0].data(), parabolas_[1].data(), parabolas_[2].data()},
              {parabolas_[3].data(), parabolas_[4].data(), parabolas_[5].data()},
              last_part_.data(),
              corner_.data(),
              in_groups_part_.data(),
              raster_->heights_msl_m,
              raster_->columns},
             groups, height_msl_m_.data());
  for (int b = 0; b < blocks(); ++b) {
    float known_m = base_msl_m_;
    if (!(slack_m_[b] < HUGE_VALF)) {  // near a void
      for (int i = b * kBlock; i < (b + 1) * kBlock; ++i) known_m += height_msl_m_[SectorPosts::inGroups(i)];
      known_m += slack_m_[b];
    }
    if (std::isnan(known_m)) posts_read_ = b * kBlock;
  }
}

/// Sets a chord; that before it was the last one set. @return the first post, not beyond `end`, that is not
/// in the raster
int SectorTerrain::setChord(int index, int end) {
  const int per_chord = posts_.blocksPerChord() * kBlock;
  const int first = index * per_chord;
  const double begin_m = ground_.ranges_m[first];
  const double length_m = ground_.ranges_m[std::min(first + per_chord, posts_.count() - 1)] - begin_m;
  ChordInRaster edges[3];
  for (int edge = 0; edge < 3; ++edge) {
    const auto positionAt = [&](double range_m) {
      return fastDirect(station_.geodesy, azimuths_[edge].sine, azimuths_[edge].cosine, range_m);
    };
    const FastDirect begin = index > 0 ? ends_[edge] : positionAt(begin_m);
    const FastDirect middle = positionAt(begin_m + length_m / 2);
    ends_[edge] = positionAt(begin_m + length_m);
    edges[edge] = chordInRaster(*raster_, chordThrough(begin, middle, ends_[edge]));
  }
  const auto isInRaster = [&](int post) {
    const auto part = static_cast<double>(posts_.part()[post]);
    return isWithin(*raster_, edges[0], part) && isWithin(*raster_, edges[1], part) &&
           isWithin(*raster_, edges[2], part);
  };
  int within = first, beyond = end;  // the posts before `within` are in the raster
  if (isInRaster(end - 1)) within = end;
  while (within < beyond) {
    const int middle = within + (beyond - within) / 2;
    if (isInRaster(middle)) {
      within = middle + 1;
    } else {
      beyond = middle;
    }
  }
  if (within == first) return within;

  const double within_part = static_cast<double>(posts_.part()[within - 1]);
  double lowest_column = HUGE_VAL, lowest_row = HUGE_VAL;
  for (const ChordInRaster& edge : edges) {
    const auto lowestOf = [within_part](const Parabola<double>& parabola) {
      return std::min(parabola.c[0], parabola.at(within_part)) -
             std::fabs(parabola.c[2]) * within_part * within_part / 4;
    };
    lowest_column = std::min(lowest_column, lowestOf(edge.column));
    lowest_row = std::min(lowest_row, lowestOf(edge.row));
  }
  SectorChord& chord = chords_[index];
  // The chord's first block begins before its first post.
  chord.corner_column = std::max(static_cast<int>(lowest_column) - 1, 0);
  chord.corner_row = std::max(static_cast<int>(lowest_row) - 1, 0);
  chord.corner_msl_m = raster_->heights_msl_m + static_cast<long long>(chord.corner_row) * raster_->columns +
                       chord.corner_column;
  for (int n = 0; n < 3; ++n) {
    const auto fit = [n](double low, double middle, double high, int corner, Parabola<float>* of_sector) {
      of_sector[0].c[n] = static_cast<float>(middle - (n == 0 ? corner : 0));
      of_sector[1].c[n] = static_cast<float>((high - low) / 2);
      of_sector[2].c[n] = static_cast<float>((high + low) / 2 - middle);
    };
    fit(edges[0].column.c[n], edges[1].column.c[n], edges[2].column.c[n], chord.corner_column, chord.column);
    fit(edges[0].row.c[n], edges[1].row.c[n], edges[2].row.c[n], chord.corner_row, chord.row);
  }
  return within;
}

/// Assigns a chord to its blocks, and to the padding of the last group.
void SectorTerrain::spread(int index, int last_post) {
  const SectorChord& chord = chords_[index];
  const int first = index * posts_.blocksPerChord();
  const int end = (last_post / kBlock / kGroup + 1) * kGroup;
  const auto fill = [&](auto& array, auto value) {
    std::fill(array.begin() + first, array.begin() + end, value);
  };
  for (int n = 0; n < 3; ++n) {
    fill(parabolas_[n], chord.column[0].c[n]);
    fill(parabolas_[3 + n], chord.row[0].c[n]);
  }
  fill(last_part_, posts_.part()[last_post]);
  fill(corner_, static_cast<int>(chord.corner_msl_m - raster_->heights_msl_m));
}

}  // namespace emscape::emfield
