#include "emscape/scenario/model/emitter.h"

#include <algorithm>
#include <complex>

#include "emscape/base/units.h"

namespace emscape::scenario {

using propagation::Polarization;

double polarizationFactor(Polarization transmit, Polarization receive, double isolation_db) {
  // Jones vectors (horizontal, vertical) without the factor sqrt(1/2) of the mixed ones, which norm()
  // restores.
  struct Jones {
    std::complex<double> horizontal, vertical;
  };
  static const Jones kJones[] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {1, {0, -1}}, {1, {0, 1}}};
  const Jones& t = kJones[static_cast<int>(transmit)];
  const Jones& r = kJones[static_cast<int>(receive)];
  const auto norm = [](const Jones& j) { return std::norm(j.horizontal) + std::norm(j.vertical); };
  const double ideal =
      std::norm(t.horizontal * std::conj(r.horizontal) + t.vertical * std::conj(r.vertical)) /
      (norm(t) * norm(r));
  return std::max(ideal, dbToRatio(-isolation_db));
}

}  // namespace emscape::scenario
