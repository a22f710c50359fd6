#include "propagation/parabolic_equation/field_march.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"
#include "emscape/base/work.h"
#include "propagation/parabolic_equation/excess.h"

namespace emscape::propagation {
namespace {

/// The mean of two fields' powers, in dB.
float meanPower_db(float a_db, float b_db) {
  return -10 * std::log10((std::pow(10.0f, -a_db / 10) + std::pow(10.0f, -b_db / 10)) / 2);
}

/// Calls a function for each cell. Each piece of the cells has a copy of the function.
template <class Function>
void forCells(const FieldMarch& field, const Function& function) {
  const auto heights = static_cast<std::size_t>(field.march.cells.heights);
  parallelFor(static_cast<int>(field.cellCount() / heights), 16, [&](int begin, int end) {
    Function own = function;
    for (std::size_t i = std::size_t(begin) * heights; i < std::size_t(end) * heights; ++i) own(i);
  });
}

/// Losses of a member, of the mean power of the polarisations.
void marchMember(FieldMarch& field, const std::vector<RefractivityAlongPath>& member, float* cells_db) {
  const bool has_other = field.surfaces.size() > 1;
  {
    const WorkPart part("", 0, has_other ? 0.5 : 1);
    marchAzimuths(field.set(member, field.surfaces.front()), cells_db);
  }
  if (has_other) {
    const WorkPart part("", 0.5, 1);
    std::vector<float> other_db(field.cellCount());
    marchAzimuths(field.set(member, field.surfaces.back()), other_db.data());
    forCells(field, [&](std::size_t i) { cells_db[i] = meanPower_db(cells_db[i], other_db[i]); });
  }
  forCells(field, [&](std::size_t i) {
    if (cells_db[i] > kPeNoField_db) cells_db[i] = kPeNoField_db;
  });
}

void marchEnsemble(FieldMarch& field, float* excess_db) {
  std::vector<std::vector<float>> members;
  const auto count = static_cast<double>(field.members.size());
  for (const auto& member : field.members) {
    const auto done = static_cast<double>(members.size());
    const WorkPart part("", done / count, (done + 1) / count);
    members.emplace_back(field.cellCount());
    marchMember(field, member, members.back().data());
  }
  forCells(field, [&, losses_db = std::vector<float>()](std::size_t i) mutable {
    losses_db.resize(members.size());
    for (std::size_t m = 0; m < members.size(); ++m) losses_db[m] = members[m][i];
    const float first_db = losses_db.front();  // NaN for all members or none: they have the same ground
    excess_db[i] = std::isnan(first_db) ? NAN : ofMembers_db(losses_db, field.quantile);
  });
}

}  // namespace

void marchField(FieldMarch& field, float* excess_db) {
  if (field.members.size() > 1) {
    marchEnsemble(field, excess_db);
  } else {
    marchMember(field, field.members.front(), excess_db);
  }
  const RadialCells& cells = field.march.cells;
  for (std::size_t a = 0; a < field.known_ranges.size(); ++a) {
    float* const azimuth = excess_db + a * std::size_t(cells.ranges) * std::size_t(cells.heights);
    std::fill(azimuth + std::size_t(field.known_ranges[a]) * std::size_t(cells.heights),
              azimuth + std::size_t(cells.ranges) * std::size_t(cells.heights), NAN);
  }
}

float ofMembers_db(std::vector<float>& losses_db, const std::optional<double>& quantile) {
  if (losses_db.size() == 1) return losses_db.front();
  if (quantile) {
    const int at = rankOfQuantile(*quantile, int(losses_db.size()));
    std::nth_element(losses_db.begin(), losses_db.begin() + at, losses_db.end());
    return losses_db[std::size_t(at)];
  }
  double power = 0;
  for (const float loss_db : losses_db) power += std::pow(10.0, double(-loss_db) / 10);
  return static_cast<float>(-10 * std::log10(power / double(losses_db.size())));
}

int rankOfQuantile(double quantile, int members) {
  return int(std::lround((1 - quantile) * (members - 1)));
}

bool isForGpu(const FieldMarch& field) {
  constexpr int kFewAzimuths = 16;  // each is one block of threads
  const MarchGrid& grid = field.march.grid;
  return field.march.azimuths >= kFewAzimuths && grid.intervals >= kMinBlockIntervals &&
         grid.intervals <= kMaxBlockIntervals &&
         (grid.form == PeForm::wide || field.march.ground_msl_m.empty());
}

}  // namespace emscape::propagation
