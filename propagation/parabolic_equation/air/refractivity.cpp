#include "propagation/parabolic_equation/air/refractivity.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>

#include "emscape/base/error.h"

namespace emscape::propagation {
namespace {

constexpr int kEvaporationLevels = 256;
constexpr double kEvaporationTop_m = 1000;
constexpr int kAddedLevels = 96;
constexpr double kMaxDuctHeight_m = 60;
/// Standard air above a measured profile ends here; N falls by e in the scale height above.
constexpr double kStandardTop_m = 5000, kScaleHeight_m = 7350;
constexpr int kMaxLevels = 256;
constexpr double kMaxHeight_m = 60000;
constexpr double kMaxM = 2500;
constexpr double kMaxGradient_m = 5;

/// @param allowed  "above 0 m"
[[noreturn]] void refuse(const char* what, double value, const char* unit, const std::string& allowed) {
  throw Error(ErrorCode::bad_input, fmt::format("{}: {} {} is not {}", what, value, unit, allowed));
}

bool haveSameCounts(const std::vector<RefractivityProfile>& profiles) {
  return std::all_of(profiles.begin(), profiles.end(), [&](const RefractivityProfile& profile) {
    return profile.levels.size() == profiles.front().levels.size();
  });
}

/// Heights with a constant step in their logarithm, so that the error of linear interpolation is uniform, and
/// the duct height.
std::set<double> evaporationHeights_m(double top_m, int count, double duct_height_m) {
  const double step = std::log1p(top_m / kEvaporationRoughness_m) / (count - 2);
  std::set<double> heights_m{duct_height_m};
  for (int i = 0; i < count - 1; ++i) heights_m.insert(kEvaporationRoughness_m * std::expm1(step * i));
  return heights_m;
}

void checkDuctHeight(double duct_height_m) {
  if (!(duct_height_m >= 0 && duct_height_m <= kMaxDuctHeight_m)) {
    refuse("duct height", duct_height_m, "m", fmt::format("in 0 .. {} m", kMaxDuctHeight_m));
  }
}

/// The departure of an evaporation duct from standard air, without a constant: integral of its gradient,
/// faded to 0 between two and three duct heights.
double departure(double z, double d) {
  constexpr double z0 = kEvaporationRoughness_m, excess = 0.125 - kStandardGradient_m;
  z = std::clamp(z, 0.0, 3 * d);
  const auto full = [&](double h) { return excess * h - 0.125 * d * std::log((h + z0) / z0); };
  // Integral of (3 - h/d) (excess - 0.125 d / (h + z0)).
  const auto faded = [&](double h) {
    const double logarithm = std::log((h + z0) / z0);
    return 3 * full(h) - excess * h * h / (2 * d) + 0.125 * (h - z0 * logarithm);
  };
  return z <= 2 * d ? full(z) : full(2 * d) + faded(z) - faded(2 * d);
}

}  // namespace

double RefractivityProfile::at(double height_msl_m) const {
  const RefractivityLevel &first = levels.front(), &last = levels.back();
  if (levels.size() == 1 || height_msl_m >= last.height_msl_m) {
    return last.m_units + top_gradient_m * (height_msl_m - last.height_msl_m);
  }
  const auto above =
      height_msl_m < first.height_msl_m
          ? levels.begin() + 1
          : std::upper_bound(levels.begin() + 1, levels.end() - 1, height_msl_m,
                             [](double z, const RefractivityLevel& level) { return z < level.height_msl_m; });
  const RefractivityLevel &upper = *above, &lower = *std::prev(above);
  return lower.m_units + (upper.m_units - lower.m_units) * (height_msl_m - lower.height_msl_m) /
                             (upper.height_msl_m - lower.height_msl_m);
}

bool RefractivityProfile::traps() const {
  if (top_gradient_m < 0) return true;
  return std::adjacent_find(levels.begin(), levels.end(),
                            [](const RefractivityLevel& lower, const RefractivityLevel& upper) {
                              return upper.m_units < lower.m_units;
                            }) != levels.end();
}

RefractivityProfile standardRefractivity(double surface_m_units) {
  return linearRefractivity(kStandardGradient_m, surface_m_units);
}

RefractivityProfile linearRefractivity(double gradient_m, double surface_m_units) {
  return {{{0, surface_m_units}}, gradient_m};
}

RefractivityProfile evaporationDuct(double duct_height_m, double surface_m_units) {
  checkDuctHeight(duct_height_m);
  RefractivityProfile profile;
  for (const double z : evaporationHeights_m(kEvaporationTop_m, kEvaporationLevels, duct_height_m)) {
    const double logarithm = std::log((z + kEvaporationRoughness_m) / kEvaporationRoughness_m);
    profile.levels.push_back({z, surface_m_units + 0.125 * (z - duct_height_m * logarithm)});
  }
  return profile;
}

RefractivityProfile withEvaporationDuct(const RefractivityProfile& profile, double duct_height_m) {
  checkDuctHeight(duct_height_m);
  if (duct_height_m == 0) return profile;
  std::set<double> heights_m = evaporationHeights_m(3 * duct_height_m, kAddedLevels, duct_height_m);
  for (const RefractivityLevel& level : profile.levels) heights_m.insert(level.height_msl_m);
  RefractivityProfile sum;
  sum.top_gradient_m = profile.top_gradient_m;
  sum.known_to_m = profile.known_to_m;
  for (const double z : heights_m) sum.levels.push_back({z, profile.at(z) + departure(z, duct_height_m)});
  return sum;
}

RefractivityProfile withUpperAir(RefractivityProfile profile) {
  RefractivityLevel top = profile.levels.back();
  profile.known_to_m = top.height_msl_m;
  if (top.height_msl_m < kStandardTop_m) {
    top = {kStandardTop_m, profile.at(kStandardTop_m)};
    profile.levels.push_back(top);
  }
  const double n_units = top.m_units - kFlatteningGradient_m * top.height_msl_m;
  if (n_units <= 0) return profile;
  for (const double above_m : {1e3, 2e3, 3e3, 5e3, 7e3, 10e3, 15e3, 20e3, 35e3}) {
    const double z = top.height_msl_m + above_m;
    profile.levels.push_back({z, n_units * std::exp(-above_m / kScaleHeight_m) + kFlatteningGradient_m * z});
  }
  profile.top_gradient_m = kFlatteningGradient_m;
  return profile;
}

RefractivityProfile meanProfile(const std::vector<RefractivityProfile>& profiles,
                                const std::vector<double>& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const auto mean = [&](const auto& valueOf) {
    double weighted = 0;
    for (std::size_t i = 0; i < profiles.size(); ++i) weighted += weights[i] * valueOf(profiles[i]);
    return weighted / sum;
  };
  RefractivityProfile result;
  result.top_gradient_m = mean([](const RefractivityProfile& p) { return p.top_gradient_m; });
  for (const RefractivityProfile& p : profiles) result.known_to_m = std::min(result.known_to_m, p.known_to_m);
  if (haveSameCounts(profiles)) {
    for (std::size_t i = 0; i < profiles.front().levels.size(); ++i) {
      result.levels.push_back({mean([i](const RefractivityProfile& p) { return p.levels[i].height_msl_m; }),
                               mean([i](const RefractivityProfile& p) { return p.levels[i].m_units; })});
    }
    return result;
  }
  std::set<double> heights_m;
  for (const RefractivityProfile& profile : profiles) {
    for (const RefractivityLevel& level : profile.levels) heights_m.insert(level.height_msl_m);
  }
  for (const double z : heights_m) {
    result.levels.push_back({z, mean([z](const RefractivityProfile& p) { return p.at(z); })});
  }
  return result;
}

std::vector<RefractivityLevel> thinned(const std::vector<RefractivityLevel>& levels, double tolerance) {
  if (levels.size() < 3) return levels;
  std::vector<bool> kept(levels.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> pieces{{0, levels.size() - 1}};
  while (!pieces.empty()) {
    const auto [first, last] = pieces.back();
    pieces.pop_back();
    const RefractivityLevel &a = levels[first], &b = levels[last];
    const double gradient = (b.m_units - a.m_units) / (b.height_msl_m - a.height_msl_m);
    std::size_t worst = first;
    double largest = tolerance;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double error =
          std::fabs(a.m_units + gradient * (levels[i].height_msl_m - a.height_msl_m) - levels[i].m_units);
      if (error > largest) {
        largest = error;
        worst = i;
      }
    }
    if (worst == first) continue;
    kept[worst] = true;
    pieces.emplace_back(first, worst);
    pieces.emplace_back(worst, last);
  }
  std::vector<RefractivityLevel> few;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (kept[i]) few.push_back(levels[i]);
  }
  return few;
}

RefractivityProfile surfaceDuct(double top_m, double deficit_m_units, double surface_m_units) {
  return trilinearRefractivity(0, top_m, deficit_m_units, surface_m_units);
}

RefractivityProfile trilinearRefractivity(double base_m, double top_m, double deficit_m_units,
                                          double surface_m_units) {
  if (!(base_m >= 0)) refuse("base of the layer", base_m, "m", "0 m or more");
  if (!(top_m > base_m))
    refuse("top of the layer", top_m, "m", fmt::format("above its base of {} m", base_m));
  if (!(top_m <= kMaxHeight_m))
    refuse("top of the layer", top_m, "m", fmt::format("{} m or less", kMaxHeight_m));
  if (!(deficit_m_units > 0 && deficit_m_units <= kMaxM)) {
    refuse("deficit of the layer", deficit_m_units, "M-units",
           fmt::format("above 0, up to {} M-units", kMaxM));
  }
  const double at_base = surface_m_units + kStandardGradient_m * base_m;
  RefractivityProfile profile;
  if (base_m > 0) profile.levels.push_back({0, surface_m_units});
  profile.levels.push_back({base_m, at_base});
  profile.levels.push_back({top_m, at_base - deficit_m_units});
  return profile;
}

std::string faultOfLevel(const std::vector<RefractivityLevel>& levels, std::size_t index) {
  const RefractivityLevel& level = levels[index];
  if (!(std::fabs(level.height_msl_m) <= kMaxHeight_m)) {
    return fmt::format("height: {} m is not within {} m of sea level", level.height_msl_m, kMaxHeight_m);
  }
  if (!(level.m_units >= 0 && level.m_units <= kMaxM)) {
    return fmt::format("M: {} is not in 0 .. {} M-units", level.m_units, kMaxM);
  }
  if (index == 0) return {};
  const RefractivityLevel& below = levels[index - 1];
  if (!(level.height_msl_m > below.height_msl_m)) {
    return fmt::format("height: {} m is not above the level before, {} m", level.height_msl_m,
                       below.height_msl_m);
  }
  const double gradient = (level.m_units - below.m_units) / (level.height_msl_m - below.height_msl_m);
  if (!(std::fabs(gradient) <= kMaxGradient_m)) {
    return fmt::format("gradient from the level before: {:.4g} M-units per metre is not within +-{}",
                       gradient, kMaxGradient_m);
  }
  return {};
}

RefractivityProfile profileOfLevels(std::vector<RefractivityLevel> levels) {
  if (levels.size() < 2 || levels.size() > kMaxLevels) {
    throw Error(ErrorCode::bad_input,
                fmt::format("refractivity profile: {} levels; expected 2 .. {}", levels.size(), kMaxLevels));
  }
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (const std::string fault = faultOfLevel(levels, i); !fault.empty()) {
      throw Error(ErrorCode::bad_input, fmt::format("refractivity profile, level {}: {}", i + 1, fault));
    }
  }
  return {std::move(levels)};
}

RefractivityAlongPath::RefractivityAlongPath(RefractivityProfile profile)
    : ranges_m_{0}, profiles_{std::move(profile)} {}

RefractivityAlongPath::RefractivityAlongPath(std::vector<double> ranges_m,
                                             std::vector<RefractivityProfile> profiles)
    : ranges_m_(std::move(ranges_m)), profiles_(std::move(profiles)) {
  if (profiles_.empty() || ranges_m_.size() != profiles_.size()) {
    throw Error(ErrorCode::bad_input, fmt::format("refractivity along the path: {} ranges for {} profiles",
                                                  ranges_m_.size(), profiles_.size()));
  }
  for (std::size_t i = 1; i < ranges_m_.size(); ++i) {
    if (!(ranges_m_[i] > ranges_m_[i - 1])) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("refractivity along the path: range {} m is not above {} m", ranges_m_[i],
                              ranges_m_[i - 1]));
    }
  }
}

RefractivityProfile RefractivityAlongPath::at(double range_m) const {
  const auto above = std::upper_bound(ranges_m_.begin(), ranges_m_.end(), range_m);
  if (above == ranges_m_.begin()) return profiles_.front();
  if (above == ranges_m_.end()) return profiles_.back();
  const std::size_t i = std::size_t(above - ranges_m_.begin());
  const double t = (range_m - ranges_m_[i - 1]) / (ranges_m_[i] - ranges_m_[i - 1]);
  return meanProfile({profiles_[i - 1], profiles_[i]}, {1 - t, t});
}

bool RefractivityAlongPath::traps() const {
  return std::any_of(profiles_.begin(), profiles_.end(),
                     [](const RefractivityProfile& p) { return p.traps(); });
}

bool RefractivityAlongPath::pointwise() const {
  return std::adjacent_find(profiles_.begin(), profiles_.end(),
                            [](const RefractivityProfile& a, const RefractivityProfile& b) {
                              return a.levels.size() != b.levels.size();
                            }) != profiles_.end();
}

}  // namespace emscape::propagation
