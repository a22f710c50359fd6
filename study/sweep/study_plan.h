/// The order in which the variants of a study are computed, so that most of the field is reused.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "emscape/base/enum_names.h"
#include "study/sweep/definition/study_file.h"

namespace emscape::study {

using emscape::toString;

/// The recomputation that a change of a parameter causes, the most expensive first.
enum class ChangeClass {
  geometry,  ///< profiles and excess losses of an emitter: sites, tracks, frequencies, models, terrain
  beam,      ///< the combination of the emitters: antennas, scans
  power,     ///< the same with unchanged antennas: powers, losses, receivers, radar cross sections
  product    ///< only what is derived from the combination
};
constexpr auto namesOf(ChangeClass) {
  return std::array{"geometry", "beam", "power", "product"};
}
constexpr std::size_t kChangeClasses = 4;

struct StudyPlan {
  std::vector<ChangeClass> classes;  ///< class of each path of the variants
  std::vector<std::uint32_t> order;  ///< the variants in the order of computation
  /// Number of variants by the class of their change from the previous variant in the order; the first counts
  /// as geometry.
  std::array<std::size_t, kChangeClasses> changes{};
};

/// Plans a study. The class of a parameter is determined by what FieldSolver::update() recomputes at the
/// first, middle and last time, if only this parameter differs from the scenario: with the first, middle and
/// last of its different values.
/// @param terrain  as of loadTerrain(); null: none
StudyPlan planStudy(const StudySpec& study, const scenario::TerrainPtr& terrain);

/// The class of the change between two variants.
ChangeClass changeBetween(const StudySpec& study, const StudyPlan& plan, std::size_t from, std::size_t to);

/// Positions [begin, end) of a part in the order.
struct PartRange {
  std::size_t begin = 0, end = 0;
};
/// @param part  1..parts
PartRange rangeOfPart(std::size_t variants, int part, int parts);

constexpr int kMaxParts = 99999;
/// The usual number of parts: about 16 variants in each, at most 500 parts.
int usualParts(std::size_t variants);

}  // namespace emscape::study
