/// Stage 4: from accumulators to the quantities that a volume holds.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/fast_math.h"
#include "emfield/combine.h"
#include "emfield/radar_product.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "emscape/emfield/field_solver.h"
#include "emscape/volume/value_range.h"

namespace emscape::emfield {

/// How a channel's accumulator becomes its quantity: decibels = scale * 10 log10(accumulator) + offset, or
/// the accumulator itself.
struct ProductScale {
  bool decibels = true;
  float scale = 1;
  float offset_db = 0;
  float floor = -120;  ///< lowest value kept
};

EMSCAPE_HD inline float decibelsOf(const ProductScale& product, float accumulator) {
  const float value = product.scale * fastRatioToDb(accumulator) + product.offset_db;
  return (accumulator > 0) & (value > product.floor) ? value : product.floor;
}

/// Largest burn-through margin (60 dB): also that of a radar that nothing jams.
constexpr float kLargestMargin = 1e6f;

/// The scale of a quantity's colours as volumes name it (volume::kScaleKey); null: none.
const char* scaleOf(scenario::Quantity quantity);

/// How a channel is made: its reduction, each emitter's weight in it, and its scale.
struct ChannelRecipe {
  Reduction reduction = Reduction::sum;
  ProductScale product;
  std::vector<float> weights;  ///< in the order of Channel::emitters
  /// In the same order: radars that enter by their echoes instead of by their weights; empty: none does.
  std::vector<RadarTask> radars;
  /// What the tasks' curves point to (detection_probability), in the same order.
  std::vector<std::shared_ptr<const DetectionCurve>> curves;
};

/// @param known_curves  taken where one is that of a radar's detector
/// @throws Error (bad_input) if the scenario lacks what the quantity needs (a receiver, a radar)
ChannelRecipe recipeOf(const Channel& channel, const scenario::Scenario& scenario,
                       const std::vector<std::shared_ptr<const DetectionCurve>>& known_curves = {});

/// Values of one channel.
struct ProductTask {
  Dims dims;
  ProductScale product;
  const float* accumulator = nullptr;
  const std::uint16_t* first_valid_k = nullptr;  ///< per column; null: all voxels are valid
  float* values = nullptr;
};

/// @return the range of the valid voxels above the floor
volume::ValueRange productCpu(const ProductTask& task);

}  // namespace emscape::emfield
