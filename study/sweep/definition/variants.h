/// The variants of a study: the product of lists of edits.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "emscape/scenario/model/edit.h"

namespace emscape::study {

/// A list of settings of the same paths: the variants of a list, the values of a swept parameter, or samples.
struct VariantFactor {
  enum class Kind { list, sweep, samples, sites };
  Kind kind = Kind::list;
  std::vector<std::string> names;   ///< of the settings; empty: they have none
  std::vector<std::string> paths;   ///< of the values, as an Edit takes them
  std::vector<std::string> values;  ///< [setting][path] in YAML; empty: left as in the scenario
  std::size_t count = 0;            ///< settings

  const std::string& value(std::size_t setting, std::size_t path) const {
    return values[setting * paths.size() + path];
  }
};

/// The product of factors; the last factor varies fastest. Variants are numbered from 0.
class VariantSet {
 public:
  static constexpr std::size_t kMaxVariants = 10'000'000;

  VariantSet() = default;
  explicit VariantSet(std::vector<VariantFactor> factors);

  std::size_t count() const { return count_; }
  const std::vector<VariantFactor>& factors() const { return factors_; }
  /// Paths of all factors, in their order.
  const std::vector<std::string>& paths() const { return paths_; }
  /// Index of the factor that sets a path.
  std::size_t factorOf(std::size_t path) const { return owners_[path].factor; }

  /// The setting of a factor in a variant.
  std::size_t setting(std::size_t variant, std::size_t factor) const {
    return variant / strides_[factor] % factors_[factor].count;
  }
  /// The value of a path in a variant; empty: left as in the scenario.
  const std::string& value(std::size_t variant, std::size_t path) const {
    const Owner& owner = owners_[path];
    return factors_[owner.factor].value(setting(variant, owner.factor), owner.column);
  }
  /// Names of the settings, separated by " / "; empty if none has a name.
  std::string name(std::size_t variant) const;
  std::vector<scenario::Edit> edits(std::size_t variant) const;

 private:
  struct Owner {
    std::size_t factor, column;
  };
  std::vector<VariantFactor> factors_;
  std::vector<std::size_t> strides_;
  std::vector<std::string> paths_;
  std::vector<Owner> owners_;  ///< of each path
  std::size_t count_ = 0;
};

}  // namespace emscape::study
