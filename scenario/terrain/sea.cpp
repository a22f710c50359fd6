#include "scenario/terrain/sea.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"

namespace emscape::scenario {
namespace {

constexpr float kSeaLevel_m = 0.5F, kLevel_m = 0.02F;
constexpr std::size_t kMinPoints = 30;

/// Calls visit(index) for a point and its neighbours.
template <class Visit>
void eachNear(int columns, int rows, std::size_t point, const Visit& visit) {
  const int i = static_cast<int>(point % static_cast<std::size_t>(columns));
  const int j = static_cast<int>(point / static_cast<std::size_t>(columns));
  for (int y = std::max(j - 1, 0); y <= std::min(j + 1, rows - 1); ++y) {
    for (int x = std::max(i - 1, 0); x <= std::min(i + 1, columns - 1); ++x)
      visit(static_cast<std::size_t>(y) * columns + x);
  }
}

}  // namespace

std::vector<std::uint8_t> seaByHeights(int columns, int rows, const std::vector<float>& msl_m,
                                       const std::vector<std::uint8_t>& by_coast) {
  if (msl_m.empty()) return std::vector<std::uint8_t>(static_cast<std::size_t>(columns) * rows, 0);
  enum : std::uint8_t { kNotLevel, kLevel, kSeen };
  std::vector<std::uint8_t> states(msl_m.size());
  parallelFor(rows, 16, [&](int begin, int end) {
    const std::size_t width = static_cast<std::size_t>(columns);
    for (std::size_t point = begin * width; point < end * width; ++point) {
      bool is_level = std::abs(msl_m[point]) <= kSeaLevel_m;
      if (is_level) {
        eachNear(columns, rows, point, [&](std::size_t near) {
          is_level = is_level && !(std::abs(msl_m[near] - msl_m[point]) > kLevel_m);
        });
      }
      states[point] = is_level ? kLevel : kNotLevel;
    }
  });
  std::vector<std::uint8_t> sea(msl_m.size(), 0);
  std::vector<std::size_t> part;
  for (std::size_t start = 0; start < states.size(); ++start) {
    if (states[start] != kLevel) continue;
    part.assign(1, start);
    states[start] = kSeen;
    bool is_sea = by_coast.empty();
    for (std::size_t n = 0; n < part.size(); ++n) {
      is_sea = is_sea || by_coast[part[n]] != 0;
      eachNear(columns, rows, part[n], [&](std::size_t near) {
        if (states[near] != kLevel) return;
        states[near] = kSeen;
        part.push_back(near);
      });
    }
    if (!is_sea || part.size() < kMinPoints) continue;
    for (const std::size_t point : part) {
      eachNear(columns, rows, point, [&](std::size_t near) {
        if (std::abs(msl_m[near] - msl_m[point]) <= kLevel_m) sea[near] = 1;
      });
    }
  }
  return sea;
}

}  // namespace emscape::scenario
