/// Ports of this computer for tests.
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>

namespace emscape::test {

/// Binds sockets of TCP and UDP to a port of the loopback interface, and closes them again.
/// @param port  0: the system chooses it
/// @return the port; 0 if it is used
inline std::uint16_t boundPort(std::uint16_t port) {
  const int tcp = socket(AF_INET, SOCK_STREAM, 0), udp = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  socklen_t size = sizeof address;
  auto* const place = reinterpret_cast<sockaddr*>(&address);
  const bool is_free =
      bind(tcp, place, size) == 0 && getsockname(tcp, place, &size) == 0 && bind(udp, place, size) == 0;
  close(tcp);
  close(udp);
  return is_free ? ntohs(address.sin_port) : 0;
}

/// A port that no program uses.
inline std::uint16_t freePort() {
  for (int attempt = 0; attempt < 100; ++attempt) {
    if (const std::uint16_t port = boundPort(0)) return port;
  }
  throw std::runtime_error("there is no free port");
}

}  // namespace emscape::test
