#include "render/cells/integral/psi.h"

#include <algorithm>

#include "emscape/base/parallel.h"

namespace emscape::render {

PsiTable::PsiTable() : values_(static_cast<std::size_t>(PsiLookup::kEntries) * PsiLookup::kEntries) {
  constexpr int kEntries = PsiLookup::kEntries;
  const auto depthOf = [](int n) { return static_cast<double>(n) / (kEntries - 1 - n); };
  parallelFor(kEntries, 8, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int i = 0; i < kEntries; ++i) {
        // gamma = 1 is an infinite extinction: Psi is 0.
        const bool is_limit = std::max(i, j) == kEntries - 1;
        values_[static_cast<std::size_t>(j) * kEntries + i] =
            is_limit ? 0.0F : static_cast<float>(psi(depthOf(i), depthOf(j)));
      }
    }
  });
}

const PsiTable& PsiTable::shared() {
  static const PsiTable table;
  return table;
}

}  // namespace emscape::render
