/// Addresses of IPv4 on the command line.
#pragma once

#include <cstdint>
#include <string>

namespace emscape::playback {

/// Host of addresses that have none: this computer alone.
constexpr const char* kLoopback = "127.0.0.1";

struct Address {
  std::uint32_t host = 0;  ///< IPv4, the first byte highest
  std::uint16_t port = 0;

  /// True for the groups 224.0.0.0 to 239.255.255.255.
  bool isMulticast() const { return host >> 28 == 0xE; }
  std::string hostText() const;
  std::string text() const;  ///< "127.0.0.1:3000"
};

/// Reads "HOST:PORT" or "PORT", the host as four numbers or a name.
/// @param option  for the message
/// @throws Error (usage)
Address parseAddress(const std::string& text, const std::string& option);
/// @param option  that goes with groups alone @throws Error (usage) for another address
void requireMulticast(const Address& address, const std::string& option);
/// Reads a host alone. @throws Error (usage)
std::uint32_t parseHost(const std::string& text, const std::string& option);

}  // namespace emscape::playback
