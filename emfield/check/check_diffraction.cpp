/// Diffraction.
#include "emfield/check/datasets.h"
#include "emfield/check/reference_table.h"
#include "emfield/models/diffraction_knife_edge.h"

namespace emscape::emfield {

DatasetCheck checkKnifeEdge(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"nu", "J_exact_fresnel_dB", "J_P526_approx_dB"});
  FigureCheck exact{"J_exact_fresnel_dB", 1e-4, "dB"}, approximate{"J_P526_approx_dB", 1e-4, "dB"};
  for (int i = 0; i < cases.rows(); ++i) {
    const double nu = cases.number(i, "nu");
    const int line = cases.place(i).line;
    exact.compare(knifeEdgeExactDb(nu), cases.number(i, "J_exact_fresnel_dB"), line);
    approximate.compare(knifeEdgeDb(nu), cases.number(i, "J_P526_approx_dB"), line);
  }
  return {cases.rows(), {exact, approximate}};
}

}  // namespace emscape::emfield
