/// Ports of this computer for tests.
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>

namespace emscape::test {

/// A port that no program uses: the system chooses it for sockets of TCP and UDP that are closed again.
inline std::uint16_t freePort() {
  for (int attempt = 0; attempt < 100; ++attempt) {
    const int tcp = socket(AF_INET, SOCK_STREAM, 0), udp = socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const place = reinterpret_cast<sockaddr*>(&address);
    const bool is_free =
        bind(tcp, place, size) == 0 && getsockname(tcp, place, &size) == 0 && bind(udp, place, size) == 0;
    close(tcp);
    close(udp);
    if (is_free) return ntohs(address.sin_port);
  }
  throw std::runtime_error("there is no free port");
}

}  // namespace emscape::test
