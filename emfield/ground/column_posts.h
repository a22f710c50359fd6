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

  /// Calls visit(PathPost) for the posts from the first one beyond the emitter on.
  /// @tparam kOrdered  in the order of their ranges, which takes more time
  /// @param nearest_m  nearer posts may be left out, not with kOrdered
  /// @return false if the visits are void: a chord was found whose posts are regular ones, and the next call
  /// knows it
  template <bool kOrdered, class Visit>
  EMSCAPE_HD bool each(float nearest_m, const Visit& visit) {
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
        if (kOrdered) addClutter(static_cast<double>(post.range_m));
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
        const int others_end = n == 0 ? larger(smaller(ground_.near_count, smaller(end, 128)), 1) : first;
        const double* const others_m = n == 0 ? ground_.ranges_m + 1 : &begin_m;
        const int others = n == 0 ? others_end - 1 : 1;
        const Found found =
            kOrdered ? eachInOrder(chord, begin_m, of_path.length_m, others_m, others, visitInOrder)
                     : eachCrossing(chord, begin_m, of_path.length_m, nearest_m, visit);
        if (found != Found::all) regular_chords_ |= bitOf(n);
        if (found == Found::void_post) return false;
        with_crossings = found == Found::all;
        if (with_crossings) end = kOrdered ? first : others_end;
      }
      if (!with_crossings && beginning > 0 && first < end && ground_.ranges_m[first] <= begin_m) ++first;
      EMSCAPE_UNROLL_BY(1)
      for (int i = first - (with_crossings && kOrdered ? 0 : beginning); i < end; ++i) {
        const double range_m = i < first ? begin_m : ground_.ranges_m[i];
        if (with_crossings && range_m < static_cast<double>(nearest_m)) continue;
        visitInOrder(PathPost{fminf(static_cast<float>(range_m), farthest_m()),
                              is_smooth ? 0 : heightAt(chord, range_m)});
      }
      addClutter(end_of_chord_m);
    }
    return true;
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

  /// The crossings of a chord, column by column, then row by row.
  template <class Visit>
  EMSCAPE_HD Found eachCrossing(const TerrainChord& chord, double begin_m, double chord_m, float nearest_m,
                                const Visit& visit) const {
    if (chord.in_raster.corner_msl_m == nullptr) return Found::too_many;
    const ChordCrossings crossings(chord.in_raster);
    if (crossings.count() > ground_.maxCrossings(chord_m)) return Found::too_many;
    const float* const corner_msl_m = crossings.corner_msl_m;
    const int row_posts = crossings.row_posts;
    const auto from_m = static_cast<float>(begin_m), length_m = static_cast<float>(chord_m);
    const float farthest_m = this->farthest_m();
    const bool is_raised = ground_.is_raised;
    const float nearest_part = (nearest_m - from_m) / length_m;
    float unknown = 0;
    EMSCAPE_UNROLL_BY(1)
    for (int run = 0; run < 4; ++run) {  // before and after the turn of columns and rows
      const bool of_columns = run < 2, is_first = run % 2 == 0;
      const LineCrossings lines = of_columns ? crossings.columns : crossings.rows;
      const Parabola<float> across = of_columns ? crossings.rows.coordinate : crossings.columns.coordinate;
      int first = is_first ? 0 : lines.before_turn;
      if (nearest_part > 0) {
        const float part = fminf(nearest_part, 1);
        first = larger(first, lines.countBefore(part, static_cast<int>(lines.coordinate.at(part))) - 1);
      }
      const int end = is_first ? lines.before_turn : lines.count;
      if (first >= end) continue;
      const int line_step = of_columns ? 1 : row_posts, cell_step = of_columns ? row_posts : 1;
      const int step = (lines.to_root > 0) == is_first ? 1 : -1;
      const float c1 = lines.coordinate.c[1], square = c1 * c1, c2 = lines.coordinate.c[2];
      const int first_line = lines.line(first);
      float to_line = static_cast<float>(first_line) - lines.coordinate.c[0];
      const float* line_msl_m = corner_msl_m + static_cast<long long>(first_line) * line_step;
      EMSCAPE_UNROLL_BY(2)
      for (int n = first; n < end; ++n) {
        const float sum = fmaf(lines.to_root, rootOf(fmaxf(fmaf(4 * c2, to_line, square), 0)), c1);
        float part = (is_first ? 2 * to_line : -sum) * approximateReciprocal(is_first ? sum : 2 * c2);
        part = fminf(fmaxf(part, 0), 1);
        const float at = across.at(part);
        const int cell = static_cast<int>(at);
        const float* const near = line_msl_m + cell * cell_step;
        PathPost post;
        post.height_msl_m = lerp(near[0], near[cell_step], at - static_cast<float>(cell));
        post.range_m = fminf(fmaxf(fmaf(length_m, part, from_m), 0.01f), farthest_m);
        unknown += post.height_msl_m;
        if (is_raised)
          post.height_msl_m = raised(chord, static_cast<double>(post.range_m), post.height_msl_m);
        visit(post);
        to_line += static_cast<float>(step);
        line_msl_m += step * line_step;
      }
    }
    return std::isnan(unknown) ? Found::void_post : Found::all;
  }

  /// The crossings of a chord and other posts, in their order: between two crossings with the lines of which
  /// there are more, those with the others.
  template <class Visit>
  EMSCAPE_HD Found eachInOrder(const TerrainChord& chord, double begin_m, double chord_m,
                               const double* others_m, int others, const Visit& visit) const {
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
    int other = 0;
    float other_m = others > 0 ? static_cast<float>(others_m[0]) : HUGE_VALF, unknown = 0;
    const auto add = [&](float part, float height_msl_m) {
      PathPost post{fminf(fmaxf(fmaf(length_m, part, from_m), 0.01f), farthest_m), height_msl_m};
      unknown += height_msl_m;
      while (other_m <= post.range_m) {
        visit(PathPost{fminf(other_m, farthest_m), heightAt(chord, others_m[other])});
        other_m = ++other < others ? static_cast<float>(others_m[other]) : HUGE_VALF;
      }
      if (is_raised) post.height_msl_m = raised(chord, static_cast<double>(post.range_m), height_msl_m);
      visit(post);
    };
    int cell = few.first_cell;
    for (int n = 0; n <= most.count; ++n) {
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
      if (n == most.count) break;
      const float* const near = corner_msl_m + (line * most_step + next_cell * few_step);
      add(part, lerp(near[0], near[few_step], across - static_cast<float>(next_cell)));
    }
    while (other < others) {
      visit(
          PathPost{fminf(static_cast<float>(others_m[other]), farthest_m), heightAt(chord, others_m[other])});
      ++other;
    }
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
