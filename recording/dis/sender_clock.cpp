#include "recording/dis/sender_clock.h"

#include <cmath>

namespace emscape::interop::dis {
namespace {

constexpr double kHour_s = 3600;
/// Largest difference (s) between a sender's clock and the arrivals: logs have whole seconds, networks
/// delays.
constexpr double kTolerance_s = 2;
constexpr int kMaxFaults = 3;  ///< restarts of a sender's clock that are followed
constexpr std::size_t kMaxSenders = 65536;

}  // namespace

double SenderClocks::timeOf(const EntityId& sender, const Header& header, double arrival_s) {
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
  if (clock.faults <= kMaxFaults && std::abs(time_s - arrival_s) <= kTolerance_s) return time_s;
  ++untrusted_;
  if (++clock.faults <= kMaxFaults) clock.offset_s = arrival_s - clock.seconds;
  return arrival_s;
}

}  // namespace emscape::interop::dis
