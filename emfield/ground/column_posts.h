/// The posts of a column's path, by one thread of the device, which stores none; also on the host, for tests.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/math/device_loop.h"
#include "base/math/device_turn.h"
#include "emfield/ground/chord_crossings.h"
#include "emfield/ground/ground_posts.h"
#include "emscape/base/host_device.h"
#include "propagation/diffraction/smooth_earth.h"

namespace emscape::emfield {

/// A post between the emitter and the receivers.
struct PathPost {
  float range_m, height_msl_m;
};

/// The posts of a path with posts at crossings: see chord_crossings.h. Regular posts elsewhere.
class ColumnPosts {
 public:
  /// @param at_crossings  false: regular posts
  EMSCAPE_HD ColumnPosts(const Station& station, const GroundPosts& ground, const FastInverse& path,
                         bool at_crossings)
      : station_(station), ground_(ground), path_(path), around_(RasterChord{}) {
    if (!at_crossings || ground.is_smooth) regular_chords_ = ~0ull;
  }

  /// Calls visit(PathPost) for the posts from the first one beyond the emitter on, in the order of their
  /// ranges.
  /// @param skips  skips(from (m), to (m), height above mean sea level (m)): true if posts between these
  /// ranges that are not higher may be left out
  /// @return false if the visits are void: a chord was found whose posts are regular ones, and the next call
  /// knows it
  template <class Skips, class Visit>
  EMSCAPE_HD bool each(const Skips& skips, const Visit& visit) {
    const int regular = ground_.lastBefore(path_.distance_m) + 1;
    const bool is_smooth = ground_.is_smooth, with_beginnings = regular_chords_ != ~0ull;
    const Chords of_path = chords();
    ClutterPosts more(ground_, path_.distance_m);
    for (int n = 0; n < of_path.count; ++n) {
      const double begin_m = n * of_path.length_m;
      TerrainChord chord;
      const auto addClutter = [&](double end_m) {
        for (; more.next_m < end_m; more.advance(ground_, path_.distance_m))
          visit(PathPost{fminf(static_cast<float>(more.next_m), farthest_m()),
                         is_smooth ? 0 : heightAt(chord, more.next_m)});
      };
      const auto visitInOrder = [&](const PathPost& post) {
        addClutter(static_cast<double>(post.range_m));
        visit(post);
      };
      const double end_of_chord_m = n + 1 < of_path.count ? begin_m + of_path.length_m : HUGE_VAL;
      if (!is_smooth) prepare(station_, ground_, path_, n, chord);
      int first = n == 0 ? 1 : ground_.lastBefore(begin_m) + 1;
      int end = n + 1 < of_path.count ? ground_.lastBefore(begin_m + of_path.length_m) + 1 : regular;
      const int beginning = n > 0 && with_beginnings ? 1 : 0;
      bool with_crossings = !isRegular(n);
      if (with_crossings) {
        // Posts besides the crossings: the first regular ones, or the chord's beginning.
        const int others = n == 0 ? larger(smaller(ground_.near_count, smaller(end, 128)), 1) - 1 : 1;
        const double* const others_m = n == 0 ? ground_.ranges_m + 1 : &begin_m;
        const Found found =
            eachCrossing(chord, begin_m, of_path.length_m, others_m, others, skips, visitInOrder);
        if (found != Found::all) regular_chords_ |= bitOf(n);
        if (found == Found::void_post) return false;
        with_crossings = found == Found::all;
        if (with_crossings) end = first;
      }
      if (!with_crossings && beginning > 0 && first < end && ground_.ranges_m[first] <= begin_m) ++first;
      EMSCAPE_UNROLL_BY(1)
      for (int i = first - (with_crossings ? 0 : beginning); i < end; ++i) {
        const double range_m = i < first ? begin_m : ground_.ranges_m[i];
        visitInOrder(PathPost{fminf(static_cast<float>(range_m), farthest_m()),
                              is_smooth ? 0 : heightAt(chord, range_m)});
      }
      addClutter(end_of_chord_m);
    }
    return true;
  }

  /// Calls visit(PathPost) for every second regular post, in the order of their ranges.
  template <class Visit>
  EMSCAPE_HD void eachSecondRegular(const Visit& visit) const {
    const int regular = ground_.lastBefore(path_.distance_m) + 1;
    const Chords of_path = chords();
    TerrainChord chord;
    int n = -1;
    EMSCAPE_UNROLL_BY(1)
    for (int i = 1; i < regular; i += 2) {
      const double range_m = ground_.ranges_m[i];
      const int here = smaller(static_cast<int>(range_m / of_path.length_m), of_path.count - 1);
      if (here != n && !ground_.is_smooth) prepare(station_, ground_, path_, here, chord);
      n = here;
      visit(PathPost{fminf(static_cast<float>(range_m), farthest_m()),
                     ground_.is_smooth ? 0 : heightAt(chord, range_m)});
    }
  }

  /// After each().
  EMSCAPE_HD propagation::PostsAround<float> around(float range_m) {
    propagation::PostsAround<float> found;
    const auto add = [&](double at_m) {
      const float here_m = fminf(static_cast<float>(at_m), farthest_m());
      if (here_m < range_m) {
        found.before_m = fmaxf(found.before_m, here_m);
      } else {
        found.after_m = fminf(found.after_m, here_m);
      }
    };
    const int regular = ground_.lastBefore(path_.distance_m) + 1;
    const auto addRegular = [&](int end) {
      const int before = smaller(ground_.lastBefore(static_cast<double>(range_m)), end - 1);
      if (before > 0) add(ground_.ranges_m[before]);
      if (before + 1 < end) add(ground_.ranges_m[before + 1]);
    };
    for (ClutterPosts more(ground_, path_.distance_m); more.next_m < HUGE_VAL;
         more.advance(ground_, path_.distance_m))
      add(more.next_m);
    if (ground_.is_smooth || regular_chords_ == ~0ull) {
      addRegular(regular);
      return found;
    }
    const Chords of_path = chords();
    const double chord_m = of_path.length_m;
    const int n = smaller(static_cast<int>(static_cast<double>(range_m) / chord_m), of_path.count - 1);
    const double begin_m = n * chord_m;
    if (n > 0) add(begin_m);
    if (n + 1 < of_path.count) add(begin_m + chord_m);
    if (isRegular(n)) {
      addRegular(regular);
      return found;
    }
    if (n == 0) addRegular(smaller(ground_.near_count, regular));
    if (n != around_chord_) {
      TerrainChord chord;
      prepare(station_, ground_, path_, n, chord);
      around_ = ChordCrossings(chord.in_raster);
      around_chord_ = n;
    }
    const float part = fminf(static_cast<float>((static_cast<double>(range_m) - begin_m) / chord_m), 1);
    for (const LineCrossings* lines : {&around_.columns, &around_.rows}) {
      const int next = lines->countBefore(part, static_cast<int>(lines->coordinate.at(part)));
      for (int i = larger(next - 1, 0); i < smaller(next + 1, lines->count); ++i)
        add(crossingRange_m(begin_m, chord_m, lines->part(i, lines->line(i)), path_.distance_m));
    }
    return found;
  }

 private:
  enum class Found { all, void_post, too_many };
  /// The ranges of the posts for clutter, one after another; infinite after the last one.
  struct ClutterPosts {
    int n = -1;
    double next_m = HUGE_VAL;

    EMSCAPE_HD ClutterPosts(const GroundPosts& ground, double path_m) { advance(ground, path_m); }
    EMSCAPE_HD void advance(const GroundPosts& ground, double path_m) {
      for (next_m = HUGE_VAL; ++n < ground.clutterPosts();) {
        const double range_m = ground.clutterPost_m(n, path_m);
        if (!isClutterAt(range_m, path_m)) continue;
        next_m = range_m;
        return;
      }
    }
  };
  struct Chords {
    int count;
    double length_m;
  };
  /// HighestOfTiles along a chord, in lines from the chord's corner.
  class TilesAlong {
   public:
    EMSCAPE_HD TilesAlong(const GroundPosts& ground, const float* corner_msl_m, bool by_columns) {
      if (ground.tiles.msl_m == nullptr || ground.has_clutter || ground.is_raised) return;
      const scenario::TerrainRaster& raster = ground.terrain.rasters[0];
      const long long corner = corner_msl_m - raster.heights_msl_m;
      const int row = static_cast<int>(corner / raster.columns);
      const int column = static_cast<int>(corner - static_cast<long long>(row) * raster.columns);
      msl_m_ = ground.tiles.msl_m;
      most_origin_ = by_columns ? column : row;
      few_origin_ = by_columns ? row : column;
      most_step_ = by_columns ? 1 : ground.tiles.columns;
      few_step_ = by_columns ? ground.tiles.columns : 1;
    }
    EMSCAPE_HD bool areKnown() const { return msl_m_ != nullptr; }
    /// The lines from one on that are reached within the tile in which the path is before it.
    EMSCAPE_HD int linesFrom(int line, int direction) const {
      const int in_tile = cellBefore(line, direction) & (HighestOfTiles::kCells - 1);
      return direction > 0 ? HighestOfTiles::kCells - in_tile : in_tile + 1;
    }
    /// Of the cells before these lines, from one across to another.
    EMSCAPE_HD float highest_m(int line, int direction, int cell, int end_cell) const {
      const int first = (few_origin_ + smaller(cell, end_cell)) >> HighestOfTiles::kShift;
      const int last = (few_origin_ + larger(cell, end_cell)) >> HighestOfTiles::kShift;
      if (last - first > 2) return HUGE_VALF;
      const float* const of_lines =
          msl_m_ + (cellBefore(line, direction) >> HighestOfTiles::kShift) * most_step_;
      float highest = of_lines[first * few_step_];
      for (int tile = first + 1; tile <= last; ++tile) highest = fmaxf(highest, of_lines[tile * few_step_]);
      return highest;
    }

   private:
    EMSCAPE_HD int cellBefore(int line, int direction) const {
      return most_origin_ + line - (direction > 0 ? 1 : 0);
    }

    const float* msl_m_ = nullptr;
    int most_origin_ = 0, few_origin_ = 0, most_step_ = 0, few_step_ = 0;
  };

  EMSCAPE_HD Chords chords() const {
    if (ground_.is_smooth) return {1, path_.distance_m};
    const TerrainWalk walk(station_, ground_.terrain, path_);
    return {walk.chords(), walk.chord_m()};
  }

  static EMSCAPE_HD std::uint64_t bitOf(int chord) { return 1ull << smaller(chord, 62); }
  EMSCAPE_HD bool isRegular(int chord) const { return (regular_chords_ & bitOf(chord)) != 0; }
  /// A post may be at the receivers in float.
  EMSCAPE_HD float farthest_m() const { return static_cast<float>(path_.distance_m) * (1 - 2.4e-7f); }

  /// Height above mean sea level (m), with the clutter where that counts; NaN over missing terrain.
  EMSCAPE_HD float heightAt(const TerrainChord& chord, double range_m) const {
    float height_msl_m = chord.in_raster.corner_msl_m != nullptr ? chord.in_raster.heightAt(range_m) : NAN;
    if (std::isnan(height_msl_m)) height_msl_m = amongRasters(ground_, chord, range_m);
    return raised(chord, range_m, height_msl_m);
  }
  EMSCAPE_HD float raised(const TerrainChord& chord, double range_m, float height_msl_m) const {
    return ground_.is_raised ? height_msl_m + clutterAt(chord, range_m, height_msl_m) : height_msl_m;
  }
  // Separate calls, so that their registers are not part of those of the loops over posts.
  EMSCAPE_NOINLINE static EMSCAPE_HD void prepare(const Station& station, const GroundPosts& ground,
                                                  const FastInverse& path, int n, TerrainChord& chord) {
    chord = TerrainWalk(station, ground.terrain, path).chord(n);
  }
  EMSCAPE_NOINLINE static EMSCAPE_HD float amongRasters(const GroundPosts& ground, const TerrainChord& chord,
                                                        double range_m) {
    return chord.heightAmongRasters(ground.terrain, range_m);
  }
  EMSCAPE_NOINLINE EMSCAPE_HD float clutterAt(const TerrainChord& chord, double range_m,
                                              float ground_msl_m) const {
    if (!isClutterAt(range_m, path_.distance_m)) return 0;
    const double part = (range_m - chord.in_raster.begin_m) * chord.in_raster.per_m;
    const float cover_m = ground_.terrain.coverAt(chord.position.latitude_rad.at(part),
                                                  chord.position.longitude_rad.at(part), ground_msl_m);
    return cover_m > 0 ? cover_m : 0;
  }

  /// The crossings of a chord and other posts, in their order: between two crossings with the lines of which
  /// there are more, those with the others.
  template <class Skips, class Visit>
  EMSCAPE_HD Found eachCrossing(const TerrainChord& chord, double begin_m, double chord_m,
                                const double* others_m, int others, const Skips& skips,
                                const Visit& visit) const {
    if (chord.in_raster.corner_msl_m == nullptr) return Found::too_many;
    const ChordCrossings crossings(chord.in_raster);
    if (crossings.count() > ground_.maxCrossings(chord_m)) return Found::too_many;
    const bool by_columns = crossings.columns.count >= crossings.rows.count;
    const LineCrossings most = by_columns ? crossings.columns : crossings.rows;
    const LineCrossings few = by_columns ? crossings.rows : crossings.columns;
    const int row_posts = crossings.row_posts;
    const int most_step = by_columns ? 1 : row_posts, few_step = by_columns ? row_posts : 1;
    const float* const corner_msl_m = crossings.corner_msl_m;
    const auto from_m = static_cast<float>(begin_m), length_m = static_cast<float>(chord_m);
    const float farthest_m = this->farthest_m();
    const bool is_raised = ground_.is_raised;
    const auto rangeAt = [&](float part) {
      return fminf(fmaxf(fmaf(length_m, part, from_m), 0.01f), farthest_m);
    };
    TilesAlong tiles(ground_, corner_msl_m, by_columns);
    int other = 0;
    float other_m = others > 0 ? static_cast<float>(others_m[0]) : HUGE_VALF, unknown = 0;
    const auto nextOther = [&] {
      other_m = ++other < others ? static_cast<float>(others_m[other]) : HUGE_VALF;
    };
    const auto add = [&](float part, float height_msl_m) {
      PathPost post{rangeAt(part), height_msl_m};
      unknown += height_msl_m;
      while (other_m <= post.range_m) {
        visit(PathPost{fminf(other_m, farthest_m), heightAt(chord, others_m[other])});
        nextOther();
      }
      if (is_raised) post.height_msl_m = raised(chord, static_cast<double>(post.range_m), height_msl_m);
      visit(post);
    };
    int cell = few.first_cell;
    float reached = 0;  // part of the chord
    for (int n = 0; n <= most.count;) {
      int end = n + 1;
      if (tiles.areKnown() && n < most.count) {  // as far as to the end of a tile
        const bool is_first = n < most.before_turn;
        const int line = most.line(n), direction = is_first ? most.step : -most.step;
        end = n + smaller(tiles.linesFrom(line, direction), (is_first ? most.before_turn : most.count) - n);
        const float part = partOf(most, is_first, line + direction * (end - 1 - n));
        const int end_cell = static_cast<int>(few.coordinate.at(part));
        const bool turns = few.turn > reached && few.turn < part;
        const float to_m = rangeAt(part);
        if (!turns && skips(rangeAt(reached), to_m, tiles.highest_m(line, direction, cell, end_cell))) {
          cell = end_cell;
          reached = part;
          n = end;
          while (other_m <= to_m) nextOther();
          continue;
        }
        reached = part;
      }
      for (; n < end; ++n) {
        int line = 0, next_cell = few.last_cell;
        float part = 1, across = 0;
        if (n < most.count) {
          line = most.line(n);
          part = partOf(most, n < most.before_turn, line);
          across = few.coordinate.at(part);
          next_cell = static_cast<int>(across);
        }
        while (cell != next_cell) {
          const bool rises = cell < next_cell;
          const int few_line = rises ? cell + 1 : cell;
          const float few_part = partOf(few, rises == (few.to_root > 0), few_line);
          const float along = most.coordinate.at(few_part);
          const int of_most = static_cast<int>(along);
          const float* const near = corner_msl_m + (few_line * few_step + of_most * most_step);
          add(few_part, lerp(near[0], near[most_step], along - static_cast<float>(of_most)));
          cell += rises ? 1 : -1;
        }
        if (n == most.count) continue;
        const float* const near = corner_msl_m + (line * most_step + next_cell * few_step);
        add(part, lerp(near[0], near[few_step], across - static_cast<float>(next_cell)));
      }
    }
    for (; other < others; ++other)
      visit(
          PathPost{fminf(static_cast<float>(others_m[other]), farthest_m), heightAt(chord, others_m[other])});
    return std::isnan(unknown) ? Found::void_post : Found::all;
  }

  /// LineCrossings::part(), within 2e-7.
  static EMSCAPE_HD float partOf(const LineCrossings& of, bool is_first, int line) {
    const float* const c = of.coordinate.c;
    const float to_line = static_cast<float>(line) - c[0];
    const float sum = fmaf(of.to_root, rootOf(fmaxf(fmaf(4 * c[2], to_line, c[1] * c[1]), 0)), c[1]);
    const float part = (is_first ? 2 * to_line : -sum) * approximateReciprocal(is_first ? sum : 2 * c[2]);
    return fminf(fmaxf(part, 0), 1);
  }

  const Station& station_;
  const GroundPosts& ground_;
  const FastInverse& path_;
  int around_chord_ = -1;
  ChordCrossings around_;             ///< of around_chord_
  std::uint64_t regular_chords_ = 0;  ///< by bitOf(); all: the profile has regular posts only
};

}  // namespace emscape::emfield
