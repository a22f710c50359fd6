#include "volume/description_check.h"

#include <algorithm>
#include <cmath>

#include "base/geodesy/position_limits.h"
#include "base/memory.h"
#include "base/text/quantity_text.h"

namespace emscape::volume {
namespace {

struct Limits {
  double min, max;
  const char* unit;
};

constexpr Limits kSpacing{kMinSpacing_m, kMaxSpacing_m, "m"};
constexpr Limits kTime{-kMaxTime_s, kMaxTime_s, "s"};
constexpr Limits kLatitude{-PositionLimits::kLatitude_deg, PositionLimits::kLatitude_deg, "deg"};
constexpr Limits kLongitude{-PositionLimits::kLongitude_deg, PositionLimits::kLongitude_deg, "deg"};
constexpr Limits kHeight{PositionLimits::kLowest_m, PositionLimits::kHighest_m, "m"};
constexpr Limits kFloat{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::max(), ""};

/// False for NaN.
bool isWithin(double value, const Limits& limits) {
  return value >= limits.min && value <= limits.max;
}

void requireWithin(const std::string& name, double value, const Limits& limits,
                   const SourceLocation& location) {
  if (isWithin(value, limits)) return;
  constexpr int kDigits = 12;  // limits are shown in full
  throw Error(ErrorCode::bad_input, location,
              (name.empty() ? "" : name + " ") + quantityText(value, limits.unit, kDigits) +
                  " is outside the allowed range " + rangeText(limits.min, limits.max, limits.unit, kDigits));
}

}  // namespace

void checkGrid(const Grid& grid, const std::string& who, const SourceLocation& location) {
  checkDims(grid.dims, location, who);
  const auto checkAxis = [&](const char* axis, double spacing_m, double first_center_m) {
    requireWithin(who + "spacing_m in " + axis, spacing_m, kSpacing, location);
    const double most_m = kMaxFirstVoxel * spacing_m;
    requireWithin(who + "first_center_m in " + axis, first_center_m, {-most_m, most_m, "m"}, location);
  };
  checkAxis("x", grid.spacing_m.x, grid.first_center_m.x);
  checkAxis("y", grid.spacing_m.y, grid.first_center_m.y);
  checkAxis("z", grid.spacing_m.z, grid.first_center_m.z);
  if (grid.georeferenced) checkFrame(grid.frame, who, location);
}

void checkFrame(const FrameOrigin& frame, const std::string& who, const SourceLocation& location) {
  requireWithin(who + "latitude_deg of the frame's origin", frame.latitude_deg, kLatitude, location);
  requireWithin(who + "longitude_deg of the frame's origin", frame.longitude_deg, kLongitude, location);
  requireWithin(who + "height_msl_m of the frame's origin", frame.height_msl_m, kHeight, location);
}

void checkInfo(const VolumeInfo& info, const std::string& who, const SourceLocation& location) {
  checkTime(info.time_s, who + "time_s", location);
  requireWithin(who + "range_min", info.range_min, kFloat, location);
  requireWithin(who + "range_max", info.range_max, kFloat, location);
  if (info.range_min <= info.range_max) return;
  throw Error(ErrorCode::bad_input, location,
              who + "range_min " + quantityText(info.range_min, "") + " is above range_max " +
                  quantityText(info.range_max, ""));
}

void checkTime(double time_s, const std::string& name, const SourceLocation& location) {
  requireWithin(name, time_s, kTime, location);
}

float requireFloat(double value, const std::string& name) {
  if (std::isfinite(value)) requireWithin(name, value, kFloat, {});
  return static_cast<float>(value);
}

void checkAxes(const std::array<double, 9>& matrix, const Vec3d& spacing_m, const std::string& who,
               const SourceLocation& location) {
  const double spacings_m[] = {spacing_m.x, spacing_m.y, spacing_m.z};
  const double tolerance_m = 1e-6 * *std::min_element(std::begin(spacings_m), std::end(spacings_m));
  for (std::size_t n = 0; n < matrix.size(); ++n) {
    const double expected_m = n % 4 == 0 ? spacings_m[n / 4] : 0;
    if (!(std::abs(matrix[n] - expected_m) <= tolerance_m)) {
      throw Error(
          ErrorCode::bad_input, location,
          who + "the grid is rotated, sheared or mirrored; grids whose axes are x, y and z can be read");
    }
  }
}

void checkSparseness(const Dims& dims, std::uint64_t stored, const SourceLocation& location) {
  constexpr long long kAlwaysDense = 1LL << 27;
  constexpr std::uint64_t kSparsest = 1000;
  checkDims(dims, location);
  if (dims.count() > kAlwaysDense && static_cast<std::uint64_t>(dims.count()) / kSparsest > stored) {
    throw Error(ErrorCode::bad_input, location,
                "the box of the active voxels holds " + std::to_string(dims.count()) +
                    " voxels, but the file stores only " + std::to_string(stored) +
                    " values for them: too sparse to be made dense");
  }
}

void requireDenseMemory(const Dims& dims, const SourceLocation& location) {
  checkDims(dims, location);
  requireMemory({"a dense volume of " + std::to_string(dims.x) + " x " + std::to_string(dims.y) + " x " +
                     std::to_string(dims.z) + " voxels",
                 sizeof(float) * static_cast<std::size_t>(dims.count()), "a coarser grid takes less"},
                location);
}

}  // namespace emscape::volume
