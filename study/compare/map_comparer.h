/// Changes between maps of A and of B, computed or read from files.
#pragma once

#include <functional>
#include <vector>

#include "study/compare/compare.h"

namespace emscape::study {

/// Takes pairs of maps of one product, height and time each; collects their figures and the largest changed
/// areas.
class MapComparer {
 public:
  /// @param products  of the maps; areas are collected for the first product that marks an area
  /// @param areas     number of changed areas to keep, for gained and lost each
  /// @param take      receives the maps of changeNameOf()
  MapComparer(const MapGrid& grid, const std::vector<Product>& products, int areas,
              std::function<void(const Map&)> take);

  void add(const CoverageMap& a, const CoverageMap& b);

  /// The figures, and the areas without emitter and paths, gained before lost, the largest first.
  Comparison finish();

 private:
  const MapGrid& grid_;
  std::vector<Product> products_;
  int areas_;
  std::function<void(const Map&)> take_;
  std::vector<ComparisonRow> rows_;
  std::vector<ChangedArea> gained_, lost_;
};

/// @throws Error (usage) for Product::best, whose maps hold indices
void requireDifferences(const std::vector<Product>& products);

}  // namespace emscape::study
