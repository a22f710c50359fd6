/// Points of a unit cube for samples of parameters, the same on every machine and in any order.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace emscape::study {

/// Philox4x32-10: four random words of a counter and a key.
/// @see Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

/// Points of the open unit cube; each coordinate in (0, 1).
struct SamplePoints {
  int count = 0, dimensions = 0;
  std::vector<double> coordinates;  ///< [point][dimension]

  double at(int point, int dimension) const {
    return coordinates[static_cast<std::size_t>(point) * static_cast<std::size_t>(dimensions) +
                       static_cast<std::size_t>(dimension)];
  }
};

/// Latin hypercube: of each dimension, every one of `count` equal intervals holds one point.
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

/// Quantile of the normal distribution with mean 0 and standard deviation 1.
/// @param probability  in (0, 1)
/// @accuracy relative 1e-15
/// @see Wichura, algorithm AS 241 (PPND16), Applied Statistics 37 (1988)
double normalQuantile(double probability);

}  // namespace emscape::study
