#include "emfield/path_excess.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "emfield/models/diffraction.h"
#include "emfield/models/horizon.h"

namespace emscape::emfield {
namespace {

using scenario::PropagationModel;

void warnOutside(const ModelLimit& limit, double value_si, PathExcess& excess) {
  if (!limit.holds(value_si)) excess.warnings.push_back(outsideMessage(limit, value_si));
}

PathExcess horizonExcess(const PathProfile& profile) {
  // As the field has it: slopes in single precision.
  const HorizonGeometry<float> geometry{static_cast<float>(profile.begin.height_msl_m),
                                        static_cast<float>(profile.station.effective_earth_radius_m)};
  std::vector<RangeTerms<float>> ranges;
  for (const double range_m : profile.ranges_m) ranges.push_back(geometry.termsAt(range_m));
  std::vector<float> slopes(profile.ranges_m.size());
  grazingSlopes(geometry, profile.ground_msl_m.data(), ranges.data(), profile.count(), slopes.data());
  const int before = profile.count() - 2;
  const bool is_lit = before == 0 || static_cast<float>(profile.end.height_msl_m) >=
                                         geometry.heightOn(slopes[before], ranges.back());
  PathExcess excess;
  excess.why = is_lit ? "nothing stands above the ray: free space"
                      : "something stands above the ray: no field at all behind it (no diffraction)";
  if (!is_lit) {
    excess.loss_db = std::numeric_limits<double>::infinity();
    excess.parts.push_back({"shadow", "shadow of terrain and earth", excess.loss_db});
  }
  const double highest_m = std::max(profile.begin.height_msl_m, profile.end.height_msl_m);
  if (highest_m > kLinearRefractivityHeight_m) {
    excess.warnings.push_back(
        fmt::format("height {:.0f} m: 'horizon' takes refractivity as linear in height, which "
                    "does not hold above {:.0f} m",
                    highest_m, kLinearRefractivityHeight_m));
  }
  return excess;
}

PathExcess diffractionExcess(const PathProfile& profile, const scenario::Emitter& emitter) {
  DiffractionParameters parameters;
  parameters.frequency_hz = emitter.frequency_hz;
  parameters.effective_earth_radius_m = profile.station.effective_earth_radius_m;
  const auto model = diffractionModel<double>(parameters);
  const TerrainProfile terrain{profile.ranges_m.data(), profile.ground_msl_m.data(), profile.count()};
  const DeltaBullington<double> loss =
      deltaBullington(model, terrain, profile.begin.height_msl_m, profile.end.height_msl_m);
  PathExcess excess;
  excess.loss_db = loss.loss_db;
  excess.parts = {{"terrain_edge", "terrain as one edge (Bullington)", loss.terrain_db},
                  {"smooth_earth", "what that lacks of the earth's bulge", loss.loss_db - loss.terrain_db}};
  excess.why = "delta-Bullington over the terrain profile";
  warnOutside(kDiffractionFrequency, emitter.frequency_hz, excess);
  warnOutside(kDiffractionDistance, profile.range_m, excess);
  for (const PathEnd* end : {&profile.begin, &profile.end})
    warnOutside(kDiffractionHeight, end->height_msl_m, excess);
  return excess;
}

}  // namespace

PathExcess pathExcess(PropagationModel model, const PathProfile& profile, const scenario::Emitter& emitter) {
  switch (model) {
    case PropagationModel::free_space:
      return {0, {}, "spreading alone: neither terrain nor earth count", {}};
    case PropagationModel::horizon:
      return horizonExcess(profile);
    case PropagationModel::diffraction:
      return diffractionExcess(profile, emitter);
    default:
      break;
  }
  throw Error(ErrorCode::bad_input,
              fmt::format("propagation '{}' has no profile yet; one of free_space, horizon, "
                          "diffraction",
                          scenario::toString(model)));
}

}  // namespace emscape::emfield
