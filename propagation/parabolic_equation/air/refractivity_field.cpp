#include "propagation/parabolic_equation/air/refractivity_field.h"

#include <algorithm>

namespace emscape::propagation {
namespace {

// Each structured binding names every member, so that a new one cannot be forgotten.

bool same(const RefractivityLevel& a, const RefractivityLevel& b) {
  const auto& [height_msl_m, m_units] = a;
  return height_msl_m == b.height_msl_m && m_units == b.m_units;
}

bool same(const RefractivityField::Position& a, const RefractivityField::Position& b) {
  const auto& [latitude_deg, longitude_deg] = a;
  return latitude_deg == b.latitude_deg && longitude_deg == b.longitude_deg;
}

bool same(const RefractivityProfile& a, const RefractivityProfile& b);
bool same(const RefractivityField& a, const RefractivityField& b);

template <class Item>
bool same(const std::vector<Item>& a, const std::vector<Item>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Item& x, const Item& y) { return same(x, y); });
}

bool same(const RefractivityProfile& a, const RefractivityProfile& b) {
  const auto& [levels, top_gradient_m, known_to_m] = a;
  return same(levels, b.levels) && top_gradient_m == b.top_gradient_m && known_to_m == b.known_to_m;
}

bool same(const RefractivityField& a, const RefractivityField& b) {
  const auto& [profiles, ranges_m, positions, evaporation_duct_m] = a;
  return same(profiles, b.profiles) && ranges_m == b.ranges_m && same(positions, b.positions) &&
         evaporation_duct_m == b.evaporation_duct_m;
}

}  // namespace

bool areSame(const std::shared_ptr<const Refractivity>& a, const std::shared_ptr<const Refractivity>& b) {
  if (a == b) return true;
  if (!a || !b) return false;
  const auto& [air, members, quantile, source] = *a;  // the source is only told
  return same(air, b->air) && same(members, b->members) && quantile == b->quantile;
}

}  // namespace emscape::propagation
