#include <fmt/format.h>

#include <array>
#include <cmath>
#include <ostream>

#include "emscape/base/error.h"
#include "recording/common/tally.h"
#include "recording/dis/datagrams.h"

namespace emscape::interop::dis {
namespace {

/// Largest packet and block that are read (bytes).
constexpr std::uint32_t kMaxPacket = 262144, kMaxBlock = 1u << 20;

std::uint16_t bigU16(const std::uint8_t* bytes) {
  return static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]);
}

/// Numbers of a capture's own headers, in the byte order of the machine that wrote them.
class Order {
 public:
  explicit Order(bool is_big) : is_big_(is_big) {}
  std::uint32_t u32(const std::uint8_t* b) const {
    return is_big_ ? std::uint32_t{b[0]} << 24 | std::uint32_t{b[1]} << 16 | std::uint32_t{b[2]} << 8 | b[3]
                   : std::uint32_t{b[3]} << 24 | std::uint32_t{b[2]} << 16 | std::uint32_t{b[1]} << 8 | b[0];
  }
  std::uint16_t u16(const std::uint8_t* b) const {
    return is_big_ ? bigU16(b) : static_cast<std::uint16_t>(b[1] << 8 | b[0]);
  }

 private:
  bool is_big_;
};

enum LinkType : std::uint32_t {
  bsd_loopback = 0,
  ethernet = 1,
  raw_ip = 101,
  linux_cooked = 113,
  raw_ipv4 = 228,
  raw_ipv6 = 229,
  linux_cooked_2 = 276
};

void requireKnown(std::uint32_t link_type) {
  for (const std::uint32_t known :
       {bsd_loopback, ethernet, raw_ip, linux_cooked, raw_ipv4, raw_ipv6, linux_cooked_2}) {
    if (link_type == known) return;
  }
  throw Error(ErrorCode::bad_input,
              fmt::format("packets of link type {}; Ethernet (1), raw IP (101, 228, 229), Linux cooked (113, "
                          "276) and BSD loopback (0) are read: capture on an Ethernet interface, or convert "
                          "the file with editcap -T",
                          link_type));
}

/// Bytes of a packet.
struct Bytes {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
  bool has(std::size_t count) const { return size >= count; }
  void skip(std::size_t count) {
    data += count;
    size -= count;
  }
};

/// Skips the header of the link layer. @return false if it is not one of IP
bool skipLink(Bytes& packet, std::uint32_t link_type) {
  std::size_t header = 0, type_at = 0;
  switch (link_type) {
    case ethernet:
      header = 14, type_at = 12;
      break;
    case linux_cooked:
      header = 16, type_at = 14;
      break;
    case linux_cooked_2:
      header = 20, type_at = 0;
      break;
    case bsd_loopback:
      if (!packet.has(4)) return false;
      packet.skip(4);
      return true;
    default:
      return true;
  }
  if (!packet.has(header)) return false;
  std::uint16_t type = bigU16(packet.data + type_at);
  packet.skip(header);
  while ((type == 0x8100 || type == 0x88A8) && packet.has(4)) {  // a VLAN tag
    type = bigU16(packet.data + 2);
    packet.skip(4);
  }
  return type == 0x0800 || type == 0x86DD;
}

enum class Content { udp, fragment, other };

/// Skips the header of IP, and cuts the padding after the packet.
Content skipIp(Bytes& packet) {
  constexpr std::uint8_t kUdp = 17;
  if (!packet.has(20)) return Content::other;
  const int version = packet.data[0] >> 4;
  if (version == 4) {
    const std::size_t header = 4u * (packet.data[0] & 15), total = bigU16(packet.data + 2);
    if (header < 20 || !packet.has(header)) return Content::other;
    if (packet.data[9] != kUdp) return Content::other;
    if ((bigU16(packet.data + 6) & 0x3FFF) != 0) return Content::fragment;
    if (total >= header && total < packet.size) packet.size = total;
    packet.skip(header);
    return Content::udp;
  }
  if (version != 6 || !packet.has(40)) return Content::other;
  std::uint8_t next = packet.data[6];
  packet.skip(40);
  while (next == 0 || next == 43 || next == 60) {  // headers of options and routing
    if (!packet.has(8)) return Content::other;
    const std::size_t size = 8 * (std::size_t{packet.data[1]} + 1);
    if (!packet.has(size)) return Content::other;
    next = packet.data[0];
    packet.skip(size);
  }
  if (next == 44) return Content::fragment;
  return next == kUdp ? Content::udp : Content::other;
}

void takePacket(Bytes packet, std::uint32_t link_type, double arrival_s, ReadingTally& tally,
                const DatagramSink& sink) {
  if (!skipLink(packet, link_type)) return countIgnored(tally, "packets other than IP");
  switch (skipIp(packet)) {
    case Content::other:
      return countIgnored(tally, "packets other than UDP");
    case Content::fragment:
      return countIgnored(tally, "fragments of UDP datagrams");
    case Content::udp:
      break;
  }
  if (!packet.has(8)) return countIgnored(tally, "packets cut by the capture");
  const std::size_t length = bigU16(packet.data + 4);
  packet.skip(8);
  if (length < 8 || length - 8 > packet.size) return countIgnored(tally, "packets cut by the capture");
  sink({arrival_s, packet.data, length - 8});
}

void readClassic(RecordReader& reader, const std::vector<std::uint8_t>& magic, ReadingTally& tally,
                 const DatagramSink& sink) {
  const bool is_big = magic[0] == 0xA1;
  const Order order(is_big);
  const double unit_s = order.u32(magic.data()) == 0xA1B23C4Du ? 1e-9 : 1e-6;
  std::vector<std::uint8_t> bytes;
  if (!reader.read(20, bytes)) {
    tally.torn = "within the header of the capture";
    return;
  }
  const std::uint32_t link_type = order.u32(bytes.data() + 16) & 0xFFFF;
  requireKnown(link_type);
  for (;;) {
    const std::uint64_t at = reader.offset();
    if (!reader.read(16, bytes)) {
      if (!bytes.empty()) tally.torn = fmt::format("byte {}: within the header of a packet", at);
      return;
    }
    const double arrival_s = order.u32(bytes.data()) + order.u32(bytes.data() + 4) * unit_s;
    const std::uint32_t size = order.u32(bytes.data() + 8);
    if (size > kMaxPacket) {
      tally.torn =
          fmt::format("byte {}: a packet of {} bytes, more than the allowed {}", at, size, kMaxPacket);
      return;
    }
    if (!reader.read(size, bytes)) {
      tally.torn = fmt::format("byte {}: within a packet", at);
      return;
    }
    takePacket({bytes.data(), bytes.size()}, link_type, arrival_s, tally, sink);
  }
}

/// An interface of a .pcapng file.
struct Interface {
  std::uint32_t link_type = 0;
  double unit_s = 1e-6;
};

Interface interfaceOf(const std::vector<std::uint8_t>& block, const Order& order) {
  Interface result;
  if (block.size() < 8) return result;
  result.link_type = order.u16(block.data());
  for (std::size_t at = 8; at + 4 <= block.size();) {
    const std::uint16_t option = order.u16(block.data() + at), size = order.u16(block.data() + at + 2);
    if (option == 9 && size == 1 && at + 4 < block.size()) {  // if_tsresol
      const std::uint8_t power = block[at + 4];
      result.unit_s = (power & 0x80) != 0 ? std::pow(2.0, -(power & 0x7F)) : std::pow(10.0, -power);
    }
    if (option == 0) break;
    at += 4 + (size + 3u) / 4 * 4;
  }
  return result;
}

void readBlocks(RecordReader& reader, std::vector<std::uint8_t> type, ReadingTally& tally,
                const DatagramSink& sink) {
  Order order(false);
  std::vector<Interface> interfaces;
  std::vector<std::uint8_t> head, block;
  for (;;) {
    const std::uint64_t at = reader.offset() - type.size();
    if (!reader.read(4, head)) {
      tally.torn = fmt::format("byte {}: within the header of a block", at);
      return;
    }
    const bool is_section = type == std::vector<std::uint8_t>{0x0A, 0x0D, 0x0D, 0x0A};
    std::uint32_t body = 0;
    if (is_section) {
      if (!reader.read(4, block)) {
        tally.torn = fmt::format("byte {}: within the header of a section", at);
        return;
      }
      order = Order(block[0] == 0x1A);
      interfaces.clear();
      body = 4;  // read already
    }
    const std::uint32_t length = order.u32(head.data());
    if (length < 12 + body || length > kMaxBlock || length % 4 != 0) {
      tally.torn = fmt::format("byte {}: a block of {} bytes, outside 12 to {}", at, length, kMaxBlock);
      return;
    }
    if (!reader.read(length - 12 - body, block) || !reader.read(4, head)) {
      tally.torn = fmt::format("byte {}: within a block", at);
      return;
    }
    const std::uint32_t kind = order.u32(type.data());
    if (kind == 1 && interfaces.size() < 4096) {
      interfaces.push_back(interfaceOf(block, order));
      requireKnown(interfaces.back().link_type);
    } else if (kind == 6 && block.size() >= 20) {  // an enhanced packet
      const std::uint32_t interface = order.u32(block.data()), size = order.u32(block.data() + 12);
      if (interface < interfaces.size() && size <= block.size() - 20) {
        const double ticks = order.u32(block.data() + 4) * 4294967296.0 + order.u32(block.data() + 8);
        takePacket({block.data() + 20, size}, interfaces[interface].link_type,
                   ticks * interfaces[interface].unit_s, tally, sink);
      } else {
        countIgnored(tally, "packets of an unknown interface or size");
      }
    } else if (kind == 3 || kind == 2) {
      countIgnored(tally, "packets without a time, or of an obsolete block");
    }
    if (!reader.read(4, type)) {
      if (!type.empty()) tally.torn = fmt::format("byte {}: within a block", reader.offset());
      return;
    }
  }
}

/// Of the header of IPv4. @see RFC 1071
std::uint16_t checksumOf(const std::uint8_t* bytes, std::size_t size) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < size; i += 2) sum += bigU16(bytes + i);
  while (sum > 0xFFFF) sum = (sum & 0xFFFF) + (sum >> 16);
  return static_cast<std::uint16_t>(~sum);
}

void writeLittle(std::ostream& stream, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) stream.put(static_cast<char>(value >> (8 * i)));
}

}  // namespace

void readCapture(ByteSource& source, ReadingTally& tally, const DatagramSink& sink) {
  RecordReader reader(source);
  std::vector<std::uint8_t> magic;
  if (!reader.read(4, magic)) throw Error(ErrorCode::bad_input, "the capture has no header");
  if (magic[0] == 0x0A) {
    readBlocks(reader, magic, tally, sink);
  } else {
    readClassic(reader, magic, tally, sink);
  }
}

CaptureWriter::CaptureWriter(std::ostream& stream) : stream_(stream) {
  writeLittle(stream_, 0xA1B2C3D4u, 4);
  writeLittle(stream_, 2, 2);
  writeLittle(stream_, 4, 2);
  writeLittle(stream_, 0, 8);
  writeLittle(stream_, 65535, 4);
  writeLittle(stream_, raw_ip, 4);
}

void CaptureWriter::write(double time_s, const std::vector<std::uint8_t>& bytes) {
  const std::size_t udp = 8 + bytes.size(), total = 20 + udp;
  const auto microseconds = static_cast<std::uint64_t>(std::llround(time_s * 1e6));
  writeLittle(stream_, microseconds / 1000000, 4);
  writeLittle(stream_, microseconds % 1000000, 4);
  writeLittle(stream_, total, 4);
  writeLittle(stream_, total, 4);
  const auto high = [](std::size_t value) { return static_cast<std::uint8_t>(value >> 8); };
  const auto low = [](std::size_t value) { return static_cast<std::uint8_t>(value & 0xFF); };
  ++count_;
  // Version 4; not fragmented; a lifetime of 1 hop; UDP; from 10.0.0.1 to the multicast group 239.1.2.3.
  std::array<std::uint8_t, 28> head{0x45, 0,  high(total), low(total), high(count_), low(count_), 0x40, 0,
                                    1,    17, 0,           0,          10,           0,           0,    1,
                                    239,  1,  2,           3};
  const std::uint16_t checksum = checksumOf(head.data(), 20);
  head[10] = high(checksum);
  head[11] = low(checksum);
  head[20] = head[22] = high(kDisPort);
  head[21] = head[23] = low(kDisPort);
  head[24] = high(udp);
  head[25] = low(udp);
  stream_.write(reinterpret_cast<const char*>(head.data()), static_cast<std::streamsize>(head.size()));
  stream_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace emscape::interop::dis
