/// Options of the model `diffraction` with separate knife edges: the single largest edge, and Deygout's
/// construction with three or more edges.
///
/// Both omit the diffraction of the smooth earth: over flat ground they depend on the sampling of the
/// profile. Deygout's construction overestimates the loss of edges that are close together.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/diffraction/diffraction.h"

namespace emscape::propagation {

/// The post with the largest nu on the path between two points over posts.
template <class Real>
struct MainEdge {
  int post = -1;  ///< -1 without a post between
  Real nu = -Real(HUGE_VAL);
};

/// @param first, last            posts, first < last
/// @param first_msl_m, last_msl_m  heights of the path's ends over them
/// @see P.526-15 eq. (26), with the bulge of the effective earth
template <class Real>
EMSCAPE_HD MainEdge<Real> mainEdge(const DiffractionModel<Real>& model, const TerrainProfile& profile,
                                   int first, Real first_msl_m, int last, Real last_msl_m) {
  MainEdge<Real> edge;
  const Real begin = Real(profile.range_m[first]);
  const Real d = Real(profile.range_m[last]) - begin;
  for (int i = first + 1; i < last; ++i) {
    const Real d1 = Real(profile.range_m[i]) - begin, d2 = d - d1;
    const Real line = first_msl_m + (last_msl_m - first_msl_m) * (d1 / d);
    const Real above = Real(profile.height_msl_m[i]) - line + model.half_curvature * d1 * d2;
    const Real nu = model.nuOf(above, d1, d2);
    if (nu > edge.nu) edge = {i, nu};
  }
  return edge;
}

/// Loss (dB) of the largest single edge.
/// @param tx_msl_m, rx_msl_m  heights of the antennas over the first and the last post
template <class Real>
EMSCAPE_HD Real singleEdgeLossDb(const DiffractionModel<Real>& model, const TerrainProfile& profile,
                                 Real tx_msl_m, Real rx_msl_m) {
  return knifeEdgeDb(mainEdge(model, profile, 0, tx_msl_m, profile.count - 1, rx_msl_m).nu);
}

/// Loss (dB) of three edges: the main one, and one on either side of it.
/// @see P.526-13 section 4.4.2, eq. (50) to (52) ("cascaded knife edge"): L = J_p + T (J_t + J_r + C)
template <class Real>
EMSCAPE_HD Real deygoutLossDb(const DiffractionModel<Real>& model, const TerrainProfile& profile,
                              Real tx_msl_m, Real rx_msl_m) {
  const int last = profile.count - 1;
  const MainEdge<Real> main = mainEdge(model, profile, 0, tx_msl_m, last, rx_msl_m);
  const Real main_db = knifeEdgeDb(main.nu);
  if (!(main_db > 0)) return main_db;
  const Real top_msl_m = Real(profile.height_msl_m[main.post]);
  const Real side_db = knifeEdgeDb(mainEdge(model, profile, 0, tx_msl_m, main.post, top_msl_m).nu) +
                       knifeEdgeDb(mainEdge(model, profile, main.post, top_msl_m, last, rx_msl_m).nu);
  const Real empirical_db = 10 + Real(4e-5) * Real(profile.range_m[last]);
  return main_db + (1 - std::exp(-main_db / 6)) * (side_db + empirical_db);
}

}  // namespace emscape::propagation
