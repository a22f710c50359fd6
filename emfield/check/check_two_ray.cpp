/// Two rays over a flat earth that reflects perfectly.
#include <cmath>

#include "emfield/check/datasets.h"
#include "emfield/check/reference_table.h"
#include "propagation/two_ray/two_ray.h"

namespace emscape::emfield {

using namespace propagation;

DatasetCheck checkTwoRay(const std::filesystem::path& file) {
  const ReferenceTable cases(file,
                             {"f_MHz", "h1_m", "h2_m", "d_m", "R1_m", "R2_m", "F_dB_gamma_minus1_exact"});
  FigureCheck factor{"F_dB_gamma_minus1_exact", 1e-3, "dB"}, difference{"R2_m - R1_m", 2e-6, "m"};
  TwoRayParameters parameters;
  parameters.effective_earth_radius_m = 1e18;  // flat
  parameters.ground.relative_permittivity = 1;
  parameters.ground.conductivity_s_per_m = 1e20;  // a reflection of -1
  for (int i = 0; i < cases.rows(); ++i) {
    parameters.frequency_hz = cases.number(i, "f_MHz") * 1e6;
    const auto model = twoRayModel<double>(parameters);
    const ReflectedPath<double> path =
        reflectedPath(parameters.effective_earth_radius_m, cases.number(i, "d_m"), cases.number(i, "h1_m"),
                      cases.number(i, "h2_m"));
    const int line = cases.location(i).line;
    factor.compare(20 * std::log10(interferenceFactor(model, path)),
                   cases.number(i, "F_dB_gamma_minus1_exact"), line);
    difference.compare(path.path_difference_m, cases.number(i, "R2_m") - cases.number(i, "R1_m"), line);
  }
  return {cases.rows(), {factor, difference}};
}

}  // namespace emscape::emfield
