/// Terrain heights along an azimuth of a station, in order of increasing range.
///
/// Positions are exact at the ends and in the middle of chords, and between them on parabolas of latitude and
/// longitude.
/// @accuracy positions within 2 cm of fastDirect() to 75 degrees of latitude, 10 cm beyond, farther than 10
/// km from the poles; heights in a raster within 2 mm times the slope of the ground
#pragma once

#include <cmath>

#include "base/math/device_loop.h"
#include "base/math/float_pair.h"
#include "emfield/columns/station.h"
#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "scenario/terrain/view.h"

namespace emscape::emfield {

/// c[0] + part * (c[1] + part * c[2]).
template <class Real>
struct Parabola {
  Real c[3] = {};

  EMSCAPE_HD Real at(Real part) const { return c[0] + part * (c[1] + part * c[2]); }
};

/// The parabola through three values, at 0, 1/2 and 1.
EMSCAPE_HD inline Parabola<double> parabolaThrough(double begin, double middle, double end) {
  const double to_middle = middle - begin, to_end = end - begin;
  return {{begin, 4 * to_middle - to_end, 2 * to_end - 4 * to_middle}};
}

/// The parabolas of latitude and longitude of a chord; longitudes in the same 360 degrees as the beginning's.
struct ChordPosition {
  Parabola<double> latitude_rad, longitude_rad;
};
EMSCAPE_HD inline ChordPosition chordThrough(const FastDirect& begin, const FastDirect& middle,
                                             const FastDirect& end) {
  const auto beside = [&](double longitude_rad) {
    const double east_rad = longitude_rad - begin.longitude_rad;
    return longitude_rad - (east_rad > kPi ? 2 * kPi : east_rad < -kPi ? -2 * kPi : 0);
  };
  return {parabolaThrough(begin.latitude_rad, middle.latitude_rad, end.latitude_rad),
          parabolaThrough(begin.longitude_rad, beside(middle.longitude_rad), beside(end.longitude_rad))};
}

/// The same in posts of a raster, with bounds.
struct ChordInRaster {
  Parabola<double> column, row;
  double lowest_column, highest_column, lowest_row, highest_row;

  /// True if the chord, with a margin (posts), is within the raster.
  EMSCAPE_HD bool isWithin(const scenario::TerrainRaster& raster, double margin) const {
    return lowest_column - margin >= raster.first_column && highest_column + margin <= raster.last_column &&
           lowest_row - margin >= raster.first_row && highest_row + margin <= raster.last_row;
  }
};
EMSCAPE_HD inline ChordInRaster chordInRaster(const scenario::TerrainRaster& raster,
                                              const ChordPosition& chord) {
  const Parabola<double>&latitude = chord.latitude_rad, &longitude = chord.longitude_rad;
  // Of the begin, in the turn of longitudes that the raster counts in; the chord's others follow.
  const double turn = 2 * kPi * raster.posts_per_rad_lon;
  double first_column = (longitude.c[0] - raster.west_rad) * raster.posts_per_rad_lon;
  first_column -= turn * std::floor((first_column - raster.first_column) / turn);
  ChordInRaster in;
  in.column = {
      {first_column, longitude.c[1] * raster.posts_per_rad_lon, longitude.c[2] * raster.posts_per_rad_lon}};
  in.row = {{(latitude.c[0] - raster.south_rad) * raster.posts_per_rad_lat,
             latitude.c[1] * raster.posts_per_rad_lat, latitude.c[2] * raster.posts_per_rad_lat}};
  const auto bound = [](const Parabola<double>& parabola, double& lowest, double& highest) {
    const double begin = parabola.c[0], end = parabola.at(1), beyond = std::fabs(parabola.c[2]) / 4;
    lowest = (begin < end ? begin : end) - beyond;
    highest = (begin < end ? end : begin) + beyond;
  };
  bound(in.column, in.lowest_column, in.highest_column);
  bound(in.row, in.lowest_row, in.highest_row);
  return in;
}

/// Bilinear height (m) at column x and row y of a raster, from a corner of it; NaN beside a void.
EMSCAPE_HD inline float bilinearHeight(const float* corner_msl_m, int row_posts, float x, float y) {
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const int at = j * row_posts + i;
  const FloatPair south = floatPair(corner_msl_m + at), north = floatPair(corner_msl_m + row_posts + at);
  const float to_east = x - static_cast<float>(i), to_north = y - static_cast<float>(j);
  return lerp(lerp(south.first, south.second, to_east), lerp(north.first, north.second, to_east), to_north);
}

/// Longest chord (m) whose deviation from the ground track is within the accuracy above.
EMSCAPE_HD inline double maxChord_m(double sine_of_latitude) {
  constexpr double kOf60Degrees = 0.866025403784439, kOf80Degrees = 0.984807753012208;
  return sine_of_latitude < kOf60Degrees ? 32000 : sine_of_latitude < kOf80Degrees ? 8000 : 100;
}

/// A chord in the finest raster.
struct RasterChord {
  double begin_m = 0, per_m = 0;  ///< part of the chord at a range: (range - begin_m) * per_m, 0..1
  /// Posts of the raster, from the one that `corner` points to, if the whole chord is in it; else null.
  const float* corner_msl_m = nullptr;
  int row_posts = 0;  ///< posts in a row of the raster
  Parabola<float> column, row;

  /// Bilinear height (m) where corner_msl_m is set; NaN beside a void.
  EMSCAPE_HD float heightAt(double range_m) const {
    const auto part = static_cast<float>((range_m - begin_m) * per_m);
    return bilinearHeight(corner_msl_m, row_posts, column.at(part), row.at(part));
  }
};

/// A part of a walk.
struct TerrainChord {
  RasterChord in_raster;
  ChordPosition position;

  /// Height (m) in all rasters; NaN if the terrain is missing.
  EMSCAPE_HD float heightAmongRasters(const scenario::TerrainView& terrain, double range_m) const {
    const double part = (range_m - in_raster.begin_m) * in_raster.per_m;
    return terrain.heightAt(position.latitude_rad.at(part), position.longitude_rad.at(part));
  }
  EMSCAPE_HD float heightAt(const scenario::TerrainView& terrain, double range_m) const {
    if (in_raster.corner_msl_m != nullptr) {
      const float height_msl_m = in_raster.heightAt(range_m);
      if (height_msl_m == height_msl_m) return height_msl_m;
    }
    return heightAmongRasters(terrain, range_m);
  }
};

/// The chords of a path over the ground, one after another, all of the same length.
class TerrainWalk {
 public:
  EMSCAPE_HD TerrainWalk(const Station& station, const scenario::TerrainView& terrain,
                         const FastInverse& path)
      : station_(station), terrain_(terrain), sine_(path.sin_azimuth), cosine_(path.cos_azimuth) {
    const double longest_m = maxChord_m(std::fabs(station.geodesy.station.up.z));
    last_ = static_cast<int>(path.distance_m / longest_m);
    chord_m_ = path.distance_m / (last_ + 1);
    per_m_ = chord_m_ > 0 ? 1 / chord_m_ : 0;
  }

  EMSCAPE_HD int chords() const { return last_ + 1; }
  EMSCAPE_HD double chord_m() const { return chord_m_; }
  /// Chord `index`, not before that of the last call.
  EMSCAPE_HD const TerrainChord& chord(int index) {
    if (index != index_) {
      setChord(index);
      index_ = index;
    }
    return chord_;
  }
  /// Range at which the chord of a range ends; infinity for the last chord.
  EMSCAPE_HD double endOfChord_m(double range_m) const {
    const int index = indexOf(range_m);
    return index < last_ ? (index + 1) * chord_m_ : HUGE_VAL;
  }
  /// The chord that contains a range; ranges must not decrease from one call to the next.
  EMSCAPE_HD const TerrainChord& chordAt(double range_m) { return chord(indexOf(range_m)); }
  EMSCAPE_HD float heightAt(double range_m) { return chordAt(range_m).heightAt(terrain_, range_m); }

 private:
  EMSCAPE_HD int indexOf(double range_m) const {
    const int index = static_cast<int>(range_m * per_m_);
    return index < last_ ? index : last_;
  }
  EMSCAPE_DEVICE_CALL EMSCAPE_HD FastDirect positionAt(double range_m) const {
    return fastDirect(station_.geodesy, sine_, cosine_, range_m);
  }

  EMSCAPE_HD void setChord(int index) {
    const double begin_m = index * chord_m_;
    chord_.in_raster.begin_m = begin_m;
    chord_.in_raster.per_m = per_m_;
    const FastDirect begin = index > 0 && index == index_ + 1 ? end_ : positionAt(begin_m);
    const FastDirect middle = positionAt(begin_m + chord_m_ / 2);
    end_ = positionAt(begin_m + chord_m_);
    chord_.position = chordThrough(begin, middle, end_);
    findRaster();
  }

  /// Sets the chord's raster: the finest, if the whole chord is within it.
  EMSCAPE_HD void findRaster() {
    RasterChord& chord = chord_.in_raster;
    chord.corner_msl_m = nullptr;
    if (terrain_.count == 0) return;
    const scenario::TerrainRaster& raster = terrain_.rasters[0];
    const ChordInRaster in = chordInRaster(raster, chord_.position);
    constexpr double kMargin = 1;  // post
    if (!in.isWithin(raster, kMargin)) return;
    // An index from the corner must fit into an int.
    if (!((in.highest_row - in.lowest_row + 6) * raster.columns < 2e9)) return;
    const int i = static_cast<int>(in.lowest_column - kMargin), j = static_cast<int>(in.lowest_row - kMargin);
    chord.corner_msl_m = raster.heights_msl_m + static_cast<long long>(j) * raster.columns + i;
    chord.row_posts = raster.columns;
    chord.column = relativeTo(in.column, i);
    chord.row = relativeTo(in.row, j);
  }

  EMSCAPE_HD static Parabola<float> relativeTo(const Parabola<double>& parabola, int origin) {
    return {{static_cast<float>(parabola.c[0] - origin), static_cast<float>(parabola.c[1]),
             static_cast<float>(parabola.c[2])}};
  }

  const Station& station_;
  const scenario::TerrainView& terrain_;
  double sine_, cosine_;
  int last_;  ///< index of the last chord
  double chord_m_, per_m_;
  int index_ = -1;
  FastDirect end_;
  TerrainChord chord_;
};

}  // namespace emscape::emfield
