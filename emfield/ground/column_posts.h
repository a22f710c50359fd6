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
  float raised_m = 0;  ///< of the height: clutter
};

/// The posts of a path with posts at crossings: see chord_crossings.h. Regular posts elsewhere.
class ColumnPosts {
 public:
  /// @param at_crossings  false: regular posts
  EMSCAPE_HD ColumnPosts(const Station& station, const GroundPosts& ground, const FastInverse& path,
                         bool at_crossings)
      : station_(station),
        ground_(ground),
        path_(path),
        chords_(chordsOf(station, ground, path)),
        around_(RasterChord{}) {
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
    ClutterPosts clutter(ground_, path_.distance_m);
    for (int n = 0; n < chords_.count; ++n) {
      const double begin_m = n * chords_.length_m;
      const bool is_last = n + 1 == chords_.count;
      const TerrainChord& chord = chordOf(n);
      const bool with_crossings = !isRegular(n) && canCross(chord.in_raster, chords_.length_m);
      const bool with_beginning = n > 0 && regular_chords_ != ~0ull;
      if (!with_crossings) regular_chords_ |= bitOf(n);
      OtherPosts others{ground_.ranges_m, ground_.has_clutter ? &clutter : nullptr};
      others.regular = n == 0 ? 1 : ground_.lastBefore(begin_m) + 1;
      others.end = is_last ? regular : ground_.lastBefore(begin_m + chords_.length_m) + 1;
      if (with_crossings) others.end = n == 0 ? smaller(ground_.near_count, others.end) : 0;
      if (with_beginning && others.regular < others.end && ground_.ranges_m[others.regular] <= begin_m)
        ++others.regular;
      others.end_m = is_last ? HUGE_VAL : begin_m + chords_.length_m;
      others.range_m = with_beginning ? begin_m : others.next();
      if (!eachOf(chord, with_crossings, begin_m, chords_.length_m, others, skips, visit)) {
        regular_chords_ |= bitOf(n);
        return false;
      }
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
    for (ClutterPosts more(ground_, path_.distance_m); more.next_m < HUGE_VAL; more.advance())
      add(more.next_m);
    if (ground_.is_smooth || regular_chords_ == ~0ull) {
      addRegular(regular);
      return found;
    }
    const double chord_m = chords_.length_m;
    const int n = smaller(static_cast<int>(static_cast<double>(range_m) / chord_m), chords_.count - 1);
    const double begin_m = n * chord_m;
    if (n > 0) add(begin_m);
    if (n + 1 < chords_.count) add(begin_m + chord_m);
    if (isRegular(n)) {
      addRegular(regular);
      return found;
    }
    if (n == 0) addRegular(smaller(ground_.near_count, regular));
    if (n != around_chord_) {
      around_ = ChordCrossings(chordOf(n).in_raster);
      around_chord_ = n;
    }
    const float part = fminf(static_cast<float>((static_cast<double>(range_m) - begin_m) / chord_m), 1);
    for (const LineCrossings* lines : {&around_.columns, &around_.rows}) {
      const int next = lines->countBefore(part, static_cast<int>(lines->coordinate.at(part)));
      for (int i = larger(next - 1, 0); i < smaller(next + 1, lines->count); ++i)
        add(crossingRange_m(begin_m, chord_m, partOf(*lines, i < lines->before_turn, lines->line(i)),
                            path_.distance_m));
    }
    return found;
  }

 private:
  /// The ranges of the posts for clutter, one after another; infinite after the last one.
  struct ClutterPosts {
    const GroundPosts& ground;
    double path_m;
    int n = -1;
    double next_m = HUGE_VAL;

    EMSCAPE_HD ClutterPosts(const GroundPosts& ground_, double path_m_) : ground(ground_), path_m(path_m_) {
      advance();
    }
    EMSCAPE_HD void advance() {
      for (next_m = HUGE_VAL; ++n < ground.clutterPosts();) {
        const double range_m = ground.clutterPost_m(n, path_m);
        if (!isClutterAt(range_m, path_m)) continue;
        next_m = range_m;
        return;
      }
    }
  };
  /// The posts of a chord other than crossings, one after another.
  struct OtherPosts {
    const double* ranges_m;
    ClutterPosts* clutter;     ///< null: none
    int regular = 1, end = 0;  ///< of the regular posts
    double end_m = 0;          ///< of the chord
    double range_m = 0;        ///< of the next one, at first perhaps the chord's beginning; infinite: none

    EMSCAPE_HD float range() const { return static_cast<float>(range_m); }
    /// Leaves out the present one.
    EMSCAPE_HD float advance() {
      range_m = next();
      return range();
    }
    EMSCAPE_HD double next() {
      const double regular_m = regular < end ? ranges_m[regular] : HUGE_VAL;
      if (clutter != nullptr && clutter->next_m < end_m && clutter->next_m < regular_m) return nextClutter();
      ++regular;
      return regular_m;
    }
    EMSCAPE_DEVICE_CALL EMSCAPE_HD double nextClutter() {
      const double here_m = clutter->next_m;
      clutter->advance();
      return here_m;
    }
  };
  struct Chords {
    int count;
    double length_m;
  };
  /// HighestOfTiles along a chord, in lines from the chord's corner.
  class TilesAlong {
   public:
    TilesAlong() = default;
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

  static EMSCAPE_HD Chords chordsOf(const Station& station, const GroundPosts& ground,
                                    const FastInverse& path) {
    if (ground.is_smooth) return {1, path.distance_m};
    const TerrainWalk walk(station, ground.terrain, path);
    return {walk.chords(), walk.chord_m()};
  }

  /// The last two that were asked for are kept.
  EMSCAPE_HD const TerrainChord& chordOf(int n) {
    if (!ground_.is_smooth && kept_[n & 1] != n) prepare(station_, ground_, path_, n, chord_[n & 1]);
    kept_[n & 1] = n;
    return chord_[n & 1];
  }
  static EMSCAPE_HD std::uint64_t bitOf(int chord) { return 1ull << smaller(chord, 62); }
  EMSCAPE_HD bool isRegular(int chord) const { return (regular_chords_ & bitOf(chord)) != 0; }
  EMSCAPE_HD float farthest_m() const {
    return static_cast<float>(path_.distance_m) * static_cast<float>(propagation::kBeforeReceivers);
  }

  /// Height of the bare ground above mean sea level (m); NaN over missing terrain.
  EMSCAPE_HD float heightAt(const TerrainChord& chord, double range_m) const {
    float height_msl_m = chord.in_raster.corner_msl_m != nullptr ? chord.in_raster.heightAt(range_m) : NAN;
    if (std::isnan(height_msl_m)) height_msl_m = amongRasters(ground_, chord, range_m);
    return height_msl_m;
  }
  // Separate calls, so that their registers are not part of those of the loops over posts.
  EMSCAPE_DEVICE_CALL static EMSCAPE_HD void prepare(const Station& station, const GroundPosts& ground,
                                                     const FastInverse& path, int n, TerrainChord& chord) {
    chord = TerrainWalk(station, ground.terrain, path).chord(n);
  }
  EMSCAPE_DEVICE_CALL static EMSCAPE_HD float amongRasters(const GroundPosts& ground,
                                                           const TerrainChord& chord, double range_m) {
    return chord.heightAmongRasters(ground.terrain, range_m);
  }
  EMSCAPE_DEVICE_CALL EMSCAPE_HD float clutterAt(const TerrainChord& chord, double range_m,
                                                 float ground_msl_m) const {
    if (!isClutterAt(range_m, path_.distance_m)) return 0;
    const double part = (range_m - chord.in_raster.begin_m) * chord.in_raster.per_m;
    const float cover_m = ground_.terrain.coverAt(chord.position.latitude_rad.at(part),
                                                  chord.position.longitude_rad.at(part), ground_msl_m);
    return cover_m > 0 ? cover_m : 0;
  }

  /// True if a chord's crossings are read.
  EMSCAPE_HD bool canCross(const RasterChord& chord, double chord_m) const {
    return chord.corner_msl_m != nullptr && ChordCrossings(chord).count() <= ground_.maxCrossings(chord_m);
  }

  /// The lines that a chord crosses most often, one after another.
  struct MostLines {
    LineCrossings lines;
    int step;  ///< between the raster's posts of two lines
    float inverse, bend;
    int n = 0, line;

    EMSCAPE_HD MostLines(const LineCrossings& of, int step_)
        : lines(of),
          step(step_),
          inverse(approximateReciprocal(of.coordinate.c[1])),
          bend(4 * of.coordinate.c[2] * inverse),
          line(of.line<true>(0)) {}
    EMSCAPE_HD void advance(int count) {
      n += count;
      line += count * lines.step;
    }
    /// See LineCrossings::partOfStraight().
    EMSCAPE_HD float partOf(int of_line) const {
      const float to = (static_cast<float>(of_line) - lines.coordinate.c[0]) * inverse, b = bend * to;
      return fminf(fmaxf(to * (1 - b * (0.25f - b * (0.125f - b * 0.078125f))), 0), 1);
    }
  };

  /// The posts of a chord in their order.
  /// @return false if there is a void beside a crossing
  template <class Skips, class Visit>
  EMSCAPE_HD bool eachOf(const TerrainChord& chord, bool with_crossings, double begin_m, double chord_m,
                         OtherPosts& others, const Skips& skips, const Visit& visit) const {
    const auto from_m = static_cast<float>(begin_m), length_m = static_cast<float>(chord_m);
    const float farthest_m = this->farthest_m();
    const auto rangeAt = [&](float part) {
      return fminf(fmaxf(fmaf(length_m, part, from_m), 0.01f), farthest_m);
    };
    const ChordCrossings crossings(chord.in_raster);
    const bool by_columns = crossings.columns.count >= crossings.rows.count;
    const int row_posts = crossings.row_posts;
    const float* const corner_msl_m = crossings.corner_msl_m;
    MostLines most(by_columns ? crossings.columns : crossings.rows, by_columns ? 1 : row_posts);
    const LineCrossings across(by_columns ? crossings.rows : crossings.columns);
    const int direction = most.lines.step, lines = with_crossings ? most.lines.count : 0;
    const int step_across = by_columns ? row_posts : 1;
    TilesAlong tiles;
    if (with_crossings) tiles = TilesAlong(ground_, corner_msl_m, by_columns);
    /// On a line, at a coordinate along it.
    const auto heightOn = [&](int line, int line_step, float at, int step_along) {
      const int cell = static_cast<int>(at);
      const float* const near = corner_msl_m + (line * line_step + cell * step_along);
      return lerp(near[0], near[step_along], at - static_cast<float>(cell));
    };
    const bool is_raised = ground_.is_raised;
    float other_m = others.range(), unknown = 0;
    const auto visitPost = [&](PathPost post, double exact_m) {
      if (is_raised) {
        post.raised_m = clutterAt(chord, exact_m, post.height_msl_m);
        post.height_msl_m += post.raised_m;
      }
      visit(post);
    };
    float reached = 0;  // part of the chord
    int untried = 1;    // tiles to go through, after one that is not skipped
    do {
      float end = 2;             // as far as to the end of a tile
      int end_line = lines + 1;  // with a last step to the end of the chord
      while (tiles.areKnown() && most.n < lines) {
        const int count = smaller(tiles.linesFrom(most.line, direction), lines - most.n);
        end = most.partOf(most.line + direction * (count - 1));
        const int cell = static_cast<int>(across.coordinate.at(reached));
        const int end_cell = static_cast<int>(across.coordinate.at(end));
        const float to_m = rangeAt(end);
        const bool is_needed =
            (across.turn > reached && across.turn < end) ||
            !skips(rangeAt(reached), to_m, tiles.highest_m(most.line, direction, cell, end_cell));
        if (isForAnyLane(is_needed)) {  // threads of a warp remain together
          end_line = smaller(most.n + count + (untried - 1) * HighestOfTiles::kCells, lines);
          end = most.partOf(most.line + direction * (end_line - most.n - 1));
          untried = smaller(2 * untried, 4);
          break;
        }
        untried = 1;
        reached = end;
        end = 2;
        most.advance(count);
        while (other_m <= to_m) other_m = others.advance();
      }
      // From one line to the next one, with the crossings of others between; the chord is straight in a cell.
      float part = reached, at = across.coordinate.at(part);
      int cell = static_cast<int>(at);
      EMSCAPE_UNROLL_BY(1)
      for (; most.n < end_line; most.advance(1)) {
        const bool is_line = most.n < lines;
        const float next_part = is_line ? most.partOf(most.line) : 1;
        const float next_at = across.coordinate.at(next_part);
        const int next_cell = with_crossings ? static_cast<int>(next_at) : cell;
        const float next_m = is_line ? rangeAt(next_part) : HUGE_VALF;
        float height_msl_m = 0;
        if (is_line) height_msl_m = heightOn(most.line, most.step, next_at, step_across);
        EMSCAPE_UNROLL_BY(1)
        while (cell != next_cell || other_m <= next_m) {
          const int line = larger(cell, next_cell > cell ? cell + 1 : cell - 1);
          const float here = fmaf((static_cast<float>(line) - at) * approximateReciprocal(next_at - at),
                                  next_part - part, part);
          PathPost post{cell != next_cell ? rangeAt(here) : next_m, 0};
          auto exact_m = static_cast<double>(post.range_m);
          if (other_m <= post.range_m) {
            if (other_m == HUGE_VALF) break;
            exact_m = others.range_m;
            post = {fminf(other_m, farthest_m), ground_.is_smooth ? 0 : heightAt(chord, exact_m)};
            other_m = others.advance();
          } else {
            post.height_msl_m = heightOn(line, step_across, most.lines.coordinate.at(here), most.step);
            unknown += post.height_msl_m;
            cell += next_cell > cell ? 1 : -1;
          }
          visitPost(post, exact_m);
        }
        part = next_part;
        at = next_at;
        if (!is_line) break;
        unknown += height_msl_m;
        visitPost({next_m, height_msl_m}, static_cast<double>(next_m));
      }
      reached = end;
    } while (reached < 2);
    return !std::isnan(unknown);
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
  Chords chords_;
  TerrainChord chord_[2];
  int kept_[2] = {-1, -1};  ///< which chords they are
  int around_chord_ = -1;
  ChordCrossings around_;             ///< of around_chord_
  std::uint64_t regular_chords_ = 0;  ///< by bitOf(); all: the profile has regular posts only
};

}  // namespace emscape::emfield
