#include "propagation/parabolic_equation/refractivity.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "emscape/base/error.h"

namespace emscape::propagation {
namespace {

constexpr int kEvaporationLevels = 256;
constexpr double kEvaporationTop_m = 1000;
constexpr double kMaxDuctHeight_m = 60;
constexpr int kMaxLevels = 256;
constexpr double kMaxHeight_m = 60000;
constexpr double kMaxM = 2500;
constexpr double kMaxGradient_m = 5;

/// @param allowed  "above 0 m"
[[noreturn]] void refuse(const char* what, double value, const char* unit, const std::string& allowed) {
  throw Error(ErrorCode::bad_input, fmt::format("{}: {} {} is not {}", what, value, unit, allowed));
}

RefractivityProfile levelByLevel(const RefractivityProfile& a, const RefractivityProfile& b, double t) {
  const auto lerp = [t](double from, double to) { return from + t * (to - from); };
  RefractivityProfile between;
  for (std::size_t i = 0; i < a.levels.size(); ++i) {
    between.levels.push_back({lerp(a.levels[i].height_msl_m, b.levels[i].height_msl_m),
                              lerp(a.levels[i].m_units, b.levels[i].m_units)});
  }
  between.top_gradient_m = lerp(a.top_gradient_m, b.top_gradient_m);
  return between;
}

RefractivityProfile heightByHeight(const RefractivityProfile& a, const RefractivityProfile& b, double t) {
  std::set<double> heights_m;
  for (const RefractivityProfile* profile : {&a, &b}) {
    for (const RefractivityLevel& level : profile->levels) heights_m.insert(level.height_msl_m);
  }
  RefractivityProfile between;
  for (const double z : heights_m) between.levels.push_back({z, a.at(z) + t * (b.at(z) - a.at(z))});
  between.top_gradient_m = a.top_gradient_m + t * (b.top_gradient_m - a.top_gradient_m);
  return between;
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
  if (!(duct_height_m >= 0 && duct_height_m <= kMaxDuctHeight_m)) {
    refuse("duct height", duct_height_m, "m", fmt::format("in 0 .. {} m", kMaxDuctHeight_m));
  }
  // Evenly spaced in the logarithm: the error of the straight pieces is the same everywhere.
  constexpr double z0 = kEvaporationRoughness_m;
  const double last = std::log((kEvaporationTop_m + z0) / z0);
  RefractivityProfile profile;
  for (int i = 0; i < kEvaporationLevels; ++i) {
    const double logarithm = last * i / (kEvaporationLevels - 1);
    const double z = z0 * std::expm1(logarithm);
    profile.levels.push_back({z, surface_m_units + 0.125 * (z - duct_height_m * logarithm)});
  }
  return profile;
}

RefractivityProfile surfaceDuct(double top_m, double deficit_m_units, double surface_m_units) {
  return trilinearRefractivity(0, top_m, deficit_m_units, surface_m_units);
}

RefractivityProfile trilinearRefractivity(double base_m, double top_m, double deficit_m_units,
                                          double surface_m_units) {
  if (!(base_m >= 0)) refuse("base of the layer", base_m, "m", "0 m or more");
  if (!(top_m > base_m && top_m <= kMaxHeight_m)) {
    refuse("top of the layer", top_m, "m",
           fmt::format("above its base of {} m, up to {} m", base_m, kMaxHeight_m));
  }
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
  const RefractivityProfile &a = profiles_[i - 1], &b = profiles_[i];
  const double t = (range_m - ranges_m_[i - 1]) / (ranges_m_[i] - ranges_m_[i - 1]);
  return a.levels.size() == b.levels.size() ? levelByLevel(a, b, t) : heightByHeight(a, b, t);
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
