/// Times of PDUs from the timestamps of their senders.
#pragma once

#include <cstdint>
#include <map>

#include "recording/dis/pdu.h"

namespace emscape::interop::dis {

/// Timestamps count within an hour, and senders set them as they like: to the time, to the time since their
/// start, to a counter. A sender's clock is followed as long as it agrees with the arrivals; its first PDU
/// fixes the offset. A clock that is ahead of them, as in a replay at more than the recorded speed, is held
/// back, and one that is too far behind is set again, three times; after that the arrival is the time.
class SenderClocks {
 public:
  /// The time of a PDU on the axis of the arrivals.
  double timeOf(const EntityId& sender, const Header& header, double arrival_s);
  /// PDUs whose timestamps were not used.
  long long untrusted() const { return untrusted_; }

 private:
  struct Clock {
    double seconds = 0;  ///< of the last PDU, without the hours' wrap
    double offset_s = 0;
    int faults = 0, leads = 0;
  };
  std::map<std::uint32_t, Clock> clocks_;  ///< by site and application
  bool has_fractions_ = false;             ///< arrivals are not whole seconds
  long long untrusted_ = 0;
};

}  // namespace emscape::interop::dis
