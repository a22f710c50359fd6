/// Volumes and grounds of known values for the renderer's tests.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "emscape/render/scene/height_field.h"
#include "emscape/render/scene/renderer.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/volume/dense_volume.h"

namespace emscape::render::testing {

using ValueAt = std::function<float(int, int, int)>;

inline RendererOptions on(Backend backend) {
  RendererOptions options;
  options.backend = backend;
  return options;
}

/// A volume in a frame where its box begins at the origin.
inline std::shared_ptr<volume::DenseVolume> makeVolume(Dims dims, Vec3d spacing_m, const ValueAt& value) {
  auto volume = std::make_shared<volume::DenseVolume>();
  volume->grid.dims = dims;
  volume->grid.spacing_m = spacing_m;
  volume->grid.first_center_m = spacing_m * 0.5;
  for (int k = 0; k < dims.z; ++k) {
    for (int j = 0; j < dims.y; ++j) {
      for (int i = 0; i < dims.x; ++i) volume->values.push_back(value(i, j, k));
    }
  }
  volume->info.quantity = "test";
  volume->info.range_min = 0;
  volume->info.range_max = 1;
  return volume;
}

/// Power density in dB of three emitters with 1/R^2 and a lobe each, as an EME volume looks; the ground is
/// masked.
inline std::shared_ptr<volume::DenseVolume> makeEmeVolume(Dims dims, unsigned seed = 1) {
  const auto part = [&](unsigned n) { return std::fmod(0.37 + 0.618034 * (seed * 7 + n), 1.0); };
  auto volume = makeVolume(dims, {150, 150, 60}, [&](int i, int j, int k) {
    double power = 0;
    for (unsigned e = 0; e < 3; ++e) {
      const double x = i - part(3 * e) * dims.x;
      const double y = j - part(3 * e + 1) * dims.y;
      const double z = k - part(3 * e + 2) * dims.z * 0.4;
      const double azimuth = std::atan2(x, y) - 6.283 * part(e + 20);
      power += std::pow(10.0, 2 * std::cos(azimuth) + std::cos(3 * azimuth)) / (x * x + y * y + z * z + 0.3);
    }
    return static_cast<float>(10 * std::log10(power));
  });
  volume->info.range_min = -50;
  volume->info.range_max = 30;
  volume->info.floor = -120;
  volume->first_valid_k.resize(static_cast<std::size_t>(dims.x) * dims.y);
  for (int j = 0; j < dims.y; ++j) {
    for (int i = 0; i < dims.x; ++i) {
      const int first =
          static_cast<int>((1.2 + std::sin(i * 0.31 + seed) + std::cos(j * 0.23)) * 0.1 * dims.z);
      volume->first_valid_k[static_cast<std::size_t>(j) * dims.x + i] =
          static_cast<std::uint16_t>(std::max(first, 0));
      for (int k = 0; k < std::min(first, dims.z); ++k) {
        volume->values[static_cast<std::size_t>(volume->grid.index(i, j, k))] = volume->info.floor;
      }
    }
  }
  return volume;
}

/// A ground over the box of a volume: `posts` along each side.
inline std::shared_ptr<HeightField> makeGround(const volume::Grid& grid, int posts,
                                               const std::function<double(double, double)>& height_m) {
  auto field = std::make_shared<HeightField>();
  const Vec3d size = grid.upper_m() - grid.lower_m();
  field->columns = field->rows = posts;
  field->spacing_x_m = size.x / (posts - 1);
  field->spacing_y_m = size.y / (posts - 1);
  field->first_x_m = grid.lower_m().x;
  field->first_y_m = grid.lower_m().y;
  for (int j = 0; j < posts; ++j) {
    for (int i = 0; i < posts; ++i) {
      field->heights_m.push_back(static_cast<float>(
          height_m(field->first_x_m + i * field->spacing_x_m, field->first_y_m + j * field->spacing_y_m)));
    }
  }
  return field;
}

inline TransferFunction makeFunction(std::vector<TransferFunction::ColorPoint> colors,
                                     std::vector<TransferFunction::OpacityPoint> opacities) {
  TransferFunction function;
  function.colors = std::move(colors);
  function.opacities = std::move(opacities);
  return function;
}

/// White of one opacity for every value.
inline TransferFunction fog(double opacity) {
  return makeFunction({{0, {1, 1, 1}}}, {{0, opacity}, {1, opacity}});
}

}  // namespace emscape::render::testing
