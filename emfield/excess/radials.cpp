#include "emfield/excess/radials.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>
#include <vector>

#include "emfield/columns/foot_inverse.h"
#include "emfield/ground/read_posts.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

using propagation::RadialInputs;

constexpr int kArcs = 7200;
constexpr double kArc_rad = 2 * kPi / kArcs;

/// The farthest positions of each arc.
class Arcs {
 public:
  explicit Arcs(const Station& station) : station_(station), farthest_m_(kArcs, 0) {}

  void add(const GridColumn& column, double t_m) {
    const Seen seen = see(column, t_m);
    raise(seen.arc, seen.distance_m);
  }
  /// Adds all positions on the straight line between two columns.
  void addBetween(const GridColumn& first, const GridColumn& second, double t_m) {
    const Seen begin = see(first, t_m), end = see(second, t_m);
    raise(begin.arc, begin.distance_m);
    raise(end.arc, end.distance_m);
    if (begin.distance_m == 0 || end.distance_m == 0) return;
    const int gap = ((end.arc - begin.arc) % kArcs + kArcs) % kArcs;
    const int from = gap <= kArcs / 2 ? begin.arc : end.arc, arcs = std::min(gap, kArcs - gap);
    for (int i = 0; i <= arcs; ++i) raise((from + i) % kArcs, std::max(begin.distance_m, end.distance_m));
  }
  void add(const Arcs& other) {
    for (int i = 0; i < kArcs; ++i) raise(i, other.farthest_m_[static_cast<std::size_t>(i)]);
  }
  std::vector<float> take() { return std::move(farthest_m_); }

 private:
  struct Seen {
    int arc;
    float distance_m;  ///< 0 at the station: no azimuth
  };
  Seen see(const GridColumn& column, double t_m) const {
    constexpr double kNoAzimuth_m = 1;
    const FastInverse foot = footInverse(station_, column, t_m);
    const double arc = std::atan2(foot.sin_azimuth, foot.cos_azimuth) / kArc_rad + kArcs;
    return {static_cast<int>(arc) % kArcs,
            foot.distance_m < kNoAzimuth_m ? 0 : static_cast<float>(foot.distance_m)};
  }
  void raise(int arc, float distance_m) {
    float& farthest_m = farthest_m_[static_cast<std::size_t>(arc)];
    farthest_m = std::max(farthest_m, distance_m);
  }

  const Station& station_;
  std::vector<float> farthest_m_;
};

/// The farthest positions of a grid are on its border; for tilted columns, at their middles or ends.
void addGrid(const GridColumns& columns, Arcs& arcs) {
  const Dims& dims = columns.dims;
  std::vector<std::size_t> border;
  const auto add = [&](int x, int y) { border.push_back(static_cast<std::size_t>(y) * dims.x + x); };
  for (int x = 0; x < dims.x; ++x) add(x, 0);
  for (int y = 1; y < dims.y; ++y) add(dims.x - 1, y);
  for (int x = dims.x - 2; x >= 0; --x) add(x, dims.y - 1);
  for (int y = dims.y - 2; y >= 0; --y) add(0, y);
  std::vector<double> heights_m = {columns.middle_m()};
  if (columns.tilted)
    for (const float end_m : {columns.t_m.front(), columns.t_m.back()})
      heights_m.push_back(static_cast<double>(end_m));
  for (const double t_m : heights_m) {
    for (std::size_t n = 0; n < border.size(); ++n)
      arcs.addBetween(columns.of_grid[border[n]], columns.of_grid[border[n > 0 ? n - 1 : n]], t_m);
  }
}

void addSurface(const Station& station, const GridColumns& columns, Arcs& arcs) {
  const ColumnsView view = columns.view();
  std::mutex of_arcs;
  parallelFor(static_cast<int>(columns.count()), 1 << 15, [&](int begin, int end) {
    Arcs part(station);
    for (int c = begin; c < end; ++c) part.add(view[static_cast<std::size_t>(c)], columns.middle_m());
    const std::lock_guard lock(of_arcs);
    arcs.add(part);
  });
}

/// Sets the sector that holds all columns: the circle without its widest empty arc, if that is more than
/// half.
void setSector(RadialInputs& radials) {
  int widest = 0, first = 0, empty = 0;
  for (int i = 0; i < 2 * kArcs; ++i) {
    const bool filled = radials.farthest_of_arcs_m[static_cast<std::size_t>(i % kArcs)] > 0;
    empty = filled ? 0 : std::min(empty + 1, kArcs);
    if (empty <= widest) continue;
    widest = empty;
    first = i + 1;
  }
  if (widest <= kArcs / 2 || widest == kArcs) return;
  radials.first_azimuth_rad = first % kArcs * kArc_rad;
  radials.azimuth_span_rad = (kArcs - widest) * kArc_rad;
}

/// Distance (m) between neighbouring columns, on the diagonal.
double spacingOf(const GridColumns& columns) {
  const Dims& dims = columns.dims;
  if (dims.x * dims.y < 2) return 0;
  double longest_m = 2 * columns.beyond_outline_m;
  for (const GridColumn& column : columns.outline)
    longest_m = std::max(longest_m, length(column.foot_ecef_m - columns.outline.front().foot_ecef_m));
  return longest_m / std::hypot(dims.x - 1, dims.y - 1);
}

void setHeights(const GridColumns& columns, const propagation::PathExtent& extent, RadialInputs& radials) {
  const std::vector<float>& t_m = columns.t_m;
  double step_m = t_m.size() > 1 ? static_cast<double>(t_m.back() - t_m.front()) / (t_m.size() - 1) : 0;
  radials.above_ground = columns.every_height;
  if (!radials.above_ground) {
    constexpr double kOfOneLayer_m = 20;
    radials.lowest_m = extent.lowest_msl_m;
    radials.highest_m = extent.highest_msl_m;
    radials.height_step_m = step_m > 0 ? step_m : kOfOneLayer_m;
    radials.are_level = !columns.tilted;
    return;
  }
  // Maps: the lowest height is in the middle of the second cell above the ground, where the mean over a cell
  // is within 0.2 dB of a field that grows with the height.
  constexpr double kMaxStep_m = 10, kMinStep_m = 0.5;
  double lowest_m = HUGE_VAL, highest_m = 0;
  for (std::size_t c = 0; c < columns.count(); ++c) {
    const double ground_m = columns.ground_msl_m.empty() ? 0 : static_cast<double>(columns.ground_msl_m[c]);
    if (!std::isfinite(ground_m)) continue;
    const GridColumn column = columns.view()[c];
    const auto aboveGround_m = [&](float at_m) {
      return heightMsl_m(column, static_cast<double>(at_m)) - ground_m;
    };
    // of those above the ground: the first may be on it, or below
    const auto low =
        std::partition_point(t_m.begin(), t_m.end(), [&](float at_m) { return !(aboveGround_m(at_m) > 0); });
    if (low != t_m.end()) lowest_m = std::min(lowest_m, aboveGround_m(*low));
    const double high_m = aboveGround_m(t_m.back());
    if (std::isfinite(high_m)) highest_m = std::max(highest_m, high_m);
  }
  lowest_m = std::clamp(lowest_m, 1.5 * kMinStep_m, 1.5 * kMaxStep_m);
  radials.height_step_m = lowest_m / 1.5;
  radials.lowest_m = radials.height_step_m / 2;
  radials.highest_m = std::max(highest_m, lowest_m);
}

}  // namespace

RadialInputs radialInputs(const Station& station, const GridColumns& columns,
                          const scenario::Terrain* terrain, const propagation::PathExtent& extent) {
  RadialInputs radials;
  radials.farthest_m = std::max(extent.farthest_m, 1.0);
  Arcs arcs(station);
  if (columns.of_grid.empty()) {
    addSurface(station, columns, arcs);
  } else {
    addGrid(columns, arcs);
  }
  radials.farthest_of_arcs_m = arcs.take();
  setSector(radials);
  radials.spacing_m = spacingOf(columns);
  setHeights(columns, extent, radials);
  radials.has_terrain = terrain != nullptr;
  if (terrain == nullptr) return radials;

  radials.site_ground_msl_m = terrain->heightMsl_m(station.latitude_deg, station.longitude_deg);
  if (std::isnan(radials.site_ground_msl_m)) {
    throw Error(ErrorCode::bad_input, "the ground below the emitter is missing");
  }
  const auto pathOf = [](double azimuth_rad, double length_m) {
    return FastInverse{length_m, std::sin(azimuth_rad), std::cos(azimuth_rad)};
  };
  const auto rangesOf = [](int count, double step_m) {
    std::vector<double> ranges_m(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) ranges_m[static_cast<std::size_t>(i)] = i * step_m;
    return ranges_m;
  };
  radials.ground = [=](double azimuth_rad, double length_m, double step_m, int count, float* ground_msl_m) {
    const std::vector<double> ranges_m = rangesOf(count, step_m);
    readPostsCpu(station, groundPosts(terrain, ranges_m), pathOf(azimuth_rad, length_m), 0, count,
                 ground_msl_m);
  };
  if (terrain->view().hasCover()) {
    radials.cover = [=](double azimuth_rad, double length_m, double step_m, int count,
                        const float* ground_msl_m, float* cover_m) {
      const std::vector<double> ranges_m = rangesOf(count, step_m);
      readCover(station, groundPosts(terrain, ranges_m), pathOf(azimuth_rad, length_m), ranges_m.data(),
                ground_msl_m, count, cover_m);
    };
  }
  // The relief, from a few azimuths: summits between them may be higher by some metres.
  constexpr int kAzimuths = 128, kPosts = 512;
  double lowest_m = radials.site_ground_msl_m, highest_m = radials.site_ground_msl_m;
  std::mutex of_relief;
  parallelFor(kAzimuths, 8, [&](int begin, int end) {
    std::vector<float> ground_msl_m(kPosts);
    for (int a = begin; a < end; ++a) {
      radials.ground(radials.first_azimuth_rad + a * radials.azimuth_span_rad / (kAzimuths - 1),
                     radials.farthest_m, radials.farthest_m / (kPosts - 1), kPosts, ground_msl_m.data());
      const auto known_end = std::find_if(ground_msl_m.begin(), ground_msl_m.end(),
                                          [](float height_m) { return std::isnan(height_m); });
      if (known_end == ground_msl_m.begin()) continue;
      const auto [low, high] = std::minmax_element(ground_msl_m.begin(), known_end);
      const std::lock_guard lock(of_relief);
      lowest_m = std::min(lowest_m, static_cast<double>(*low));
      highest_m = std::max(highest_m, static_cast<double>(*high));
    }
  });
  radials.lowest_ground_msl_m = lowest_m;
  radials.highest_ground_msl_m = highest_m;
  return radials;
}

}  // namespace emscape::emfield
