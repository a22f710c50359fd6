#include "emscape/propagation/steep_ground.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "emscape/base/units.h"
#include "propagation/parabolic_equation/march/march_grid.h"

namespace emscape::propagation {
namespace {

struct Lengths {
  double whole_m = 0, staircases_m = 0, behind_m = 0;

  void add(const std::vector<SteepAzimuth>& azimuths) {
    for (const SteepAzimuth& azimuth : azimuths) {
      whole_m += azimuth.whole_m;
      staircases_m += azimuth.staircases_m;
      behind_m += azimuth.behind_m;
    }
  }
  double part(double length_m) const { return whole_m > 0 ? length_m / whole_m : 0; }
  double lostPart() const { return part(staircases_m + behind_m); }
};

/// None: a plan is refused.
std::optional<Lengths> lengthsWith(const std::vector<SteepGround>& marches, double max_angle_deg) {
  Lengths all;
  for (const SteepGround& march : marches) {
    const std::vector<SteepAzimuth> azimuths = march.with(max_angle_deg);
    if (azimuths.empty()) return std::nullopt;
    all.add(azimuths);
  }
  return all;
}

/// The narrowest sector that has nine tenths of what is lost.
std::string sectorText(const std::vector<SteepGround>& marches) {
  constexpr double kMost = 0.9;
  struct Lost {
    double azimuth_deg, lost_m;
  };
  std::vector<Lost> lost;
  double all_m = 0;
  for (const SteepGround& march : marches) {
    for (const SteepAzimuth& azimuth : march.azimuths) {
      const double lost_m = azimuth.staircases_m + azimuth.behind_m;
      if (!(lost_m > 0)) continue;
      const double azimuth_deg = std::fmod(radToDeg(azimuth.azimuth_rad) + 720, 360);
      lost.push_back({azimuth_deg, lost_m});
      all_m += lost_m;
    }
  }
  std::sort(lost.begin(), lost.end(),
            [](const Lost& a, const Lost& b) { return a.azimuth_deg < b.azimuth_deg; });
  const std::size_t count = lost.size();
  double first_deg = 0, width_deg = 360, held_m = 0;
  for (std::size_t first = 0, end = 0; first < count; held_m -= lost[first++].lost_m) {
    for (; held_m < kMost * all_m && end < first + count; ++end) held_m += lost[end % count].lost_m;
    if (held_m < kMost * all_m) break;
    const double to_deg = std::fmod(lost[(end - 1) % count].azimuth_deg - lost[first].azimuth_deg + 360, 360);
    if (to_deg >= width_deg) continue;
    width_deg = to_deg;
    first_deg = lost[first].azimuth_deg;
  }
  const auto rounded = [](double azimuth_deg) { return std::lround(azimuth_deg) % 360; };
  if (std::lround(width_deg) < 1) return fmt::format("at azimuth {} degrees", rounded(first_deg));
  return fmt::format("nine tenths of it between azimuths {} and {} degrees", rounded(first_deg),
                     rounded(first_deg + width_deg));
}

std::string leavesText(const std::string& setting, const Lengths& lengths) {
  return fmt::format("'max_angle_deg: {}' leaves {:.1f} %", setting, 100 * lengths.lostPart());
}

std::string remedyText(const std::vector<SteepGround>& marches, const Lengths& now) {
  constexpr double kNear = 0.005, kWorthwhile = 0.5;  // of the length; of what is lost remains
  const auto helps = [&](const std::optional<Lengths>& tried) {
    return tried && tried->lostPart() <= kWorthwhile * now.lostPart();
  };
  if (!std::all_of(marches.begin(), marches.end(), [](const SteepGround& m) { return m.is_automatic; })) {
    const std::optional<Lengths> automatic = lengthsWith(marches, 0);
    if (helps(automatic)) return leavesText("auto", *automatic);
  }
  double least_deg = kPeAngle.max;
  for (const SteepGround& march : marches) least_deg = std::min(least_deg, march.max_angle_deg);
  std::vector<int> angles_deg(std::size_t(std::max(kPeAngle.max - std::floor(least_deg), 0.0)));
  std::iota(angles_deg.begin(), angles_deg.end(), int(std::floor(least_deg)) + 1);
  const auto end = std::partition_point(angles_deg.begin(), angles_deg.end(), [&](int angle_deg) {
    return lengthsWith(marches, angle_deg).has_value();
  });
  if (end == angles_deg.begin())
    return least_deg >= kPeAngle.max ? "no larger 'max_angle_deg' is possible"
                                     : "the height steps afford no larger 'max_angle_deg'";
  const std::optional<Lengths> largest = lengthsWith(marches, end[-1]);
  if (!helps(largest))
    return fmt::format("no 'max_angle_deg' up to {}{} leaves half of it or less", end[-1],
                       end == angles_deg.end() ? "" : ", which is what the height steps afford,");
  const auto least = std::partition_point(angles_deg.begin(), end - 1, [&](int angle_deg) {
    const std::optional<Lengths> tried = lengthsWith(marches, angle_deg);
    return !helps(tried) || tried->lostPart() > largest->lostPart() + kNear;
  });
  return leavesText(std::to_string(*least), *lengthsWith(marches, *least));
}

}  // namespace

double SteepGround::lostPart() const {
  Lengths lengths;
  lengths.add(azimuths);
  return lengths.lostPart();
}

std::string steepGroundWarning(const std::vector<SteepGround>& marches) {
  constexpr double kFewStaircases = 0.0005, kMuchBehind = 0.1;
  Lengths now;
  for (const SteepGround& march : marches) now.add(march.azimuths);
  const double staircases = now.part(now.staircases_m), behind = now.part(now.behind_m);
  if (staircases < kFewStaircases && behind < kMuchBehind) return "";
  std::string text;
  if (staircases >= kFewStaircases)
    text = fmt::format(
        "{:.1f} % of the length of its marches is over ground that is steeper or more sharply bent than the "
        "band of the equation holds, and taken as steps of a staircase (with another largest angle the field "
        "differs by some dB in sight and by 10 to 30 dB deep in shadow)",
        100 * staircases);
  if (behind >= kFewStaircases)
    text += fmt::format("{}{:.1f} % {} behind ground above the largest angle, where 'diffraction' applies",
                        text.empty() ? "" : ", and ", 100 * behind,
                        text.empty() ? "of the length of its marches is" : "is");
  return fmt::format("{}; {}; {}", text, sectorText(marches), remedyText(marches, now));
}

}  // namespace emscape::propagation
