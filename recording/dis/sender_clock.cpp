#include "recording/dis/sender_clock.h"

#include <cmath>

namespace emscape::interop::dis {
namespace {

constexpr double kHour_s = 3600;
/// A sender's clock may be so far (s) behind the arrivals: networks delay.
constexpr double kMaxDelay_s = 2;
/// Its times may be so far (s) after the arrivals: by the delay of its first PDU, and by the fraction of a
/// second that a log has not.
constexpr double kMaxLead_s = 0.1, kMaxLeadOfWholeSeconds_s = 1;
constexpr int kMaxFaults =
    3;  ///< of a sender's clock that are followed: restarts, and first PDUs that were late
constexpr std::size_t kMaxSenders = 65536;

}  // namespace

double SenderClocks::timeOf(const EntityId& sender, const Header& header, double arrival_s) {
  has_fractions_ = has_fractions_ || arrival_s != std::floor(arrival_s);
  const std::uint32_t key = std::uint32_t{sender.site} << 16 | sender.application;
  const double seconds = header.seconds();
  auto found = clocks_.find(key);
  if (found == clocks_.end()) {
    if (clocks_.size() < kMaxSenders) clocks_[key] = {seconds, arrival_s - seconds, 0};
    return arrival_s;
  }
  Clock& clock = found->second;
  clock.seconds += std::remainder(seconds - clock.seconds, kHour_s);
  const double time_s = clock.seconds + clock.offset_s;
  const double latest_s = arrival_s + (has_fractions_ ? kMaxLead_s : kMaxLeadOfWholeSeconds_s);
  if (clock.faults <= kMaxFaults && time_s > latest_s) {
    // Of a replay that is faster than its timestamps. Never back: the PDUs after it would be late.
    if (++clock.leads > kMaxFaults) ++untrusted_;
    clock.offset_s += latest_s - time_s;
    return latest_s;
  }
  if (clock.faults <= kMaxFaults && time_s >= arrival_s - kMaxDelay_s) return time_s;
  ++untrusted_;
  if (++clock.faults <= kMaxFaults) clock.offset_s = arrival_s - clock.seconds;
  return arrival_s;
}

}  // namespace emscape::interop::dis
