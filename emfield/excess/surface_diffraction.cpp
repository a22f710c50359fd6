#include "emfield/excess/surface_diffraction.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/math/simd.h"
#include "emfield/excess/block_cover.h"
#include "emfield/excess/path_sectors.h"
#include "emfield/excess/sector_terrain.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "propagation/diffraction/bullington_lanes.h"

namespace emscape::emfield {
namespace {

using propagation::DiffractionModel;

constexpr int kBlock = SectorPosts::kBlock, kGroup = SectorPosts::kGroup;
/// Posts of a path in a block: crossings, of which there are rarely more, and regular posts near the emitter;
/// of raised profiles elsewhere the beginning of a chord.
constexpr int kCrossings = 8, kOfBlock = kCrossings + kBlock;
static_assert(kOfBlock == BlockCover::kPosts);

/// Number of groups of kGroup that contain a number of blocks, or of groups.
int groupsOf(int count) {
  return (count + kGroup - 1) / kGroup;
}

/// Bounds of the blocks of a sector's paths. Heights are relative to the ground below the emitter; "lowered"
/// heights are minus the earth's bulge r^2 / (2 a). Arrays, also those of groups, are padded to whole groups.
struct SectorBounds {
  float base_msl_m = 0;
  float tx_m = 0;
  std::vector<float> lowered_m;         ///< largest lowered height of an obstacle
  std::vector<float> tx_slope;          ///< largest slope from the transmitter to a lowered obstacle
  std::vector<float> highest_tx_slope;  ///< the largest over this block and all before it
  /// The same of groups.
  std::vector<float> group_lowered_m, group_tx_slope;
};

/// The line fitted to the terrain in the middle of a sector, for paths that are not clear of the smooth earth
/// above their own ground; made when first needed.
struct SectorTrend {
  /// Per block: sums of the intervals that end at or before its first post.
  std::vector<propagation::TerrainSums> before;
  /// Per block: integral over twice the range of the differences of a path's heights from the middle's, from
  /// the emitter to beyond the block; at most.
  std::vector<float> differences_m2;
};

/// Values common to all paths.
struct Posts {
  DiffractionModel<float> model;
  const double* exact_range_m;
  const SectorPosts* of_sectors;
  const GroundPosts* ground;
  int near_count;                             ///< GroundPosts
  const float *first_m, *last_m;              ///< per block: ranges of its obstacles
  const float *group_first_m, *group_last_m;  ///< per group
  /// In groups (SectorPosts), of the ranges that a post stands for: the least bulge of the earth r^2 / (2 a),
  /// and 1 / r of the nearest and the farthest.
  const float *lowering_m, *per_nearest, *per_farthest;
  const float* has_clutter;  ///< in groups: 1, or 0 near the emitter
  const BlockCover* cover;   ///< by which profiles are raised; null: they are not
  float highest_cover_m, longest_chord_m, longest_chord_beside_m;
};

/// Work of one thread.
struct PathMemory {
  std::vector<float> range_m, height_m;  ///< of the posts of the blocks that were read, kOfBlock each
  std::vector<int> read_for;             ///< per block: number of the path for which it was read
  std::vector<int> raised_for;           ///< the same for its clutter
  std::vector<int> columns;              ///< per block: number of the posts on columns
  std::vector<unsigned> doubtful;        ///< per block: posts whose heights are upper bounds, as bits
  /// The posts for clutter (GroundPosts) of the path for which they were read.
  std::vector<float> clutter_m, clutter_height_m;
  std::vector<char> clutter_doubtful;
  int clutter_read_for = 0;
  std::vector<float> rx_m;  ///< heights of the receivers, as inputs of the model
  std::vector<int> rx_block,
      nu_block;  ///< per height: the blocks that determined the loss of the previous path
  int tx_block = 0;
  bool is_left = false;  ///< the path has a void, or a block of too many posts
  SectorTrend trend;
  /// Paths of the sector that were searched, and of their receivers, path by path: nu and distance of the
  /// edge, and the loss.
  std::vector<const SectorPath*> searched;
  std::vector<float> nu, distance_m, loss_db;
};

/// A search for a maximum of the posts of a path.
struct Maximum {
  float value;
  int block;              ///< that holds it
  bool is_bound = false;  ///< the true value may be less
};

/// The path to a column.
struct Path {
  float distance_m;
  int before;  ///< last regular post before the receivers
  int blocks;
  float last_m;  ///< largest range of an obstacle
  int number;
  float aside;     ///< in the sector, -1..1
  float chord_m;   ///< length of the chords of its profile
  float beside_m;  ///< largest distance from its profile's path
  double exact_distance_m;
};

/// The crossings of a short straight part of a path with columns or rows.
struct Lines {
  float begin, length;  ///< coordinate whose integers are the lines
  float per_length;
  int first, step, count;

  /// @param overlap  the part begins earlier by this
  Lines(float begin_at, float end_at, float overlap) : begin(begin_at), length(end_at - begin_at) {
    const bool rises = length > 0;
    const int cell = static_cast<int>(rises ? begin - overlap : begin + overlap),
              last = static_cast<int>(end_at);
    first = rises ? cell + 1 : cell;
    step = rises ? 1 : -1;
    count = rises ? last - cell : cell - last;
    per_length = count > 0 ? 1 / length : 0;
  }
  float partOf(int line) const {
    const float part = (static_cast<float>(line) - begin) * per_length;
    return part > 0 ? (part < 1 ? part : 1.0f) : 0.0f;
  }
};

/// Finds the maxima over the posts of a path.
class Search {
 public:
  Search(const Posts& posts, const SectorTerrain& terrain, const SectorBounds& bounds, PathMemory& memory,
         const Path& path)
      : posts_(posts), terrain_(terrain), bounds_(bounds), memory_(memory), path_(path) {}

  /// @param boundOf(lowered_m, tx_slope, first_m, last_m)  bound of valueOf over obstacles at those ranges
  /// @param valueOf(range_m, height_m)                     of an obstacle
  /// @param most  start of the search; receives the maximum
  template <class BoundOf, class ValueOf>
  void operator()(const BoundOf& boundOf, const ValueOf& valueOf, Maximum& most) const {
    if (posts_.cover != nullptr) visitClutter(valueOf, most);
    const int guess = std::min(most.block, path_.blocks - 1);
    const float farthest_m = path_.last_m;
    const auto clipped = [farthest_m](float last_m) { return last_m < farthest_m ? last_m : farthest_m; };
    if (boundOf(bounds_.lowered_m[guess], bounds_.tx_slope[guess], posts_.first_m[guess],
                clipped(posts_.last_m[guess])) > most.value) {
      visit(guess, valueOf, most);
    }
    const auto visitBlock = [&](int block) {
      if (block != guess) visit(block, valueOf, most);
    };
    const auto visitGroup = [&](int group) {
      descend(group, path_.blocks, bounds_.lowered_m.data(), bounds_.tx_slope.data(), posts_.first_m,
              posts_.last_m, clipped, boundOf, most, visitBlock);
    };
    const int groups = groupsOf(path_.blocks);
    for (int of_groups = groupsOf(groups) - 1; of_groups >= 0; --of_groups) {
      descend(of_groups, groups, bounds_.group_lowered_m.data(), bounds_.group_tx_slope.data(),
              posts_.group_first_m, posts_.group_last_m, clipped, boundOf, most, visitGroup);
    }
    memory_.is_left = memory_.is_left || most.is_bound;
  }

 private:
  /// Visits those of kGroup blocks or groups whose bound exceeds the maximum, the farthest first.
  /// @param count  of all blocks or groups
  template <class Clipped, class BoundOf, class Visit>
  static void descend(int group, int count, const float* lowered_m, const float* tx_slope,
                      const float* first_m, const float* last_m, const Clipped& clipped,
                      const BoundOf& boundOf, const Maximum& most, const Visit& visitOne) {
    const int begin = group * kGroup;
    const float least = most.value;
    float bound[kGroup];
    unsigned exceeds = 0;  // bit i: the bound of i exceeds the maximum
#pragma omp simd reduction(| : exceeds)
    for (int i = 0; i < kGroup; ++i) {
      bound[i] =
          boundOf(lowered_m[begin + i], tx_slope[begin + i], first_m[begin + i], clipped(last_m[begin + i]));
      exceeds |= (bound[i] > least ? 1u : 0u) << i;
    }
    if (count - begin < kGroup) exceeds &= (1u << (count - begin)) - 1;
    while (exceeds != 0) {
      const int i = 31 - __builtin_clz(exceeds);
      exceeds &= ~(1u << i);
      if (bound[i] > most.value) visitOne(begin + i);
    }
  }

  template <class ValueOf>
  void visit(int block, const ValueOf& valueOf, Maximum& most) const {
    constexpr float kRounding = 1e-5f;
    read(block);
    const bool is_raised = posts_.cover != nullptr;
    const float *const range_m = memory_.range_m.data() + block * kOfBlock, *const height_m =
                                                                                memory_.height_m.data() +
                                                                                block * kOfBlock;
    float highest_m = 0;
    const auto largestOf = [&](int begin, int end) {
      const float raised_m = highest_m;
      float largest = -HUGE_VALF;
#pragma omp simd reduction(max : largest)
      for (int i = begin; i < end; ++i) {
        const float value = valueOf(range_m[i], height_m[i] + raised_m);
        largest = value > largest ? value : largest;
      }
      return largest;
    };
    const auto largestOfAll = [&] {
      const float largest = largestOf(0, kCrossings);
      if (!is_raised && block * kBlock >= posts_.near_count) return largest;
      return std::max(largest, largestOf(kCrossings, kOfBlock));
    };
    if (is_raised && memory_.raised_for[block] != path_.number) {
      highest_m = terrain_.cover_m()[block];
      if (!(largestOfAll() > most.value)) return;
      memory_.is_left = memory_.is_left || !(highest_m < HUGE_VALF);
      highest_m = 0;
      memory_.raised_for[block] = path_.number;
      raise(block);
    }
    const float largest = largestOfAll();
    if (!(largest > most.value)) return;
    bool is_bound = false;
    for (unsigned left = is_raised ? memory_.doubtful[block] : 0; left != 0; left &= left - 1) {
      const int i = __builtin_ctz(left);
      is_bound = is_bound || valueOf(range_m[i], height_m[i]) >= largest - kRounding * std::fabs(largest);
    }
    most = {largest, block, is_bound};
  }

  /// The posts for clutter, first of all: they often decide.
  template <class ValueOf>
  void visitClutter(const ValueOf& valueOf, Maximum& most) const {
    if (memory_.clutter_read_for != path_.number) readClutter();
    for (std::size_t i = 0; i < memory_.clutter_m.size(); ++i) {
      const float value = valueOf(memory_.clutter_m[i], memory_.clutter_height_m[i]);
      if (value > most.value) most = {value, most.block, memory_.clutter_doubtful[i] != 0};
    }
  }

  /// Reads the posts for clutter, by the blocks in which they are.
  void readClutter() const {
    constexpr int kAtOnce = kOfBlock - kCrossings;
    memory_.clutter_read_for = path_.number;
    memory_.clutter_m.clear();
    memory_.clutter_height_m.clear();
    memory_.clutter_doubtful.clear();
    const GroundPosts& ground = *posts_.ground;
    float range_m[kOfBlock], height_m[kOfBlock];
    int block = 0, count = 0;
    const auto raiseAll = [&] {
      if (count == 0) return;
      for (int i = 0; i < kOfBlock; ++i) {
        if (i >= kCrossings && i < kCrossings + count) continue;
        range_m[i] = posts_.first_m[block];
        height_m[i] = -HUGE_VALF;
      }
      const unsigned doubtful = posts_.cover->raise(lineOf(block), 0, path_.distance_m, path_.beside_m,
                                                    bounds_.base_msl_m, range_m, height_m);
      for (int i = kCrossings; i < kCrossings + count; ++i) {
        memory_.is_left = memory_.is_left || std::isnan(height_m[i]);
        memory_.clutter_m.push_back(range_m[i]);
        memory_.clutter_height_m.push_back(height_m[i]);
        memory_.clutter_doubtful.push_back((doubtful >> i & 1) != 0);
      }
      count = 0;
    };
    for (int n = 0; n < ground.clutterPosts(); ++n) {
      const double at_m = ground.clutterPost_m(n, path_.exact_distance_m);
      if (!isClutterAt(at_m, path_.exact_distance_m)) continue;
      const auto here_m = static_cast<float>(at_m);
      int of_post = std::min(ground.lastBefore(at_m) / kBlock, path_.blocks - 1);
      if (of_post + 1 < path_.blocks && here_m > posts_.last_m[of_post]) ++of_post;
      if (of_post != block || count == kAtOnce) raiseAll();
      block = of_post;
      const SectorChord& chord = terrain_.chord(block / posts_.of_sectors->blocksPerChord());
      const float first = posts_.of_sectors->firstPart()[block];
      const float part =
          first + (here_m - posts_.first_m[block]) / lengthOf_m(block) * (lastPartOf(block) - first);
      range_m[kCrossings + count] = here_m;
      height_m[kCrossings + count++] = bilinearHeight(chord.corner_msl_m, terrain_.rowPosts(),
                                                      alongPath(chord.column, path_.aside).at(part),
                                                      alongPath(chord.row, path_.aside).at(part)) -
                                       bounds_.base_msl_m;
    }
    raiseAll();
  }

  float lengthOf_m(int block) const {
    return std::min(posts_.last_m[block], path_.last_m) - posts_.first_m[block];
  }
  /// Exactly where the next block begins, if the path reaches it: no crossing is between them.
  float lastPartOf(int block) const {
    const float first = posts_.of_sectors->firstPart()[block], last = posts_.of_sectors->lastPart()[block];
    const float whole_m = posts_.last_m[block] - posts_.first_m[block], length_m = lengthOf_m(block);
    return length_m < whole_m ? first + (last - first) * length_m / whole_m : last;
  }

  /// The part of the path in a block, which is straight, within 0.1 mm.
  RasterLine lineOf(int block) const {
    const SectorPosts& of_sectors = *posts_.of_sectors;
    const SectorChord& chord = terrain_.chord(block / of_sectors.blocksPerChord());
    const float first_m = posts_.first_m[block], length_m = lengthOf_m(block);
    const float first_part = of_sectors.firstPart()[block], last_part = lastPartOf(block);
    const auto column = alongPath(chord.column, path_.aside), row = alongPath(chord.row, path_.aside);
    const auto begin_column = static_cast<double>(column.at(first_part)),
               begin_row = static_cast<double>(row.at(first_part));
    return {begin_column + chord.corner_column,
            begin_row + chord.corner_row,
            static_cast<double>(column.at(last_part)) - begin_column,
            static_cast<double>(row.at(last_part)) - begin_row,
            first_m,
            length_m};
  }

  /// Adds the clutter to the posts of a block.
  void raise(int block) const {
    memory_.doubtful[block] = posts_.cover->raise(
        lineOf(block), memory_.columns[block], path_.distance_m, path_.beside_m, bounds_.base_msl_m,
        memory_.range_m.data() + block * kOfBlock, memory_.height_m.data() + block * kOfBlock);
  }

  /// Reads the posts of a block. Its part of the path is straight, within 0.1 mm, and unused places are below
  /// everything.
  void read(int block) const {
    if (memory_.read_for[block] == path_.number) return;
    memory_.read_for[block] = path_.number;
    const SectorPosts& of_sectors = *posts_.of_sectors;
    const int index = block / of_sectors.blocksPerChord();
    const SectorChord& chord = terrain_.chord(index);
    const Parabola<float> column = alongPath(chord.column, path_.aside),
                          row = alongPath(chord.row, path_.aside);
    const float first_m = posts_.first_m[block], length_m = lengthOf_m(block);
    const float first_part = of_sectors.firstPart()[block], last_part = lastPartOf(block);
    float* const range_m = memory_.range_m.data() + block * kOfBlock;
    float* const height_m = memory_.height_m.data() + block * kOfBlock;
    const float* const corner = chord.corner_msl_m;
    const int row_posts = terrain_.rowPosts();
    const float base_msl_m = bounds_.base_msl_m;
    // Chords meet within rounding: the first block of one begins a little earlier.
    const float overlap = block > 0 && block == index * of_sectors.blocksPerChord() ? 1e-4f : 0;
    const Lines columns(column.at(first_part), column.at(last_part), overlap);
    const Lines rows(row.at(first_part), row.at(last_part), overlap);
    const int column_count = columns.count, count = column_count + rows.count;
    memory_.is_left = memory_.is_left || count > kCrossings;
    memory_.columns[block] = column_count;
#pragma omp simd
    for (int n = 0; n < kCrossings; ++n) {
      const int of_row = n < count ? n - column_count : 0;
      const int line_column = columns.first + columns.step * n, line_row = rows.first + rows.step * of_row;
      const float part = n < column_count ? columns.partOf(line_column) : rows.partOf(line_row);
      const float x = columns.begin + part * columns.length, y = rows.begin + part * rows.length;
      const int i = n < column_count ? line_column : static_cast<int>(x);
      const int j = n < column_count ? static_cast<int>(y) : line_row;
      const int post = j * row_posts + i, next = post + (n < column_count ? row_posts : 1);
      const float along = n < column_count ? y - static_cast<float>(j) : x - static_cast<float>(i);
      const float here = lerp(corner[post], corner[next], along) - base_msl_m;
      range_m[n] = first_m + part * length_m;
      height_m[n] = n < count ? here : -HUGE_VALF;
    }
    const int first_post = block * kBlock;
    for (int i = 0; first_post < posts_.near_count && i < kBlock; ++i) {
      const int post = first_post + i;
      const bool is_read = post > 0 && post < posts_.near_count && post <= path_.before;
      const float part = of_sectors.part()[is_read ? post : 0];
      const float here = bilinearHeight(corner, row_posts, column.at(part), row.at(part)) - base_msl_m;
      range_m[kCrossings + i] = is_read ? of_sectors.range_m()[post] : first_m;
      height_m[kCrossings + i] = is_read ? here : -HUGE_VALF;
    }
    const bool is_near = first_post < posts_.near_count;
    if (posts_.cover != nullptr && !is_near) {
      for (int i = kCrossings; i < kOfBlock; ++i) {
        range_m[i] = first_m;
        height_m[i] = -HUGE_VALF;
      }
      // Profiles have posts at the beginnings of chords.
      const float next_m = std::ceil(first_m / path_.chord_m) * path_.chord_m;
      if (next_m < first_m + length_m) {
        const float part = first_part + (next_m - first_m) / length_m * (last_part - first_part);
        range_m[kCrossings] = next_m;
        height_m[kCrossings] = bilinearHeight(corner, row_posts, column.at(part), row.at(part)) - base_msl_m;
      }
    }
    if (!(terrain_.slack_m()[block] < HUGE_VALF)) {
      const int stored = is_near || posts_.cover != nullptr ? kOfBlock : kCrossings;
      for (int i = 0; i < stored; ++i) memory_.is_left = memory_.is_left || std::isnan(height_m[i]);
    }
  }

  const Posts& posts_;
  const SectorTerrain& terrain_;
  const SectorBounds& bounds_;
  PathMemory& memory_;
  const Path& path_;
};

/// Finds nu of Bullington's edge for receivers clear of the smooth earth, lowest first.
/// @param rx_m  heights, relative to the base
inline void findEdges(const Posts& posts, const SectorBounds& bounds, const Path& path, const Search& search,
                      const float* rx_m, int count, PathMemory& memory, float* nu_of) {
  const float d = path.distance_m, tx_m = bounds.tx_m;
  const float k = posts.model.half_curvature, bulge = k * d;
  const int last = path.blocks - 1;
  // The known part of the steepest post, which is only searched for if it may be above the line of sight.
  float steepest = bounds.highest_tx_slope[last];
  bool is_found = false;
  for (int n = 0; n < count; ++n) {
    const float rx = rx_m[n], slope = (rx - tx_m) / d;
    if (!is_found && steepest + bulge >= slope) {
      Maximum most{-HUGE_VALF, memory.tx_block};
      search([](float, float tx_slope, float, float) { return tx_slope; },
             [=](float range, float height) { return (height - k * range * range - tx_m) * (1 / range); },
             most);
      memory.tx_block = most.block;
      steepest = most.value;
      is_found = true;
    }
    float nu;
    if (steepest + bulge >= slope) {
      Maximum most{-HUGE_VALF, memory.rx_block[n]};
      search(
          [=](float lowered, float, float first_m, float last_m) {
            const float above = lowered + bulge * d - rx;
            return above / (d - (above > 0 ? last_m : first_m)) - bulge;
          },
          [=](float range, float height) { return (height - rx) * (1 / (d - range)) + k * range; }, most);
      memory.rx_block[n] = most.block;
      nu = propagation::bullingtonEdgeNu(posts.model, d, slope, steepest + bulge, most.value);
    } else {
      const float factor2 = 2 * d / posts.model.earth.wavelength_m, rise = bulge - slope, half = d / 2;
      Maximum most{propagation::kKnifeEdgeClear<float>, memory.nu_block[n]};
      search(
          [=](float lowered, float, float first_m, float last_m) {
            const float above = lowered - tx_m + rise * (rise > 0 ? last_m : first_m);
            const float widest = half < first_m ? first_m : half > last_m ? last_m : half;
            const float below = above * std::sqrt(factor2 / (widest * (d - widest)));
            return above >= 0 ? HUGE_VALF : below;
          },
          [=](float range, float height) {
            const float beyond = d - range;
            return (height - tx_m + k * range * beyond - slope * range) *
                   std::sqrt(factor2 / (range * beyond));
          },
          most);
      memory.nu_block[n] = most.block;
      nu = most.value;
      if (nu <= propagation::kKnifeEdgeClear<float>) {  // and so are those above
        for (; n < count; ++n) nu_of[n] = nu;
        return;
      }
    }
    nu_of[n] = nu;
  }
}

/// Computes bounds of the blocks of a sector from the heights in its middle.
EMSCAPE_SIMD_CLONES void setBounds(const Posts& posts, const SectorTerrain& terrain, float tx_msl_m,
                                   SectorBounds& bounds) {
  const float base = terrain.base_msl_m(), tx = posts.model.raised_m(tx_msl_m - base, 0);
  bounds.base_msl_m = base;
  bounds.tx_m = tx;
  const int blocks = terrain.blocks(), groups = groupsOf(blocks);
  float max_slope = -HUGE_VALF;  // the largest so far
  for (int g = 0; g < groups; ++g) {
    const int begin = g * kGroup;
    const float *const slack_m = terrain.slack_m() + begin, *const cover_m = terrain.cover_m() + begin;
    float *const lowered = bounds.lowered_m.data() + begin, *const steepest = bounds.tx_slope.data() + begin;
#pragma omp simd
    for (int n = 0; n < kGroup; ++n) lowered[n] = steepest[n] = -HUGE_VALF;
    for (int j = 0; j < kBlock; ++j) {
      const int first = (g * kBlock + j) * kGroup;
      const float* const height_msl_m = terrain.height_msl_m() + first;
      const float *const lowering_m = posts.lowering_m + first, *const has_clutter =
                                                                    posts.has_clutter + first;
      const float *const per_nearest = posts.per_nearest + first, *const per_farthest =
                                                                      posts.per_farthest + first;
#pragma omp simd
      for (int n = 0; n < kGroup; ++n) {
        const float raised_m = has_clutter[n] > 0 ? cover_m[n] : 0.0f;
        const float here = height_msl_m[n] - base - lowering_m[n] + slack_m[n] + raised_m;
        const float above = here - tx, slope = above * (above > 0 ? per_nearest[n] : per_farthest[n]);
        lowered[n] = here > lowered[n] ? here : lowered[n];
        steepest[n] = slope > steepest[n] ? slope : steepest[n];
      }
    }
    float group_lowered = -HUGE_VALF, group_steepest = -HUGE_VALF;
    const int count = std::min(kGroup, blocks - begin);
    for (int n = 0; n < kGroup; ++n) {
      lowered[n] = n < count ? lowered[n] : -HUGE_VALF;
      steepest[n] = n < count ? steepest[n] : -HUGE_VALF;
      group_lowered = std::max(group_lowered, lowered[n]);
      group_steepest = std::max(group_steepest, steepest[n]);
    }
    bounds.group_lowered_m[g] = group_lowered;
    bounds.group_tx_slope[g] = group_steepest;
    for (int n = 0; n < count; ++n) {
      max_slope = std::max(max_slope, steepest[n]);
      bounds.highest_tx_slope[begin + n] = max_slope;
    }
  }
  for (int g = groups; g < groupsOf(groups) * kGroup; ++g) {
    bounds.group_lowered_m[g] = bounds.group_tx_slope[g] = -HUGE_VALF;
  }
}

/// Height in the middle of the sector, relative to the base.
inline double middleHeight_m(const SectorTerrain& terrain, const SectorBounds& bounds, int post) {
  if (post == 0) return 0;
  return static_cast<double>(terrain.height_msl_m()[SectorPosts::inGroups(post)] - bounds.base_msl_m);
}

void setTrend(const Posts& posts, const SectorTerrain& terrain, const SectorBounds& bounds,
              SectorTrend& trend) {
  propagation::TerrainSums sums;
  double before_m = 0, height_before_m = 0, differences_m2 = 0;
  for (int post = 0; post < terrain.posts(); ++post) {
    const double range_m = posts.exact_range_m[post];
    const double height_m = middleHeight_m(terrain, bounds, post);
    sums.add(before_m, height_before_m, range_m, height_m);
    before_m = range_m;
    height_before_m = height_m;
    if (post % kBlock != 0) continue;
    const int beyond = std::min(post + kBlock, posts.of_sectors->count() - 1);
    const double length_m = posts.exact_range_m[beyond] - posts.exact_range_m[std::max(post - 1, 0)];
    differences_m2 += 2 * length_m * static_cast<double>(terrain.acrossSlack_m()[post / kBlock]);
    trend.before.push_back(sums);
    trend.differences_m2.push_back(static_cast<float>(differences_m2));
  }
}

/// True if the smooth earth has no loss for a receiver and those above: see LaneColumn::isClearOfEarth().
inline bool isClearOfEarth(const Posts& posts, const SectorTerrain& terrain, const SectorBounds& bounds,
                           const SectorPath& to, const Path& path, float rx_m, SectorTrend& trend) {
  const DiffractionModel<float>& model = posts.model;
  const float ground_m = to.ground_msl_m - bounds.base_msl_m;
  const auto isClear = [&](float tx, float rx) {
    return isClearThroughout(model.earth, path.distance_m, sightLine(model.earth, path.distance_m, tx, rx));
  };
  if (isClear(bounds.tx_m, rx_m - ground_m)) return true;
  if (trend.before.empty()) setTrend(posts, terrain, bounds, trend);
  const int block = path.before / kBlock;
  propagation::TerrainSums sums = trend.before[block];
  double before_m = posts.exact_range_m[block * kBlock];
  double height_before_m = middleHeight_m(terrain, bounds, block * kBlock);
  const auto add = [&](double range_m, double height_m) {
    sums.add(before_m, height_before_m, range_m, height_m);
    before_m = range_m;
    height_before_m = height_m;
  };
  for (int post = block * kBlock + 1; post <= path.before; ++post) {
    add(posts.exact_range_m[post], middleHeight_m(terrain, bounds, post));
  }
  add(to.distance_m, static_cast<double>(ground_m));
  // The weight of a height in either end of the line is at most twice that in the mean height.
  // Clutter of one height along two thirds of the path, where the weights are positive, raises it by 4/3 of
  // it.
  const float most_m = 2 * trend.differences_m2[block] / path.distance_m + posts.highest_cover_m * (4.0f / 3);
  propagation::TerrainTrend<float> highest{};
  highest.start_msl_m = static_cast<float>(sums.start_m(to.distance_m)) + most_m;
  highest.end_msl_m = static_cast<float>(sums.end_m(to.distance_m)) + most_m;
  highest.rx_ground_msl_m = ground_m;
  const auto least = effectiveHeights(highest, bounds.tx_m, rx_m);
  return isClear(least.tx_m, least.rx_m);
}

/// Largest distance between a path of a sector and the same in chords of a profile, whose deviation grows by
/// the cube of their length. @see terrain_walk.h
inline float besideProfile_m(const Posts& posts, float chord_m) {
  constexpr float kRounding_m = 0.005f;
  const float part = chord_m / posts.longest_chord_m;
  return kRounding_m + posts.longest_chord_beside_m * part * part * part;
}

/// The paths of one sector.
struct SectorTask {
  const ExcessTask<propagation::DiffractionExcess>& task;
  const SectorPath *begin, *end;
  double half_width_rad;
  const ExcessOutput& out;
  char* is_left;
};

/// Sets the excess of the paths that were searched.
inline void setLosses(const SectorTask& sector, PathMemory& memory) {
  const ExcessGrid& grid = sector.task.grid;
  const int receivers = static_cast<int>(memory.searched.size()) * grid.layers;
  const float *const nu = memory.nu.data(), *const distance_m = memory.distance_m.data();
  float* const loss_db = memory.loss_db.data();
#pragma omp simd
  for (int i = 0; i < receivers; ++i) {
    loss_db[i] = propagation::bullingtonLossInLoopDb(nu[i], distance_m[i]);
  }
  float* of_path_db = loss_db;
  for (const SectorPath* const to : memory.searched) {
    const auto column = static_cast<std::size_t>(to->column);
    if (sector.task.terminal.isSet()) {
      for (int n = 0; n < grid.layers; ++n) {
        const auto height_msl_m = static_cast<float>(to->base_msl_m + static_cast<double>(grid.t_m[n]));
        of_path_db[n] = sector.task.terminal.withLossDb(of_path_db[n], static_cast<float>(to->distance_m),
                                                        height_msl_m - to->ground_msl_m);
      }
    }
    if (!sector.task.air.isClear()) {
      const propagation::AirColumn above(sector.task.air, static_cast<float>(to->distance_m));
      for (int n = 0; n < grid.layers; ++n) {
        of_path_db[n] += above.lossDb(static_cast<float>(to->base_msl_m + static_cast<double>(grid.t_m[n])));
      }
    }
    for (int n = 0; n < grid.layers; ++n) {
      sector.out.excess.set(n * grid.column_count + column, of_path_db[n]);
    }
    sector.is_left[column] = 0;
    of_path_db += grid.layers;
  }
}

EMSCAPE_SIMD_CLONES void fillSector(const SectorTask& sector, const Posts& all_posts,
                                    const SectorTerrain& terrain, const SectorBounds& bounds,
                                    PathMemory& memory) {
  constexpr int kMinPosts = 16;  // shorter paths are read as fast
  const Posts posts = all_posts;
  const ExcessGrid& grid = sector.task.grid;
  const DiffractionModel<float>& model = posts.model;
  const float per_rad = static_cast<float>(1 / sector.half_width_rad);
  const auto layers = static_cast<std::size_t>(grid.layers);
  const std::size_t receivers = static_cast<std::size_t>(sector.end - sector.begin) * layers;
  memory.searched.clear();
  memory.trend.before.clear();
  memory.trend.differences_m2.clear();
  for (std::vector<float>* const array : {&memory.nu, &memory.distance_m, &memory.loss_db}) {
    if (array->size() < receivers) array->resize(receivers);
  }
  Path path{};
  for (const SectorPath* to = sector.begin; to < sector.end; ++to) {
    path.distance_m = static_cast<float>(to->distance_m);
    path.exact_distance_m = to->distance_m;
    path.before = sector.task.ground.lastBefore(to->distance_m);
    path.last_m = path.distance_m * (1 - 3e-7f);
    path.aside = to->aside_rad * per_rad;
    path.chord_m = path.distance_m / (std::floor(path.distance_m / posts.longest_chord_m) + 1);
    path.beside_m = besideProfile_m(posts, path.chord_m);
    ++path.number;
    if (path.before < kMinPosts || path.before + 1 >= terrain.posts()) continue;
    const bool is_beyond = path.last_m > posts.of_sectors->farthest_m()[path.before];
    path.blocks = (path.before + (is_beyond ? 1 : 0)) / kBlock + 1;
    const float ground_m = to->ground_msl_m - bounds.base_msl_m;
    for (int n = 0; n < grid.layers; ++n) {
      const auto height_msl_m = static_cast<float>(to->base_msl_m + static_cast<double>(grid.t_m[n]));
      const float here_m = sector.task.modelHeight_m(to->distance_m, height_msl_m);
      memory.rx_m[n] = model.raised_m(here_m - bounds.base_msl_m, ground_m);
    }
    if (!isClearOfEarth(posts, terrain, bounds, *to, path, memory.rx_m[0], memory.trend)) continue;
    memory.is_left = false;
    const std::size_t first = memory.searched.size() * layers;
    findEdges(posts, bounds, path, Search(posts, terrain, bounds, memory, path), memory.rx_m.data(),
              grid.layers, memory, memory.nu.data() + first);
    if (memory.is_left) continue;
    memory.searched.push_back(to);
    std::fill_n(memory.distance_m.begin() + static_cast<std::ptrdiff_t>(first), layers, path.distance_m);
  }
  setLosses(sector, memory);
}

}  // namespace

std::vector<char> fillSurfaceDiffraction(const ExcessTask<propagation::DiffractionExcess>& task,
                                         const TerrainBounds& bounds, const ExcessOutput& out) {
  std::vector<char> is_left(task.grid.column_count, 1);
  const SectorPosts sector_posts(task.station, task.ground);
  const int sector_count = PathSectors::countFor(task.ground, task.grid.column_count);
  if (!sector_posts.isUsable() || sector_count == 0) return is_left;
  const PathSectors sectors(task.station, task.grid, sector_count);

  const int blocks = sector_posts.blocks(), groups = groupsOf(blocks);
  std::vector<float> group_first_m, group_last_m, first_m, last_m;
  first_m.assign(sector_posts.first_m(), sector_posts.first_m() + blocks);
  last_m.assign(sector_posts.last_m(), sector_posts.last_m() + blocks);
  first_m.resize(groups * kGroup, first_m.back());
  last_m.resize(groups * kGroup, last_m.back());
  for (int g = 0; g < groups; ++g) {
    group_first_m.push_back(first_m[g * kGroup]);
    group_last_m.push_back(last_m[(g + 1) * kGroup - 1]);
  }
  const int padded_groups = groupsOf(groups) * kGroup;
  group_first_m.resize(padded_groups, group_first_m.back());
  group_last_m.resize(padded_groups, group_last_m.back());
  std::vector<float> lowering_m, per_nearest, per_farthest, has_clutter;
  for (const int post : sector_posts.postsInGroups()) {
    const float nearest_m = sector_posts.nearest_m()[post];
    lowering_m.push_back(task.model.model.half_curvature * nearest_m * nearest_m);
    per_nearest.push_back(1 / nearest_m);
    per_farthest.push_back(1 / sector_posts.farthest_m()[post]);
    has_clutter.push_back(static_cast<double>(sector_posts.farthest_m()[post]) > kClutterFree_m ? 1.0f
                                                                                                : 0.0f);
  }
  constexpr double kOf75Degrees = 0.965925826289068;
  const double sine_of_latitude = std::fabs(task.station.geodesy.station.up.z);
  std::optional<BlockCover> cover;
  if (task.ground.is_raised) cover.emplace(task.ground.terrain);
  const Posts posts{task.model.model,
                    task.ground.ranges_m,
                    &sector_posts,
                    &task.ground,
                    task.ground.near_count,
                    first_m.data(),
                    last_m.data(),
                    group_first_m.data(),
                    group_last_m.data(),
                    lowering_m.data(),
                    per_nearest.data(),
                    per_farthest.data(),
                    has_clutter.data(),
                    cover ? &*cover : nullptr,
                    cover ? bounds.highestCoverOfAll_m() : 0,
                    static_cast<float>(maxChord_m(sine_of_latitude)),
                    sine_of_latitude < kOf75Degrees ? 0.02f : 0.1f};
  parallelFor(sectors.count(), 16, [&](int begin, int end) {
    SectorTerrain terrain(task.station, task.ground, bounds, sector_posts);
    SectorBounds of_sector;
    for (auto* const array : {&of_sector.lowered_m, &of_sector.tx_slope, &of_sector.highest_tx_slope}) {
      array->resize(groups * kGroup);
    }
    of_sector.group_lowered_m.resize(padded_groups);
    of_sector.group_tx_slope.resize(padded_groups);
    PathMemory memory;
    memory.range_m.resize(blocks * kOfBlock);
    memory.height_m.resize(blocks * kOfBlock);
    memory.columns.resize(blocks);
    memory.doubtful.resize(blocks);
    memory.rx_m.resize(task.grid.layers);
    memory.rx_block.resize(task.grid.layers);
    memory.nu_block.resize(task.grid.layers);
    for (int sector = begin; sector < end; ++sector) {
      double farthest_m = 0;
      for (const SectorPath* to = sectors.begin(sector); to < sectors.end(sector); ++to) {
        farthest_m = std::max(farthest_m, to->distance_m);
      }
      if (farthest_m == 0) continue;
      terrain.read(sectors.middle(sector), sectors.halfWidth_rad(sector),
                   std::min(task.ground.lastBefore(farthest_m) + 2, task.ground.range_count));
      if (terrain.blocks() == 0) continue;
      setBounds(posts, terrain, task.model.tx_msl_m, of_sector);
      memory.read_for.assign(blocks, 0);
      memory.raised_for.assign(blocks, 0);
      memory.clutter_read_for = 0;
      fillSector({task, sectors.begin(sector), sectors.end(sector), sectors.halfWidth_rad(sector), out,
                  is_left.data()},
                 posts, terrain, of_sector, memory);
    }
  });
  return is_left;
}

}  // namespace emscape::emfield
