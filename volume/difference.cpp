#include "volume/difference.h"

#include <algorithm>
#include <cctype>

#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "emscape/volume/statistics.h"

namespace emscape::volume {
namespace {

bool isDecibel(const std::string& unit) {
  return unit.compare(0, 2, "dB") == 0;
}

std::string lowerAlphanumeric(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return result;
}

/// A quantity's name split into base name, unit and name of a radar.
struct NameParts {
  std::string name, unit_suffix, radar;
};

NameParts partsOf(const VolumeInfo& info) {
  const std::size_t colon = std::min(info.quantity.find(':'), info.quantity.size());
  NameParts parts{info.quantity.substr(0, colon), "", info.quantity.substr(colon)};
  const std::size_t last = parts.name.rfind('_');
  if (last != std::string::npos && !info.unit.empty() &&
      lowerAlphanumeric(parts.name.substr(last)) == lowerAlphanumeric(info.unit)) {
    parts.unit_suffix = parts.name.substr(last);
    parts.name.resize(last);
  }
  return parts;
}

void checkComparable(const VolumeInfo& a, const VolumeInfo& b) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::bad_input, "difference of " + a.quantity + " and " + b.quantity + ": " + why);
  };
  if (a.quantity != b.quantity || a.unit != b.unit) refuse("expected the same quantity in the same unit");
  requireDifference(a.quantity, a.categorical);
}

}  // namespace

void requireDifference(const std::string& quantity, bool categorical) {
  if (!categorical) return;
  throw Error(ErrorCode::bad_input, quantity + ": indices have no difference; compare another quantity");
}

VolumeInfo differenceInfo(const VolumeInfo& of) {
  VolumeInfo info = of;
  const NameParts parts = partsOf(of);
  const bool decibel = isDecibel(of.unit);
  info.quantity =
      parts.name + "_difference" + (decibel ? std::string("_db") : parts.unit_suffix) + parts.radar;
  info.unit = decibel ? "dB" : of.unit;
  info.floor = 0;
  info.range_min = info.range_max = 0;
  info.extra[kScaleKey] = kDifferenceScale;
  return info;
}

bool isDifference(const VolumeInfo& info) {
  const auto scale = info.extra.find(kScaleKey);
  return scale != info.extra.end() && scale->second == kDifferenceScale;
}

DenseVolume difference(const DenseVolume& a, const DenseVolume& b) {
  checkComparable(a.info, b.info);
  if (a.grid != b.grid) {
    throw Error(ErrorCode::bad_input,
                "difference of " + a.info.quantity + ": the two grids are not the same");
  }
  checkVolume(a, {});
  checkVolume(b, {});
  DenseVolume result;
  result.grid = a.grid;
  result.info = differenceInfo(a.info);
  const Dims dims = a.grid.dims;
  const std::size_t columns = static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y);
  if (!a.first_valid_k.empty() || !b.first_valid_k.empty()) {
    const auto lowest = [](const DenseVolume& volume, std::size_t column) {
      return volume.first_valid_k.empty() ? std::uint16_t{0} : volume.first_valid_k[column];
    };
    result.first_valid_k.resize(columns);
    for (std::size_t column = 0; column < columns; ++column) {
      result.first_valid_k[column] = std::max(lowest(a, column), lowest(b, column));
    }
  }
  result.values.resize(a.values.size());
  parallelFor(dims.z, 1, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const std::size_t first = static_cast<std::size_t>(k) * columns;
      for (std::size_t column = 0; column < columns; ++column) {
        const std::size_t i = first + column;
        const bool masked = !result.first_valid_k.empty() && k < result.first_valid_k[column];
        result.values[i] = masked ? 0.0F : a.values[i] - b.values[i];
      }
    }
  });
  setRangeFromValues(result);
  return result;
}

}  // namespace emscape::volume
