/// Points of a unit cube for samples of parameters, the same on every machine and in any order.
#pragma once

#include <cstdint>
#include <vector>

namespace emscape::study {

/// Points of the open unit cube; each coordinate in (0, 1).
struct SamplePoints {
  int count = 0, dimensions = 0;
  std::vector<double> coordinates;  ///< [point][dimension]

  double at(int point, int dimension) const {
    return coordinates[static_cast<std::size_t>(point) * static_cast<std::size_t>(dimensions) +
                       static_cast<std::size_t>(dimension)];
  }
};

/// Latin hypercube: in each dimension, each of `count` equal intervals has one point.
SamplePoints latinHypercube(int count, int dimensions, std::uint64_t seed);

constexpr int kMaxSobolDimensions = 21;
/// The first points of Sobol's sequence in Gray-code order, with the direction numbers of Joe and Kuo,
/// shifted digit by digit (exclusive or) by a random number of each dimension.
/// @param dimensions  1..kMaxSobolDimensions
/// @see Joe, Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci.
/// Comput. 30 (2008), file new-joe-kuo-6
SamplePoints sobolPoints(int count, int dimensions, std::uint64_t seed);
/// The same without the shift: words of 32 bits, [point][dimension].
std::vector<std::uint32_t> sobolWords(int count, int dimensions);

}  // namespace emscape::study
