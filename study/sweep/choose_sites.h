/// Choice of sites that together cover the most.
#pragma once

#include <cstdint>
#include <vector>

namespace emscape::study {

/// Chooses sites whose union covers the most: one after another, each the one that adds the most (greedy),
/// then exchanges of a chosen site for another while they improve the result (1-exchange). The greedy result
/// is at least 1 - 1/e of the optimum (Nemhauser, Wolsey, Fisher 1978).
/// @param pixels   of each site: 1 where it covers
/// @param weights  of the pixels
/// @param count    1 to the number of sites
/// @return indices, ascending
std::vector<std::size_t> chooseSites(const std::vector<std::vector<std::uint8_t>>& pixels,
                                     const std::vector<float>& weights, std::size_t count);

/// Number of other sites with one of which in place of a chosen one as much is covered.
std::size_t equalSites(const std::vector<std::vector<std::uint8_t>>& pixels,
                       const std::vector<float>& weights, const std::vector<std::size_t>& chosen);

/// The weight of the pixels that any of the sites covers.
double coveredWeight(const std::vector<std::vector<std::uint8_t>>& pixels, const std::vector<float>& weights,
                     const std::vector<std::size_t>& sites);

}  // namespace emscape::study
