#include "study/sweep/definition/variants.h"

#include <fmt/format.h>

#include "emscape/base/error.h"

namespace emscape::study {

VariantSet::VariantSet(std::vector<VariantFactor> factors)
    : factors_(std::move(factors)), strides_(factors_.size(), 1), count_(1) {
  for (std::size_t f = factors_.size(); f-- > 0;) {
    strides_[f] = count_;
    if (factors_[f].count > kMaxVariants / count_) {
      throw Error(ErrorCode::bad_input, fmt::format("the study has more than {} variants", kMaxVariants));
    }
    count_ *= factors_[f].count;
  }
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    for (std::size_t column = 0; column < factors_[f].paths.size(); ++column) {
      paths_.push_back(factors_[f].paths[column]);
      owners_.push_back({f, column});
    }
  }
}

std::string VariantSet::name(std::size_t variant) const {
  std::string name;
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    if (factors_[f].names.empty()) continue;
    name += (name.empty() ? "" : " / ") + factors_[f].names[setting(variant, f)];
  }
  return name;
}

std::vector<scenario::Edit> VariantSet::edits(std::size_t variant) const {
  std::vector<scenario::Edit> edits;
  for (std::size_t path = 0; path < paths_.size(); ++path) {
    if (const std::string& text = value(variant, path); !text.empty()) edits.push_back({paths_[path], text});
  }
  return edits;
}

}  // namespace emscape::study
