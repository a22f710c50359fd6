#include "emscape/render/scene/height_field.h"

#include <algorithm>

namespace emscape::render {

double heightAt_m(const HeightField& ground, double x_m, double y_m) {
  const double x = std::clamp((x_m - ground.first_x_m) / ground.spacing_x_m, 0.0, ground.columns - 1.0);
  const double y = std::clamp((y_m - ground.first_y_m) / ground.spacing_y_m, 0.0, ground.rows - 1.0);
  const int i = std::min(static_cast<int>(x), ground.columns - 2);
  const int j = std::min(static_cast<int>(y), ground.rows - 2);
  const auto post = [&](int di, int dj) {
    return double{ground.heights_m[static_cast<std::size_t>(j + dj) * ground.columns + i + di]};
  };
  const double u = x - i, v = y - j;
  return (post(0, 0) * (1 - u) + post(1, 0) * u) * (1 - v) + (post(0, 1) * (1 - u) + post(1, 1) * u) * v;
}

}  // namespace emscape::render
