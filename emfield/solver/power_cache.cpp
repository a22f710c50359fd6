#include "emfield/solver/power_cache.h"

#include "emfield/solver/field_inputs.h"

namespace emscape::emfield {

bool samePower(const scenario::AntennaPtr& antenna_a, const EmitterBeam& a,
               const scenario::AntennaPtr& antenna_b, const EmitterBeam& b) {
  return a.forward == b.forward && a.right == b.right && a.up == b.up && a.steer_u == b.steer_u &&
         a.steer_v == b.steer_v && a.eirp_over_4pi_w == b.eirp_over_4pi_w &&
         samePattern(antenna_a, antenna_b);
}

}  // namespace emscape::emfield
