#include "emscape/scenario/model/clutter.h"

#include <cmath>

namespace emscape::scenario {

const char* toString(LandKind kind) {
  static constexpr const char* kNames[] = {"flatland",     "farmland",  "woods",
                                           "wooded_hills", "mountains", "urban"};
  return kNames[static_cast<int>(kind)];
}

double landGammaDb(LandKind kind, double frequency_hz) {
  static constexpr double kAt10GHz_db[] = {-20, -15, -15, -10, 0, 0};
  return kAt10GHz_db[static_cast<int>(kind)] + 5 * std::log10(frequency_hz / 10e9);
}

const char* toString(MtiKind kind) {
  static constexpr const char* kNames[] = {"canceller", "pulse_doppler"};
  return kNames[static_cast<int>(kind)];
}

}  // namespace emscape::scenario
