#include "study/maps/contour_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "emscape/base/work.h"

namespace emscape::study {
namespace {

/// A side of a cell: 2 n from value n to the next in x, 2 n + 1 to the next in y.
using Side = long long;

/// The sides to which a side is joined, at most one in each of its two cells; -1: none.
using Joints = std::map<Side, std::array<Side, 2>>;

void join(Joints& joints, Side a, Side b) {
  for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
    std::array<Side, 2>& ends = joints.try_emplace(from, std::array<Side, 2>{-1, -1}).first->second;
    ends[ends[0] < 0 ? 0 : 1] = to;
  }
}

/// Removes a line from the joints, from one of its sides on.
std::vector<Side> take(Joints& joints, Side begin) {
  std::vector<Side> sides{begin};
  for (Side before = -1, side = begin;;) {
    const auto found = joints.find(side);
    if (found == joints.end()) break;
    const std::array<Side, 2> ends = found->second;
    joints.erase(found);
    const Side next = ends[0] == before || ends[0] < 0 ? ends[1] : ends[0];
    if (next < 0) break;
    sides.push_back(next);
    before = side;
    side = next;
  }
  return sides;
}

}  // namespace

std::vector<GridLine> contourLines(const std::vector<float>& values, int width, int height, float level,
                                   float floor) {
  Joints joints;
  for (int j = 0; j + 1 < height; ++j) {
    checkpoint();
    for (int i = 0; i + 1 < width; ++i) {
      const Side n = static_cast<Side>(j) * width + i;
      // Around the cell: corners, and the sides from each to the next.
      const std::array<float, 4> corners{values[n], values[n + 1], values[n + width + 1], values[n + width]};
      const std::array<Side, 4> sides{2 * n, 2 * (n + 1) + 1, 2 * (n + width), 2 * n + 1};
      if (!std::all_of(corners.begin(), corners.end(), [](float v) { return std::isfinite(v); })) continue;
      std::vector<Side> crossed;
      for (int c = 0; c < 4; ++c) {
        if ((corners[c] >= level) != (corners[(c + 1) % 4] >= level)) crossed.push_back(sides[c]);
      }
      const float mean = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
      // At a saddle, the corners that differ from the middle are cut off.
      if (crossed.size() == 4 && (corners[0] >= level) != (mean >= level)) {
        std::rotate(crossed.begin(), crossed.begin() + 3, crossed.end());
      }
      for (std::size_t c = 0; c < crossed.size(); c += 2) join(joints, crossed[c], crossed[c + 1]);
    }
  }
  const auto place = [&](Side side) {
    const Side n = side / 2, next = side % 2 == 0 ? n + 1 : n + width;
    const bool is_edge = values[n] <= floor || values[next] <= floor;
    const double part = is_edge ? 0.5 : static_cast<double>((level - values[n]) / (values[next] - values[n]));
    const auto x = static_cast<double>(n % width), y = static_cast<double>(n / width);
    return side % 2 == 0 ? GridPoint{x + part, y} : GridPoint{x, y + part};
  };
  std::vector<GridLine> lines;
  const auto addFrom = [&](Side begin) {
    GridLine line;
    for (const Side side : take(joints, begin)) line.push_back(place(side));
    lines.push_back(std::move(line));
  };
  std::vector<Side> ends;
  for (const auto& [side, to] : joints) {
    if (to[1] < 0) ends.push_back(side);
  }
  for (const Side end : ends) {
    if (joints.count(end) > 0) addFrom(end);
  }
  while (!joints.empty()) addFrom(joints.begin()->first);
  return lines;
}

}  // namespace emscape::study
