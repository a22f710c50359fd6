#include "scenario/terrain/fill_values.h"

#include <algorithm>
#include <cstring>

namespace emscape::scenario {
namespace {

constexpr std::uint32_t kBits = 1U << 24;
constexpr std::size_t kMaxIsolated = 4096;  ///< heights of which a post is isolated
/// Values that programs write for no data, in the file's unit.
constexpr double kUsual[] = {-999,    -999.9,   -1000,  -3000,  -9998,  -9999,
                             -9999.9, -9999.99, -10000, -12000, -32766, -99999};

}  // namespace

FillValues::FillValues(long long columns, double unit_m) : columns_(static_cast<std::size_t>(columns)) {
  // As TerrainFile converts them.
  for (const double value : kUsual)
    usual_m_.insert(static_cast<float>(static_cast<double>(static_cast<float>(value)) * unit_m));
}

void FillValues::add(const float* heights_m) {
  if (has_last_) judge(has_before_ ? before_m_.data() : nullptr, last_m_.data(), heights_m);
  std::swap(before_m_, last_m_);
  has_before_ = has_last_;
  last_m_.assign(heights_m, heights_m + columns_);
  has_last_ = true;
}

FillValues::Result FillValues::result() {
  if (has_last_) judge(has_before_ ? before_m_.data() : nullptr, last_m_.data(), nullptr);
  has_last_ = false;
  constexpr double kMaxPartOfBits = 0.1;  // one height in a hundred is then taken for a connected one
  result_.is_partial = result_.is_partial || static_cast<double>(bits_) > kMaxPartOfBits * kBits;
  for (const auto& [height_m, posts] : isolated_) {
    const Bits bits = bitsOf(height_m);
    const bool is_connected =
        isUsual(height_m) ? usual_connected_m_.count(height_m) != 0
                          : result_.is_partial || (bits_ > 0 && hasBit(bits.first) && hasBit(bits.second));
    if (is_connected) {
      addToRange(height_m, posts);
    } else {
      result_.fills.push_back({height_m, posts});
    }
  }
  return result_;
}

void FillValues::addToRange(float height_m, long long posts) {
  result_.low_posts += posts;
  result_.lowest_m = std::min(result_.lowest_m, height_m);
  result_.highest_m = std::max(result_.highest_m, height_m);
}

FillValues::Bits FillValues::bitsOf(float height_m) {
  std::uint32_t pattern = 0;
  std::memcpy(&pattern, &height_m, sizeof pattern);
  const std::uint64_t mixed = pattern * 0x9E3779B97F4A7C15ULL;
  return {static_cast<std::uint32_t>(mixed >> 40), static_cast<std::uint32_t>(mixed >> 16) % kBits};
}

void FillValues::setBit(std::uint32_t bit) {
  if (hasBit(bit)) return;
  connected_[bit / 64] |= std::uint64_t{1} << bit % 64;
  ++bits_;
}

void FillValues::judge(const float* below_m, const float* middle_m, const float* above_m) {
  for (std::size_t i = 0; i < columns_; ++i) {
    const float height_m = middle_m[i];
    if (!(height_m < kBelow_m)) continue;
    const std::size_t first = i > 0 ? i - 1 : 0, last = std::min(i + 1, columns_ - 1);
    bool is_isolated = true;
    for (const float* row : {below_m, middle_m, above_m}) {
      for (std::size_t k = first; row != nullptr && k <= last; ++k)
        is_isolated = is_isolated && !(row[k] != height_m && row[k] <= height_m + kStep_m);
    }
    if (is_isolated && (isolated_.size() < kMaxIsolated || isUsual(height_m))) {
      ++isolated_[height_m];
      continue;
    }
    result_.is_partial = result_.is_partial || is_isolated;
    addToRange(height_m);
    if (is_isolated) continue;
    if (isUsual(height_m)) usual_connected_m_.insert(height_m);
    if (connected_.empty()) connected_.resize(kBits / 64);
    const Bits bits = bitsOf(height_m);
    setBit(bits.first);
    setBit(bits.second);
  }
}

}  // namespace emscape::scenario
