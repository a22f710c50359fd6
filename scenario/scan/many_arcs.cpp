#include "scenario/scan/many_arcs.h"

#include <algorithm>
#include <cmath>

#include "base/math/simd.h"
#include "emscape/base/work.h"

namespace emscape::scenario {
namespace {

constexpr double kCircle_deg = 360;

/// A row and its repetition, so that each turn of it is contiguous.
class TurnedRow {
 public:
  explicit TurnedRow(const std::vector<double>& row) : count_(static_cast<int>(row.size())), twice_(row) {
    twice_.insert(twice_.end(), row.begin(), row.end());
  }
  /// The row turned by a number of entries: its entry k is entry k - by of the row.
  const double* turnedBy(int by) const { return twice_.data() + count_ - (by % count_ + count_) % count_; }
  int count() const { return count_; }

 private:
  int count_;
  std::vector<double> twice_;
};

EMSCAPE_SIMD_CLONES void addWeighted(const double* a, const double* b, const double* c, const double* d,
                                     const double* weights, int count, double* sums) {
  const double of_a = weights[0], of_b = weights[1], of_c = weights[2], of_d = weights[3];
  for (int k = 0; k < count; ++k) sums[k] += (of_a * a[k] + of_b * b[k]) + (of_c * c[k] + of_d * d[k]);
}

/// Between the entries of two rows.
EMSCAPE_SIMD_CLONES void raiseToMixed(const double* a, const double* b, double of_b, int count,
                                      double* largest) {
  for (int k = 0; k < count; ++k) largest[k] = std::max(largest[k], a[k] + of_b * (b[k] - a[k]));
}

EMSCAPE_SIMD_CLONES void raiseToEither(const double* a, const double* b, int count, double* largest) {
  for (int k = 0; k < count; ++k) largest[k] = std::max(largest[k], std::max(a[k], b[k]));
}

}  // namespace

std::vector<double> rowWeightsOf(const std::vector<SweptArc>& arcs, int azimuths) {
  std::vector<double> weights(static_cast<std::size_t>(azimuths));
  const auto at = [&](double entry) -> double& {
    return weights[static_cast<std::size_t>(entry - azimuths * std::floor(entry / azimuths))];
  };
  for (const SweptArc& arc : arcs) {
    const double begin = arc.first_deg / kCircle_deg * azimuths,
                 width = arc.width_deg / kCircle_deg * azimuths;
    if (width == 0) {
      const double below = std::floor(begin);
      at(below) += arc.share * (1 - (begin - below));
      at(below + 1) += arc.share * (begin - below);
      continue;
    }
    const double of_turns = std::floor(width / azimuths) * azimuths;
    for (double& weight : weights) weight += arc.share * of_turns / width / azimuths;
    const double end = begin + width - of_turns, of_entry = arc.share / width;
    for (double below = std::floor(begin); below < end; ++below) {
      const double from = std::max(begin - below, 0.0), to = std::min(end - below, 1.0);
      const double of_upper = (to * to - from * from) / 2;  // the integral of the interpolation's weight
      at(below) += of_entry * (to - from - of_upper);
      at(below + 1) += of_entry * of_upper;
    }
  }
  return weights;
}

std::vector<RowSpan> rowSpansOf(const std::vector<SweptArc>& arcs, int azimuths) {
  constexpr double kClosedGap = 0.5;
  std::vector<RowSpan> spans;
  for (const SweptArc& arc : arcs) {
    const double begin = arc.first_deg / kCircle_deg * azimuths,
                 width = arc.width_deg / kCircle_deg * azimuths;
    const double in_turn = begin - azimuths * std::floor(begin / azimuths);
    spans.push_back({in_turn, in_turn + std::min(width, double(azimuths))});
  }
  std::sort(spans.begin(), spans.end(), [](const RowSpan& a, const RowSpan& b) { return a.begin < b.begin; });
  std::vector<RowSpan> joined;
  for (const RowSpan& span : spans) {
    if (joined.empty() || span.begin > joined.back().end + kClosedGap) {
      joined.push_back(span);
    } else {
      joined.back().end = std::max(joined.back().end, span.end);
    }
  }
  // The last one may go on at the circle's beginning.
  std::size_t first = 0;
  while (first + 1 < joined.size() && joined[first].begin + azimuths <= joined.back().end + kClosedGap) {
    joined.back().end = std::max(joined.back().end, joined[first].end + azimuths);
    ++first;
  }
  joined.erase(joined.begin(), joined.begin() + static_cast<std::ptrdiff_t>(first));
  for (const RowSpan& span : joined) {
    if (span.end + kClosedGap >= span.begin + azimuths) return {{0, double(azimuths)}};
  }
  return joined;
}

void addMean(const std::vector<double>& power, const std::vector<double>& weights, std::vector<double>& row) {
  constexpr int kAtOnce = 4;
  const TurnedRow turned(power);
  for (int first = 0; first < turned.count(); first += kAtOnce) {
    double some[kAtOnce] = {};
    std::copy_n(weights.begin() + first, std::min(kAtOnce, turned.count() - first), some);
    if (std::all_of(some, some + kAtOnce, [](double weight) { return weight == 0; })) continue;
    addWeighted(turned.turnedBy(first), turned.turnedBy(first + 1), turned.turnedBy(first + 2),
                turned.turnedBy(first + 3), some, turned.count(), row.data());
  }
}

void raiseToLargest(const std::vector<double>& power, const std::vector<RowSpan>& spans,
                    std::vector<double>& row) {
  const int count = static_cast<int>(power.size());
  std::vector<TurnedRow> runs{
      TurnedRow(power)};  // runs[n], entry k: the largest of the 2^n entries from k on
  for (const RowSpan& span : spans) {
    checkpoint();
    if (span.end - span.begin >= count) {
      const double largest = *std::max_element(power.begin(), power.end());
      for (double& value : row) value = std::max(value, largest);
      continue;
    }
    const int first = static_cast<int>(std::floor(span.begin)), last = static_cast<int>(std::floor(span.end));
    for (const double end : {span.begin, span.end}) {
      const int below = static_cast<int>(std::floor(end));
      raiseToMixed(runs[0].turnedBy(below), runs[0].turnedBy(below + 1), end - below, count, row.data());
    }
    const int entries = last - first + (span.begin > first ? 0 : 1);  // from k - last on
    if (entries < 1) continue;
    std::size_t level = 0;
    while ((2 << level) <= entries) ++level;
    while (runs.size() <= level) {
      const int half = 1 << (runs.size() - 1);
      std::vector<double> longer(power.size());
      raiseToEither(runs.back().turnedBy(0), runs.back().turnedBy(-half), count, longer.data());
      runs.emplace_back(longer);
    }
    raiseToEither(runs[level].turnedBy(last), runs[level].turnedBy(last - entries + (1 << level)), count,
                  row.data());
  }
}

}  // namespace emscape::scenario
