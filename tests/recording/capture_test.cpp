// Packet captures and logs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "recording/dis/datagrams.h"
#include "tests/support/errors.h"

namespace emscape::interop::dis {
namespace {

using testing::HasSubstr;

struct Read {
  std::vector<double> times_s;
  std::vector<std::string> contents;
  ReadingTally tally;
};

template <class Reader>
Read readAll(const std::string& bytes, const Reader& reader) {
  Read read;
  const auto source = openText(bytes);
  reader(*source, read.tally, [&](const Datagram& datagram) {
    read.times_s.push_back(datagram.arrival_s);
    read.contents.emplace_back(reinterpret_cast<const char*>(datagram.bytes), datagram.size);
  });
  return read;
}

std::string little(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i));
  return text;
}
std::string big(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i));
  return text;
}

std::string udp(const std::string& content) {
  return big(4000, 2) + big(3000, 2) + big(8 + content.size(), 2) + big(0, 2) + content;
}
std::string ipv4(const std::string& content, int fragment = 0, int protocol = 17) {
  const std::string body = udp(content);
  return std::string("\x45\0", 2) + big(20 + body.size(), 2) + big(1, 2) +
         big(static_cast<std::uint64_t>(fragment), 2) + big(64, 1) +
         big(static_cast<std::uint64_t>(protocol), 1) + big(0, 2) + big(0x7F000001, 4) + big(0x7F000001, 4) +
         body;
}
std::string ipv6(const std::string& content) {
  const std::string body = udp(content);
  // An header of options before UDP.
  return big(0x60000000, 4) + big(8 + body.size(), 2) + big(0, 1) + big(64, 1) + std::string(32, '\1') +
         std::string("\x11\0\1\4\0\0\0\0", 8) + body;
}
std::string ethernet(int type, const std::string& packet) {
  return std::string(12, '\2') + big(static_cast<std::uint64_t>(type), 2) + packet;
}
std::string classic(const std::string& packet, std::uint32_t link, std::uint32_t magic = 0xA1B2C3D4u,
                    std::uint32_t fraction = 500000) {
  return little(magic, 4) + little(2, 2) + little(4, 2) + little(0, 8) + little(65535, 4) + little(link, 4) +
         little(1000, 4) + little(fraction, 4) + little(packet.size(), 4) + little(packet.size(), 4) + packet;
}

TEST(Capture, DatagramsOfEveryLinkTypeAreFound) {
  const std::string vlan = big(7, 2) + big(0x0800, 2) + ipv4("hello");
  const std::vector<std::string> files{
      classic(ethernet(0x0800, ipv4("hello") + "padding"), 1),
      classic(ethernet(0x8100, vlan), 1),
      classic(ethernet(0x86DD, ipv6("hello")), 1),
      classic(ipv4("hello"), 101),
      classic(ipv6("hello"), 101),
      classic(std::string(14, '\0') + big(0x0800, 2) + ipv4("hello"), 113),
      classic(big(0x0800, 2) + std::string(18, '\0') + ipv4("hello"), 276),
      classic(little(2, 4) + ipv4("hello"), 0),
      classic(ipv4("hello"), 101, 0xA1B23C4Du, 500000000),
  };
  for (std::size_t i = 0; i < files.size(); ++i) {
    const Read read = readAll(files[i], readCapture);
    ASSERT_EQ(read.contents.size(), 1u) << i;
    EXPECT_EQ(read.contents[0], "hello") << i;
    EXPECT_DOUBLE_EQ(read.times_s[0], 1000.5) << i;
    EXPECT_EQ(read.tally.torn, "") << i;
  }
}

TEST(Capture, OtherPacketsAreCounted) {
  EXPECT_EQ(
      readAll(classic(ipv4("x", 0x2000), 101), readCapture).tally.ignored.at("fragments of UDP datagrams"),
      1);
  EXPECT_EQ(readAll(classic(ipv4("x", 0, 6), 101), readCapture).tally.ignored.at("packets other than UDP"),
            1);
  EXPECT_EQ(
      readAll(classic(ethernet(0x0806, "arp"), 1), readCapture).tally.ignored.at("packets other than IP"), 1);
  const std::string whole = ipv4("hello");
  EXPECT_EQ(readAll(classic(whole.substr(0, whole.size() - 2), 101), readCapture)
                .tally.ignored.at("packets cut by the capture"),
            1);
}

TEST(Capture, TornEndIsToldWithItsByte) {
  const std::string file = classic(ipv4("hello"), 101);
  for (std::size_t size = 25; size < file.size(); ++size)
    EXPECT_THAT(readAll(file.substr(0, size), readCapture).tally.torn, HasSubstr("byte 24: within")) << size;
  EXPECT_EQ(readAll(file.substr(0, 24), readCapture).tally.torn, "");
}

TEST(Capture, UnknownLinkTypeIsRefusedWithARemedy) {
  EXPECT_THAT(test::errorOf([] { readAll(classic("x", 105), readCapture); }, ErrorCode::bad_input),
              HasSubstr("packets of link type 105; Ethernet (1)"));
}

std::string block(std::uint32_t type, std::string body) {
  body.resize((body.size() + 3) / 4 * 4);
  const std::string length = little(12 + body.size(), 4);
  return little(type, 4) + length + body + length;
}

TEST(Capture, EnhancedPacketsOfPcapngAreRead) {
  const std::string packet = ipv4("hello");
  const std::uint64_t ticks = 1000500000000ull;  // nanoseconds
  const std::string file =
      block(0x0A0D0D0A, little(0x1A2B3C4D, 4) + little(1, 2) + little(0, 2) + std::string(8, '\xFF')) +
      block(1, little(101, 2) + little(0, 2) + little(65535, 4) + little(9, 2) + little(1, 2) +
                   std::string("\x09\0\0\0", 4)) +
      block(6, little(0, 4) + little(ticks >> 32, 4) + little(ticks & 0xFFFFFFFF, 4) +
                   little(packet.size(), 4) + little(packet.size(), 4) + packet);
  const Read read = readAll(file, readCapture);
  ASSERT_EQ(read.contents.size(), 1u) << read.tally.torn;
  EXPECT_EQ(read.contents[0], "hello");
  EXPECT_DOUBLE_EQ(read.times_s[0], 1000.5);
}

TEST(Capture, WrittenDatagramsAreReadBack) {
  std::ostringstream stream;
  CaptureWriter writer(stream);
  writer.write(1600000000.25, {1, 2, 3});
  writer.write(1600000001.999999, {4});
  const Read read = readAll(stream.str(), readCapture);
  ASSERT_EQ(read.contents.size(), 2u);
  EXPECT_EQ(read.contents[0], "\1\2\3");
  EXPECT_NEAR(read.times_s[1], 1600000001.999999, 1e-6);
}

TEST(HexLog, PairsOfTimeAndBytesAreRead) {
  const Read read = readAll("0\n5 1 ff\n1.5\n0A b\n", readHexLog);
  ASSERT_EQ(read.contents.size(), 2u);
  EXPECT_EQ(read.contents[0], "\5\1\xFF");
  EXPECT_EQ(read.contents[1], "\x0A\x0B");
  EXPECT_EQ(read.times_s[1], 1.5);
  const Read faulty = readAll("0\n5 123\n1\n", readHexLog);
  EXPECT_EQ(faulty.tally.bad, 1);
  EXPECT_THAT(faulty.tally.torn, HasSubstr("line 3: a time without its PDU"));
}

TEST(Session, RecordsAreReadToATornEnd) {
  const std::string file = big(1500, 8) + big(3, 2) + "abc" + big(2000, 8) + big(5, 2) + "de";
  const Read read = readAll(file, readSession);
  ASSERT_EQ(read.contents.size(), 1u);
  EXPECT_EQ(read.contents[0], "abc");
  EXPECT_EQ(read.times_s[0], 1.5);
  EXPECT_THAT(read.tally.torn, HasSubstr("byte 13: within a PDU"));
}

}  // namespace
}  // namespace emscape::interop::dis
