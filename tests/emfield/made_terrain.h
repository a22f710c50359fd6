/// Terrain made up for tests, without files.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "emscape/base/units.h"
#include "emscape/scenario/terrain/terrain.h"
#include "scenario/terrain/view.h"

namespace emscape::emfield::testing {

/// Hills of several sizes over a square about a point, posts about 90 m apart; optionally with a hole.
class MadeTerrain : public scenario::Terrain {
 public:
  /// @param side_deg  of the square
  /// @param hole_deg  side of a void square in the middle of its north-eastern quarter
  MadeTerrain(double latitude_deg, double longitude_deg, double side_deg, double hole_deg = 0)
      : MadeTerrain(latitude_deg, longitude_deg, side_deg, [=](double i_deg, double j_deg) {
          const double east_deg = i_deg - side_deg * 0.75, north_deg = j_deg - side_deg * 0.75;
          double height_m = 400;
          for (int n = 1; n < 7; ++n) {
            const double size_m = 500.0 / n, turns = 3 * std::pow(2.1, n) / side_deg;
            height_m += size_m * std::sin(turns * i_deg + n) * std::cos(turns * j_deg + 2 * n);
          }
          const bool is_void = std::abs(east_deg) < hole_deg / 2 && std::abs(north_deg) < hole_deg / 2;
          return is_void ? std::numeric_limits<double>::quiet_NaN() : height_m;
        }) {}

  /// @param height_m  of the degrees from the square's western and southern sides
  MadeTerrain(double latitude_deg, double longitude_deg, double side_deg,
              const std::function<double(double east_deg, double north_deg)>& height_m)
      : box_{latitude_deg - side_deg / 2, latitude_deg + side_deg / 2, longitude_deg - side_deg / 2,
             longitude_deg + side_deg / 2} {
    constexpr double kStep_deg = 1.0 / 1200;
    const int posts = int(side_deg / kStep_deg) + 1;
    for (int j = 0; j < posts; ++j) {
      for (int i = 0; i < posts; ++i) heights_m_.push_back(float(height_m(i * kStep_deg, j * kStep_deg)));
    }
    raster_.heights_msl_m = heights_m_.data();
    raster_.columns = raster_.rows = posts;
    raster_.south_rad = degToRad(box_.south_deg);
    raster_.west_rad = degToRad(box_.west_deg);
    raster_.posts_per_rad_lat = raster_.posts_per_rad_lon = 1 / degToRad(kStep_deg);
    raster_.last_column = raster_.last_row = posts - 1;
  }

  double heightMsl_m(double latitude_deg, double longitude_deg) const override {
    return double(view().heightAt(degToRad(latitude_deg), degToRad(longitude_deg)));
  }
  scenario::TerrainView view() const override { return {&raster_, 1}; }
  double postSpacing_m() const override { return 70; }
  long long voidPosts() const override { return 0; }
  double uncoveredFraction() const override { return 0; }
  scenario::GeoBox box() const override { return box_; }
  scenario::GeoBox coverage() const override { return box_; }
  double lowest_m() const override { return 0; }
  double highest_m() const override { return 2000; }

 private:
  scenario::GeoBox box_;
  std::vector<float> heights_m_;
  scenario::TerrainRaster raster_;
};

}  // namespace emscape::emfield::testing
