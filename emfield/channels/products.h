/// Stage 4: from accumulators to the quantities of a volume.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/math/fast_math.h"
#include "emfield/combine/combine.h"
#include "emfield/combine/radar_product.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/volume/value_range.h"

namespace emscape::emfield {

/// Conversion of a channel's accumulator to its quantity.
enum class ProductForm {
  decibels,      ///< scale * 10 log10(accumulator) + offset
  itself,        ///< the accumulator
  signal_ratio,  ///< 10 log10(signal / (1 + others)) of Reduction::signal
  age            ///< offset - accumulator; the floor where it is 0
};

struct ProductScale {
  ProductForm form = ProductForm::decibels;
  float scale = 1;
  float offset = 0;    ///< dB; of ages s
  float floor = -120;  ///< lowest stored value
};

EMSCAPE_HD inline float decibelsOf(const ProductScale& product, float accumulator) {
  const float value = product.scale * fastRatioToDb(accumulator) + product.offset;
  const bool is_above = (accumulator > 0) & (value > product.floor);
  return is_above ? value : product.floor;
}
/// @param second  of ProductForm::signal_ratio
EMSCAPE_HD inline float valueOf(const ProductScale& product, float accumulator, float second) {
  switch (product.form) {
    case ProductForm::decibels:
      return decibelsOf(product, accumulator);
    case ProductForm::itself:
      return accumulator;
    case ProductForm::signal_ratio:
      return decibelsOf(product, second / (1 + accumulator));
    case ProductForm::age:
      return accumulator > 0 ? product.offset - accumulator : product.floor;
  }
  return accumulator;
}

/// Burn-through margins are within 60 dB of 0: the largest is that of a radar without jamming, the smallest
/// that of a jammed radar without an echo.
constexpr float kMaxMargin = 1e6f;
/// Largest jammer-to-signal ratio (100 dB): that of a jammed radar without an echo.
constexpr float kMaxJammerToSignal = 1e10f;

/// The colour scale of a quantity (a value of volume::kScaleKey); null: none.
const char* scaleOf(scenario::Quantity quantity);

/// True if one more emitter never lowers the quantity: the value of some of a channel's emitters is at most
/// that of all. Jamming is part of each radar's own value.
bool emittersOnlyRaise(scenario::Quantity quantity);

/// Line of the legend about the quantity's bounds or its signal (volume::kLegendNoteKey); empty: none.
std::string legendNoteOf(scenario::Quantity quantity, const scenario::Scenario& scenario);

/// Computation of a channel: its reduction, each emitter's weight, and its scale.
struct ChannelPlan {
  Reduction reduction = Reduction::sum;
  ProductScale product;
  std::vector<float> weights;  ///< in the order of Channel::emitters
  /// In the same order: radars that contribute their echoes instead of weighted powers; empty: none.
  std::vector<RadarTask> radars;
  /// For channels of occupancy: the power density (W/m2) above which an emitter counts; else 0.
  float occupancy_threshold_wm2 = 0;
  /// The curves that the tasks point to (detection_probability), in the same order.
  std::vector<std::shared_ptr<const DetectionCurve>> curves;

  /// True if emitters contribute weighted power densities.
  bool reducesPower() const { return radars.empty() && occupancy_threshold_wm2 == 0; }
};

/// @param auxiliary  Blanker::auxiliary
/// @param curve      of the detector, with that of blanked pulses; the blanker points to it
Blanker blankerOf(double auxiliary, const Detector& detector, const DetectionCurve& curve);

/// @throws Error (bad_input) if the scenario lacks an object that the quantity needs (a receiver, a radar)
ChannelPlan channelPlan(const Channel& channel, const scenario::Scenario& scenario);

/// Values of one channel.
struct ProductTask {
  Dims dims;
  ProductScale product;
  const float* accumulator = nullptr;
  const float* second = nullptr;                 ///< see Accumulator
  const std::uint16_t* first_valid_k = nullptr;  ///< per column; null: all voxels are valid
  float* values = nullptr;
};

/// @return the range of the valid voxels above the floor
volume::ValueRange productCpu(const ProductTask& task);

}  // namespace emscape::emfield
