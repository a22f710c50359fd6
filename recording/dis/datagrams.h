/// Datagrams of files that recorded a network: packet captures and logs of DIS.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "recording/common/byte_source.h"
#include "recording/common/recording.h"

namespace emscape::interop::dis {

struct Datagram {
  double arrival_s = 0;  ///< since 1970 in captures, since any time in logs
  const std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
};
using DatagramSink = std::function<void(const Datagram&)>;

/// Calls `sink` for each UDP datagram of a capture: classic .pcap of either byte order and of micro- or
/// nanoseconds, .pcapng with enhanced packet blocks; link types Ethernet (with VLAN tags), raw IP, Linux
/// cooked (1 and 2) and BSD loopback; IPv4 and IPv6. Fragments of datagrams are counted, not joined.
/// @throws Error (bad_input) for another link type
void readCapture(ByteSource& source, ReadingTally& tally, const DatagramSink& sink);

/// The same for the text logs of KDIS: a line with seconds, then a line with the bytes in hexadecimal.
void readHexLog(ByteSource& source, ReadingTally& tally, const DatagramSink& sink);

/// The same for Disco's .session: milliseconds (int64), size (int16), bytes, all big-endian.
void readSession(ByteSource& source, ReadingTally& tally, const DatagramSink& sink);

/// Writes a classic .pcap of IPv4 datagrams, with microseconds.
class CaptureWriter {
 public:
  /// @param stream  must outlive the writer
  explicit CaptureWriter(std::ostream& stream);
  /// @param time_s  since 1970, 0..4294967295  @param bytes  at most 8192
  void write(double time_s, const std::vector<std::uint8_t>& bytes);

 private:
  std::ostream& stream_;
  std::uint16_t count_ = 0;
};

/// Convention of DIS, not part of the standard.
constexpr std::uint16_t kDisPort = 3000;

}  // namespace emscape::interop::dis
