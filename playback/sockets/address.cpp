#include "playback/sockets/address.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>

#include <cstring>
#include <memory>

#include "document/schema_check.h"
#include "emscape/base/error.h"

namespace emscape::playback {

std::string Address::hostText() const {
  return fmt::format("{}.{}.{}.{}", host >> 24, host >> 16 & 255, host >> 8 & 255, host & 255);
}

std::string Address::text() const {
  return fmt::format("{}:{}", hostText(), port);
}

std::uint32_t parseHost(const std::string& text, const std::string& option) {
  in_addr number{};
  if (inet_pton(AF_INET, text.c_str(), &number) == 1) return ntohl(number.s_addr);
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  addrinfo* found = nullptr;
  const int failure = text.empty() ? EAI_NONAME : getaddrinfo(text.c_str(), nullptr, &wanted, &found);
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  if (failure != 0) {
    throw Error(ErrorCode::usage,
                fmt::format("{} '{}': no such host ({}); expected four numbers such as 239.1.2.3, or a name",
                            option, text, gai_strerror(failure)));
  }
  sockaddr_in at{};
  std::memcpy(&at, found->ai_addr, sizeof at);
  return ntohl(at.sin_addr.s_addr);
}

void requireMulticast(const Address& address, const std::string& option) {
  if (address.isMulticast()) return;
  throw Error(ErrorCode::usage, fmt::format("{} goes with a multicast group (224.0.0.0 to 239.255.255.255); "
                                            "{} is an address of one computer or network",
                                            option, address.hostText()));
}

Address parseAddress(const std::string& text, const std::string& option) {
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  const auto number = document::numberOf(port);
  if (!number || *number < 1 || *number > 65535 || *number != static_cast<int>(*number)) {
    throw Error(ErrorCode::usage, fmt::format("{} '{}' is not PORT or HOST:PORT, the port 1..65535, such as "
                                              "3000, 127.0.0.1:3000 or 239.1.2.3:3000",
                                              option, text));
  }
  return {parseHost(colon == std::string::npos ? kLoopback : text.substr(0, colon), option),
          static_cast<std::uint16_t>(*number)};
}

}  // namespace emscape::playback
