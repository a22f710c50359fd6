#include "emscape/scenario/model/clutter.h"

#include <cmath>

namespace emscape::scenario {

double landGammaDb(LandKind kind, double frequency_hz) {
  static constexpr double kAt10GHz_db[] = {-20, -15, -15, -10, 0, 0};
  return kAt10GHz_db[static_cast<int>(kind)] + 5 * std::log10(frequency_hz / 10e9);
}

double Mti::outputsOf(double hits) const {
  return kind == MtiKind::canceller ? hits - pulses + 1 : hits / pulses;
}

}  // namespace emscape::scenario
