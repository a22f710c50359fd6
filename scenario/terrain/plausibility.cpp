#include "scenario/terrain/plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "scenario/terrain/file.h"

namespace emscape::scenario {
namespace {

constexpr std::size_t kMaxFillValues = 2;
/// Of posts that are not on earth: a larger share is no error of single posts.
constexpr double kMaxShareBeyond = 0.01;

/// Other units in which the heights would be on land, the first with its key.
std::string otherUnits(const TerrainFile& file, const HeightTally& tally) {
  constexpr double kLowestLand_m = -500;
  if (!file.head().meaning.is_unit_assumed && !file.head().keys.height_unit)
    return "";  // a key would contradict it
  std::string names;
  for (const HeightUnit unit : {HeightUnit::cm, HeightUnit::dm, HeightUnit::ft}) {
    const double factor = metresOf(unit) / file.head().meaning.unit_m;
    if (factor >= 1 || tally.lowest_m() * factor < kLowestLand_m ||
        tally.highest_m() * factor > kHighestOnEarth_m)
      continue;
    names += names.empty() ? fmt::format("`height_unit: {}`", toString(unit))
                           : fmt::format(" or {}", toString(unit));
  }
  return names.empty() ? "" : "If they are in another unit, " + names + " of the file states it. ";
}

std::string percent(long long part, long long all) {
  return fmt::format("{:.3g} %", 100.0 * static_cast<double>(part) / static_cast<double>(std::max(all, 1LL)));
}

void addBeyond(const TerrainFile& file, const HeightTally& tally, std::vector<Implausibility>& all) {
  for (const HeightTally::Value& fill : tally.fills()) {
    all.push_back({false, fmt::format("{} post{} of {:g} m {} not on earth ({:g} to {:g} m): a fill value "
                                      "that the file does not declare; void",
                                      fill.posts, fill.posts == 1 ? "" : "s", fill.height_m,
                                      fill.posts == 1 ? "is" : "are", kLowestOnEarth_m, kHighestOnEarth_m)});
  }
  if (tally.beyond() == 0 || !tally.fills().empty()) return;
  const std::string what = fmt::format(
      "{} of {} posts ({}) are not on earth ({:g} to {:g} m): the lowest {:g} m, the highest {:g} m",
      tally.beyond(), tally.posts(), percent(tally.beyond(), tally.posts()), kLowestOnEarth_m,
      kHighestOnEarth_m, tally.lowest_m(), tally.highest_m());
  const bool is_few =
      static_cast<double>(tally.beyond()) <= kMaxShareBeyond * static_cast<double>(tally.posts());
  if (is_few || file.head().keys.implausible == ImplausibleHeights::as_void) {
    all.push_back({false, what + "; void"});
    return;
  }
  all.push_back({true, fmt::format("{}. The file may have another encoding or byte order, or be damaged. "
                                   "{}`implausible: void` of the file in the scenario takes them as voids",
                                   what, otherUnits(file, tally))});
}

}  // namespace

float withSwappedBytes(float value) {
  const auto bits = static_cast<std::uint16_t>(static_cast<std::int32_t>(value));
  return static_cast<float>(static_cast<std::int16_t>(static_cast<std::uint16_t>(bits << 8U | bits >> 8U)));
}

float withSwappedBytesOfReal(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  bits = bits << 24U | (bits & 0xFF00U) << 8U | (bits >> 8U & 0xFF00U) | bits >> 24U;
  std::memcpy(&value, &bits, sizeof bits);
  return value;
}

void HeightTally::addBeyond(double height_m, long long posts) {
  beyond_ += posts;
  lowest_m_ = std::min(lowest_m_, height_m);
  highest_m_ = std::max(highest_m_, height_m);
  const auto known = std::find_if(values_.begin(), values_.end(),
                                  [&](const Value& value) { return value.height_m == height_m; });
  if (known != values_.end()) {
    known->posts += posts;
  } else if (values_.size() <= kMaxFillValues) {
    values_.push_back({height_m, posts});
  }
}

void HeightTally::add(const HeightTally& other) {
  const long long beyond = beyond_ + other.beyond_;
  for (const Value& value : other.values_) addBeyond(value.height_m, value.posts);
  beyond_ = beyond;
  lowest_m_ = std::min(lowest_m_, other.lowest_m_);
  highest_m_ = std::max(highest_m_, other.highest_m_);
  posts_ += other.posts_;
  tiny_ += other.tiny_;
  tiny_heights_ += other.tiny_heights_;
  pairs_ += other.pairs_;
  steps_ += other.steps_;
  step_sum_ += other.step_sum_;
  swapped_step_sum_ += other.swapped_step_sum_;
}

void HeightTally::addSteps(const std::vector<float>& values, const std::vector<std::uint8_t>& is_known,
                           std::size_t first, std::size_t count) {
  for (std::size_t k = first + 1; k < first + count; ++k) {
    if (is_known[k] == 0 || is_known[k - 1] == 0) continue;
    ++pairs_;
    if (values[k] == values[k - 1]) continue;
    ++steps_;
    step_sum_ += static_cast<double>(std::abs(values[k] - values[k - 1]));
    swapped_step_sum_ +=
        static_cast<double>(std::abs(withSwappedBytes(values[k]) - withSwappedBytes(values[k - 1])));
  }
}

bool HeightTally::looksSwapped() const {
  // A step of one becomes one of 256: real ground steps by far less than 100 between posts, or by more when
  // its bytes are exchanged.
  constexpr double kMinStep = 100, kMinRatio = 8, kMinShare = 0.03;
  const auto steps = static_cast<double>(steps_);
  return steps > kMinShare * static_cast<double>(pairs_) && step_sum_ > kMinStep * steps &&
         step_sum_ > kMinRatio * swapped_step_sum_;
}

void HeightTally::addReal(float value) {
  constexpr float kLeastHeight = 1e-3F;
  if (value == 0 || std::abs(value) >= kLeastReal) return;
  ++tiny_;
  const float size = std::abs(withSwappedBytesOfReal(value));
  if (size >= kLeastHeight && static_cast<double>(size) <= -kLowestOnEarth_m) ++tiny_heights_;
}

bool HeightTally::looksSwappedReal() const {
  // Numbers that are nearly 0 for another reason become heights by chance only.
  constexpr double kMinShare = 0.8;
  return static_cast<double>(tiny_) > kMaxShareBeyond * static_cast<double>(posts_) &&
         static_cast<double>(tiny_heights_) > kMinShare * static_cast<double>(tiny_);
}

std::vector<HeightTally::Value> HeightTally::fills() const {
  return values_.size() <= kMaxFillValues ? values_ : std::vector<Value>{};
}

std::vector<Implausibility> implausibilitiesOf(const TerrainFile& file, const HeightTally& tally,
                                               const FillValues::Result& fills) {
  std::vector<Implausibility> all;
  if (tally.looksSwapped()) {
    const std::string remedy = file.head().keys.swap_bytes
                                   ? "leave out `swap_bytes` of the file"
                                   : "`swap_bytes: true` of the file in the scenario reads them so";
    all.push_back({true, fmt::format("its heights jump from post to post, and become smooth if the two bytes "
                                     "of each are exchanged: it is in the other byte order; {}",
                                     remedy)});
    return all;
  }
  if (tally.looksSwappedReal()) {
    all.push_back({true, fmt::format("its real numbers are nearly 0, below 1e-20, as the other byte order "
                                     "makes of heights; {}",
                                     file.head().keys.swap_bytes
                                         ? "leave out `swap_bytes` of the file"
                                         : "`swap_bytes: true` of the file in the scenario reads them so")});
    return all;
  }
  addBeyond(file, tally, all);
  if (fills.low_posts > 0) {
    all.push_back(
        {false, fmt::format("{} of {} posts ({}) are below {:g} m, the lowest at {:g} m, where no land is: "
                            "if they are the bed of a sea, ground is that bed, not the water",
                            fills.low_posts, tally.posts(), percent(fills.low_posts, tally.posts()),
                            FillValues::kBelow_m, fills.lowest_m)});
  }
  return all;
}

}  // namespace emscape::scenario
