/// Counter-based random numbers, the same on every machine and in any order.
#pragma once

#include <array>
#include <cstdint>

namespace emscape {

/// Philox4x32-10: four random words of a counter and a key.
/// @see Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);
/// Maps a word to the middle of its interval, one of 2^32 equal intervals of (0, 1).
double fractionOf(std::uint32_t word);

/// Quantile of the normal distribution with mean 0 and standard deviation 1.
/// @param probability  in (0, 1)
/// @accuracy relative 1e-15
/// @see Wichura, algorithm AS 241 (PPND16), Applied Statistics 37 (1988)
double normalQuantile(double probability);

}  // namespace emscape
