#include "recording/acmi/acmi_handshake.h"

#include <fmt/format.h>

#include <vector>

namespace emscape::interop {
namespace {

constexpr std::string_view kProtocol = "XtraLib.Stream.0\nTacview.RealTimeTelemetry.0\n";

/// UTF-8 as UTF-16LE; bytes that are no UTF-8 as they are.
std::vector<std::uint8_t> utf16(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  const auto add = [&bytes](std::uint32_t unit) {
    bytes.push_back(static_cast<std::uint8_t>(unit));
    bytes.push_back(static_cast<std::uint8_t>(unit >> 8));
  };
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<std::uint8_t>(text[i++]);
    const int more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : first >= 0xC0 ? 1 : 0;
    std::uint32_t code = more == 0 ? first : first & (0x3Fu >> more);
    for (int n = 0; n < more && i < text.size(); ++n)
      code = code << 6 | (static_cast<std::uint8_t>(text[i++]) & 0x3Fu);
    if (code >= 0x10000) {
      add(0xD800 + ((code - 0x10000) >> 10));
      add(0xDC00 + ((code - 0x10000) & 0x3FF));
    } else {
      add(code);
    }
  }
  return bytes;
}

/// The lines of a greeting after its protocol.
std::string afterProtocol(std::string_view hello, std::string& fault) {
  if (hello.substr(0, kProtocol.size()) == kProtocol) return std::string(hello.substr(kProtocol.size()));
  fault = "the other side does not speak Tacview's real-time protocol (XtraLib.Stream.0)";
  return "";
}

}  // namespace

std::string acmiHash64(const std::string& password) {
  std::uint64_t crc = ~std::uint64_t{0};
  for (const std::uint8_t byte : utf16(password)) {
    crc ^= std::uint64_t{byte} << 56;
    for (int bit = 0; bit < 8; ++bit) crc = crc << 1 ^ (crc >> 63 != 0 ? 0x42F0E1EBA9EA3693ull : 0);
  }
  return fmt::format("{:x}", ~crc);
}

std::string acmiHash32(const std::string& password) {
  std::uint32_t crc = ~std::uint32_t{0};
  for (const std::uint8_t byte : utf16(password)) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320u : 0);
  }
  return fmt::format("{:x}", ~crc);
}

std::string acmiClientHello(const std::string& name, const std::string& password) {
  return std::string(kProtocol) + name + "\n" + (password.empty() ? "0" : acmiHash64(password)) + '\0';
}

std::string acmiHostHello(const std::string& name) {
  return std::string(kProtocol) + name + "\n" + '\0';
}

std::string acmiHostFault(std::string_view hello) {
  std::string fault;
  afterProtocol(hello, fault);
  return fault;
}

std::string acmiClientFault(std::string_view hello, const std::string& password) {
  std::string fault;
  const std::string rest = afterProtocol(hello, fault);
  if (!fault.empty() || password.empty()) return fault;
  const std::size_t end = rest.find('\n');
  const std::string hash = end == std::string::npos ? "" : rest.substr(end + 1);
  return hash == acmiHash64(password) || hash == acmiHash32(password) ? "" : "the password is wrong";
}

}  // namespace emscape::interop
