#include "render/cells/integral/lane_transfer.h"

namespace emscape::render {

LaneTransfer::LaneTransfer(const IntervalsView& intervals, const PsiLookup& psi)
    : intervals_(intervals), psi_(psi) {
  for (const TransferInterval* from = intervals.intervals; from < intervals.intervals + intervals.count;
       ++from) {
    LaneInterval to{};
    to.lower = from->lower;
    to.upper = from->upper;
    to.base = from->uniform ? 0 : from->lower;
    to.per_unit = from->uniform ? 0 : 1 / (from->upper - from->lower);
    to.extinction = from->extinction[0];
    to.extinction_rise = from->extinction[1] - from->extinction[0];
    const Rgb &low = from->color[0], &high = from->color[1];
    const float lows[] = {low.r, low.g, low.b}, highs[] = {high.r, high.g, high.b};
    for (int n = 0; n < 3; ++n) {
      to.color[n] = static_cast<double>(lows[n]);
      to.color_rise[n] = static_cast<double>(highs[n]) - static_cast<double>(lows[n]);
    }
    to.clear = from->clear ? 1 : 0;
    lanes_.push_back(to);
  }
}

}  // namespace emscape::render
