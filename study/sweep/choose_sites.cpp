#include "study/sweep/choose_sites.h"

#include <algorithm>

namespace emscape::study {
namespace {

constexpr double kMinGain = 1e-9;  ///< relative: an exchange must add more than rounding

/// Number of sites that cover each pixel, and the gain of another site.
class Cover {
 public:
  Cover(const std::vector<std::vector<std::uint8_t>>& pixels, const std::vector<float>& weights)
      : pixels_(pixels), weights_(weights), counts_(weights.size()) {}

  void add(std::size_t site, int sign) {
    for (std::size_t p = 0; p < counts_.size(); ++p) counts_[p] += sign * pixels_[site][p];
  }
  /// The weight that a site adds.
  double gain(std::size_t site) const {
    double gain = 0;
    for (std::size_t p = 0; p < counts_.size(); ++p) {
      if (counts_[p] == 0 && pixels_[site][p] != 0) gain += static_cast<double>(weights_[p]);
    }
    return gain;
  }
  /// The site that adds the most; the first of equals.
  std::size_t best(const std::vector<std::size_t>& chosen, double& gain_of_best) const {
    std::size_t found = 0;
    gain_of_best = -1;
    for (std::size_t site = 0; site < pixels_.size(); ++site) {
      if (std::find(chosen.begin(), chosen.end(), site) != chosen.end()) continue;
      const double its = gain(site);
      if (its > gain_of_best) {
        gain_of_best = its;
        found = site;
      }
    }
    return found;
  }

 private:
  const std::vector<std::vector<std::uint8_t>>& pixels_;
  const std::vector<float>& weights_;
  std::vector<int> counts_;
};

}  // namespace

std::vector<std::size_t> chooseSites(const std::vector<std::vector<std::uint8_t>>& pixels,
                                     const std::vector<float>& weights, std::size_t count) {
  Cover cover(pixels, weights);
  std::vector<std::size_t> chosen;
  double gain = 0;
  while (chosen.size() < std::min(count, pixels.size())) {
    chosen.push_back(cover.best(chosen, gain));
    cover.add(chosen.back(), 1);
  }
  for (bool has_changed = chosen.size() < pixels.size(); has_changed;) {
    has_changed = false;
    for (std::size_t& site : chosen) {
      cover.add(site, -1);
      const double own = cover.gain(site);
      const std::size_t other = cover.best(chosen, gain);
      if (gain > own * (1 + kMinGain)) {
        site = other;
        has_changed = true;
      }
      cover.add(site, 1);
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::size_t equalSites(const std::vector<std::vector<std::uint8_t>>& pixels,
                       const std::vector<float>& weights, const std::vector<std::size_t>& chosen) {
  Cover cover(pixels, weights);
  for (const std::size_t site : chosen) cover.add(site, 1);
  std::vector<bool> is_equal(pixels.size());
  for (const std::size_t out : chosen) {
    cover.add(out, -1);
    const double own = cover.gain(out);
    for (std::size_t site = 0; site < pixels.size(); ++site) {
      const bool is_chosen = std::find(chosen.begin(), chosen.end(), site) != chosen.end();
      if (!is_chosen && cover.gain(site) >= own * (1 - kMinGain)) is_equal[site] = true;
    }
    cover.add(out, 1);
  }
  return static_cast<std::size_t>(std::count(is_equal.begin(), is_equal.end(), true));
}

double coveredWeight(const std::vector<std::vector<std::uint8_t>>& pixels, const std::vector<float>& weights,
                     const std::vector<std::size_t>& sites) {
  double sum = 0;
  for (std::size_t p = 0; p < weights.size(); ++p) {
    const bool is_covered =
        std::any_of(sites.begin(), sites.end(), [&](std::size_t site) { return pixels[site][p] != 0; });
    if (is_covered) sum += static_cast<double>(weights[p]);
  }
  return sum;
}

}  // namespace emscape::study
