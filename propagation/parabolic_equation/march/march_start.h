/// The field at the start of a march, and the checks of its input.
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "propagation/parabolic_equation/march/march_grid.h"
#include "propagation/parabolic_equation/march/source.h"
#include "propagation/parabolic_equation/march/surface.h"

namespace emscape::propagation {

/// The field at range 0.
/// @param ratio     r of the mixed transform; 0: Dirichlet
/// @param halvings  of N since the start of the march, whose band the source has
/// @return at the heights 0, 1, ... N-1
std::vector<std::complex<double>> startField(const MarchGrid& grid, const PeSource& source,
                                             std::complex<double> ratio, int halvings = 0);

/// @throws Error (bad_input) for a source below the ground (on a perfect surface: at it) or above the usable
/// domain
void checkSource(const MarchGrid& grid, const PeSource& source, const PeSurface& surface);

/// @param ground_m  heights at the range steps
/// @throws Error (bad_input) for a hole (NaN), with its range
template <class Height>
void checkGround(const MarchGrid& grid, const Height* ground_m, std::size_t steps);

/// r of the mixed transform at a height step. @throws Error (bad_input) outside its limits
std::complex<double> checkedRatio(const MarchGrid& grid, const PeSurface& surface, double height_step_m);

}  // namespace emscape::propagation
